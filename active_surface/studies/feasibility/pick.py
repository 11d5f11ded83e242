"""Pick: a case at a point of the chart, which its own run proves to move the part."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.spatial import cKDTree

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.chart import Chart
from active_surface.studies.feasibility.ground import Ground
from active_surface.studies.feasibility.result import Feasibility
from common import quantity_text
from coupling import Progress, Result, borders, run_case, silent
from coupling.case import Case

ROWS: Final = 7  # strokes tried in a column
PARTS: Final = 16  # of the way from one column to the next, for distances from borders
CLEAR: Final = 0.5  # of the largest distance from the borders that any point has: enough
MAX_TRIED: Final = 40  # runs
MIN_ROOM: Final = 1.02  # ratio of the two borders of a column in which points are looked for


@dataclass(frozen=True, eq=False)
class Picked:
    """A case at a point of the chart, and its run."""

    case: Case
    frequency: float  # Hz, of its fastest drive
    stroke: float  # m or N, the largest
    unit: str  # of the stroke
    result: Result

    @property
    def where(self) -> str:
        """The point."""
        return f"{quantity_text(self.frequency, 'Hz', 5)} and {quantity_text(self.stroke, self.unit, 5)}"

    @property
    def text(self) -> str:
        """What its drives do, in a sentence."""
        summary = self.result.summary
        far, along = quantity_text(summary.distance, "m", 4), quantity_text(summary.path_length, "m", 4)
        lasting = quantity_text(summary.duration, "s", 4)
        ends = f"ends {far} from its start after {lasting}, on a path of {along}"
        return f"At {self.where} the part {ends}. {summary.sentence}"

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        summary = self.result.summary
        return {
            "frequency": self.frequency,
            "stroke": self.stroke,
            "outcome": summary.outcome,
            "distance": summary.distance,
            "path_length": summary.path_length,
            "end_position": list(summary.end_position),
        }


def pick(
    found: Feasibility,
    frequency: float | None = None,
    stroke: float | None = None,
    threads: int | None = None,
    progress: Progress = silent,
) -> Picked:
    """A case that moves: at a frequency [Hz] and a largest stroke [m or N], or at the best point of the chart.

    The best point moves the part farthest, from start to end, of those at least half as far from all borders as any is,
    in the logarithms of frequency and stroke. It is within the model's bounds where points there move the part, and
    rounded to three digits.
    Raises ValueError where the case's run loses the part or does not carry it farther than FAR of half the plate's
    longer side, and where no column of the chart has a ratio of MIN_ROOM between its borders.
    """
    tried = 0
    if frequency is None or stroke is None:
        with progress("Trying points of the map"):
            tried, best = best_point(found.ground, found.chart, found.valid, threads)
        if best is None:
            narrow = (
                f"at every frequency the stroke that loses it is less than {MIN_ROOM:g} times the one that moves it"
            )
            slips = any(math.isfinite(column.slips) for column in found.chart.columns)
            raise ValueError(
                "Input pick of feasibility must be on a map where the part moves without being lost; "
                + (narrow if slips else "no stroke looked at moves it")
            )
        frequency, stroke = (float(f"{value:.3g}") for value in (best[0] * found.frequency, best[1] * found.stroke))
    case = found.at(frequency, stroke)
    result = run_case(case, progress=progress)
    picked = Picked(case, frequency, stroke, found.stroke_unit, result)
    lost, far = result.trajectory.outcome in borders.LOST, result.summary.distance
    least = borders.FAR * found.ground.surface.size
    if lost or not far > least:
        only = f"moves only {quantity_text(far, 'm', 3)}" if far > 0 else "stays at rest"
        what = f"is lost after {quantity_text(result.summary.end_time, 's', 3)}" if lost else only
        raise ValueError(
            f"Input pick of feasibility must carry the part farther than {quantity_text(least, 'm', 3)}, "
            f"{borders.FAR:g} of half the plate's longer side, without losing it; got "
            f"{f'the best of {tried} points, ' * bool(tried)}{picked.where}, where it {what}{_beside(found, frequency)}"
        )
    return picked


def _beside(found: Feasibility, frequency: float) -> str:
    """The borders at a frequency [Hz], as the end of a sentence."""
    columns = found.chart.columns
    factor = frequency / found.frequency
    if not columns[0].frequency <= factor <= columns[-1].frequency:
        return ""
    limits = found.chart.limits(factor)
    texts = [
        f"{what} from {quantity_text(border * found.stroke, found.stroke_unit, 4)}"
        for what, border in (("slips", limits.slips[0]), ("is lost", limits.lost[0]))
        if math.isfinite(border)
    ]
    return f": at that frequency it {' and '.join(texts)}" if texts else ""


def best_point(
    ground: Ground, chart: Chart, largest: FloatArray, threads: int | None = None
) -> tuple[int, tuple[float, float] | None]:
    """How many points are tried, and the factors of frequency and stroke of the best; None: there are none.

    largest: strokes (columns,) up to which the model is valid.
    """
    points, rooms = _candidates(chart, largest)
    if not len(points):
        points, rooms = _candidates(chart, np.full(len(chart.columns), np.inf))
    if not len(points):
        return 0, None
    clear = np.flatnonzero(rooms >= CLEAR * rooms.max())
    tried = clear[np.argsort(-rooms[clear], kind="stable")[:MAX_TRIED]]
    paths = ground.paths([(float(k), float(s)) for k, s in points[tried]], threads)
    far = [-1.0 if path.outcome in borders.LOST else path.distance for path in paths]
    best = int(np.argmax(far))
    return len(tried), (float(points[tried[best], 0]), float(points[tried[best], 1]))


def _candidates(chart: Chart, largest: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points (n, 2) within the borders and below the strokes `largest`, and how far (n,) from the borders they are."""
    points = []
    for column, most in zip(chart.columns, largest, strict=True):
        low, high = column.slips, min(column.lost, chart.strokes[1], float(most))
        if math.isfinite(low) and high > MIN_ROOM * low:
            points += [(column.frequency, s) for s in np.geomspace(low, high, ROWS + 2)[1:-1].tolist()]
    if not points:
        return np.zeros((0, 2)), np.zeros(0)
    found = np.array(points)
    return found, clearances(chart, found)


def clearances(chart: Chart, points: FloatArray) -> FloatArray:
    """How far (n,) points (n, 2) are from the borders, in the logarithm."""
    frequencies = [one.frequency for one in chart.columns]
    between = [np.geomspace(a, b, PARTS, endpoint=False) for a, b in zip(frequencies, frequencies[1:], strict=False)]
    border = []
    for k in [*np.concatenate(between).tolist(), frequencies[-1]]:
        limits = chart.limits(k)
        border += [(k, s) for s in (limits.slips[1], limits.lost[0], chart.strokes[1]) if math.isfinite(s)]
    return np.asarray(cKDTree(np.log(border)).query(np.log(points))[0])
