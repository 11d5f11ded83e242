"""Parts on plates of varying thickness and on foundations, made in Python."""

import numpy as np
import pytest

import meshes
from coupling import Case, run_case, surface_motion
from fem_plate import AnisotropicSection, Plate, PlateSection, VaryingSection
from particle import CoulombAdhesion, Drive, Micropart, simulate

RADIUS = 300e-6  # m
SILICON = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=5e-6, density=2330)
POINTS = [[-200e-6, 0.0], [200e-6, 0.0]]
PART = Micropart(mass=2e-9, position=(-120e-6, -80e-6))
LAW = CoulombAdhesion(0.02, 700e-9)


def path(plate, drives, points=POINTS):
    surface = surface_motion(plate.influence(points), drives, half_thickness=2.5e-6)
    return simulate(surface, PART, LAW, 2e-3)


@pytest.mark.slow
@pytest.mark.compiled
def test_an_even_thickness_gives_the_path_of_the_uniform_plate():
    mesh, drives = meshes.disc(RADIUS, 60e-6), [Drive(10e-6, 1300.0), Drive(10e-6, 1000.0)]
    uniform = path(Plate(mesh, SILICON, tolerance=1e-7), drives)
    twice = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=10e-6, density=2330)
    even = VaryingSection(twice, lambda x, y: 5e-6 + 0 * x)
    other = path(Plate(mesh, even, tolerance=1e-7), drives)
    assert uniform.distance > 1e-7
    np.testing.assert_allclose(other.position[-1], uniform.position[-1], atol=1e-4 * uniform.distance)


@pytest.mark.slow
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


@pytest.mark.slow
@pytest.mark.parametrize("reference", [5e-6, 10e-6])
def test_cells_follow_the_logarithm_at_each_actuator(reference):
    """It is as strong as the plate is soft there."""
    section = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=reference)
    sloped = VaryingSection(section, lambda x, y: 5e-6 * (1 + 0.3 * x / RADIUS))
    shapes = Plate(meshes.disc(RADIUS, 60e-6), sloped, tolerance=1e-6).influence(POINTS)
    surface = surface_motion(shapes, [Drive(1e-6, 1.0), Drive(0.0, 1.0)])
    near = np.array(POINTS[0]) + 1e-7 * np.array([[3.0, 1.0], [-1.0, 2.0]])
    state = surface.evaluate(near, 0.5)  # the first actuator is up
    np.testing.assert_allclose(state.hessian, shapes.evaluate(near, np.array([1e-6, 0.0]))[2], rtol=2e-3)


@pytest.mark.compiled
def test_a_case_with_a_wafer_on_a_foundation_runs():
    """Its first frequency is the plate's, and 1e10 N/m^3 raises it."""
    case = Case(
        plate={"shape": "disc", "radius": RADIUS, "thickness": 5e-6, "density": 2330.0, "cell_size": 60e-6}
        | {"wafer": "100", "foundation": 1e10},
        actuators=[{"position": (0.0, 0.0), "stroke": 1e-7, "frequency": 1e3}],
        part={"mass": 2e-9, "position": (1e-4, 0.0)},
        friction={"model": "coulomb", "coefficient": 0.1},
        run={"duration": 1e-4},
    )
    summary = run_case(case).summary
    wafer = AnisotropicSection.cubic((165.7e9, 63.9e9, 79.6e9), 5e-6, 2330.0)
    alone = Plate(meshes.disc(RADIUS, 60e-6), wafer).frequencies(1, [[0.0, 0.0]])[0]
    raised = np.sqrt(alone**2 + 1e10 / (2330.0 * 5e-6) / (2 * np.pi) ** 2)
    assert summary.first_frequency == pytest.approx(raised, rel=1e-3)
