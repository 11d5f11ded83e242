"""A friction law from measured points: the limit Q over the net load N, without a model behind it.

Between neighbouring points Q is a polynomial of degree 5 that meets a slope and a second derivative at both, so the map
is C2. It does not fall where its Bernstein coefficients do not. Slopes and second derivatives are those of the cubic
spline through the points; where these would make Q fall, they give way to zero second derivatives and slopes of at
most 5/4 of both neighbouring chords, which never do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from particle.friction.contact import POINTS, FrictionLaw, friction_limits, new_law
from particle.friction_input import point_mistakes
from particle.types import FloatArray

FLAT = 1e-14  # of the largest limit: rounding is no fall


@dataclass(frozen=True)
class FrictionTable:
    """Q through measured points; the part comes off below the first load, and the law ends at the last.

    Parameters
    ----------
    loads : sequence of float
        Net loads, N, ascending. The first is minus the pull-off force, so it is 0 or negative.
    limits : sequence of float
        Largest friction while sliding at each load, N; 0 or positive, not falling.
    static_ratio : float
        Limit of a stuck part over that of a sliding one.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    loads: Sequence[float]  # N
    limits: Sequence[float]  # N
    static_ratio: float = 1.0

    def __post_init__(self) -> None:
        wrong = point_mistakes(self.loads, self.limits, self.static_ratio)
        if wrong:
            places = ["" if point is None else f"at point {point} " for _, point, _ in wrong]
            each = zip(wrong, places, strict=True)
            raise ValueError(
                "; ".join(f"Input {name} of FrictionTable {place}{what}" for (name, _, what), place in each)
            )
        for name in ("loads", "limits"):
            object.__setattr__(self, name, tuple(float(value) for value in getattr(self, name)))

    @property
    def pull_off(self) -> float:
        """N, minus the first load."""
        return 0.0 - self.loads[0]

    @property
    def largest_load(self) -> float:
        """N, the last load; nothing is extrapolated."""
        return self.loads[-1]

    @cached_property
    def law(self) -> FrictionLaw:
        """The polynomials between the points, and a straight line beyond either end for an integrator's trial steps."""
        loads, limits = np.array(self.loads), np.array(self.limits)
        return new_law(
            POINTS,
            self.pull_off,
            self.largest_load,
            static_ratio=float(self.static_ratio),
            loads=loads,
            pieces=_pieces(loads, limits),
        )

    @cached_property
    def table_error(self) -> float:
        """How well the points resolve Q, an estimate: how far maps through every second point miss those left out.

        The largest miss, over the limit there; of a limit that is 0 over the largest limit. Noise of the measurement is
        in it, and in smooth data it is larger than the error between the points.
        """
        loads, limits = np.array(self.loads), np.array(self.limits)
        worst = 0.0
        for left_out in (np.arange(1, len(loads) - 1, 2), np.arange(2, len(loads) - 1, 2)):
            if len(left_out) == 0:
                continue
            kept_loads, kept = np.delete(loads, left_out), np.delete(limits, left_out)
            law = new_law(POINTS, self.pull_off, self.largest_load, loads=kept_loads, pieces=_pieces(kept_loads, kept))
            scale = np.where(limits[left_out] > 0, limits[left_out], max(limits[-1], math.ulp(0.0)))
            misses = np.abs(friction_limits(law, loads[left_out]) - limits[left_out]) / scale
            worst = max(worst, float(misses.max()))
        return worst

    def friction_limit(self, net_load: ArrayLike) -> FloatArray:
        """Q [N] while sliding under net loads [N] of any shape; ValueError before the first or past the last."""
        return friction_limits(self.law, net_load)


def _pieces(loads: FloatArray, limits: FloatArray) -> FloatArray:
    """`FrictionLaw.pieces`, (6, points + 1); before the first and past the last point Q goes on as a straight line."""
    from scipy.interpolate import CubicSpline  # here, because other laws do without it

    h, rise = np.diff(loads), np.diff(limits)
    spline, chord = CubicSpline(loads, limits), rise / h
    slope, bend = np.maximum(spline(loads, 1), 0.0), spline(loads, 2)
    safe = 1.25 * np.minimum(np.append(chord[0], chord), np.append(chord, chord[-1]))
    while True:
        # Differences of neighbouring Bernstein coefficients, which are those of the derivative over 5 / h.
        first, last = h * slope[:-1] / 5, h * slope[1:] / 5
        second, fourth = first + h**2 * bend[:-1] / 20, last - h**2 * bend[1:] / 20
        steps = np.array([first, second, rise - first - second - fourth - last, fourth, last])
        falls = np.flatnonzero((steps < -FLAT * limits[-1]).any(axis=0))
        if len(falls) == 0:
            break
        for points in (falls, falls + 1):
            slope[points], bend[points] = np.minimum(slope[points], safe[points]), 0.0
    powers = [math.comb(5, k) * np.diff(steps, k - 1, axis=0)[0] / h**k for k in range(5, 0, -1)]
    ends = np.zeros((6, 2))
    ends[4], ends[5] = slope[[0, -1]], limits[[0, -1]]
    return np.ascontiguousarray(np.column_stack([ends[:, 0], [*powers, limits[:-1]], ends[:, 1]]))
