"""A block on a shaken platform: the motion of the paper's figure 4, and dry friction on a sine, period by period."""

import numpy as np
import pytest
from scipy.optimize import brentq

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    HermiteDrive,
    Micropart,
    platform_surface,
    simulate,
)

G, MU = 9.80665, 0.3
FIGURE_4 = 23.524  # m/s^2, what friction bears


def growing(t):
    """x = t sin(3.2 t), its velocity and acceleration."""
    s, c = np.sin(3.2 * t), np.cos(3.2 * t)
    return t * s, s + 3.2 * t * c, 6.4 * c - 10.24 * t * s


def test_figure_4_slips_and_sticks_when_the_paper_says():
    drive = HermiteDrive.of(growing, 4.0, 200)
    assert drive.error < 1e-11
    block = Micropart(1.0, (0.0, 0.0))
    trajectory = simulate(platform_surface(x=drive, size=4.0), block, ConstantFriction(FIGURE_4), 3.0)
    slip = brentq(lambda t: growing(t)[2] + FIGURE_4, 2.3, 2.5, xtol=1e-14)
    stop = brentq(lambda t: growing(slip)[1] - FIGURE_4 * (t - slip) - growing(t)[1], 2.7, 3.0, xtol=1e-14)
    assert (slip, stop) == pytest.approx((2.41, 2.86), abs=5e-3)
    assert [event.kind for event in trajectory.events] == [EventKind.SLIPS, EventKind.STOPS]
    assert [event.time for event in trajectory.events] == pytest.approx([slip, stop], abs=1e-8)
    way = growing(slip)[0] + growing(slip)[1] * (stop - slip) - FIGURE_4 * (stop - slip) ** 2 / 2 - growing(stop)[0]
    assert trajectory.position[-1] == pytest.approx([way, 0.0], abs=1e-8)


def on_a_sine(stroke, frequency, end):
    """Times and kinds of what happens to a block on x = stroke sin(2 pi f t), and its way on that platform.

    It breaks away where the platform's acceleration passes mu g, goes on at constant deceleration, and meets the
    platform's velocity again: there it stays if friction can hold it, else it slides on the other way.
    """
    rate = 2 * np.pi * frequency
    step = 1e-3 / frequency

    def motion(t):
        return stroke * np.sin(rate * t), stroke * rate * np.cos(rate * t), -stroke * rate**2 * np.sin(rate * t)

    def first(function, t):
        """The first zero after t at which the function changes its sign."""
        grid = t + step * np.arange(1, 3000) * 0.5
        signs = np.sign([function(time) for time in grid])
        k = np.flatnonzero(signs[1:] != signs[:-1])[0]
        return brentq(function, grid[k], grid[k + 1], xtol=1e-16, rtol=1e-15)

    events, way, time, stuck = [], 0.0, 0.0, True
    while True:
        if stuck:
            holds = abs(motion(time)[2]) < MU * G
            time = first(lambda t: abs(motion(t)[2]) - MU * G, time) if holds else time
            if time >= end:
                return events, way
            events.append((EventKind.SLIPS, time))
        sense = -np.sign(motion(time)[2])
        x, v, begin = *motion(time)[:2], time

        def relative(t, v=v, sense=sense, begin=begin):
            return v - sense * MU * G * (t - begin) - motion(t)[1]

        time = first(relative, begin)
        last = min(time, end)
        way += x + v * (last - begin) - sense * MU * G * (last - begin) ** 2 / 2 - motion(last)[0]
        if time >= end:
            return events, way
        stuck = abs(motion(time)[2]) <= MU * G
        events.append((EventKind.STOPS if stuck else EventKind.REVERSES, time))


@pytest.mark.compiled
@pytest.mark.parametrize(
    "excess, kinds",
    [(1.3, {EventKind.SLIPS, EventKind.STOPS}), (4.0, {EventKind.SLIPS, EventKind.REVERSES})],
    ids=["rests in every half period", "never rests again"],
)
def test_a_hundred_periods_of_a_sine_are_those_of_dry_friction(excess, kinds):
    """excess: the platform's largest acceleration over what friction bears."""
    frequency, end = 50.0, 2.0
    stroke = excess * MU * G / (2 * np.pi * frequency) ** 2
    expected, way = on_a_sine(stroke, frequency, end)
    surface = platform_surface(x=Drive(stroke, frequency, "sine"), size=2 * stroke)
    trajectory = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(MU), end)
    assert {kind for kind, _ in expected} == kinds
    assert len(expected) > 190
    assert [event.kind for event in trajectory.events] == [kind for kind, _ in expected]
    found, wanted = (np.array(times) for times in ([e.time for e in trajectory.events], [t for _, t in expected]))
    assert np.abs(found - wanted).max() < 1e-8 / frequency
    assert trajectory.position[-1] == pytest.approx([way, 0.0], abs=1e-7 * stroke)
    assert trajectory.energy.balance < 1e-6
