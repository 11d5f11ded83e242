"""Meshes of polygons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from meshes.fill import RimEdges, fill
from meshes.mesh import PlateMesh
from meshes.outline import Outline, straight
from meshes.shapes import check_lengths
from meshes.triangles import cross
from meshes.types import FloatArray, IntArray

SHARP = np.deg2rad(60)  # towards sharper corners cells shrink with the plate's width
GROWTH = 0.5  # of cells away from a short side, per length


def polygon(corners: ArrayLike, cell_size: float, names: Sequence[str] | None = None) -> PlateMesh:
    """A simple polygon; corners in either sense of rotation, re-entrant ones allowed.

    Parameters
    ----------
    corners : (k, 2) array_like
        [m].
    cell_size : float
        About the longest edge of a cell [m].
    names : sequence of str, optional
        The boundary of each side, the first from the first corner to the second; by default "rim" for all.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names everything that is wrong: fewer than three corners, repeated ones, sides that cross or touch, a cell size
        that is not a positive length, another number of names than sides.
    """
    try:
        xy = np.asarray(corners, dtype=float)
    except (TypeError, ValueError):
        xy = np.empty(0)
    check_lengths("polygon", *_mistakes(xy, corners, names), cell_size=cell_size)
    side_names = ["rim"] * len(xy) if names is None else list(names)
    if _area(xy) < 0:
        xy, side_names = xy[::-1], side_names[-2::-1] + side_names[-1:]
    ends = np.roll(xy, -1, axis=0)
    outline = Outline(edges=straight(xy, ends))
    sizes = [_Sizes(xy, k, cell_size) for k in range(len(xy))]
    points = [size.points() for size in sizes]
    row = np.arange(sum(map(len, points)))
    side = np.repeat(np.arange(len(xy)), [len(p) for p in points])

    def min_length(start: FloatArray, end: FloatArray, sides: IntArray) -> FloatArray:
        return np.array([sizes[k].min_length(a, b) for a, b, k in zip(start, end, sides, strict=True)])

    rim = RimEdges(np.stack([row, np.roll(row, -1)], axis=1), side, lambda middle, _: middle, min_length)
    mesh_points, triangles = fill(np.concatenate(points), rim, outline, cell_size)
    boundaries = {
        name: rim.edges[np.isin(rim.sides, [k for k, other in enumerate(side_names) if other == name])]
        for name in dict.fromkeys(side_names)
    }
    return PlateMesh(mesh_points, triangles, boundaries, {}, outline)


def regular_polygon(sides: int, radius: float, cell_size: float, rotation: float = 0.0) -> PlateMesh:
    """A regular polygon around the origin; its boundary is "rim".

    Parameters
    ----------
    sides : int
        How many, 3 or more.
    radius : float
        From the centre to a corner [m].
    cell_size : float
        About the longest edge of a cell [m].
    rotation : float
        Of the first corner from the x axis, counter-clockwise [rad].

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names everything that is wrong.
    """
    mistakes = []
    if isinstance(sides, bool) or not isinstance(sides, (int, np.integer)) or sides < 3:
        mistakes.append(f"Input sides of regular_polygon must be a whole number of at least 3; got {sides!r}")
    if not np.isfinite(rotation):
        mistakes.append(f"Input rotation of regular_polygon must be a finite angle in rad; got {rotation!r}")
    check_lengths("regular_polygon", *mistakes, radius=radius, cell_size=cell_size)
    angle = rotation + 2 * np.pi * np.arange(sides) / sides
    return polygon(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1), cell_size)


class _Sizes:
    """How long the edges on one side of a polygon should be."""

    def __init__(self, xy: FloatArray, side: int, cell_size: float) -> None:
        before, start, end, after = np.roll(xy, 1 - side, axis=0).take(range(4), axis=0, mode="wrap")
        self.start, self.end, self.cell_size = start, end, cell_size
        self.length = float(np.hypot(*(end - start)))
        # For each end: the width of the plate over the distance from it, the tip's length, the shorter side's length.
        self.ends = [self._end(start, before, end), self._end(end, start, after)]

    def _end(self, corner: FloatArray, before: FloatArray, after: FloatArray) -> tuple[float, float, float]:
        a, b = after - corner, before - corner
        angle = np.arctan2(cross(a, b), a @ b) % (2 * np.pi)
        short = float(min(np.hypot(*a), np.hypot(*b)))
        return (2 * float(np.sin(angle / 2)) if angle < SHARP else 0.0), min(self.cell_size, short / 3), short

    def at(self, distance: FloatArray) -> FloatArray:
        """The length [m] that edges should have at distances (n,) [m] from the side's start."""
        size = np.full(len(distance), self.cell_size)
        for (width, tip, short), x in zip(self.ends, (distance, self.length - distance), strict=True):
            size = np.minimum(size, short + GROWTH * x)
            if width:
                size = np.minimum(size, np.where(x < tip, tip, x * width))
        return size

    def points(self) -> FloatArray:
        """The side's first corner and the points to its last, which is left out."""
        x = np.linspace(0, self.length, 4001)
        number = np.concatenate([[0], np.cumsum(np.diff(x) / self.at((x[1:] + x[:-1]) / 2))])
        count = max(1, int(np.ceil(number[-1] - 1e-6)))
        place = np.interp(np.arange(count) * number[-1] / count, number, x)[:, None]
        return np.asarray(self.start + place / self.length * (self.end - self.start))

    def min_length(self, start: FloatArray, end: FloatArray) -> float:
        """The length [m] below which the edge between two points is not cut: at a sharp corner, the plate's width."""
        x = sorted([np.hypot(*(start - self.start)), np.hypot(*(end - self.start))])
        longest = 0.0
        for (width, tip, _), distance in zip(self.ends, (x[0], self.length - x[1]), strict=True):
            if width:
                at_tip = distance < 1e-9 * self.length
                longest = max(longest, tip if at_tip else min(self.cell_size, width * distance))
        return 0.7 * longest


