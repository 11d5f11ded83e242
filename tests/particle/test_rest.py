"""A part that stays: its largest pull and smallest load beside closed forms and brute force, and faster drives."""

import math

import numpy as np
import pytest

from particle import (
    Body,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    Footprint,
    Micropart,
    part_at_rest,
    platform_surface,
)
from particle import polynomial_surface as polynomial
from particle.rest import largest

G, MASS = 9.80665, 2e-9
PART = Micropart(MASS, (0.12, 0.05))


def amplitude(drive):
    """Of the acceleration [m/s^2], by brute force."""
    times = np.linspace(0, 1 / drive.frequency, 20_001)
    return np.abs(drive.evaluate(times)[2]).max()


@pytest.mark.parametrize("factor, stroke", [(0.5, 0.4), (1.0, 1.0), (3.0, 0.4)])
def test_a_platform_pulls_by_mass_times_acceleration(factor, stroke):
    drive = Drive(1e-6, 500, "sine")
    rest = part_at_rest(platform_surface(x=drive), PART, ConstantFriction(1e-8), 20e-3)
    expected = MASS * amplitude(drive) * factor**2 * stroke / 1e-8
    assert rest.scaled(factor, stroke).slip().value == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_a_platform_that_rises_and_falls_loads_by_its_acceleration(factor):
    drive = Drive(2e-6, 300, "cosine")
    rest = part_at_rest(platform_surface(z=drive), PART, CoulombAdhesion(0.3, 2e-7), 20e-3)
    swing = MASS * amplitude(drive) * factor**2
    assert rest.scaled(factor).contact_margin().value == pytest.approx(1 + (2e-7 - swing) / (MASS * G), rel=1e-8)
    assert rest.scaled(factor).slip().value == 0


def test_a_tilting_plane_beside_brute_force():
    rest = part_at_rest(
        polynomial([[[0.0] * 5], [[0.0, 0.5, -0.9, 0.2, 0.1]]]), PART, CoulombAdhesion(0.4, 1e-8, 0.6), 1.0
    )  # w = x (0.5 t - 0.9 t^2 + 0.2 t^3 + 0.1 t^4)
    t, x = np.linspace(0, 1, 2_000_001), PART.position[0]
    slope = 0.5 * t - 0.9 * t**2 + 0.2 * t**3 + 0.1 * t**4
    b, s = G + x * (-1.8 + 1.2 * t + 1.2 * t**2), np.sqrt(1 + slope**2)
    ratio = MASS * b * np.abs(slope) / s / (0.6 * (MASS * b / s + 1e-8))
    slip = rest.slip()
    assert slip.value == pytest.approx(ratio.max(), rel=1e-11)
    assert slip.time == pytest.approx(t[ratio.argmax()], abs=1e-5)
    margin = rest.contact_margin()
    assert margin.value == pytest.approx((b / s + 1e-8 / MASS).min() / G, rel=1e-11)


def test_a_part_that_has_come_off_is_held_by_nothing():
    drive = Drive(5e-6, 1000)
    rest = part_at_rest(platform_surface(x=drive, z=drive), PART, CoulombAdhesion(0.3, 1e-9), 2e-3)
    assert rest.contact_margin().value < 0
    assert rest.slip().value == math.inf


def test_peaks_between_the_given_times_are_found():
    peak = largest(lambda t: 1 - (t - 0.337) ** 2, np.linspace(0, 1, 8))
    assert peak.value == pytest.approx(1, abs=1e-12) and peak.time == pytest.approx(0.337, abs=1e-6)
    twin = largest(lambda t: np.cos(6 * math.pi * t) + 1e-3 * t, np.linspace(0, 1, 20))
    assert twin.value == pytest.approx(1.001, abs=1e-6)


def test_scaled_drives_are_those_of_another_frequency_and_stroke():
    drive, other = Drive(2e-6, 300, delay=1e-3, cycles=3), Drive(1.5e-6, 600, delay=0.5e-3, cycles=3)
    one, two = platform_surface(x=drive).scaled(2, 0.75), platform_surface(x=other)
    for time in np.linspace(0, 7e-3, 50):
        np.testing.assert_allclose(one.base_acceleration(time), two.base_acceleration(time), rtol=1e-12)
    np.testing.assert_allclose(one.drives.jump, two.drives.jump, rtol=1e-12)
    np.testing.assert_allclose(one.drives.rough, two.drives.rough, rtol=1e-12)
    assert one.stroke_times.min() == pytest.approx(two.stroke_times.min(), rel=1e-14)


@pytest.mark.compiled
def test_a_face_on_a_platform_slips_turns_and_tips_at_closed_forms():
    side, height, law = 100e-6, 10e-6, CoulombAdhesion(0.4, 1e-8)
    square, press = Footprint.rectangle(side, side), MASS * G + 1e-8

    def body(footprint, heading=0.0):
        return Body(footprint, 2 * height, MASS, position=(0.0, 0.0), heading=heading)

    sway, turn = Drive(1e-6, 500, "sine"), Drive(2e-3, 500, "sine")
    pushed = part_at_rest(platform_surface(x=sway), body(square, math.pi / 4), law, 4e-3)
    force = MASS * amplitude(sway)
    assert pushed.slip().value == pytest.approx(force / (0.4 * press), rel=1e-7)
    # Across its diagonal a square's least pressure falls by 6 sqrt(2) / side times the shift of what presses.
    least = (press - force * height * 6 * math.sqrt(2) / side) / (MASS * G)
    assert pushed.contact_margin().value == pytest.approx(least, rel=1e-7)
    upright = part_at_rest(platform_surface(x=sway), body(square), law, 4e-3)
    assert upright.contact_margin().value == pytest.approx((press - force * height * 6 / side) / (MASS * G), rel=1e-7)
    disc = body(Footprint.disc(side / 2))
    turned = part_at_rest(platform_surface(turn=turn), disc, law, 4e-3)
    torque = MASS * (side / 2) ** 2 / 2 * amplitude(turn)
    assert turned.slip().value == pytest.approx(torque / (0.4 * press * side / 3), rel=1e-7)
    assert turned.scaled(2.0, 0.5).slip().value == pytest.approx(2 * turned.slip().value, rel=1e-7)
