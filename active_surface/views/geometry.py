"""Geometry of what is drawn: triangles of a surface, lines in pieces or thinned, and round numbers."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from matplotlib.tri import TrapezoidMapTriFinder, Triangulation
from scipy.spatial import Delaunay, cKDTree

from active_surface.arrays import BoolArray, FloatArray, IntArray
from meshes import cross

SLIVER = 0.01  # of a cell's area: smaller triangles of a thinned surface are none

DIGITS = (1, 2, 5)
DRAWN_HEIGHT = 0.2  # of a length: heights are drawn about so large
MIN_EXAGGERATION = 1.5  # a smaller one counts as 1
SLACK = 1e-9  # relative: a number that is round up to rounding errors is round


class Spots(NamedTuple):
    """Points on a surface of triangles, each a mean of three corners."""

    corners: IntArray  # (q, 3)
    weights: FloatArray  # (q, 3), which add up to 1

    def heights(self, z: FloatArray) -> FloatArray:
        """Their heights, each at its own of q steps: z (q, n)."""
        return np.asarray((np.take_along_axis(z, self.corners, axis=1) * self.weights).sum(axis=1))


def spots_of(points: FloatArray, triangles: IntArray, places: FloatArray) -> Spots:
    """Places (q, 2) [m] on triangles (m, 3) of points (n, 2) [m]; one outside is on the plane of the one near it."""
    triangle = _triangles_at(points, triangles, places)
    nearest = cKDTree(points[triangles].mean(axis=1)).query(places)[1]
    corners = triangles[np.where(triangle >= 0, triangle, nearest)]
    return Spots(corners, barycentric(points[corners], places))


def barycentric(corners: FloatArray, places: FloatArray) -> FloatArray:
    """The coordinates (..., 3) of places (..., 2) in triangles with corners (..., 3, 2); of slivers those of the first.

    They add up to 1, and none is negative inside.
    """
    a, b, c = np.moveaxis(corners, -2, 0)
    u, v, w = b - a, c - a, places - a
    area = cross(u, v)
    area = np.where(area == 0, 1.0, area)
    second, third = cross(w, v) / area, cross(u, w) / area
    return np.stack([1 - second - third, second, third], axis=-1)


def inside(points: FloatArray, triangles: IntArray, places: FloatArray) -> BoolArray:
    """Which places (q, 2) [m] lie in the triangles."""
    return _triangles_at(points, triangles, places) >= 0


def _triangles_at(points: FloatArray, triangles: IntArray, places: FloatArray) -> IntArray:
    """The numbers (q,) of the triangles (m, 3) that places (q, 2) [m] lie in; -1: in none."""
    # `get_trifinder` makes a reference cycle, whose megabytes stay until the garbage collector comes.
    return np.asarray(TrapezoidMapTriFinder(Triangulation(*points.T, triangles))(*places.T))


def coarse(points: FloatArray, triangles: IntArray, max_points: int) -> IntArray:
    """Triangles (m', 3) that cover about the same with at most so many of the points, spread, those at edges first."""
    used = np.unique(triangles)
    low, high = points[used].min(axis=0), points[used].max(axis=0)
    inner = ~np.isin(used, outer_edges(triangles))
    side = float(np.sqrt(np.prod(high - low) / max_points))
    while True:
        cells = np.floor((points[used] - low) / side).astype(np.int64)
        order = np.lexsort((inner, cells[:, 1], cells[:, 0]))
        chosen = used[order[np.unique(cells[order], axis=0, return_index=True)[1]]]
        if len(chosen) <= max_points:
            break
        side *= 1.05
    faces = chosen[Delaunay(points[chosen]).simplices]
    u, v = points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]]
    wide = np.abs(cross(u, v)) > SLIVER * side**2
    return np.asarray(faces[wide & inside(points, triangles, points[faces].mean(axis=1))])


def outer_edges(triangles: IntArray) -> IntArray:
    """The edges (e, 2) that only one triangle has."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    unique, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    return np.asarray(unique[count == 1])


def cut_in(parts: IntArray) -> tuple[IntArray, FloatArray]:
    """Pieces of a line that are cut in so many parts each: of every part's beginning its piece, and how far along."""
    piece = np.repeat(np.arange(len(parts)), parts)
    return piece, (np.arange(len(piece)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[piece]


def thinned(line: FloatArray, apart: float) -> FloatArray:
    """Those points of a line (n, 2) that a line through them needs to pass all others within `apart`.

    By Ramer, Douglas and Peucker: the farthest point stays while it is too far away.
    """
    kept = np.zeros(len(line), dtype=bool)
    kept[[0, -1]] = True
    pieces = [(0, len(line) - 1)]
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        away = _distances(line[first + 1 : last], line[first], line[last])
        farthest = int(np.argmax(away))
        if away[farthest] > apart:
            middle = first + 1 + farthest
            kept[middle] = True
            pieces += [(first, middle), (middle, last)]
    return line[kept]


def _distances(points: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    """How far points (n, 2) are from a straight piece."""
    along = end - begin
    length = float(along @ along)
    share = np.clip((points - begin) @ along / length, 0, 1) if length > 0 else np.zeros(len(points))
    return np.asarray(np.hypot(*(points - begin - share[:, None] * along).T))


def round_below(value: float) -> float:
    """The largest 1, 2 or 5 with a power of ten that is not above a positive number."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(digit * power for digit in DIGITS if digit * power <= value * (1 + SLACK))


def round_above(value: float) -> float:
    """The smallest one that is not below it."""
    power = 10.0 ** math.floor(math.log10(value))
    return min(digit * power for digit in (*DIGITS, 10) if digit * power >= value * (1 - SLACK))


def exaggeration(height: float, length: float) -> float:
    """The factor by which heights [m] of something so long [m] are drawn larger: a round number, or 1."""
    exact = DRAWN_HEIGHT * length / height if height > 0 else 1.0
    if exact < MIN_EXAGGERATION:
        return 1.0
    return min(round_below(exact), round_above(exact), key=lambda factor: abs(math.log(factor / exact)))
