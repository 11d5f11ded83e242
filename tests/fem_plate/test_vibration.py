"""Modes: what they are by definition, what is refused, and points that hold them."""

import numpy as np
import plate_modes
import pytest

from fem_plate import Plate, PlateSection
from meshes import annulus, disc, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
HELD = np.array([[0.37, 0.21], [-0.6, 0.1], [0.1, -0.7]])


def omega(plate, count, held=None):
    return 2 * np.pi * plate.frequencies(count, held)


@pytest.fixture(scope="module")
def plate():
    return Plate(disc(1.0, 0.2), UNIT)


def test_frequencies_ascend_and_repeat_the_repeated_ones(plate):
    found = omega(plate, 8)
    assert (np.diff(found) >= -1e-9).all()
    assert found[1] == pytest.approx(found[2], rel=1e-10) and found[3] == pytest.approx(found[4], rel=1e-10)


def test_same_bits_every_time(plate):
    assert (plate.frequencies(3, HELD) == plate.frequencies(3, HELD)).all()


def test_frequencies_go_with_the_thickness_over_the_square_of_the_size(section):
    small = Plate(disc(300e-6, 60e-6), section).frequencies(3)
    unit = Plate(disc(1.0, 0.2), UNIT).frequencies(3)
    factor = np.sqrt(section.rigidity / (section.density * section.thickness)) / 300e-6**2
    assert small == pytest.approx(unit * factor, rel=1e-10)


@pytest.mark.parametrize("supports", ["clamped", "simply-supported", "free"])
@pytest.mark.parametrize("held", [None, HELD], ids=["plain", "held"])
def test_modes_are_1_at_most_and_orthogonal_over_the_plate(supports, held):
    modes = Plate(disc(1.0, 0.2), UNIT, supports).modes(5, held)
    xy, weights = modes.model.space.quadrature
    shapes = modes.functions.values(xy)
    products = shapes.T @ (weights[:, None] * shapes)
    scale = np.sqrt(np.diag(products))
    assert np.abs(products / scale / scale[:, None] - np.eye(5)).max() < 1e-6
    assert np.abs(modes.functions.values(modes.model.space.points)).max(axis=0) == pytest.approx(np.ones(5), abs=1e-12)
    if held is not None:
        assert np.abs(modes.evaluate(held)[0]).max() < 1e-7


def test_free_modes_are_in_balance():
    """No rigid motion is left in them."""
    modes = Plate(rectangle(2.0, 1.4, 0.4), UNIT, "free").modes(4)
    xy, weights = modes.model.space.quadrature
    for function in (np.ones(len(xy)), *xy.T):
        assert np.abs((weights * function) @ modes.functions.values(xy)).max() < 1e-8


def test_derivatives_of_modes_are_those_of_their_values(plate):
    modes, spots, step = plate.modes(3, HELD), np.array([[0.2, -0.3], [-0.5, 0.4]]), 1e-4
    _, gradient, hessian = modes.evaluate(spots)
    for axis in range(2):
        shift = step * np.eye(2)[axis]
        after, before = modes.evaluate(spots + shift), modes.evaluate(spots - shift)
        assert np.abs((after[0] - before[0]) / (2 * step) - gradient[..., axis]).max() < 1e-6
        assert np.abs((after[1] - before[1]) / (2 * step) - hessian[..., axis]).max() < 1e-4


@pytest.mark.parametrize("supports", ["clamped", "simply-supported", "free", {"left": "simply-supported"}])
def test_rayleighs_quotient_of_a_held_plate_rises_with_every_point(supports):
    """Courant: each new point raises no frequency above the next one before."""
    plate = Plate(rectangle(2.0, 1.4, 0.4), UNIT, supports)
    points = np.array([[0.37, 0.21], [-0.6, 0.1], [0.1, -0.5], [0.7, 0.6]])
    rigid = {"free": 3}.get(supports, 0) if isinstance(supports, str) else 1
    before = np.concatenate([np.zeros(rigid), omega(plate, 8 - rigid)])
    for k in range(1, 5):
        left = max(0, rigid - k)
        now = np.concatenate([np.zeros(left), omega(plate, 7 - left, points[:k])])
        assert (now >= before[:7] * (1 - 1e-5)).all() and (now <= before[1:8] * (1 + 1e-5)).all()
        before = np.append(now, np.inf)


HELD_PLATES = {
    "simply supported": (dict.fromkeys(("left", "right", "bottom", "top"), "simply-supported"), HELD, 6e-3),
    "free": ({}, HELD, 3e-3),
    "hinge": ({"left": "simply-supported"}, HELD[:1], 3e-3),
    "free on one point": ({}, HELD[:1], 3e-3),
}


