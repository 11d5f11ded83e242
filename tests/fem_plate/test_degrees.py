"""Elements of more than degree five: which plates have them, and that they solve what they should."""

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from fem_plate import AnisotropicSection, DiscShapes, Plate, PlateSection
from fem_plate.elements.model import PlateModel
from meshes import annulus, disc, ellipse, polygon, rectangle, regular_polygon

UNIT = PlateSection(12 * (1 - 0.3**2), 0.3, 1.0, density=1.0)  # rigidity 1 N m
C, S, F = "clamped", "simply-supported", "free"
POINTS = np.array([[0.3, 0.1], [-0.2, 0.4], [0.1, -0.5]])
L_SHAPE = [(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)]


@pytest.mark.parametrize("degree", [6, 8, 10])
def test_condensed_equations_have_the_answer_of_all_of_them(degree):
    mesh = disc(1.0, 0.5)
    model = PlateModel(mesh, {"rim": C}, UNIT.law, degree=degree)
    load = model.space.mass() @ model.space.linear()
    found, expected = model.solve(load), spsolve(model.space.stiffness(UNIT.law), load)
    for got, wanted in zip(*(model.space.evaluate(POINTS, u, 3) for u in (found, expected)), strict=True):
        assert np.abs(got - wanted).max() < 1e-8 * np.abs(wanted).max()
    assert model.solve(load[:, 0]) == pytest.approx(found[:, 0], rel=1e-9, abs=1e-9 * np.abs(found).max())
    assert model.solve(load[:, :0]).shape == (model.unknowns, 0)


def test_errors_fall_with_the_degree_down_to_rounding():
    """Without the correction of what the penalties leave the last Hessian would be off by 5e-7."""
    at = np.random.default_rng(2).uniform(-0.7, 0.7, (400, 2))
    at = at[np.linalg.norm(at[:, None] - POINTS, axis=2).min(axis=1) > 0.02]
    at = np.concatenate([at, 0.999 * np.array([[np.cos(t), np.sin(t)] for t in np.arange(0, 6, 0.05)])])
    plate, exact = Plate(disc(1.0, 1 / 6), UNIT), DiscShapes(POINTS, 1.0).derivatives(at, None)
    errors = []
    for degree in (5, 6, 8, 10):
        plate._degrees = lambda points, degree=degree: range(degree, degree + 1)
        found = plate.influence(POINTS).derivatives(at / plate.mesh.size, None)
        size = plate.mesh.size ** np.arange(3)
        errors.append([np.abs(a / s - b).max() / np.abs(b).max() for a, b, s in zip(found, exact, size, strict=True)])
    for coarse, fine in zip(errors[:-1], errors[1:], strict=True):
        assert all(f < c / 3 for c, f in zip(coarse, fine, strict=True))
    assert (np.array(errors[-1]) < [1e-10, 1e-10, 1e-9]).all()


@pytest.mark.parametrize(
    ("mesh", "section", "options", "smooth"),
    [
        (disc(1.0, 0.3), UNIT, {}, True),
        (annulus(0.4, 1.0, 0.3), UNIT, {"supports": {"inner": F, "outer": S}}, True),
        (ellipse(1.0, 0.6, 0.3), AnisotropicSection.orthotropic((12.0, 2.0), 0.3, 1.5, 1.0), {}, True),
        (rectangle(2.0, 1.4, 0.3), UNIT, {"supports": S}, True),
        (rectangle(2.0, 1.4, 0.3), UNIT, {}, True),  # corners of exponent 2.7
        (disc(1.0, 0.3), UNIT, {"supports": F}, False),
        (disc(1.0, 0.3), UNIT, {"tension": 1.0}, False),
        (disc(1.0, 0.3), UNIT, {"foundation": 1.0}, False),
        (polygon(L_SHAPE, 0.3), UNIT, {}, False),
        (regular_polygon(8, 1.0, 0.4), UNIT, {"supports": S}, False),
    ],
)
def test_a_tolerance_raises_the_degree_of_smooth_plates_alone(mesh, section, options, smooth):
    shapes = Plate(mesh, section, tolerance=1e-5, **options).influence([[-0.4, -0.4], [0.1, -0.5], [-0.5, 0.1]])
    assert shapes.error_estimate < 1e-5
    assert (shapes.model.degree > 5) == smooth


def test_a_force_on_a_free_rim_leaves_the_degree():
    plate = Plate(annulus(0.4, 1.0, 0.3), UNIT, {"inner": F, "outer": C}, tolerance=1e-4)
    assert plate.deflection([[0.4, 0.0]], [1.0]).model.degree == 5


def test_the_degree_follows_from_the_tolerance_and_cells():
    def degree(cells, tolerance):
        return Plate(disc(1.0, 1 / cells), UNIT, tolerance=tolerance).influence(POINTS).model.degree

    assert [degree(3, tolerance) for tolerance in (None, 1e-4, 1e-6, 1e-9)] == [5, 7, 8, 10]
    assert degree(8, 1e-6) == 7


@pytest.mark.parametrize("tolerance", [None, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("cells", [2, 4])
def test_the_estimate_is_no_less_than_half_of_the_error(cells, tolerance):
    shapes = Plate(disc(1.0, 1 / cells), UNIT, tolerance=tolerance).influence(POINTS)
    at = np.random.default_rng(1).uniform(-0.7, 0.7, (1000, 2))
    exact = DiscShapes(POINTS, 1.0).values(at)
    error = (np.abs(shapes.values(at) - exact).max(axis=0) / np.abs(exact).max(axis=0)).max()
    assert error < 2 * shapes.error_estimate
    assert tolerance is None or error < tolerance
