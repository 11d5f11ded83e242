"""Deflection: superposition, balance of a plate that can move, pressure, and what its error estimate is worth."""

import goursat
import numpy as np
import plate_theory as theory
import pytest
from goursat_rim import FREE, Arc, polygon
from plate_rectangles import levy_pressure, supported_force
from spots import scattered

from fem_plate import Plate, PlateSection
from fem_plate.analytic import disc_green
from meshes import annulus, disc, ellipse, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)  # rigidity 1
FOUR = np.array([[0.3, 0.15], [-0.2, 0.4], [-0.35, -0.25], [0.25, -0.5]])


@pytest.fixture(scope="module", params=["clamped", "simply-supported"])
def plate(request):
    return Plate(disc(1.0, 0.25), UNIT, request.param)


@pytest.fixture(scope="module", params=["disc", "annulus", "rectangle"])
def free(request):
    mesh = {"disc": disc(1.0, 0.25), "annulus": annulus(0.1, 1.0, 0.4), "rectangle": rectangle(2.0, 1.5, 0.4)}
    return Plate(mesh[request.param], UNIT, "free")


def test_forces_and_pressure_superpose(plate):
    spots = scattered(plate.mesh, FOUR)
    both = plate.deflection(FOUR, [1.0, -2.0, 3.0, 0.5], 0.7).evaluate(spots)
    parts = [
        plate.deflection(FOUR, [1.0, -2.0, 0.0, 0.0]).evaluate(spots),
        plate.deflection(FOUR, [0.0, 0.0, 3.0, 0.5]).evaluate(spots),
        plate.deflection(FOUR, 0.0, 0.7).evaluate(spots),
    ]
    for total, *terms in zip(both, *parts, strict=True):
        assert np.abs(total - sum(terms)).max() < 1e-12 * np.abs(total).max()


def test_deflection_is_proportional_to_the_load(plate):
    spots = scattered(plate.mesh, FOUR)
    one, many = (plate.deflection(FOUR, k * np.arange(1, 5), k * 2.0).evaluate(spots) for k in (1.0, -1e6))
    for a, b in zip(one, many, strict=True):
        assert np.abs(b + 1e6 * a).max() < 1e-9 * np.abs(b).max()


def test_it_goes_with_one_over_the_rigidity_and_the_square_of_the_size(section):
    spots = scattered(disc(1.0, 0.25), FOUR, count=300)
    small = Plate(disc(2e-3, 0.5e-3), section).deflection(2e-3 * FOUR, np.arange(4)).evaluate(2e-3 * spots)
    unit = Plate(disc(1.0, 0.25), UNIT).deflection(FOUR, np.arange(4)).evaluate(spots)
    for order, (a, b) in enumerate(zip(small, unit, strict=True)):
        expected = b * (2e-3) ** (2 - order) / section.rigidity
        assert np.abs(a - expected).max() < 1e-11 * np.abs(expected).max()


def test_nothing_bends_under_nothing(plate):
    for field in plate.deflection(np.empty((0, 2)), []).evaluate(scattered(plate.mesh)):
        assert not field.any()


def test_one_force_may_stand_for_all_points(plate):
    spots = scattered(plate.mesh, FOUR)
    assert (
        plate.deflection(FOUR, 2.0).evaluate(spots)[0] == plate.deflection(FOUR, [2.0] * 4).evaluate(spots)[0]
    ).all()


@pytest.mark.parametrize("forces", [[1.0], [1.0, 2.0, 3.0], [[1.0, 2.0]]])
def test_there_must_be_one_force_a_point(plate, forces):
    with pytest.raises(ValueError, match="^Input forces of deflection must be one a point, 2; got shape"):
        plate.deflection(FOUR[:2], forces)


def test_misplaced_points_are_refused(plate):
    with pytest.raises(ValueError, match="point 0 .* must lie inside the rim"):
        plate.deflection([[2.0, 0.0]], [1.0])
    with pytest.raises(ValueError, match="must lie on the plate; got"):
        plate.pressure(1.0).evaluate([[2.0, 0.0]])