@pytest.mark.parametrize("name", HELD_PLATES)
def test_a_held_plate_is_just_below_ritzs_upper_bounds(name):
    """Polynomials converge slowly at a held point, from above; finite elements of two sizes agree much better."""
    supports, held, gap = HELD_PLATES[name]
    kinds = tuple(supports.get(side, "free") for side in ("left", "right", "bottom", "top"))
    all_of, evaluate = plate_modes.ritz_rectangle(2.0, 2.0, kinds, degree=24)
    values = evaluate(held)
    basis = np.linalg.svd(values)[2][len(held) :].T  # combinations of modes that vanish at the held points
    bounds = np.sqrt(np.maximum(np.linalg.eigvalsh(basis.T @ (all_of[:, None] ** 2 * basis)), 0))
    bounds = bounds[bounds > 1e-3][:4]
    coarse, fine = (omega(Plate(rectangle(2.0, 2.0, h), UNIT, supports), 4, held) for h in (0.4, 0.25))
    assert coarse == pytest.approx(fine, rel=1e-5)
    assert ((fine < bounds * (1 + 1e-6)) & (fine > bounds * (1 - gap))).all()


def test_very_many_held_points_are_allowed():
    held = np.random.default_rng(1).uniform(-0.6, 0.6, (60, 2))
    assert omega(Plate(disc(1.0, 0.25), UNIT), 1, held)[0] > 30


def test_an_annulus_vibrates_faster_than_its_disc():
    assert omega(Plate(annulus(0.3, 1.0, 0.3), UNIT), 1)[0] > 2 * omega(Plate(disc(1.0, 0.3), UNIT), 1)[0]


@pytest.mark.parametrize("stiffness", [np.inf, 20.0])
def test_a_curved_rim_on_coarse_cells_does_not_scale_the_frequencies(stiffness):
    """Cells that are made smaller for a held point reach farther out to the rim, and with them the unit of length."""
    angles = 2 * np.pi * np.arange(3) / 3
    for coarse, fine, radius in (
        (disc(1.0, 0.5), disc(1.0, 0.2), 0.9),
        (annulus(0.5, 1, 0.2), annulus(0.5, 1, 0.1), 0.95),
    ):
        held = radius * np.column_stack([np.cos(angles), np.sin(angles)])
        inner = "clamped" if len(coarse.boundaries) == 1 else {"inner": "clamped"}
        true = Plate(fine, UNIT, inner).frequencies(2, held[:1], stiffness)
        for place in held:
            found = Plate(coarse, UNIT, inner).modes(2, [place], stiffness)
            assert found.frequencies == pytest.approx(true, rel=1e-4)
            assert found.error_estimate.max() < 1e-4


def test_a_foundation_adds_to_the_squares_of_the_frequencies_on_any_cells():
    """omega^2 = omega_0^2 + k/(rho t)."""
    mesh, held = annulus(0.5, 1.0, 0.2), [(0.95, 0.0)]
    free, borne = (omega(Plate(mesh, UNIT, foundation=k), 2, held) for k in (0.0, 1e3))
    assert borne**2 - free**2 == pytest.approx([1e3, 1e3], rel=1e-6)


def test_without_density_it_says_what_is_missing():
    bare = Plate(disc(1.0, 0.5), PlateSection(169e9, 0.3, 5e-6))
    with pytest.raises(ValueError, match="^Input density of PlateSection must be given for frequencies; got None$"):
        bare.frequencies(1)


@pytest.mark.parametrize("count", [0, -1, 10**6])
def test_the_count_must_be_possible(plate, count):
    with pytest.raises(ValueError, match=f"^Input count of modes must be a whole number from 1 to .* got {count}$"):
        plate.frequencies(count)


def test_a_held_point_beyond_the_rim_or_twice_is_refused(plate):
    with pytest.raises(ValueError, match="inside the rim"):
        plate.frequencies(1, held=[(2.0, 0)])
    with pytest.raises(ValueError, match="points 0 and 1 must differ"):
        plate.frequencies(1, held=[(0.2, 0), (0.2, 0)])


@pytest.mark.parametrize(
    ("mesh", "supports", "needed"),
    [
        (rectangle(2.0, 2.0, 0.5), "clamped", "by more than 0.0006 m; it is 0.0005 m inside it"),
        (
            rectangle(2.0, 2.0, 0.5),
            "free",
            "by more than 0.0006 m, or on a free boundary and as far off the others; it is 0.0005 m inside it",
        ),
        (disc(1.0, 0.5), "simply-supported", "by more than 0.0006 m; it is 0.0005 m inside it"),
    ],
)
def test_points_that_rounding_spoils_are_refused_and_the_next_ones_are_right(mesh, supports, needed):
    """Nearer to the rim there were modes below those of the bare plate, and frequencies that were off by a quarter."""
    plate = Plate(mesh, UNIT, supports)
    for call in (plate.influence, lambda points: plate.frequencies(1, points), plate.large_deflection):
        with pytest.raises(ValueError, match="inside the rim by more than"):
            call([[0.9995, 0.0], [-0.9, 0.0], [0.0, 0.9]])
    with pytest.raises(ValueError, match=needed):
        plate.deflection([[0.9995, 0.0]], [1.0])
    if supports != "free":
        near, bare = plate.modes(3, [[0.9993, 0.0]]), omega(plate, 3)
        assert (2 * np.pi * near.frequencies >= bare * (1 - 1e-4)).all()
        assert near.error_estimate.max() < 1e-4


