"""The air under a part: constants of a film against closed forms, and a drag against theirs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from particle import (
    Air,
    Body,
    ConstantFriction,
    CoulombAdhesion,
    Footprint,
    KogutEtsion,
    Micropart,
    platform_surface,
    simulate,
)

SIDE, MASS, G = 100e-6, 2e-9, 9.80665
SQUARE, ROOM = Footprint.rectangle(SIDE, SIDE), Air()


def resting_gap() -> float:
    rough = KogutEtsion()
    return float(rough.mean_gap(rough.separation(MASS * G)))


def torsion_of(width: float, height: float) -> float:
    """int phi dA of a rectangle, by its series."""
    odd = np.arange(1, 400, 2)
    tails = np.tanh(odd * math.pi * height / (2 * width)) / odd**5
    return width**3 * height / 12 * (1 - 192 * width / (math.pi**5 * height) * float(tails.sum()))


@pytest.mark.parametrize(("width", "height"), [(1.0, 1.0), (1.0, 4.0), (0.3, 0.2)])
def test_the_torsion_function_of_a_rectangle_is_its_series(width: float, height: float) -> None:
    assert Footprint.rectangle(width, height).torsion[0] == pytest.approx(torsion_of(width, height), rel=1e-5)


def test_the_torsion_function_of_a_fine_polygon_is_that_of_its_disc() -> None:
    """r^2 is over phi: int (R^2 - r^2) r^2/4 dA = pi R^6/24."""
    disc, angles = Footprint.disc(2.0), 2 * math.pi * np.arange(24) / 24
    polygon = Footprint.polygon(2.0 * np.column_stack([np.cos(angles), np.sin(angles)]))
    assert disc.torsion == pytest.approx((math.pi * 16 / 8, math.pi * 64 / 24 / (4 * 2 * math.pi)))
    assert polygon.torsion == pytest.approx(disc.torsion, rel=0.03)
    assert polygon.torsion[0] < disc.torsion[0]


def test_a_gap_and_its_damping_have_the_constants_of_the_square() -> None:
    gap = resting_gap()
    assert gap == pytest.approx(88.727749e-9, rel=1e-7)
    assert ROOM.mean_free_path == pytest.approx(65.30e-9, rel=1e-4)
    assert ROOM.flow_factor(gap) == pytest.approx(7.756156, rel=2e-5)
    assert ROOM.damping(SQUARE, gap) == pytest.approx(0.141671, rel=2e-5)
    assert SQUARE.torsion[1] == pytest.approx(0.0262 * SIDE**2, rel=1e-3)
    assert ROOM.impulse(SQUARE, gap) == pytest.approx(1.08e-8, rel=2e-3)
    assert ROOM.drag(SIDE**2, gap) / MASS == pytest.approx(414.9, rel=1e-4)


def test_an_impulse_is_the_damping_over_the_gap() -> None:
    """Without rarefaction C falls as h^-3, so J = C h/2; its derivative is -C at any pressure."""
    dense, gap = Air(pressure=1e12), 1e-6
    assert dense.impulse(SQUARE, gap) == pytest.approx(dense.damping(SQUARE, gap) * gap / 2, rel=1e-4)
    slope = (ROOM.impulse(SQUARE, gap * 1.001) - ROOM.impulse(SQUARE, gap * 0.999)) / (0.002 * gap)
    assert -slope == pytest.approx(ROOM.damping(SQUARE, gap), rel=1e-5)


def test_a_vacuum_does_nothing_and_warm_air_is_more_viscous() -> None:
    vacuum = Air(pressure=0.0)
    assert vacuum.damping(SQUARE, 1e-7) == vacuum.drag(SIDE**2, 1e-7) == vacuum.impulse(SQUARE, 1e-7) == 0.0
    assert Air(temperature=373.15).viscosity == pytest.approx(2.18e-5, rel=0.01)  # tables: 2.17e-5 to 2.19e-5


def test_wrong_air_is_named() -> None:
    with pytest.raises(ValueError, match="Input pressure of Air must be 0 or a positive") as error:
        Air(pressure=-1.0, temperature=0.0)
    assert "Input temperature of Air must be positive" in str(error.value)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-11])
def test_a_point_that_slides_under_drag_stops_where_the_closed_form_says(tolerance: float) -> None:
    """v' = -mu g - k v: v = (V + s) exp(-k t) - s with s = mu g/k, until T = ln(1 + V/s)/k."""
    rate, mu, speed = 414.0, 0.1, 0.05
    still, part = platform_surface(size=1e-3), Micropart(MASS, (0.0, 0.0), (speed, 0.0), drag=rate * MASS)
    path = simulate(still, part, CoulombAdhesion(mu), 0.1, tolerance=tolerance)
    s = mu * G / rate
    stop = math.log1p(speed / s) / rate
    assert path.at_rest_since == pytest.approx(stop, abs=1e3 * tolerance * stop)
    assert path.position[-1, 0] == pytest.approx((speed + s) * -math.expm1(-rate * stop) / rate - s * stop, abs=1e-10)
    assert path.energy.dissipated[-1] == pytest.approx(0.5 * MASS * speed**2, rel=1e-9)


@pytest.mark.compiled
def test_a_face_under_drag_alone_slows_and_spins_down_by_the_closed_form() -> None:
    """Without friction v falls as exp(-c t/m) and the spin as exp(-c tr S t/I), S the face's mean square."""
    rate = 414.0
    square = Body(SQUARE, 50e-6, MASS, position=(0.0, 0.0), velocity=(0.05, 0.0), spin=500.0, drag=rate * MASS)
    path = simulate(platform_surface(size=1e-3), square, ConstantFriction(0.0), 5e-3)
    assert path.heading is not None
    assert path.spin is not None
    inertia = MASS * SIDE**2 / 6
    slowed = MASS * rate * (SIDE**2 / 6) / inertia
    assert path.velocity[-1, 0] == pytest.approx(0.05 * math.exp(-rate * 5e-3), rel=1e-8)
    assert path.spin[-1] == pytest.approx(500.0 * math.exp(-slowed * 5e-3), rel=1e-8)
    assert path.energy.balance < 1e-9


def test_a_drag_is_refused_with_fixed_steps() -> None:
    part = Micropart(MASS, (0.0, 0.0), drag=1e-6)
    with pytest.raises(ValueError, match="Input drag of Micropart must be left out with the scheme 'fixed'"):
        simulate(platform_surface(size=1e-3), part, CoulombAdhesion(0.1), 0.1, scheme="fixed")
