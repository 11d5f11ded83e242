"""Bounces on a shaken plate against an independent simulation of events."""

import math

import pytest
from driven_surface import driven
from scipy.optimize import brentq

from particle import CoulombAdhesion, Drive, EventKind, Micropart, simulate

G, MASS = 9.80665, 2e-9


def bounces(a, rate, mu, u, tilt, end):
    """Take-offs (time) and landings (time, place, speed after it) on h = a sin(rate t), found one by one."""
    t, x, away = 0.0, 0.0, []
    first = math.asin(G / (a * rate**2))  # the surface falls away from this phase to pi less it
    found = []
    while True:
        phase = rate * t % (2 * math.pi)
        wait = 0.0 if first <= phase <= math.pi - first else (first - phase) % (2 * math.pi) / rate
        h, v = a * math.sin(rate * t), a * rate * math.cos(rate * t)
        t += wait
        if wait > 0 and t < end:
            away.append(t)
        z, w = a * math.sin(rate * t), a * rate * math.cos(rate * t)
        x += u * wait + (tilt - mu * G) * wait**2 / 2 - mu * (z - h - v * wait)
        u += (tilt - mu * G) * wait - mu * (w - v)

        def gap(dt, t=t, z=z, w=w):
            return z + w * dt - G * dt**2 / 2 - a * math.sin(rate * (t + dt))

        step = 1e-3 / rate
        late = 5 * step
        while gap(late) > 0:
            late += step
        flown = brentq(gap, late - step, late, xtol=1e-18, rtol=1e-15)
        t, x, u = t + flown, x + u * flown + tilt * flown**2 / 2, u + tilt * flown
        u -= mu * (a * rate * math.cos(rate * t) - (w - G * flown))
        if t > end:
            return away, found
        found.append((t, x, u))


@pytest.mark.parametrize(
    "strength", [3.6, *(pytest.param(g, marks=pytest.mark.compiled) for g in (1.2, 2.2, 5.5, 9.0))]
)
@pytest.mark.parametrize("frequency", [pytest.param(4.0, marks=pytest.mark.compiled), 700.0])
@pytest.mark.parametrize("late", [0.0, 0.3], ids=["at once", "delayed"])
def test_a_part_bounces_on_a_shaken_plate_as_an_independent_simulation_does(strength, frequency, late):
    """Dead impacts on a sine whose acceleration is `strength` g, with friction in slides and in landings.

    A run that begins with the sine begins on a surface that moves already: no blow.
    """
    rate, mu, periods = 2 * math.pi * frequency, 0.1, 12
    a = strength * G / rate**2
    tilt, u = 0.5, 40 * mu * a * rate
    delay = late / frequency
    # While it waits it slides on a surface at rest, and the sine's first moment hits it.
    slower = u + (tilt - mu * G) * delay
    start = u * delay + (tilt - mu * G) * delay**2 / 2
    away, theirs = bounces(a, rate, mu, slower - (mu * a * rate if late else 0.0), tilt, periods / frequency)
    surface = driven([Drive(a, frequency, "sine", delay=delay)], size=a)
    path = simulate(
        surface,
        Micropart(MASS, (0.0, 0.0), (u, 0.0)),
        CoulombAdhesion(mu),
        delay + periods / frequency,
        gravity=(tilt, 0.0, -G),
        tolerance=1e-11,
        after_detachment="fly",
    )
    ours = [e for e in path.events if e.kind is EventKind.LANDS]
    assert len(ours) == len(theirs) >= 4
    hops = {e.time for e in ours}  # a part that hops on lands and detaches at once
    off = [e.time - delay for e in path.events if e.kind is EventKind.DETACHES and e.time not in hops]
    assert off == pytest.approx(away, abs=1e-9 / frequency)
    assert [e.time - delay for e in ours] == pytest.approx([t for t, _, _ in theirs], abs=1e-9 / frequency)
    assert [e.position[0] - start for e in ours] == pytest.approx([x for _, x, _ in theirs], abs=1e-8 * a)
    assert [e.speed for e in ours] == pytest.approx([w for _, _, w in theirs], rel=1e-9)
    assert path.energy.balance < 1e-9
