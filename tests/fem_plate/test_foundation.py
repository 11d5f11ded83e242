"""Plates on elastic foundations, against Kelvin functions and shifted frequencies."""

import re

import numpy as np
import pytest
from radial_plates import disc_on_foundation

import meshes
from fem_plate import MeasuredInfluence, Plate, PlateSection, backbone, fit_influence

UNIT = PlateSection(12 * (1 - 0.3**2), 0.3, 1.0, density=1.0)  # rigidity 1 N m
RADII = np.array([0.05, 0.2, 0.5, 0.7])
ON_RADII = np.stack([RADII * np.cos(1.0), RADII * np.sin(1.0)], axis=1)


@pytest.mark.parametrize(("modulus", "tolerance"), [(300.0, 1e-7), (1e5, 1e-5)])
def test_a_clamped_disc_bends_as_kelvins_functions_say(modulus, tolerance):
    plate = Plate(meshes.disc(1.0, 0.1), UNIT, foundation=modulus, tolerance=tolerance)
    found = plate.deflection([[0.0, 0.0]], [1.0])
    expected = disc_on_foundation(modulus, RADII)
    error = np.abs(found.evaluate(ON_RADII)[0] - expected).max() / np.abs(expected).max()
    assert error < 2 * tolerance and error < 3 * found.error_estimate


@pytest.mark.parametrize("support", ["clamped", "simply-supported", "free"])
def test_a_foundation_adds_its_modulus_over_the_mass_to_squared_frequencies(support):
    mesh, modulus, rigid = meshes.disc(1.0, 0.3), 300.0, 3 if support == "free" else 0
    alone = Plate(mesh, UNIT, support).frequencies(4)
    found = Plate(mesh, UNIT, support, foundation=modulus).frequencies(4 + rigid)
    expected = np.sqrt(np.concatenate([np.zeros(rigid), alone**2]) + modulus / (2 * np.pi) ** 2)
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_a_free_plate_on_a_foundation_sinks_evenly_under_a_pressure():
    plate = Plate(meshes.rectangle(1.0, 0.7, 0.2), UNIT, "free", foundation=50.0)
    w, gradient, _ = plate.pressure(2.0).evaluate([[0.0, 0.0], [0.3, 0.2]])
    np.testing.assert_allclose(w, 2.0 / 50.0, rtol=1e-8)
    np.testing.assert_allclose(gradient, 0.0, atol=1e-8)


def test_a_pad_between_the_mesh_s_points_holds_the_plate():
    """Its modulus is 0 at all vertices; the rigid motions of the plate are none, whatever the cells."""

    def pad(x, y):
        return 300 * np.exp(-(((x - 0.11) ** 2 + (y - 0.07) ** 2) / 0.004))

    coarse, fine = (Plate(meshes.disc(1.0, cell), UNIT, "free", foundation=pad) for cell in (0.5, 0.2))
    assert not coarse.model().rigid.size
    np.testing.assert_allclose(coarse.frequencies(3), fine.frequencies(3), rtol=0.05)
    with pytest.raises(ValueError, match="must leave it stable"):
        Plate(meshes.disc(1.0, 0.5), UNIT, foundation=lambda x, y: -60 * pad(x, y))


@pytest.mark.slow
def test_the_compliance_follows_the_modulus():
    """dw/dk = -int (1 + x) w^2 at a unit force."""
    mesh, point = meshes.disc(1.0, 0.2), np.array([[0.2, 0.1]])
    plate = Plate(mesh, UNIT, foundation=lambda x, y: 500 * (1 + x), tolerance=1e-6)
    shape = plate.deflection(point, [1.0])
    points, weights = shape.model.space.quadrature
    w = shape.functions.values(points)[:, 0]
    shift = 1e-4
    stiffer = Plate(mesh, UNIT, foundation=lambda x, y: (500 + shift) * (1 + x), tolerance=1e-6).deflection(
        point, [1.0]
    )
    change = (stiffer.evaluate(point)[0] - shape.evaluate(point)[0])[0] / shift
    assert change == pytest.approx(-(weights @ ((1 + points[:, 0]) * w**2)), rel=1e-4)


