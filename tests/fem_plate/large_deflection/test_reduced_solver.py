"""The equilibrium of a reduced plate: closed forms, least energy, derivatives, and what it refuses."""

import math

import mpmath
import numpy as np
import pytest
from reduced_plates import one_correction, one_in_plane, one_plate, random_plate
from reduced_solver import energy, reduced_equilibrium

from fem_plate.large_deflection import ReducedPlate

STIFFNESS, OWN, SQUARE, LOAD = 2.0, 1.5, 0.8, -3.0  # of a cubic spring


def cardano(d):
    """The c of K c + p + 1/2 (alpha d^2 + gamma c^2) gamma c = 0, by Cardano's formula, in 40 digits."""
    linear = 2 * (STIFFNESS + mpmath.mpf(SQUARE) * OWN * d**2 / 2) / mpmath.mpf(SQUARE) ** 2
    half = mpmath.mpf(LOAD) / mpmath.mpf(SQUARE) ** 2
    root = mpmath.sqrt(half**2 + linear**3 / 27)
    return mpmath.cbrt(root - half) - mpmath.cbrt(root + half)


def direct_energy(plate, c, d):
    """E(c; d) as it is written down, entry by entry."""
    b = [*d, *c]
    total = sum(plate.load[i] * c[i] for i in range(len(c)))
    total += 0.5 * sum(plate.stiffness[i, j] * c[i] * c[j] for i in range(len(c)) for j in range(len(c)))
    for form, own in zip(plate.membrane, plate.prestress, strict=True):
        f = own + 0.5 * sum(form[i, j] * b[i] * b[j] for i in range(len(b)) for j in range(len(b)))
        total += 0.5 * f * f
    return total


def test_a_cubic_spring_and_its_derivatives_are_cardanos():
    plate = ReducedPlate([[STIFFNESS]], [[[OWN, 0.0], [0.0, SQUARE]]], load=[LOAD])
    with mpmath.workdps(40):

        def motion(t):
            return cardano(mpmath.mpf("0.3") + mpmath.mpf("1.7") * mpmath.sin(3 * t))

        t = mpmath.mpf("0.37")
        truth = [float(mpmath.diff(motion, t, order)) for order in range(3)]
    rate, bend = 5.1 * math.cos(1.11), -15.3 * math.sin(1.11)
    found = reduced_equilibrium(plate, [0.3 + 1.7 * math.sin(1.11)], [rate], [bend]).corrections
    assert found[:, 0] == pytest.approx(truth, rel=1e-13)


@pytest.mark.parametrize("d", [-3.0, -0.2, 0.0, 1e-9, 0.7, 40.0])
def test_a_plate_of_one_correction_is_its_closed_form(d):
    found = reduced_equilibrium(one_plate(), [d])
    assert found.corrections[0, 0] == pytest.approx(one_correction(d), rel=1e-13)
    assert found.in_plane[0, 0] == pytest.approx(one_in_plane(d), rel=1e-13)


@pytest.mark.parametrize("size", [0.3, 1.0, 5.0])
def test_the_energy_is_least(size):
    plate, rng = random_plate(3, 6, 5, size=size), np.random.default_rng(1)
    d = rng.normal(size=3)
    found = reduced_equilibrium(plate, d)
    c = found.corrections[0]
    least = energy(plate, c, d)
    assert least == pytest.approx(direct_energy(plate, c, d), rel=1e-13)
    lowest = np.linalg.eigvalsh(found.hessian)[0]
    for _ in range(20):
        change = 1e-3 * rng.normal(size=6)
        rise = direct_energy(plate, c + change, d) - least
        assert rise > 0.4 * lowest * change @ change
        assert rise == pytest.approx(0.5 * change @ found.hessian @ change, rel=0.05)


def test_derivatives_are_those_of_differences_in_time():
    plate, rng = random_plate(2, 5, 4, 3), np.random.default_rng(2)
    d, d_t, d_tt = rng.normal(size=(3, 2))
    exact = reduced_equilibrium(plate, d, d_t, d_tt)

    def both(t):
        found = reduced_equilibrium(plate, d + t * d_t + 0.5 * t**2 * d_tt, start=exact.corrections[0])
        return np.concatenate([found.corrections[0], found.in_plane[0]])

    h, truth = 4e-3, np.concatenate([exact.corrections, exact.in_plane], axis=1)
    a, b, c = ((both(k * h) + both(-k * h) - 2 * both(0.0)) / (k * h) ** 2 for k in (1, 2, 3))
    assert np.abs(1.5 * a - 0.6 * b + 0.1 * c - truth[2]).max() < 1e-8 * np.abs(truth[2]).max()
    a, b, c = ((both(k * h) - both(-k * h)) / (2 * k * h) for k in (1, 2, 3))
    assert np.abs(1.5 * a - 0.6 * b + 0.1 * c - truth[1]).max() < 1e-10 * np.abs(truth[1]).max()


def test_the_answer_does_not_depend_on_where_newton_begins():
    plate, d = random_plate(3, 6, 5, size=5.0), [1.0, -2.0, 1.5]
    found = [reduced_equilibrium(plate, d, start=start).corrections[0] for start in (None, np.full(6, 2.0))]
    assert found[0] == pytest.approx(found[1], rel=1e-9)


def test_a_plate_pressed_beyond_its_buckling_load_is_refused():
    plate = ReducedPlate([[1.0]], [[[0.0, 0.0], [0.0, 1.0]]], prestress=[-1.5])
    with pytest.raises(ValueError, match="not stable"):
        reduced_equilibrium(plate, [0.0])
    assert reduced_equilibrium(plate, [0.0], start=[0.1]).corrections[0, 0] == pytest.approx(1.0, rel=1e-12)


SOUND = {"stiffness": np.eye(2), "membrane": np.zeros((3, 4, 4))}


@pytest.mark.parametrize(
    ("wrong", "names"),
    [
        ({"stiffness": [[1.0, 0.5], [0.4, 1.0]]}, "stiffness"),
        ({"stiffness": -np.eye(2)}, "stiffness"),
        ({"stiffness": np.ones((2, 3))}, "stiffness"),
        ({"membrane": np.zeros((3, 2, 2))}, "membrane"),
        ({"membrane": np.arange(48.0).reshape(3, 4, 4)}, "membrane"),
        ({"prestress": [1.0], "load": [1.0, math.nan]}, "prestress load"),
        ({"in_plane": np.zeros((1, 3, 3)), "in_plane_offset": [0.0, 1.0]}, "in_plane in_plane_offset"),
    ],
)
def test_every_wrong_array_is_named(wrong, names):
    with pytest.raises(ValueError) as caught:
        ReducedPlate(**SOUND | wrong)
    parts = str(caught.value).split("; Input ")
    assert [part.removeprefix("Input ").split()[0] for part in parts] == names.split()
