"""How long a part rests where its contact depends on the surface's curvature: located, not proven.

What friction must resist and what it can are smooth in time over a span at a fixed place, but no polynomials. Chebyshev
polynomials through NODES moments stand for them: where their coefficients leave no room for a sign change the part
stays, else the interval is halved, the earlier half first, down to one where the excess crosses 0 once.
"""

from __future__ import annotations

import math

import numpy as np

from particle.events.mechanics import Part, rest_pull
from particle.jit import device, device_no_arrays
from particle.surface import LocalSurface, surface_at

NODES, HALVINGS, TURNS = 9, 30, 80
_AT = np.cos(np.pi * np.arange(NODES) / (NODES - 1))  # from the end of an interval back to its begin
_MATRIX = np.linalg.inv(np.cos(np.outer(np.arccos(_AT), np.arange(NODES))))  # values there to coefficients
RESOLVED = 1e-3  # of all coefficients: the last two, in a polynomial that stands for the room
ROUNDING = 1e-13


@device_no_arrays
def room(local: LocalSurface, part: Part, x: float, y: float, time: float) -> float:
    """The least of 1 - (friction needed / its limit)^2 and the load's distance from the contact's ends, over a scale.

    0 and positive: a part at rest at (x, y) [m] stays at a time [s].
    """
    a = rest_pull(surface_at(local, x, y, time), part)
    law, limit = part.law, part.law.static_ratio * a.limit
    ends = min(a.load + law.pull_off, law.largest_load - a.load) / law.pull_off
    return min(1.0 - (a.demand / limit) ** 2 if limit > 0.0 else -1.0, ends)


@device
def leaves_rest_by_search(local: LocalSurface, part: Part, x: float, y: float, begin: float, end: float) -> float:
    """When [s] a part at rest at (x, y) [m] first slips or its contact ends, from `begin` to `end` [s]; inf: not."""
    values, c = np.empty(NODES), np.empty(NODES)
    low, width = 0.0, 1.0  # of the interval that is looked at, as shares
    if room(local, part, x, y, begin) < 0.0:
        return begin
    while low < 1.0:
        start, span = begin + low * (end - begin), width * (end - begin)
        for k in range(NODES):
            values[k] = room(local, part, x, y, start + 0.5 * span * (1.0 + _AT[k]))
        for i in range(NODES):
            c[i] = 0.0
            for k in range(NODES):
                c[i] += _MATRIX[i, k] * values[k]
        swing = steep = 0.0
        for i in range(1, NODES):
            swing += abs(c[i])
            steep += i * i * abs(c[i]) if i > 1 else 0.0
        left_out = abs(c[NODES - 1]) + abs(c[NODES - 2])
        resolved = left_out <= RESOLVED * (abs(c[0]) + swing)
        stays = resolved and c[0] - swing > left_out
        if not stays and width > 0.5**HALVINGS and swing > ROUNDING:
            if resolved and values[0] < 0.0 and steep < -c[1]:
                return _root(local, part, x, y, start, start + span)
            width *= 0.5
            continue
        if not stays and values[0] < -ROUNDING:
            return _root(local, part, x, y, start, start + span)
        low += width
        # The longest interval that begins there on the grid of halvings.
        while width < 1.0 and low / (2.0 * width) == math.floor(low / (2.0 * width)):
            width *= 2.0
    return math.inf


@device_no_arrays
def _root(local: LocalSurface, part: Part, x: float, y: float, low: float, high: float) -> float:
    """The moment [s], just beyond, at which the room falls below 0 between two: secants (Illinois) and halving."""
    above, below = room(local, part, x, y, low), room(local, part, x, y, high)
    secant = True
    for _ in range(TURNS):
        if high - low <= 1e-15 * abs(high):
            break
        middle = 0.5 * (low + high)
        if secant:
            middle = low + min(max(above / (above - below), 1e-9), 1.0 - 1e-9) * (high - low)
        if not low < middle < high:
            break
        value, width = room(local, part, x, y, middle), high - low
        if value < 0.0:
            high, below, above = middle, value, 0.5 * above
        else:
            low, above, below = middle, value, 0.5 * below
        secant = high - low < 0.5 * width
    return high
