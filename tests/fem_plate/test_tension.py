"""Plates under a tension: where there is one, what it leaves as it is, and how cells follow it."""

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.elements.forms import triangle_quadrature
from meshes import annulus, disc, polygon, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)


def test_a_free_rim_carries_no_tension():
    mesh = annulus(0.3, 1.0, 0.3)
    with pytest.raises(ValueError, match=r"must be 0 where a boundary is free.*got 5.0 N/m, and free 'inner'"):
        Plate(mesh, UNIT, {"outer": "clamped"}, tension=5.0)
    assert Plate(mesh, UNIT, {"outer": "clamped"}).tension == 0
    with pytest.raises(ValueError, match="must be 0 where a boundary is free"):
        Plate(mesh, UNIT, {"outer": "clamped"}).buckling_load()
    with pytest.raises(ValueError, match="Input tension of Plate must be finite; got nan"):
        Plate(mesh, UNIT, tension=float("nan"))


def test_compression_is_refused_where_the_plate_buckles():
    with pytest.raises(ValueError, match=r"must exceed -14.68\d* N/m, at which it buckles; got -14.7"):
        Plate(disc(1.0, 0.25), UNIT, tension=-14.7)
    section = PlateSection(169e9, 0.3, 5e-6)
    load = 14.681970642 * section.rigidity / 3e-4**2
    assert Plate(disc(3e-4, 5e-5), section).buckling_load() == pytest.approx(load, rel=1e-6)
    with pytest.raises(ValueError, match=f"must exceed -{load:.5g}"):
        Plate(disc(3e-4, 5e-5), section, tension=-1.001 * load)
    near = Plate(disc(1.0, 0.25), UNIT, tension=-14.6)
    assert near.frequencies(1) < 0.1 * Plate(disc(1.0, 0.25), UNIT).frequencies(1)
    assert (
        near.pressure(1.0).evaluate([[0, 0]])[0]
        > 100 * Plate(disc(1.0, 0.25), UNIT).pressure(1.0).evaluate([[0, 0]])[0]
    )


def test_large_deflections_have_no_tension_yet():
    with pytest.raises(ValueError, match="Input tension of Plate must be 0 for large_deflection; got 1.0 N/m"):
        Plate(disc(1.0, 0.5), UNIT, tension=1.0).large_deflection([[0.0, 0.0]])


def test_a_plate_says_its_tension():
    assert repr(Plate(disc(1.0, 0.5), UNIT, tension=3.0)).endswith("rim clamped; tension 3 N/m")
    assert "tension" not in repr(Plate(disc(1.0, 0.5), UNIT))


def test_a_large_plate_is_a_small_one():
    """tension a^2 / D, and nothing else, changes the shape."""
    section, a = PlateSection(169e9, 0.3, 5e-6), 3e-4
    small = Plate(disc(a, a / 5), section, tension=40 * section.rigidity / a**2).influence([[0.2 * a, 0.0]])
    unit = Plate(disc(1.0, 0.2), UNIT, tension=40.0).influence([[0.2, 0.0]])
    xy = np.random.default_rng(0).uniform(-0.7, 0.7, (20, 2))
    assert np.allclose(small.values(a * xy), unit.values(xy), rtol=1e-9, atol=1e-12)


def test_the_stretching_matrix_is_the_integral_of_the_gradients():
    """On functions that vanish at the rim of a straight-sided plate; by quadrature of `evaluate`."""
    mesh = rectangle(2.0, 1.0, 0.3)
    model = Plate(mesh, UNIT).model()
    space = model.space
    v = model.under_pressure()[:, 0] + 0 * 1.0
    points, weights = space.quadrature
    _, gradient = space.evaluate(points, v[:, None], 2)
    stretching = space.stretching()
    assert abs(stretching - stretching.T).max() < 1e-9 * abs(stretching).max()
    of_area = (weights[:, None] * gradient[:, 0] ** 2).sum()
    rim = space.rim
    value, slope = space.evaluate(rim.points.reshape(-1, 2), v[:, None], 2)
    across = (slope[:, 0] * rim.normal.reshape(-1, 2)).sum(axis=1)
    penalty = np.repeat(200.0 / rim.h, rim.weights.shape[1]) * value[:, 0] ** 2
    of_rim = (rim.weights.ravel() * (penalty - 2 * value[:, 0] * across)).sum()
    assert v @ (stretching @ v) == pytest.approx(of_area + of_rim, rel=1e-10)
    assert triangle_quadrature(7)[1].sum() == pytest.approx(0.5)


