"""Losses: the strokes from which runs lose a part."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from coupling import borders, least_pressure
from meshes import Outline
from particle import Trajectory
from particle.friction import Contact

CLOSE: Final = 1.005  # ratio of the strokes between which a loss begins
COARSE, FINE = 1.2, 1.02  # ratios of strokes of runs
DOUBTFUL: Final = 3.0  # times how far the margin strays from a straight line: less of it is looked at closely
ENOUGH: Final = 2.0  # a ratio of strokes over which all runs lose the part: larger ones do so, too
AT_ONCE: Final = 4  # runs


class Losses(NamedTuple):
    """From which strokes runs lose a part; inf: none up to the largest."""

    first: float  # from which some run does
    all: float  # from which all do
    runs: dict[float, float]  # by stroke how near each run came to that, as of `margin_of`


def find_losses(run: Callable[[Sequence[float]], Sequence[float]], slips: float, low: float, high: float) -> Losses:
    """From which strokes runs lose a part that slips from one on, looked for from a lowest to a largest.

    run: gives the margins of runs at strokes.
    """
    runs: dict[float, float] = {}
    ladder = _ladder(low, high, COARSE)
    for first in range(0, len(ladder), AT_ONCE):
        more = ladder[first : first + AT_ONCE]
        runs.update(zip(more, run(more), strict=True))
        if max(runs) > ENOUGH * _last_kept(runs, slips):
            break
    while more := _doubtful(runs, slips):
        runs.update(zip(more, run(more), strict=True))
    kept = _last_kept(runs, 0.0)
    some = min((stroke for stroke, margin in runs.items() if margin <= 0), default=math.inf)
    return Losses(some, min((stroke for stroke in runs if stroke > kept), default=math.inf), runs)


def margin_of(path: Trajectory, friction: Contact, outline: Outline) -> float:
    """How near a path came to losing the part, from 1 to 0, at which it is lost.

    By pull-off, tipping, overload and the rim. Between the path's steps it may have been nearer.
    """
    if path.outcome in borders.LOST:
        return 0.0
    law, load, gap = friction.law, path.normal_force, outline.gap(path.position)
    shares = [float(gap.min() / gap[0])]
    if math.isfinite(law.pull_off):
        shares.append(float((load.min() + law.pull_off) / (load[0] + law.pull_off)))
    if path.pressure_margin is not None:
        pressed = least_pressure(path.pressure_margin, load, path.air_force, law.pull_off)
        shares.append(float(np.nanmin(pressed, initial=math.inf) / pressed[0]) if pressed[0] > 0 else math.inf)
    if math.isfinite(law.largest_load):
        shares.append(float((law.largest_load - load.max()) / (law.largest_load - load[0])))
    return float(np.clip(min(shares), 1e-9, 1.0))


def _doubtful(runs: dict[float, float], slips: float) -> list[float]:
    """Strokes between those of runs where it is to be seen whether the part is lost."""
    known = sorted(runs)
    first = next((stroke for stroke in known if runs[stroke] <= 0), math.inf)
    last = _last_kept(runs, slips)
    rough = _roughness([stroke for stroke in known if stroke < first], runs)
    more: list[float] = []
    for a, b in pairwise(known):
        fine = b <= a * FINE * 1.001
        if (runs[a] > 0) != (runs[b] > 0) and (b == first or a == last):
            more += _around_border(a, b, known, runs) if b > a * CLOSE else []
        elif b < first:
            least = min(runs[a], runs[b])
            more += [math.sqrt(a * b)] if not fine and least < DOUBTFUL * max(rough[a], rough[b]) else []
        elif first <= a < last * COARSE and not fine:  # beyond the first loss: how far up does any keep the part?
            more += _ladder(a, b, math.sqrt(COARSE))[1:-1] or [math.sqrt(a * b)]
    return more


def _roughness(kept: list[float], runs: dict[float, float]) -> dict[float, float]:
    """By stroke how far the margin there is from a straight line between its neighbours."""
    rough = dict.fromkeys(kept, 0.0)
    for a, b, c in zip(kept, kept[1:], kept[2:], strict=False):
        share = math.log(b / a) / math.log(c / a)
        rough[b] = abs(runs[b] - (1 - share) * runs[a] - share * runs[c])
    return rough


def _around_border(a: float, b: float, known: list[float], runs: dict[float, float]) -> list[float]:
    """Two strokes between a and b, where the margin vanishes: at about as much as below, else in thirds."""
    n = known.index(a)
    if runs[a] > 0 and n > 0 and runs[known[n - 1]] > runs[a] and b > a * CLOSE**2:
        fall = (runs[known[n - 1]] - runs[a]) / math.log(a / known[n - 1])
        zero = a * math.exp(runs[a] / fall)
        if a * CLOSE < zero < b / CLOSE:
            return [zero / math.sqrt(CLOSE), zero * math.sqrt(CLOSE)]
    return _ladder(a, b, (b / a) ** (1 / 3) * 1.0001)[1:-1]


def _last_kept(runs: dict[float, float], default: float) -> float:
    """The largest stroke that keeps the part."""
    return max((stroke for stroke, margin in runs.items() if margin > 0), default=default)


def _ladder(low: float, high: float, ratio: float) -> list[float]:
    """Strokes from low to high, each at most `ratio` times the one before."""
    count = max(math.ceil(math.log(high / low) / math.log(ratio) - 1e-9), 1)
    return [low * (high / low) ** (n / count) for n in range(count + 1)]