def test_an_electrode_softens_until_the_plate_buckles():
    mesh = meshes.disc(1.0, 0.3)
    first = (2 * np.pi * Plate(mesh, UNIT).frequencies(1)[0]) ** 2
    soft = Plate(mesh, UNIT, foundation=-0.9 * first)
    assert 2 * np.pi * soft.frequencies(1)[0] == pytest.approx(np.sqrt(0.1 * first), rel=1e-8)
    with pytest.raises(ValueError, match="foundation of Plate must exceed .*, at which it buckles") as wrong:
        Plate(mesh, UNIT, foundation=-1.01 * first)
    assert float(re.search(r"exceed (\S+) N", str(wrong.value))[1]) == pytest.approx(-first, rel=1e-5)
    pulled = Plate(mesh, UNIT, foundation=-1.2 * first, tension=50.0)  # a stretched membrane over an electrode
    assert pulled.frequencies(1)[0] > 0
    with pytest.raises(ValueError, match="foundation of Plate must exceed"):
        pulled.buckling_load()


def test_any_softening_moves_a_free_plate():
    with pytest.raises(ValueError, match=r"must exceed 0 N/m\^3, at which it buckles .*; got -1.0"):
        Plate(meshes.disc(1.0, 0.5), UNIT, "free", foundation=-1.0)


def test_compression_counts_with_a_foundation():
    mesh = meshes.disc(1.0, 0.3)
    alone, on_foundation = Plate(mesh, UNIT).buckling_load(), Plate(mesh, UNIT, foundation=200.0).buckling_load()
    assert on_foundation > 1.2 * alone
    with pytest.raises(ValueError, match="at which it buckles"):
        Plate(mesh, UNIT, foundation=200.0, tension=-1.01 * on_foundation)
    Plate(mesh, UNIT, foundation=200.0, tension=-0.99 * on_foundation)


def test_a_foundation_of_no_use_is_named():
    mesh = meshes.disc(1.0, 0.5)
    for foundation in (np.nan, "soft"):
        with pytest.raises(ValueError, match="foundation of Plate must be a finite number or a callable; got"):
            Plate(mesh, UNIT, foundation=foundation)
    with pytest.raises(ValueError, match=r"foundation of Plate must be finite on the plate; got inf N/m\^3 at \("):
        Plate(mesh, UNIT, foundation=lambda x, y: np.where(x > 0.5, np.inf, 1.0))


@pytest.mark.slow
def test_a_foundation_stays_while_stiffness_and_tension_are_fitted():
    plate, points = Plate(meshes.disc(1.0, 0.25), UNIT, tension=10.0, foundation=300.0), [[0.3, 0.1], [-0.2, 0.4]]
    grid = np.stack(np.meshgrid(np.linspace(-0.7, 0.7, 15), np.linspace(-0.7, 0.7, 15)), axis=-1).reshape(-1, 2)
    values = plate.influence(points, stiffness=40.0).values(grid).T
    measured = MeasuredInfluence("specula", grid, values, np.arange(2), True, (15, 15))
    found = fit_influence(measured, Plate(plate.mesh, UNIT, tension=1.0, foundation=300.0), points)
    assert (found.stiffness, found.tension) == pytest.approx((40.0, 10.0), rel=1e-5)


def test_what_stretches_has_no_foundation():
    plate = Plate(meshes.disc(1.0, 0.5), UNIT, foundation=1.0)
    for wrong in (lambda: plate.large_deflection([[0.0, 0.0]]), lambda: backbone(plate, 1)):
        with pytest.raises(ValueError, match="foundation of Plate must be 0 for (large_deflection|backb)"):
            wrong()


def test_a_jump_inside_a_cell_draws_a_warning_and_along_edges_it_does_not():
    mesh = meshes.rectangle(2.0, 1.0, 0.25)
    assert np.any(mesh.points[:, 0] == 0)
    with pytest.warns(UserWarning, match=r"change abruptly at \(0.0.*, .*\) m, inside a cell"):
        Plate(mesh, UNIT, foundation=lambda x, y: np.where(x > 0.06, 1e3, 0.0))
    Plate(mesh, UNIT, foundation=lambda x, y: np.where(x > 0, 1e3, 0.0))
