"""Plates under a tension against closed forms and series: deflections, forces, frequencies, buckling loads."""

import numpy as np
import pytest
import stretched_plates as exact

from fem_plate import Plate, PlateSection
from meshes import disc, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
C, S = "clamped", "simply-supported"
SOURCE = np.array([0.35, 0.1])


def spots(count=500):
    xy = np.random.default_rng(1).uniform(-1, 1, (count, 2))
    return xy[(np.hypot(*xy.T) < 1) & (np.hypot(*(xy - SOURCE).T) > 0.02)]


def errors(found, expected):
    return [np.abs(f - e).max() / np.abs(e).max() for f, e in zip(found, expected, strict=True)]


@pytest.mark.parametrize("tension, ratio", [(10.0, 1.5998789), (100.0, 6.0058331)])
def test_the_force_that_holds_the_centre_of_a_clamped_disc(tension, ratio):
    """Against the 16 pi of the disc without tension; the ratios come from the radial solution with I_0 and K_0."""
    force = Plate(disc(1.0, 0.125), UNIT, tension=tension).influence([[0.0, 0.0]]).stiffness[0, 0]
    assert force / (16 * np.pi) == pytest.approx(ratio, rel=1e-7)
    w = exact.disc_force(np.array([[1e-9, 0.0]]), np.zeros(2), C, tension)[0]
    assert 1 / w[0] / (16 * np.pi) == pytest.approx(ratio, rel=1e-7)


BOUNDS = {  # of w, gradient and Hessian, on cells of 1/8; several times what was measured
    (C, 1.0): (2e-8, 5e-7, 4e-6),
    (C, 10.0): (1e-7, 2e-6, 2e-5),
    (C, 100.0): (6e-7, 1e-5, 9e-5),
    (C, 1e4): (1.1e-5, 4e-4, 6e-3),
    (C, -10.0): (6e-8, 2e-6, 3e-5),
    (S, 10.0): (3e-9, 7e-8, 6e-7),
    (S, 1e4): (8e-8, 3e-6, 5e-5),
    (S, -3.0): (3e-9, 9e-8, 3e-6),
}


@pytest.mark.parametrize("support, tension", BOUNDS)
def test_discs_under_a_force_off_the_centre(support, tension):
    plate = Plate(disc(1.0, 0.125), UNIT, support, tension=tension)
    found = plate.deflection([SOURCE], [1.0]).evaluate(spots())
    for error, bound in zip(
        errors(found, exact.disc_force(spots(), SOURCE, support, tension)), BOUNDS[support, tension], strict=True
    ):
        assert error < bound


@pytest.mark.parametrize("support", [C, S])
@pytest.mark.parametrize("tension, bound", [(1e-6, 1e-9), (0.9, 2e-8), (1.1, 2e-8), (10.0, 3e-7), (100.0, 2e-6)])
def test_discs_under_a_pressure(support, tension, bound):
    """Below a tension of 1 the particular solution is another one."""
    found = Plate(disc(1.0, 0.125), UNIT, support, tension=tension).pressure(1.0).evaluate(spots())
    if tension < 0.1:
        import plate_theory

        expected = plate_theory.disc_pressure(spots(), 1.0, support)[0]  # less than a millionth off
        assert np.abs(found[0] - expected).max() < 1e-6 * expected.max()
    else:
        assert errors(found, exact.disc_pressure(spots(), support, tension))[0] < bound


def test_orders_of_accuracy_are_kept():
    """Those of w, gradient and Hessian are 6, 5 and 4 on cells that follow the boundary layer, as without a tension."""
    expected, cells = exact.disc_force(spots(), SOURCE, C, 10.0), np.array([4, 8, 16])
    measured = []
    for count in cells:
        plate = Plate(disc(1.0, 1 / count), UNIT, tension=10.0)
        measured.append(errors(plate.deflection([SOURCE], [1.0]).evaluate(spots()), expected))
    orders = -np.polyfit(np.log(cells), np.log(measured), 1)[0]
    assert (orders > (5.0, 4.0, 3.0)).all()


def test_pressed_and_stretched_are_continuous_with_neither():
    xy = spots(100)
    plain, pulled, pressed = (
        Plate(disc(1.0, 0.2), UNIT, tension=tension).deflection([SOURCE], [1.0], 2.0).evaluate(xy)
        for tension in (0.0, 1e-4, -1e-4)
    )
    for none, up, down in zip(plain, pulled, pressed, strict=True):
        scale = np.abs(none).max()
        assert 1e-7 < np.abs(up - none).max() / scale < 1e-4
        assert np.abs(up + down - 2 * none).max() < 1e-9 * scale