def balanced():
    """Forces at FOUR whose sum and moments vanish."""
    return np.linalg.svd(np.column_stack([np.ones(4), FOUR]).T)[2][3]


def test_balanced_forces_bend_a_free_plate(free):
    deflection = free.deflection(FOUR, balanced())
    spots = scattered(free.mesh, FOUR)
    w = deflection.evaluate(spots)[0]
    assert np.ptp(w) > 1e-3
    # It is what actuators at these heights would make of it.
    heights = deflection.evaluate(FOUR)[0]
    assert np.abs(free.influence(FOUR).evaluate(spots, heights)[0] - w).max() < 1e-5 * np.ptp(w)


def test_mean_deflection_and_slope_of_a_free_plate_are_taken_away(free):
    deflection = free.deflection(FOUR, balanced())
    xy, weights = deflection.model.space.quadrature
    w = deflection.functions.values(xy)[:, 0]
    for function in (np.ones(len(xy)), *xy.T):
        assert abs(weights @ (w * function)) < 1e-12 * weights.sum() * np.abs(w).max()


@pytest.mark.parametrize(
    "points, forces, pressure",
    [
        ([(0.3, 0.3)], [1.0], 0.0),  # a force
        ([(0.5, 0.0), (-0.5, 0.0)], [1.0, -1.0], 0.0),  # a couple
        (np.empty((0, 2)), [], 1.0),  # pressure alone
        (FOUR, [1e-7, 0.0, 0.0, 0.0], 1e-9),
        ([(0.5, 0.3), (-0.5, 0.3)], [1.0, -1.0 - 1e-6], 0.0),
    ],
    ids=["force", "couple", "pressure", "small", "almost"],
)
def test_loads_out_of_balance_on_a_free_plate_are_refused(free, points, forces, pressure):
    with pytest.raises(ValueError, match="^Input loads of a plate whose supports leave it .* must be in balance"):
        free.deflection(points, forces, pressure)


def test_a_pressure_may_balance_a_force(free):
    """On a free plate around the origin a force in its centre, or four around it, against a pressure."""
    area = free.model().space.quadrature[1].sum() * free.model().mesh.size ** 2
    around = np.array([(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)])
    w, gradient, _ = free.deflection(around, [0.25] * 4, -1 / area).evaluate(np.concatenate([around, -around]))
    assert w[:4] == pytest.approx(w[4:], rel=1e-4) and np.ptp(w) < 1e-4 * np.abs(w).max()


def test_a_hinged_plate_needs_balance_around_its_hinge_only():
    plate = Plate(rectangle(2.0, 1.5, 0.4), UNIT, {"left": "simply-supported"})
    plate.deflection([(0.0, 0.2), (1.0 - 1e-3, 0.2)], [1.0, -1 / (2 - 1e-3)])
    with pytest.raises(ValueError, match="must be in balance"):
        plate.deflection([(0.0, 0.2)], [1.0])


def test_a_free_disc_under_balanced_forces_is_goursats():
    mesh, forces = disc(1.0, 0.2), balanced()
    spots = scattered(mesh, FOUR)
    rigid = np.column_stack([np.ones(len(spots)), spots])
    truth = goursat.solve([[Arc(0, (1, 1), FREE)]], FOUR, forces, degree=80, poles=0).evaluate(spots)
    found = Plate(mesh, UNIT, "free").deflection(FOUR, forces).evaluate(spots)
    difference = found[0] - truth[0]
    left = difference - rigid @ np.linalg.lstsq(rigid, difference, rcond=None)[0]
    assert np.abs(left).max() < 1e-8 * np.ptp(found[0])
    assert np.abs(found[2] - truth[2]).max() < 2e-5 * np.abs(truth[2]).max()


def force_on(place):
    return [place], [1.0], 0.0


