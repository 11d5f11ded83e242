"""Remedy: what would move a part that no frequency and stroke of a chart moves."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from active_surface.studies.feasibility.area import Feasible
from active_surface.studies.feasibility.borders import LOST
from active_surface.studies.feasibility.chart import Chart
from active_surface.studies.feasibility.ground import Ground
from particle.friction import ScaledFriction

BELOW: Final = 0.99  # of the stroke from which the part is lost
SMALLER: Final = (1.0, 0.8, 0.6)  # times that: strokes tried with less friction
WEAKER: Final = (0.98, 0.85)  # of the friction at which the part first slips there


class Remedy(NamedTuple):
    """How near the part comes to slipping where it comes nearest, less friction that moves it, and another start."""

    frequency: float  # factor of the case's, where the share is largest
    stroke: float  # likewise
    comes_off: bool  # whether a larger stroke loses the part there
    share: float  # of the pull over what friction holds
    friction: float | None  # a factor of the friction with which a run moves the part and keeps it; None: none tried
    friction_stroke: float | None  # the factor of strokes of that run, at that frequency
    moved: float | None  # m, from start to end of that run
    place: tuple[float, float] | None  # m, where a part slips at the case's own drives, attached all the time
    place_share: float | None  # of the time in which it does so


def remedy_of(ground: Ground, chart: Chart, areas: Feasible, threads: int | None = None) -> Remedy:
    """What would move the part, from the pull on it at rest at its start just below the borders, and from runs."""
    best = (0.0, 0.0, 0.0, False)
    for column in chart.columns:
        comes_off = math.isfinite(column.lost)
        stroke = BELOW * column.lost if comes_off else chart.strokes[1]
        best = max(best, (ground.rest(column.frequency, stroke).slip().value, column.frequency, stroke, comes_off))
    share, frequency, stroke, comes_off = best
    shares = np.where(areas.own.lost, 0.0, areas.own.shares)
    n = int(shares.argmax())
    place = (float(areas.points[n, 0]), float(areas.points[n, 1])) if shares[n] > 0 else None
    friction, smaller, moved = _friction(ground, frequency, stroke, threads) if share > 0 else (None, None, None)
    place_share = float(shares[n]) if place else None
    return Remedy(frequency, stroke, comes_off, share, friction, smaller, moved, place, place_share)


def _friction(
    ground: Ground, frequency: float, stroke: float, threads: int | None
) -> tuple[float, float, float] | tuple[None, None, None]:
    """The largest factor of the friction tried, its stroke, and how far [m] its run moves the part."""
    tried = []
    for smaller in SMALLER:
        share = ground.rest(frequency, smaller * stroke).slip().value
        if 0 < share < math.inf:
            tried += [(min(share, 1.0) * weaker, smaller * stroke) for weaker in WEAKER]
    for factor, smaller in sorted(tried, reverse=True):
        weak = ScaledFriction(ground.friction, factor)
        (path,) = ground.paths([(frequency, smaller)], threads, weak)
        if path.outcome not in LOST and path.path_length > 0:
            return factor, smaller, path.distance
    return None, None, None
