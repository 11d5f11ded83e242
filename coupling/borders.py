"""Borders: the factors of a case's drives from which a part slips and is lost, at rest and in whole runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import brentq

from coupling.case import Case
from coupling.drives import travel
from coupling.part import build_part
from coupling.scene import PlateScene, Scene
from meshes import Outline
from particle import Micropart, Outcome, PartAtRest, SurfaceMotion, Trajectory, part_at_rest
from particle.drives import horizon
from particle.friction import Contact

FAR: Final = 1e-3  # of the surface's size: a part that is carried so far moves
KEPT: Final = Outcome.STUCK, Outcome.MOVING
LOST: Final = Outcome.DETACHED, Outcome.OVERLOADED, Outcome.LEFT_PLATE
MAX_STROKES: Final = 85  # of the shortest, in which thresholds are looked for
STEP: Final = math.log(1.25)  # between the logarithms of factors between which a threshold is looked for
RANGE: Final = 64.0  # the largest factor
LEAST: Final = 1 / 4096  # the smallest
BEFORE: Final = 0.98  # of where it comes off
EXACT: Final = 1e-7  # of a threshold
CLOSE: Final = 1.005  # ratio of the strokes between which a loss in runs begins
COARSE, FINE = 1.2, 1.02  # ratios of strokes of runs
DOUBTFUL: Final = 3.0  # times how far the margin strays from a straight line: less of it is looked at closely
ENOUGH: Final = 2.0  # a ratio of strokes over which all runs lose the part: larger ones do so, too
AT_ONCE: Final = 4  # runs


@dataclass(frozen=True)
class Thresholds:
    """From how many times the frequency or stroke a part at its start slips, and comes off or is overloaded.

    None: at none up to 64; 0: at any.
    """

    knob: str  # "frequency" or "stroke"
    slips_from: float | None
    comes_off_from: float | None
    holds: float | None  # the pull over the friction limit just before it comes off, where it does not slip before


class Factors(NamedTuple):
    """The same; inf: none up to the largest."""

    slips: float
    comes_off: float


def thresholds_of(case: Case, scene: Scene, trajectory: Trajectory, friction: Contact) -> Thresholds | None:
    """The thresholds of a part that its drives did not carry far, or did not keep; None where `why_none` says why."""
    if why_none(case, scene, trajectory):
        return None
    rest = at_rest(case, scene.surface, build_part(case), friction)
    own = factors_of(lambda factor: driven(scene, rest, factor))
    if math.isclose(own.slips, own.comes_off, rel_tol=10 * EXACT):  # friction ends with contact
        own = own._replace(slips=own.comes_off)
    unslipped = own.slips >= own.comes_off * BEFORE and 0 < own.comes_off < math.inf
    return Thresholds(
        "stroke" if strokes_alone(scene) else "frequency",
        None if math.isinf(own.slips) else own.slips,
        None if math.isinf(own.comes_off) else own.comes_off,
        driven(scene, rest, own.comes_off * BEFORE).slip().value if unslipped else None,
    )


def why_none(case: Case, scene: Scene, trajectory: Trajectory) -> str:
    """Why a part needs no other drives, or why no factor of its drives tells anything, in a sentence; else empty."""
    if all(travel(drive) == 0 for drive in (*scene.lifts, *scene.base)):
        return "No drive moves."
    if trajectory.outcome in (Outcome.LEFT_PLATE, Outcome.WORK_LIMIT):
        return trajectory.sentence
    if trajectory.outcome in KEPT and trajectory.distance > FAR * scene.surface.size:
        return "The part moves already, and stays on."
    if any(case.part.velocity):
        return "The part is on the move from the start, and thresholds are those of a part at rest."
    if strokes_alone(scene) and stretches(scene):
        return "No factor scales the drives of a plate that stretches and has inertia."
    return ""


def strokes_alone(scene: Scene) -> bool:
    """Whether only strokes can be scaled: the plate does not follow its drives at once, or they are measured."""
    return bool(scene.fits) or (isinstance(scene, PlateScene) and scene.has_inertia)


def stretches(scene: Scene) -> bool:
    """Whether the plate stretches, and so is not linear in its strokes."""
    return isinstance(scene, PlateScene) and scene.stretch is not None


def at_rest(case: Case, surface: SurfaceMotion, part: Micropart, friction: Contact) -> PartAtRest:
    """A part that stays at its start, for as long as the drives take to repeat, or some strokes."""
    duration, repeated = case.run.duration, horizon(surface.drives, 0.0)
    shortest = float(surface.stroke_times.min(initial=duration))
    window = min(duration, MAX_STROKES * shortest, math.inf if repeated is None else repeated)
    return part_at_rest(surface, part, friction, window, case.run.gravity)


def driven(scene: Scene, rest: PartAtRest, factor: float, stroke: float = 1.0) -> PartAtRest:
    """A part at rest under drives times a factor: of the frequency, or of the stroke where only that is scaled."""
    return rest.scaled(1.0, factor) if strokes_alone(scene) else rest.scaled(factor, stroke)


def factors_of(scaled: Callable[[float], PartAtRest]) -> Factors:
    """The factors of drives from which a part at rest slips, and comes off."""
    ends = math.log(LEAST), math.log(RANGE)

    def factor(excess: Callable[[PartAtRest], float]) -> float:
        return math.exp(begins(lambda x: excess(scaled(math.exp(x))), 0.0, ends, STEP, EXACT))

    return Factors(factor(excess_pull), factor(excess_load))


def excess_pull(rest: PartAtRest) -> float:
    """The logarithm of the largest pull over the friction limit: the part slips from 0 on."""
    return math.log(min(max(rest.slip().value, 1e-9), 1e9))


def excess_load(rest: PartAtRest) -> float:
    """By how much the load leaves what contact bears, over the weight or so: the part is lost from 0 on."""
    law, part = rest.part.law, rest.part
    unit = part.mass * abs(part.gravity) + part.squeeze or part.mass
    excess = -math.inf
    if math.isfinite(law.pull_off):
        excess = -(rest.smallest_load().value + law.pull_off) / unit
    if math.isfinite(law.largest_load):
        excess = max(excess, (rest.largest_load().value - law.largest_load) / unit)
    return excess


def begins(
    excess: Callable[[float], float], start: float, ends: tuple[float, float], step: float, exact: float
) -> float:
    """Where an excess becomes positive, seen upwards, nearest to a start between two ends.

    inf: nowhere; -inf: it is positive from the start down to the lower end.
    """
    x = start
    positive = excess(x) >= 0
    while x != ends[not positive]:
        before, x = x, max(x - step, ends[0]) if positive else min(x + step, ends[1])
        if (excess(x) >= 0) != positive:
            return float(brentq(excess, *sorted((before, x)), xtol=exact))
    return -math.inf if positive else math.inf


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
    """How near a path came to losing the part, from 1 to 0, at which it is lost: by pull-off, overload and the rim.

    Between the path's steps it may have been nearer.
    """
    if path.outcome in LOST:
        return 0.0
    law, load, gap = friction.law, path.normal_force, outline.gap(path.position)
    shares = [float(gap.min() / gap[0])]
    if math.isfinite(law.pull_off):
        shares.append(float((load.min() + law.pull_off) / (load[0] + law.pull_off)))
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
