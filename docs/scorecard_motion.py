"""Parts that published models carry: a wall that shakes asymmetrically, and impacts on a plate that vibrates."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    HermiteDrive,
    Micropart,
    platform_surface,
    polynomial_surface,
    simulate,
)
from particle.drives import drive_table

G = 9.81  # m/s^2, as in both sources


def transport(sticking: float, slipping: float, friction: float, frequency: float, periods: int = 3) -> float:
    """The mean speed up a wall [mm/s] that goes up with one acceleration and down with another, all over G.

    Friction is what it bears over the part's mass, held and sliding alike. The wall's acceleration jumps, which the
    drive spreads over 1e-6 of a period.
    """
    period, spread = 1 / frequency, 1e-6 / frequency
    turn = period * slipping / (2 * (sticking + slipping))
    jumps = np.array([[k * period + turn, (k + 1) * period - turn] for k in range(periods)]).ravel()
    times = np.array([0.0, *np.stack([jumps - spread / 2, jumps + spread / 2], axis=1).ravel(), periods * period])
    up, down = sticking * G, -slipping * G
    a = np.array([up, *[up, down, down, up] * periods, up])
    v = np.concatenate([[0], np.cumsum((a[1:] + a[:-1]) / 2 * np.diff(times))])
    z = np.concatenate([[0], np.cumsum(v[:-1] * np.diff(times) + (2 * a[:-1] + a[1:]) / 6 * np.diff(times) ** 2)])
    wall = platform_surface(x=HermiteDrive(times, z, v, a), size=float(np.ptp(z)))
    law = ConstantFriction(friction * G)
    path = simulate(wall, Micropart(1.0, (0.0, 0.0)), law, periods * period, gravity=(-G, 0.0, 0.0))
    return float(1e3 * path.position[-1, 0] / (periods * period))


STROKE, LENGTH, FREQUENCY, START, END = 2.5e-6, 6e-3, 1e3, 7.5e-4, 0.1  # m, m, Hz, m, s


def impacts(friction: float) -> float:
    """How far along x a point hops in `END` on a standing wave [um], without restitution.

    The wave is expanded about the start, to third order: 1e-9 of it, 10 um away.
    """
    k = 2 * math.pi / LENGTH
    s, c = math.sin(k * START), math.cos(k * START)
    wave = polynomial_surface(np.array([s, c * k, -s * k**2 / 2, -c * k**3 / 6])[:, None], size=1e-4)
    wave = replace(wave, drives=drive_table([Drive(STROKE, FREQUENCY, "sine")]))
    part = Micropart(1.0, (0.0, 0.0))
    path = simulate(wave, part, CoulombAdhesion(friction), END, gravity=G, after_detachment="fly", tolerance=1e-11)
    return float(1e6 * path.position[-1, 0])


def impacts_in_steps(steps: int, friction: float) -> float:
    """The same by free fall in equal steps, this many a period, and an impulse after each that ends below the wave.

    The scheme of vsariola/vibrating-plate-simulator (V. Sariola, 2016, MIT licence), written anew for a point.
    """
    k, rate, dt = 2 * math.pi / LENGTH, 2 * math.pi * FREQUENCY, 1 / (steps * FREQUENCY)
    x, y, u, v = START, 0.0, 0.0, 0.0
    for i in range(1, round(END / dt) + 1):
        x, y, v = x + u * dt, y + v * dt - G * dt**2 / 2, v - G * dt
        height = STROKE * math.sin(rate * i * dt)
        if y >= height * math.sin(k * x):
            continue
        slope = height * k * math.cos(k * x)
        length = math.hypot(1, slope)
        rise = STROKE * rate * math.cos(rate * i * dt) * math.sin(k * x)
        along, across = (u + (v - rise) * slope) / length, (v - rise - u * slope) / length
        if across < 0:
            blow = -math.copysign(min(abs(along), -friction * across), along)
            u, v = u + (blow + across * slope) / length, v + (blow * slope - across) / length
    return 1e6 * (x - START)
