"""Comparison: two runs side by side, in what their cases and their ends differ, and where their paths part."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from common import draw, notebook_html, quantity
from coupling.case import Difference, differences
from coupling.result import Result
from coupling.results import SavedRun
from coupling.summary import Summary, summary_of

if TYPE_CHECKING:
    from common import Axes, Figure

FloatArray = NDArray[np.float64]

MAX_FIELDS: Final = 40  # that are printed
LONGEST: Final = 40  # letters of a value that is printed


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """Two runs side by side.

    Parameters
    ----------
    runs : pair of Result or SavedRun
        The runs.
    differences : tuple of Difference
        The fields in which their cases differ.
    time : array (k,)
        Moments [s] up to the end of the shorter path.
    distance : array (k,)
        How far the parts are apart then [m], ``|r_2(t) - r_1(t)|``.
    """

    runs: tuple[Result | SavedRun, Result | SavedRun]
    differences: tuple[Difference, ...]
    time: FloatArray
    distance: FloatArray

    @cached_property
    def names(self) -> tuple[str, str]:
        """The names of the runs, with A and B where they have the same."""
        first, second = (run.name if isinstance(run, SavedRun) else run.case.name for run in self.runs)
        return (f"{first}, A", f"{second}, B") if first == second else (first, second)

    @cached_property
    def summaries(self) -> tuple[Summary, Summary]:
        """The figures of both."""
        first, second = (summary_of(r.summary) if isinstance(r, SavedRun) else r.summary for r in self.runs)
        return first, second

    @property
    def farthest(self) -> tuple[float, float]:
        """The largest distance [m] between the parts, and when [s]."""
        k = int(np.argmax(self.distance))
        return float(self.distance[k]), float(self.time[k])

    @property
    def sentence(self) -> str:
        """Where the paths part."""
        (most, when), end = self.farthest, float(self.time[-1])
        whole = len({summary.end_time for summary in self.summaries}) == 1
        ends = f"where {'both end' if whole else 'the first of them ends'}."
        if most == 0:
            return "The paths are the same" + ("." if whole else f" up to {quantity(end, 's', 4)}, {ends}")
        last = f"and {quantity(float(self.distance[-1]), 'm', 4)} at {quantity(end, 's', 4)}, "
        largest = f"at most {quantity(most, 'm', 4)} apart, at {quantity(when, 's', 4)}"
        return f"The paths are {largest}, {last if when < end else ''}{ends}"

    @property
    def lines(self) -> list[tuple[str, str]]:
        """Rows (label, text) to print: ends and margins, the fields that differ, and where the paths part."""
        ends = map(Difference, ENDS, *map(_ends, self.summaries))
        fields = [Difference(*map(_cut, row)) for row in self.differences[:MAX_FIELDS]]
        rows = [Difference("", *self.names), *ends, *(fields or [Difference("fields", "none differs", "")])]
        wide, wider = (max(len(row[k]) for row in rows) + 2 for k in (0, 1))
        found = [(one.ljust(wide), f"{two.ljust(wider)}{three}".rstrip()) for one, two, three in rows]
        more = len(self.differences) - MAX_FIELDS
        found += [("", f"{more} more fields differ")] * (more > 0)
        return [*found, ("paths".ljust(wide), self.sentence)]

    @property
    def warnings(self) -> list[str]:
        """What keeps the runs from being compared in all."""
        origins = [f"those of {n} from {s.origin}" for n, s in zip(self.names, self.summaries, strict=True)]
        apart = len({summary.origin for summary in self.summaries}) > 1
        partial = [n for n, run in zip(self.names, self.runs, strict=True) if not getattr(run, "complete", True)]
        return [f"Positions are counted differently, {' and '.join(origins)}."] * apart + [
            f"The files of {name} were not written to the end: the path is compared as far as they go."
            for name in partial
        ]

    def as_dict(self) -> dict[str, Any]:
        """The figures by name in SI units, those of the runs as in their summaries."""
        runs = [{"name": n, **s.as_dict()} for n, s in zip(self.names, self.summaries, strict=True)]
        fields = {row.field: row[1:] for row in self.differences}
        apart = dict(zip(("largest_distance", "largest_distance_time"), self.farthest, strict=True))
        return {"differences": fields, "runs": runs, **apart, "end_distance": float(self.distance[-1])}

    def __repr__(self) -> str:
        fields = ", ".join(row.field for row in self.differences) or "no field"
        return f"Comparison of {self.names[0]!r} and {self.names[1]!r}, which differ in {fields}. {self.sentence}"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw both paths from above, and over time; with axes in m, only the paths, into these."""
        return draw(self, axes)

    _repr_html_ = notebook_html


def compare(first: Result | SavedRun, second: Result | SavedRun) -> Comparison:
    """Compare two runs.

    Parameters
    ----------
    first, second : Result or SavedRun
        The runs, as `run_case` returns them or `read_run` reads them.

    Returns
    -------
    comparison : Comparison
        What differs in their cases, and where their paths part.

    Raises
    ------
    ValueError
        One is no run of a single part.
    """
    for name, run in (("first", first), ("second", second)):
        if not isinstance(run, (Result, SavedRun)):
            raise ValueError(f"Input {name} of compare must be a Result or SavedRun of one part; got {run!r}")
    ways = [run.rows if isinstance(run, SavedRun) else run.trajectory for run in (first, second)]
    times = np.unique(np.concatenate([rows.time for rows in ways]))
    times = times[times <= min(rows.time[-1] for rows in ways)]
    one, other = (_places(rows, times) for rows in ways)
    return Comparison((first, second), tuple(differences(first.case, second.case)), times, np.hypot(*(other - one).T))


def _places(rows: Any, times: FloatArray) -> FloatArray:
    """Where a part is (k, 2) [m] at times (k,) [s], by cubics between the rows of its path."""
    from scipy.interpolate import CubicHermiteSpline  # here, because pictures of one run do without it

    known, chosen = np.unique(rows.time, return_index=True)
    if len(known) == 1:  # of a part that is lost at once
        return np.broadcast_to(rows.position[:1], (len(times), 2))
    return np.asarray(CubicHermiteSpline(known, rows.position[chosen], rows.velocity[chosen])(times))


ENDS: Final = ("outcome", "end", "ends at", "distance", "path", "turned", "slips", "pull", "coming off")


def _ends(s: Summary) -> list[str]:
    """The ENDS of a run in words; "-": it has none."""
    slip, off = s.margins.slip, s.margins.contact
    return [
        s.outcome,
        f"({', '.join(quantity(place, 'm', 5) for place in s.end_position)})",
        *(quantity(value, si, 5) for value, si in ((s.end_time, "s"), (s.distance, "m"), (s.path_length, "m"))),
        "-" if s.turned is None else f"{math.degrees(s.turned):+z.4f} deg",
        str(s.slips),
        "-" if slip is None else f"{slip.value:.4g} of the friction limit at {quantity(slip.time, 's', 4)}",
        "-" if off is None else f"{quantity(off.value * s.margins.scale, 'N')} away at {quantity(off.time, 's', 4)}",
    ]


def _cut(text: str) -> str:
    """The beginning of a long text."""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."