@pytest.mark.parametrize("tension, bound", [(-4.0, 2e-8), (50.0, 2e-7), (1e4, 3e-8)])
def test_a_simply_supported_square_under_a_force(tension, bound):
    """Its response is the difference of two membranes' (Green's functions of laplace and laplace - tension)."""
    xy = np.random.default_rng(1).uniform(-1, 1, (300, 2))
    xy = xy[np.abs(xy[:, 1] - SOURCE[1]) > 0.15]
    expected = exact.supported_square_force(xy, SOURCE, 2.0, tension)
    plate = Plate(rectangle(2.0, 2.0, 0.125), UNIT, S, tension=tension)
    found = plate.deflection([SOURCE], [1.0]).evaluate(xy)[0]
    assert np.abs(found - expected).max() < bound * np.abs(expected).max()


@pytest.mark.parametrize(
    "support, tension, bound", [(C, -10.0, 3e-8), (C, 10.0, 2e-8), (C, 100.0, 3e-9), (S, -3.0, 9e-9), (S, 1e4, 2e-10)]
)
def test_frequencies_of_discs(support, tension, bound):
    found = 2 * np.pi * Plate(disc(1.0, 0.125), UNIT, support, tension=tension).frequencies(6)
    assert np.abs(found / exact.disc_frequencies(support, tension, 6) - 1).max() < bound


def test_frequencies_of_a_simply_supported_square():
    """omega^2 = k^4 + tension k^2, k^2 = pi^2 (m^2 + n^2) / side^2; that of a membrane where the tension is large."""
    m, n = np.meshgrid(np.arange(1, 6), np.arange(1, 6))
    k2 = np.sort((np.pi**2 * (m**2 + n**2) / 4).ravel())[:5]
    for tension, bound in ((-4.0, 3e-7), (50.0, 1e-7), (1e4, 1e-9)):
        found = 2 * np.pi * Plate(rectangle(2.0, 2.0, 0.2), UNIT, S, tension=tension).frequencies(5)
        assert np.abs(found / np.sqrt(k2**2 + tension * k2) - 1).max() < bound
    assert found[0] / np.sqrt(1e4 * k2[0]) == pytest.approx(1, abs=1e-3)


def test_frequencies_of_a_disc_held_in_its_centre():
    """Where the modes without m = 0 stay, and the first of m = 0 lies above the plain one's."""
    held = 2 * np.pi * Plate(disc(1.0, 0.125), UNIT, tension=10.0).frequencies(5, [[0.0, 0.0]])
    free = exact.disc_frequencies(C, 10.0, 5)
    others = free[np.flatnonzero(np.diff(free, prepend=0) < 1e-6 * free)]  # of the repeated pairs
    for value in others[others < held[-1]]:
        assert (np.abs(held / value - 1) < 1e-7).sum() == 2
    assert free[0] < held.min()


def test_buckling_loads():
    for support, remembered in ((C, 14.6820), (S, 4.1978)):
        expected = exact.disc_buckling(support)
        assert expected == pytest.approx(remembered, abs=5e-5)
        assert Plate(disc(1.0, 0.125), UNIT, support).buckling_load() == pytest.approx(expected, rel=1e-8)
    square = Plate(rectangle(2.0, 2.0, 0.2), UNIT, S).buckling_load()
    assert square == pytest.approx(np.pi**2 / 2, rel=2e-8)
    clamped = exact.rectangle_buckling(2.0, 2.0, [C] * 4)
    assert Plate(rectangle(2.0, 2.0, 0.2), UNIT).buckling_load() == pytest.approx(clamped, rel=1e-6)
    mixed = exact.rectangle_buckling(2.0, 1.4, [C, S, S, C])
    sides = dict(zip(("left", "right", "bottom", "top"), (C, S, S, C), strict=True))
    assert Plate(rectangle(2.0, 1.4, 0.15), UNIT, sides).buckling_load() == pytest.approx(mixed, rel=1e-5)


@pytest.mark.slow
def test_two_actuators_to_a_tolerance():
    """The shapes of two actuators from the response to one force at each place, which the series gives."""
    places = np.array([[0.3, 0.1], [-0.25, -0.35]])
    xy = spots(200)
    xy = xy[np.hypot(*(xy - places[1]).T) > 0.02]
    near = np.array([1e-10, 0.0])
    green = np.array([[exact.disc_force(p[None] + near, q, C, 100.0)[0][0] for q in places] for p in places])
    responses = np.stack([exact.disc_force(xy, q, C, 100.0)[0] for q in places], axis=1)
    shapes = Plate(disc(1.0, 0.25), UNIT, tolerance=1e-7, tension=100.0).influence(places)
    found = shapes.evaluate(xy)[0]
    error = np.abs(found - responses @ np.linalg.inv(green)).max()
    assert error < 1e-7
    assert error / 5 < shapes.error_estimate < 1e-7
    assert np.abs(shapes.stiffness / np.linalg.inv(green) - 1).max() < 1e-6
