"""Outline: the true rim of a plate, whatever its mesh; distances from it and reflections at it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.curves import Circle, Curve, Ellipse, Parabolas
from meshes.nearest import CHUNK, nearest_on_edges, nearest_parameter, on_edges, powers
from meshes.types import BoolArray, FloatArray, IntArray

MAX_MIRRORS = 64  # with more edges than this, points are reflected at the NEAREST ones only
NEAREST = 16
FINE = 1 / 200  # of the longer side of the outline, to draw it


@dataclass(frozen=True, eq=False)
class Outline:
    """The boundaries of a plate: whole ellipses and closed loops of edges that do not cross.

    Parameters
    ----------
    conics : (k, 4) array
        Centre x, y and semi-axes in x, y of each ellipse [m].
    edges : (m, 3, 2) array
        Start, middle and end of each quadratic edge, its points at parameters 0, 1/2 and 1 [m]. A straight edge has
        its middle half-way.
    """

    conics: FloatArray = field(default_factory=lambda: np.empty((0, 4)))
    edges: FloatArray = field(default_factory=lambda: np.empty((0, 3, 2)))

    def gap(self, xy: ArrayLike) -> FloatArray:
        """Distance from the nearest boundary.

        Parameters
        ----------
        xy : (..., 2) array_like
            Points [m].

        Returns
        -------
        (...) array
            [m], positive on the plate and negative off it.
        """
        points = np.asarray(xy, dtype=float)
        flat = points.reshape(-1, 2)
        distance, inside = np.full(len(flat), np.inf), self._inside_edges(flat)
        for centre, curve in self._curves:
            gap = curve.gap(flat - centre)
            distance, inside = np.minimum(distance, np.abs(gap)), inside ^ (gap > 0)
        if len(self.edges):
            foot, _, _ = nearest_on_edges(flat, self.edges)
            distance = np.minimum(distance, np.hypot(*(foot - flat).T))
        return np.where(inside, distance, -distance).reshape(points.shape[:-1])

    def project(self, xy: ArrayLike) -> FloatArray:
        """The nearest points of the rim to points (n, 2) [m]; of several equally near ones, one."""
        xy = np.asarray(xy, dtype=float)
        feet = [centre + curve.project(xy - centre) for centre, curve in self._curves]
        if len(self.edges):
            feet.append(nearest_on_edges(xy, self.edges)[0])
        nearest = np.argmin([np.hypot(*(foot - xy).T) for foot in feet], axis=0)
        return np.asarray(np.stack(feet)[nearest, np.arange(len(xy))])

    def mirrored(self, xy: ArrayLike) -> FloatArray:
        """Points (n, 2) [m] reflected at every boundary, each at its nearest point there: (r, 2), all off the plate.

        A reflection across a hole or a slot is moved half-way to the rim until it is off the plate and no closer to the
        far side than to this one; across a re-entrant corner there is none. Of more than 64 edges the nearest 16 count.
        """
        xy = np.asarray(xy, dtype=float)
        feet = [centre + curve.project(xy - centre) for centre, curve in self._curves]
        if len(self.edges):
            feet.extend(self._feet(xy))
        foot, point = np.concatenate(feet), np.tile(xy, (len(feet), 1))
        depth = foot - point
        across = self.inside(foot + depth) | self.inside(foot + 2 * depth)
        for _ in range(6):
            depth[across] /= 2
            across[across] = self.inside((foot + depth)[across]) | self.inside((foot + 2 * depth)[across])
        return np.asarray((foot + depth)[~self.inside(foot + depth)])

    def inside(self, xy: FloatArray) -> BoolArray:
        """Whether points (n, 2) [m] are on the plate, by the parity of the boundaries around them: (n,)."""
        inside = self._inside_edges(xy)
        for centre, curve in self._curves:
            inside = inside ^ (curve.gap(xy - centre) > 0)
        return inside

    @cached_property
    def box(self) -> FloatArray:
        """The lower left and the upper right corner of the smallest box around the plate, (2, 2) m."""
        start, slope, bend = powers(self.edges)
        turn = np.clip(-slope / np.where(bend == 0, np.inf, 2 * bend), 0.0, 1.0)  # where x, and where y, is extreme
        extremes = start + turn * (slope + turn * bend)
        of_edges = np.concatenate([extremes, self.edges[:, 0], self.edges[:, 2]])
        low = np.concatenate([self.conics[:, :2] - self.conics[:, 2:], of_edges])
        high = np.concatenate([self.conics[:, :2] + self.conics[:, 2:], of_edges])
        return np.stack([low.min(axis=0), high.max(axis=0)])

    @cached_property
    def _curves(self) -> list[tuple[FloatArray, Circle | Ellipse]]:
        """The conics around the origin, with their centres."""
        return [(np.array([x, y]), Circle(a) if a == b else Ellipse(a, b)) for x, y, a, b in self.conics.tolist()]

    def _feet(self, xy: FloatArray) -> list[FloatArray]:
        """The nearest points (n, 2) of each edge, or of the nearest ones, to points (n, 2)."""
        count = len(self.edges)
        if count <= MAX_MIRRORS:
            rows = np.tile(np.arange(count), (len(xy), 1))
        else:
            rows = _chunked(self._nearest_edges, xy, count)
        edges = [self.edges[row] for row in rows.T]
        return [on_edges(edge, nearest_parameter(xy, edge)[:, None])[:, 0] for edge in edges]

    def _nearest_edges(self, xy: FloatArray) -> IntArray:
        distance = np.linalg.norm(xy[:, None] - self.edges[:, 1], axis=-1)
        return np.argpartition(distance, NEAREST, axis=1)[:, :NEAREST]

    def _inside_edges(self, xy: FloatArray) -> BoolArray:
        """Whether a ray in x from points (n, 2) crosses the edges an odd number of times, (n,)."""
        if not len(self.edges):
            return np.zeros(len(xy), dtype=bool)
        return _chunked(self._odd_crossings, xy, len(self.edges))

    def _odd_crossings(self, xy: FloatArray) -> BoolArray:
        edge, first, last, low, high = self._monotone
        # A piece includes its lower end and excludes its upper one. So a ray through a vertex crosses one of two pieces
        # that both rise there, and none or both of two that turn back.
        row, piece = np.nonzero((low > xy[:, 1:]) != (high > xy[:, 1:]))
        start, slope, bend = powers(self.edges[edge[piece]])
        width = (last - first)[piece]
        rate = (slope[:, 1] + 2 * bend[:, 1] * first[piece]) * width
        rise = xy[row, 1] - low[piece]
        root = np.sqrt(np.maximum(rate**2 + 4 * bend[:, 1] * width**2 * rise, 0.0))
        below = rate + np.copysign(root, (high - low)[piece])
        t = first[piece] + width * np.clip(2 * rise / np.where(below == 0, np.inf, below), 0.0, 1.0)
        crossed = start[:, 0] + t * (slope[:, 0] + t * bend[:, 0]) > xy[row, 0]
        return np.asarray(np.bincount(row[crossed], minlength=len(xy)) % 2 == 1)

    @cached_property
    def _monotone(self) -> tuple[IntArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """The edges in pieces along which y rises or falls: edge, first and last parameter, first and last y."""
        start, slope, bend = powers(self.edges[:, :, 1:])
        turn = (-slope / np.where(bend == 0, np.inf, 2 * bend))[:, 0]
        split = np.flatnonzero((turn > 0) & (turn < 1))
        whole = np.setdiff1d(np.arange(len(self.edges)), split)
        top = (start + turn[:, None] * (slope + turn[:, None] * bend))[split, 0]
        zero, one = np.zeros(len(self.edges)), np.ones(len(self.edges))
        low, high = self.edges[:, 0, 1], self.edges[:, 2, 1]
        return (
            np.concatenate([whole, split, split]),
            np.concatenate([zero[whole], zero[split], turn[split]]),
            np.concatenate([one[whole], turn[split], one[split]]),
            np.concatenate([low[whole], low[split], top]),
            np.concatenate([high[whole], top, high[split]]),
        )


def straight(start: FloatArray, end: FloatArray) -> FloatArray:
    """Straight edges (k, 3, 2) between points (k, 2)."""
    return np.stack([start, (start + end) / 2, end], axis=1)


def outline_of(points: FloatArray, boundaries: Mapping[str, IntArray], curves: Mapping[str, Curve]) -> Outline:
    """The outline of a mesh, by the edges (k, 2) of its boundaries, rows of points, and their curves."""
    edges = [np.empty((0, 3, 2))]
    swept: dict[tuple[float, ...], float] = {}

    def sweep(conic: tuple[float, ...], pairs: IntArray) -> None:
        centre, axes = np.array(conic).reshape(2, 2)
        angle = np.arctan2(*np.moveaxis((points[pairs] - centre) / axes, 2, 0)[::-1])
        turns = (np.diff(angle, axis=1) + np.pi) % (2 * np.pi) - np.pi
        swept[conic] = swept.get(conic, 0.0) + abs(float(turns.sum()))

    for name, pairs in boundaries.items():
        match curves.get(name):
            case Circle(radius, centre):
                sweep((*centre, radius, radius), pairs)
            case Ellipse(semi_axis_x, semi_axis_y):
                sweep((0.0, 0.0, semi_axis_x, semi_axis_y), pairs)
            case Parabolas() as curve:
                edges.append(curve.pieces)
            case None:
                edges.append(straight(*points[pairs.T]))
    for conic, angle in swept.items():
        if abs(angle - 2 * np.pi) > 1e-6:
            raise ValueError(
                "Input curves of PlateMesh must have circles and ellipses that are whole rims; boundaries cover "
                f"{np.rad2deg(angle):.4g} degrees of the one around {list(conic[:2])} m"
            )
    return Outline(np.array(list(swept), dtype=float).reshape(-1, 4), np.concatenate(edges))


def rim_curves(outline: Outline, spacing: float | None = None) -> list[FloatArray]:
    """Points (n, 2) [m] along each ellipse and each edge of the rim, at most about `spacing` [m] apart.

    spacing: None is fine enough to draw the whole rim.
    """
    if spacing is None:
        spacing = FINE * float(np.ptp(outline.box, axis=0).max())
    curves = []
    for x, y, a, b in outline.conics.tolist():
        angle = np.linspace(0, 2 * np.pi, int(np.ceil(2 * np.pi * max(a, b) / spacing)) + 4)
        curves.append(np.stack([x + a * np.cos(angle), y + b * np.sin(angle)], axis=1))
    for start, middle, end in outline.edges:
        length = np.linalg.norm(middle - start) + np.linalg.norm(end - middle)
        s = np.linspace(0, 1, int(np.ceil(length / spacing)) + 1)[:, None]
        curves.append((1 - s) * (1 - 2 * s) * start + 4 * s * (1 - s) * middle + s * (2 * s - 1) * end)
    return curves


def _chunked(function: Callable[[FloatArray], NDArray], xy: FloatArray, edges: int) -> NDArray:
    """A function of points (n, 2), applied to few enough at a time that their pairs with edges stay below CHUNK."""
    step = max(1, CHUNK // edges)
    return np.concatenate([function(xy[i : i + step]) for i in range(0, max(1, len(xy)), step)])
