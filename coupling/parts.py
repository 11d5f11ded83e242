"""Parts: the result of many over one surface, and where they overlap, as none feels the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from common import draw, notebook_html
from coupling.result import Result

if TYPE_CHECKING:
    from common import Axes, Figure

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Outlines = tuple[FloatArray, float]
"""Corners (k, c, 2) [m] at k moments, and how far around them a part reaches [m]: a disc is a corner with a radius."""

BLOCK: Final = 1000  # moments at which outlines are compared together
HALVINGS: Final = 50  # of the time between two moments
SHRINKS: Final = 1e-9  # of a part's size
MARGIN: Final = 0.1  # of a path's extent, by which it may reach beyond its rows


class Overlap(NamedTuple):
    """Two parts, and from when on their faces overlap in plan for the first time."""

    parts: tuple[str, str]
    time: float  # s

    @property
    def sentence(self) -> str:
        """What a warning says of it."""
        one, other = self.parts
        when = "from the start" if self.time == 0 else f"from {self.time * 1e3:.6g} ms on"
        return f"Parts {one} and {other} overlap {when}: contact between parts is not modelled."


@dataclass(frozen=True, eq=False, repr=False)
class PartsResult:
    """The result of a run of many parts.

    Parameters
    ----------
    name : str
        Of the run, as of its files.
    results : mapping of str to Result
        The result of each part, by its name.
    overlaps : tuple of Overlap
        The first overlap of each pair of parts that meet, by time.
    files : tuple of path
        Files that were written.
    """

    name: str
    results: Mapping[str, Result]
    overlaps: tuple[Overlap, ...]
    files: tuple[Path, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """The summaries by the names of the parts, and the overlaps, for JSON."""
        parts = {name: result.summary.as_dict() for name, result in self.results.items()}
        return {"parts": parts, "overlaps": [overlap._asdict() for overlap in self.overlaps]}

    def __repr__(self) -> str:
        return f"PartsResult {self.name!r} of the parts {', '.join(self.results)}; {len(self.overlaps)} overlap"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw all paths and outlines over the surface when it is deflected most, into axes in m or new ones."""
        return draw(self, axes)

    _repr_html_ = notebook_html


def overlaps_of(results: Mapping[str, Result]) -> tuple[Overlap, ...]:
    """The first overlap of each pair of parts, by time."""
    pairs = ((names, first_overlap(*(results[name] for name in names))) for names in combinations(results, 2))
    return tuple(sorted((Overlap(names, time) for names, time in pairs if time is not None), key=lambda one: one.time))


def first_overlap(one: Result, other: Result) -> float | None:
    """When [s] the faces of two parts first overlap, or a point is on a face, at rows of their paths or frames.

    Halving of the time since the moment before then finds it to rounding. None: never, or both are points.
    """
    pair = one, other
    reach = sum(result.case.part.face.reach for result in pair if result.case.part.face is not None)
    boxes = [_box(result.trajectory.position) for result in pair]
    if reach == 0 or np.max(np.maximum(boxes[0][0] - boxes[1][1], boxes[1][0] - boxes[0][1])) > reach:
        return None
    end = min(result.trajectory.time[-1] for result in pair)
    times = np.unique(np.concatenate([each for result in pair for each in (result.trajectory.time, result.frames)]))
    times = times[times <= end]
    for start in range(0, len(times), BLOCK):
        found = np.flatnonzero(overlapping(*(_outlines(result, times[start : start + BLOCK]) for result in pair)))
        if found.size:
            late = float(times[start + found[0]])
            early = float(times[max(start + found[0] - 1, 0)])
            for _ in range(HALVINGS):
                middle = (early + late) / 2
                if overlapping(*(_outlines(result, np.array([middle])) for result in pair))[0]:
                    late = middle
                else:
                    early = middle
            return late
    return None


def _box(places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lowest and highest coordinates (2,) [m] of a path (n, 2) [m], with a margin."""
    low, high = places.min(axis=0), places.max(axis=0)
    return low - MARGIN * (high - low), high + MARGIN * (high - low)


def _outlines(result: Result, times: FloatArray) -> Outlines:
    """A part in plan at times (k,) [s]."""
    samples, face = result.trajectory.at(times), result.case.part.face
    if face is None or face.radius or samples.heading is None:
        return samples.position[:, None], 0.0 if face is None else face.radius
    return face.outline(samples.position, samples.heading), 0.0


def overlapping(one: Outlines, other: Outlines) -> BoolArray:
    """Whether two parts overlap, at each of k moments."""
    (a, _), (b, _), apart = one, other, one[1] + other[1]
    along_a, along_b = np.roll(a, -1, axis=1) - a, np.roll(b, -1, axis=1) - b
    within_a, within_b = _shrunk(a), _shrunk(b)  # whose corners are within the other where the parts coincide
    beside_a, beside_b = _beside(a, along_a, b), _beside(b, along_b, a)  # (k, sides, corners)
    crosses = (beside_a * np.roll(beside_a, -1, axis=2) < 0) & (beside_b * np.roll(beside_b, -1, axis=2) < 0).mT
    found = crosses.any(axis=(1, 2)) | _within(a, along_a, within_b) | _within(b, along_b, within_a)
    if apart:
        found |= np.minimum(_distance(a, along_a, b), _distance(b, along_b, a)) < apart
    return np.asarray(found)


def _beside(corners: FloatArray, along: FloatArray, places: FloatArray) -> FloatArray:
    """How far places (k, n, 2) are to the left of sides (k, m, 2), times the sides' lengths: (k, m, n)."""
    away = places[:, None] - corners[:, :, None]
    return np.asarray(along[..., None, 0] * away[..., 1] - along[..., None, 1] * away[..., 0])


def _shrunk(corners: FloatArray) -> FloatArray:
    """Corners (k, n, 2) just nearer to their middle."""
    middle = corners.mean(axis=1, keepdims=True)
    return np.asarray(middle + (1 - SHRINKS) * (corners - middle))


def _within(corners: FloatArray, along: FloatArray, places: FloatArray) -> BoolArray:
    """Whether any of places (k, n, 2) is in a polygon (k, m, 2): an odd number of sides are to the right of it."""
    beside = _beside(corners, along, places)
    starts_above = corners[:, :, None, 1] > places[:, None, :, 1]
    ends_above = (corners + along)[:, :, None, 1] > places[:, None, :, 1]
    right = (starts_above != ends_above) & ((beside > 0) == ends_above)
    return np.asarray((right.sum(axis=1) % 2 == 1).any(axis=1))


def _distance(corners: FloatArray, along: FloatArray, places: FloatArray) -> FloatArray:
    """The least distance (k,) from places (k, n, 2) to sides (k, m, 2), which may be points."""
    away, along = places[:, None] - corners[:, :, None], along[:, :, None]
    length = np.square(along).sum(axis=-1)
    share = np.clip((away * along).sum(axis=-1) / np.where(length > 0, length, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * along, axis=-1).min(axis=(1, 2)))