def test_work_and_energy_agree():
    """Of a force: its work is the energy of bending and stretching, so that a tension lowers it."""
    places = [[0.3, 0.1], [-0.4, 0.2]]
    compliances = [
        Plate(polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.25), UNIT, tension=tension)
        .influence(np.array(places) * 0.5 + 0.5)
        .compliance
        for tension in (-5.0, 0.0, 5.0, 50.0, 500.0)
    ]
    for softer, stiffer in zip(compliances[:-1], compliances[1:], strict=True):
        assert np.linalg.eigvalsh(softer - stiffer).min() > 0
        assert np.allclose(stiffer, stiffer.T, rtol=1e-9)


def test_cells_follow_the_layer_at_the_rim():
    mesh = disc(1.0, 0.125)
    assert Plate(mesh, UNIT, tension=10.0).model().mesh is mesh  # the layer is as wide as half a cell there
    fine = Plate(mesh, UNIT, tension=100.0).model().mesh
    depth = 1 - np.hypot(*fine.points[fine.triangles].mean(axis=1).T)
    assert fine.cell_sizes[depth < 0.05].max() < 0.11 < fine.cell_sizes[depth > 0.5].min()
    assert len(Plate(mesh, UNIT, tension=1e8).model().mesh.triangles) < 5000
    halved = Plate(mesh, UNIT, tension=100.0).model(halvings=1).mesh
    assert halved.cell_sizes.max() < 0.6 * fine.cell_sizes.max()
    assert 3 * len(fine.triangles) < len(halved.triangles) < 6 * len(fine.triangles)


@pytest.mark.slow
def test_a_layer_too_thin_for_the_cells_is_in_the_estimate():
    """Of width 1e-3, in the limit of 100 000 unknowns; the membrane's own answer lies a layer's width off."""
    deflection = Plate(disc(1.0, 0.25), UNIT, tolerance=1e-8, tension=1e6).pressure(1.0)
    from scipy.special import i0e, i1e

    k = 1e3
    centre = 1 / (4 * k**2) - i0e(k) / i1e(k) / (2 * k**3)  # of which b I_0(0) is nothing
    error = abs(deflection.evaluate([[0.0, 0.0]])[0][0] / centre - 1)
    assert 1e-8 < error < 5 * deflection.error_estimate < 1e-2


@pytest.mark.slow
def test_shapes_on_patches_are_those_on_the_whole_plate():
    pitch, side = 1.0, np.arange(26) - 12.5
    points = np.stack([side, 0 * side], axis=1)
    plate = Plate(rectangle(27 * pitch, 4 * pitch, pitch), UNIT, tension=3.0)
    patched = plate.influence(points, truncation=1e-6)
    dense = Plate(plate.mesh.refined().refined(), UNIT, tension=3.0).influence(points)
    assert len({id(tile.patch) for tile in patched.tiles}) > 1
    xy = np.random.default_rng(2).uniform([-13, -1.8], [13, 1.8], (150, 2))
    strokes = np.random.default_rng(3).uniform(-1, 1, len(points))
    pairs = zip(patched.evaluate(xy, strokes), dense.evaluate(xy, strokes), strict=True)
    for (one, other), bound in zip(pairs, (1e-6, 1e-5, 1e-4), strict=True):
        assert np.abs(one - other).max() < bound * np.abs(other).max()
    plain = Plate(plate.mesh, UNIT).influence(points, truncation=1e-6)
    assert np.abs(plain.evaluate(xy, strokes)[0] - patched.evaluate(xy, strokes)[0]).max() > 0.05
    assert patched.compliance_at([0.0, 0.4]) < plain.compliance_at([0.0, 0.4])
    assert patched.first_frequency(1.0) > plain.first_frequency(1.0)