def test_points_on_a_free_rim_hold_a_plate():
    """The square on its corners has 7.110884; on the middles of its sides 13.46820, as with no points at all."""
    plate = Plate(rectangle(2.0, 2.0, 0.4), UNIT, "free")
    corners = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]])
    middles = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    on_corners = plate.modes(3, corners)
    assert 8 * np.pi * on_corners.frequencies == pytest.approx([7.110884, 15.770240, 15.770240], abs=6e-7)
    assert on_corners.error_estimate.max() < 1e-8
    assert np.abs(on_corners.evaluate(corners)[0]).max() < 1e-9
    on_middles = plate.modes(1, middles)
    assert 4 * omega(plate, 1, middles) == pytest.approx(4 * omega(plate, 1), rel=1e-6)
    assert on_middles.error_estimate[0] < 1e-5
    with_spring = [4 * omega(plate, 2, [*corners, [0.2, 0.1]])[0]]
    with_spring += [8 * np.pi * plate.frequencies(2, [*corners, [0.2, 0.1]], [*[k] * 4, np.inf])[0] for k in (1e9, 1e3)]
    assert with_spring[0] == pytest.approx(with_spring[1], rel=1e-6) and with_spring[2] < with_spring[0]


def test_a_point_on_the_rim_is_the_limit_of_points_inside_it():
    plate = Plate(annulus(0.4, 1.0, 0.3), UNIT, {"inner": "clamped"})
    on, near, far = ([[1 - gap, 0.0], [0.0, -(1 - gap)]] for gap in (0.0, 1e-3, 2e-3))
    assert omega(plate, 3, on) == pytest.approx(2 * omega(plate, 3, near) - omega(plate, 3, far), rel=1e-4)
    shapes = plate.influence(on)
    limit = 2 * plate.influence(near).stiffness - plate.influence(far).stiffness
    assert shapes.stiffness == pytest.approx(limit, rel=1e-4) and shapes.error_estimate < 1e-5
    with pytest.raises(ValueError, match="point 0 .* or on a free boundary .*; it is on it"):
        plate.influence([[0.4, 0.0], [0.9, 0.0]])


def test_forces_at_the_corners_twist_a_free_square():
    """w = P xy / (2 D (1 - nu)), so that each corner's own stiffness is 2 D (1 - nu) / a^2."""
    plate, corners = Plate(rectangle(2.0, 2.0, 0.25), UNIT, "free"), [[1, 1], [-1, 1], [1, -1], [-1, -1]]
    xy = np.array([[0.3, 0.8], [-1.0, 0.2], [0.5, -0.5]])
    w = plate.deflection(corners, [1.0, -1.0, -1.0, 1.0]).evaluate(xy)[0]
    assert w == pytest.approx(xy.prod(axis=1) / 1.4, abs=1e-9)
    stiffness = plate.influence(corners).stiffness
    assert stiffness == pytest.approx(1.4 / 4 * np.outer([1, -1, -1, 1], [1, -1, -1, 1]), abs=1e-9)


def test_evaluating_beyond_the_rim_is_refused(plate):
    with pytest.raises(ValueError, match="must lie on the plate"):
        plate.modes(1).evaluate([[1.0, 1.0]])


def test_a_free_plate_on_soft_springs_bounces_and_tilts_as_a_rigid_body():
    plate, angle = Plate(disc(1.0, 0.4), UNIT, "free"), 2 * np.pi / 3 * np.arange(3)
    feet, k, mass = 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=1), 1e-5, np.pi
    tilt, bounce = np.sqrt(1.5 * k * 0.5**2 / (mass / 4)), np.sqrt(3 * k / mass)
    found = 2 * np.pi * plate.frequencies(3, feet, k)
    assert found == pytest.approx([tilt, tilt, bounce], rel=1e-5)
    assert 2 * np.pi * plate.frequencies(3, feet, [1e9, 1e9, np.inf]) == pytest.approx(omega(plate, 3, feet), rel=1e-6)


def test_a_spring_between_gives_a_frequency_between(plate):
    plain, held = omega(plate, 1)[0], omega(plate, 1, HELD)[0]
    found = [2 * np.pi * plate.frequencies(1, HELD, k)[0] for k in (1e-6, 30.0, 1e8)]
    assert found[0] == pytest.approx(plain, rel=1e-7) and found[2] == pytest.approx(held, rel=1e-6)
    assert 1.05 * plain < found[1] < 0.95 * held


@pytest.mark.parametrize("wrong", [0.0, -1.0, [1.0, np.nan, 1.0]])
def test_a_hold_of_no_stiffness_is_refused(plate, wrong):
    with pytest.raises(ValueError, match="^Input stiffness of modes must be positive; got .* N/m for point [01]$"):
        plate.modes(1, HELD, wrong)


def test_the_error_estimate_is_close_to_the_error():
    modes = Plate(disc(1.0, 0.3), UNIT).modes(4)
    error = np.abs(2 * np.pi * modes.frequencies / plate_modes.disc("clamped", 4) - 1)
    assert error.max() < 1e-5
    ratio = error / modes.error_estimate
    assert (ratio > 0.2).all() and (ratio < 5).all()
