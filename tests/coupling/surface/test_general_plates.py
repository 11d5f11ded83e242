"""Parts on plates of varying thickness and on foundations, made in Python."""

import numpy as np
import pytest

import meshes
from coupling import surface_motion
from fem_plate import Plate, PlateSection, VaryingSection
from particle import CoulombAdhesion, Drive, Micropart, simulate

RADIUS = 300e-6  # m
SILICON = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330)
POINTS = [[-200e-6, 0.0], [200e-6, 0.0]]
PART = Micropart(mass=2e-9, position=(-120e-6, -80e-6))
LAW = CoulombAdhesion(0.02, 700e-9)


def path(plate, drives, points=POINTS):
    surface = surface_motion(plate.influence(points), drives, half_thickness=2.5e-6)
    return simulate(surface, PART, LAW, 2e-3)


@pytest.mark.compiled
def test_an_even_thickness_gives_the_path_of_the_uniform_plate():
    mesh, drives = meshes.disc(RADIUS, 60e-6), [Drive(10e-6, 1300.0), Drive(10e-6, 1000.0)]
    uniform = path(Plate(mesh, SILICON, tolerance=1e-7), drives)
    even = VaryingSection(SILICON, lambda x, y: 5e-6 + 0 * x)
    other = path(Plate(mesh, even, tolerance=1e-7), drives)
    assert uniform.distance > 1e-7
    np.testing.assert_allclose(other.position[-1], uniform.position[-1], atol=1e-4 * uniform.distance)


@pytest.mark.compiled
def test_a_mirrored_thickness_and_mirrored_drives_give_the_mirrored_path():
    mesh, ends = meshes.disc(RADIUS, 60e-6), []
    for way in (1, -1):
        thickness = VaryingSection(SILICON, lambda x, y, way=way: 5e-6 * (1 + 0.3 * way * x / RADIUS))
        plate = Plate(mesh, thickness, tolerance=1e-6)
        part = Micropart(mass=2e-9, position=(-120e-6 * way, -80e-6))
        drives = [Drive(10e-6, 1300.0), Drive(10e-6, 1000.0)][::way]
        surface = surface_motion(plate.influence(POINTS), drives, half_thickness=2.5e-6)
        ends.append(simulate(surface, part, LAW, 2e-3))
    assert ends[0].distance > 1e-7
    mirrored = ends[1].position[-1] * [-1, 1]
    np.testing.assert_allclose(mirrored, ends[0].position[-1], atol=1e-3 * ends[0].distance)