def _mistakes(xy: FloatArray, corners: ArrayLike, names: Sequence[str] | None) -> list[str]:
    if xy.ndim != 2 or xy.shape[1] != 2 or len(xy) < 3 or not np.isfinite(xy).all():
        return [f"Input corners of polygon must be at least three points (x, y) in m; got {corners!r}"]
    mistakes = []
    if names is not None and (isinstance(names, str) or len(names) != len(xy)):
        mistakes.append(f"Input names of polygon must be one for each of its {len(xy)} sides; got {names!r}")
    repeated = [(i, j) for i in range(len(xy)) for j in range(i) if (xy[i] == xy[j]).all()]
    for i, j in repeated:
        mistakes.append(f"Input corners of polygon must differ; got corner {i} at corner {j}, {xy[i].tolist()} m")
    if not repeated:
        ends = np.roll(xy, -1, axis=0)
        low, high = np.minimum(xy, ends), np.maximum(xy, ends)
        overlap = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2)  # of boxes: no other sides can cross
        crossed = [(j, i) for i, j in np.argwhere(np.tril(overlap, -1)).tolist() if _touch(xy, ends, i, j)]
        for one, other in crossed:
            mistakes.append(f"Input corners of polygon must give sides that do not cross; got {one} and {other}")
    return mistakes


def _touch(start: FloatArray, end: FloatArray, i: int, j: int) -> bool:
    """Whether sides i > j share more than the corner of neighbours."""
    if i == j + 1 or (j == 0 and i == len(start) - 1):
        corner, one, other = (end[j], start[j], end[i]) if i == j + 1 else (start[j], end[j], start[i])
        return bool(_turn(corner, one, other) == 0 and (one - corner) @ (other - corner) > 0)
    turns = [_turn(start[i], end[i], start[j]), _turn(start[i], end[i], end[j])]
    turns += [_turn(start[j], end[j], start[i]), _turn(start[j], end[j], end[i])]
    low, high = np.minimum(start, end), np.maximum(start, end)
    boxes = (low[i] <= high[j]).all() and (low[j] <= high[i]).all()
    return bool(turns[0] * turns[1] <= 0 and turns[2] * turns[3] <= 0 and boxes)


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """The sign of the area of abc."""
    return float(np.sign(cross(b - a, c - a)))


def _area(xy: FloatArray) -> float:
    x, y = (xy - xy[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
