"""Borders: at one frequency, the strokes from which a part slips and from which single runs lose it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, Literal

import numpy as np
from scipy.optimize import brentq

from active_surface.studies.feasibility.ground import Ground
from particle import Outcome, Trajectory

EXACT: Final = 1e-4  # of the stroke: where slip begins
STRIDE: Final = 0.4  # between the logarithms of strokes tried in search of it
CLOSE: Final = 1.005  # ratio of the strokes between which a loss begins
COARSE, FINE = 1.2, 1.02  # ratios of strokes of runs
DOUBTFUL: Final = 3.0  # times how far the margin strays from a straight line: less of it is looked at closely
ENOUGH: Final = 2.0  # a ratio of strokes over which all runs lose the part: larger ones do so, too
AT_ONCE: Final = 4  # paths
LOST: Final = (Outcome.DETACHED, Outcome.OVERLOADED, Outcome.LEFT_PLATE)


@dataclass(frozen=True)
class Column:
    """The borders at one factor of frequency, as factors of the strokes; inf: not up to the largest looked at."""

    frequency: float
    slips: float  # from which the part leaves rest
    lost: float  # from which some run loses it
    all_lost: float  # from which all do
    runs: dict[float, float] = field(repr=False, compare=False, default_factory=dict)
    """By the factor of strokes: how near a run came to losing the part, from 1 to 0, at which it is lost."""

    @property
    def ragged(self) -> bool:
        """Whether strokes that lose the part and others lie side by side."""
        return self.all_lost > self.lost * CLOSE**2


def find_slip(ground: Ground, frequency: float, strokes: tuple[float, float], guess: float = 1.0) -> float:
    """The factor of strokes from which a part at rest at its start slips, or comes off, at a factor of frequency.

    inf: not up to the largest of `strokes`; their smallest where it slips at that.  guess: where to begin.
    """
    if any(ground.case.part.velocity):
        return strokes[0]  # it is on the move from the start
    bottom, top = map(math.log, strokes)

    def value(x: float) -> float:
        """The logarithm of the largest pull over friction, over that of the stroke; from 0 on it slips."""
        return math.log(min(max(ground.rest(frequency, math.exp(x)).slip().value, 1e-9), 1e9))

    x = min(max(math.log(guess), bottom), top)
    slips = value(x) >= 0
    while True:
        before, x = x, max(x - STRIDE, bottom) if slips else min(x + STRIDE, top)
        if (value(x) >= 0) != slips:
            break
        if x in (bottom, top):
            return strokes[0] if slips else math.inf
    return math.exp(brentq(value, *sorted((before, x)), xtol=EXACT / 2) + EXACT / 2)


def find_column(
    ground: Ground, frequency: float, strokes: tuple[float, float], guess: float = 1.0, threads: int | None = None
) -> Column:
    """The borders at a factor of frequency, within factors of the strokes; guess: where slip begins."""
    slips = find_slip(ground, frequency, strokes, guess)
    if slips > strokes[1]:
        return Column(frequency, slips, math.inf, math.inf)
    runs: dict[float, float] = {}

    def run(more: Sequence[float]) -> None:
        paths = ground.paths([(frequency, stroke) for stroke in more], threads)
        runs.update((stroke, _margin(ground, path)) for stroke, path in zip(more, paths, strict=True))

    ladder = _ladder(slips * (1 + 2 * EXACT), strokes[1], COARSE)
    for first in range(0, len(ladder), AT_ONCE):
        run(ladder[first : first + AT_ONCE])
        if max(runs) > ENOUGH * _last_kept(runs, slips):
            break
    while more := _doubtful(runs, slips):
        run(more)
    lost = min((stroke for stroke, margin in runs.items() if margin <= 0), default=math.inf)
    kept = _last_kept(runs, 0.0)
    all_lost = min((stroke for stroke in runs if stroke > kept), default=math.inf)
    return Column(frequency, slips, max(lost, slips), all_lost, runs)


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


def state_of(path: Trajectory) -> Literal["rest", "moves", "lost"]:
    """What a path came to."""
    return "lost" if path.outcome in LOST else "moves" if path.path_length > 0 else "rest"


def _margin(ground: Ground, path: Trajectory) -> float:
    """How near a path came to losing the part, from 1 to 0, at which it is lost: by pull-off, overload and the rim.

    Between the path's steps it may have been nearer.
    """
    if path.outcome in LOST:
        return 0.0
    law, load = ground.friction.law, path.normal_force
    shares = [float(ground.outline.gap(path.position).min() / ground.outline.gap(path.position[:1])[0])]
    if math.isfinite(law.pull_off):
        shares.append(float((load.min() + law.pull_off) / (load[0] + law.pull_off)))
    if math.isfinite(law.largest_load):
        shares.append(float((law.largest_load - load.max()) / (law.largest_load - load[0])))
    return float(np.clip(min(shares), 1e-9, 1.0))


def _ladder(low: float, high: float, ratio: float) -> list[float]:
    """Strokes from low to high, each at most `ratio` times the one before."""
    count = max(math.ceil(math.log(high / low) / math.log(ratio) - 1e-9), 1)
    return [low * (high / low) ** (n / count) for n in range(count + 1)]