PRESSURE = np.empty((0, 2)), [], 1.0
SQUARE = polygon(np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]))
NEAR = (0.93, 0.1)
SEVERAL = FOUR, [1.0, -2.0, 1.5, 0.7], 0.0
ESTIMATED = {
    "clamped disc": (disc(1.0, 0.25), "clamped", force_on((0.4, 0.2)), lambda xy: disc_green(xy, (0.4, 0.2), 1, 1)[0]),
    "near the rim": (disc(1.0, 0.25), "clamped", force_on(NEAR), lambda xy: disc_green(xy, NEAR, 1, 1)[0]),
    "four forces": (
        disc(1.0, 0.25),
        "clamped",
        SEVERAL,
        lambda xy: sum(f * disc_green(xy, p, 1, 1)[0] for p, f in zip(FOUR, SEVERAL[1], strict=True)),
    ),
    "simply supported disc": (
        disc(1.0, 0.25),
        "simply-supported",
        force_on((0.4, 0.2)),
        lambda xy: theory.disc_force(xy, (0.4, 0.2), "simply-supported")[0],
    ),
    "its rim": (
        disc(1.0, 0.25),
        "simply-supported",
        force_on(NEAR),
        lambda xy: theory.disc_force(xy, NEAR, "simply-supported")[0],
    ),
    "simply supported ellipse": (
        ellipse(1.0, 0.5, 0.2),
        "simply-supported",
        force_on((0.4, 0.2)),
        lambda xy: goursat.solve(
            [[Arc(0, (1, 0.5), "simply-supported")]], [(0.4, 0.2)], [1], degree=80, poles=0
        ).evaluate(xy)[0],
    ),
    "annulus": (
        annulus(0.4, 1.0, 0.25),
        {"inner": "clamped", "outer": "simply-supported"},
        PRESSURE,
        lambda xy: theory.annulus_pressure(xy, 0.4, 1.0, ("clamped", "simply-supported"))[0],
    ),
    "annulus of odd rings": (
        annulus(0.4, 1.0, 0.2),
        {"inner": "free", "outer": "clamped"},
        PRESSURE,
        lambda xy: theory.annulus_pressure(xy, 0.4, 1.0, ("free", "clamped"))[0],
    ),
    "clamped square": (
        rectangle(2.0, 2.0, 0.3),
        "clamped",
        PRESSURE,
        lambda xy: goursat.solve([SQUARE], pressure=1.0, degree=20, poles=20).evaluate(xy)[0],
    ),
    "simply supported square": (
        rectangle(2.0, 2.0, 0.3),
        "simply-supported",
        force_on((0.4, 0.2)),
        lambda xy: supported_force(xy, (0.4, 0.2), 2.0, 2.0)[0],
    ),
    "free side": (
        rectangle(2.0, 1.4, 0.3),
        {"left": "simply-supported", "right": "simply-supported", "bottom": "simply-supported"},
        PRESSURE,
        lambda xy: levy_pressure(xy, 2.0, 1.4, ("simply-supported", "free"))[0],
    ),
}


@pytest.mark.parametrize("name", ESTIMATED)
def test_the_error_estimate_is_worth_the_error(name):
    mesh, supports, (points, forces, pressure), truth = ESTIMATED[name]
    deflection = Plate(mesh, UNIT, supports).deflection(points, forces, pressure)
    w, exact = (f(spots) for spots in [scattered(mesh, points)] for f in (lambda x: deflection.evaluate(x)[0], truth))
    error = np.abs(w - exact).max() / np.abs(exact).max()
    assert 0.3 < deflection.error_estimate / error < 10


@pytest.mark.parametrize("name", ["near the rim", "its rim", "annulus of odd rings", "clamped square", "free side"])
def test_a_tolerance_is_met(name):
    mesh, supports, (points, forces, pressure), truth = ESTIMATED[name]
    deflection = Plate(mesh, UNIT, supports, tolerance=1e-6).deflection(points, forces, pressure)
    spots = scattered(mesh, points)
    error = np.abs(deflection.evaluate(spots)[0] - truth(spots)).max() / np.abs(truth(spots)).max()
    assert deflection.error_estimate < 1e-6 and error < 1e-6
