"""PlateMesh: the triangles of a plate, its named boundaries and the curves that they stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.curves import Circle, Curve, Ellipse, Parabolas
from meshes.nearest import FloatArray, IntArray
from meshes.outline import Outline, straight
from meshes.refine import edge_numbers, refine

CORNER = np.deg2rad(15)  # a tangent that turns by more than this turns at a corner
CUT = "cut"  # the boundary along which a part was cut out


@dataclass(frozen=True)
class Corner:
    """A boundary point where the rim turns sharply or the boundary's name changes.

    Parameters
    ----------
    row : int
        Row of the mesh's points.
    angle : float
        Angle between the true tangents, through the plate, rad.
    sides : tuple of str
        Names of the boundaries before and after it, walking with the plate on the left.
    """

    row: int
    angle: float
    sides: tuple[str, str]


@dataclass(frozen=True, eq=False)
class PlateMesh:
    """A conforming triangulation of a plate.

    Parameters
    ----------
    points : array (n, 2)
        Corners of the triangles, m.
    triangles : array (m, 3)
        Rows of points, counter-clockwise.
    boundaries : dict of str to array (k, 2)
        For each boundary, its edges as rows of points; turned to have the plate on their left.
    curves : dict of str to curve, optional
        For each boundary, the curve that its edges approximate. Other boundaries have straight edges.
    outline : Outline, optional
        The plate's true rim; by default made of boundaries and curves.

    Raises
    ------
    ValueError
        A Circle or Ellipse is not all of a rim. Use `Parabolas` for arcs of it.
    """

    points: FloatArray
    triangles: IntArray
    boundaries: Mapping[str, IntArray]
    curves: Mapping[str, Curve] = field(default_factory=dict)
    outline: Outline = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        object.__setattr__(self, "boundaries", _turned(self.triangles, self.boundaries, len(self.points)))
        if self.outline is None:
            object.__setattr__(self, "outline", _outline(self.points, self.boundaries, self.curves))

    @cached_property
    def size(self) -> float:
        """Half of the larger side of the box around the plate [m]: the length that makes equations dimensionless."""
        return float(np.max(np.ptp(self.points, axis=0)) / 2)

    def mirrored(self, xy: ArrayLike) -> FloatArray:
        """Points (n, 2) [m] reflected at every boundary of the outline: (r, 2), all off the plate."""
        return self.outline.mirrored(xy)

    def arcs(self, name: str, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A boundary's edges along its true curve at s (n,) in [0, 1]: points (k, n, 2) m and derivatives in s."""
        start, end = self.points[self.boundaries[name].T]
        if name in self.curves:
            return self.curves[name].arc(start, end, s)
        along = np.repeat((end - start)[:, None], len(s), axis=1)
        return start[:, None] + np.asarray(s)[:, None] * along, along

    @cached_property
    def cell_sizes(self) -> FloatArray:
        """The longest edge of each triangle [m], (m,)."""
        corners = self.points[self.triangles]
        return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1))

    @cached_property
    def corners(self) -> tuple[Corner, ...]:
        """The points where the rim turns by more than 15 degrees or the boundary's name changes."""
        names = [name for name, pairs in self.boundaries.items() for _ in pairs]
        before, after = np.concatenate(list(self.boundaries.values())).T[::-1]  # points that edges run to and from
        tangents = np.concatenate([self.arcs(name, np.array([0.0, 1.0]))[1] for name in self.boundaries])
        direction = np.arctan2(tangents[..., 1], tangents[..., 0])
        order = np.argsort(before, kind="stable")
        first, count = np.searchsorted(before[order], after), np.bincount(before, minlength=len(self.points))[after]
        corners = []
        for leaving in np.argsort(after, kind="stable"):
            arriving = order[first[leaving] : first[leaving] + count[leaving]]
            # Where cells touch only in a point, the edge that arrives next counter-clockwise bounds the same cells.
            angles = (direction[arriving, 1] + np.pi - direction[leaving, 0]) % (2 * np.pi)
            k = int(np.argmin(angles))
            sides = (names[arriving[k]], names[leaving])
            if abs(angles[k] - np.pi) > CORNER or sides[0] != sides[1]:
                corners.append(Corner(int(after[leaving]), float(angles[k]), sides))
        return tuple(corners)

    def part(self, keep: NDArray[np.bool_]) -> PlateMesh:
        """The mesh of the triangles to keep (m,); new boundary edges are straight and named "cut".

        The outline stays that of the whole plate.
        """
        triangles = self.triangles[keep]
        sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        number = edge_numbers(sides, len(self.points))
        _, where, count = np.unique(number, return_index=True, return_counts=True)
        rim = np.sort(where[count == 1])
        kept = {name: np.isin(edge_numbers(p, len(self.points)), number[rim]) for name, p in self.boundaries.items()}
        boundaries = {name: self.boundaries[name][there] for name, there in kept.items() if there.any()}
        known = [edge_numbers(pairs, len(self.points)) for pairs in boundaries.values()]
        cut = sides[rim[~np.isin(number[rim], np.concatenate([np.empty(0, np.int64), *known]))]]
        if len(cut):
            boundaries[CUT] = np.concatenate([boundaries.get(CUT, np.empty((0, 2), dtype=np.int64)), cut])
        used, rows = np.unique(triangles, return_inverse=True)
        return PlateMesh(
            self.points[used],
            rows.reshape(-1, 3),
            {name: np.searchsorted(used, pairs) for name, pairs in boundaries.items()},
            {name: curve for name, curve in self.curves.items() if name in boundaries},
            self.outline,
        )

    def refined(self, marked: NDArray[np.bool_] | None = None) -> PlateMesh:
        """The mesh with marked triangles cut in four, and their neighbours cut to fit.

        Triangles cut in four keep their angles; their neighbours are cut along their longest edge. New boundary
        points lie on the true curve.

        Parameters
        ----------
        marked : array (m,) of bool, optional
            The triangles to cut; by default all.

        Returns
        -------
        mesh : PlateMesh
            The refined mesh.
        """
        points, triangles, boundaries = refine(self.points, self.triangles, self.boundaries, self.curves, marked)
        return PlateMesh(points, triangles, boundaries, self.curves, self.outline)


def _turned(triangles: IntArray, boundaries: Mapping[str, IntArray], points: int) -> dict[str, IntArray]:
    """Boundaries whose edges run as the sides of the counter-clockwise triangles do."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]) @ [points, 1]
    return {
        name: np.where(np.isin(pairs @ [points, 1], sides)[:, None], pairs, pairs[:, ::-1])
        for name, pairs in boundaries.items()
    }


def _outline(points: FloatArray, boundaries: Mapping[str, IntArray], curves: Mapping[str, Curve]) -> Outline:
    edges = [np.empty((0, 3, 2))]
    swept: dict[tuple[float, ...], float] = {}

    def sweep(conic: tuple[float, ...], pairs: IntArray) -> None:
        centre, axes = np.array(conic).reshape(2, 2)
        angle = np.arctan2(*np.moveaxis((points[pairs] - centre) / axes, 2, 0)[::-1])
        turn = (np.diff(angle, axis=1) + np.pi) % (2 * np.pi) - np.pi
        swept[conic] = swept.get(conic, 0.0) + abs(float(turn.sum()))

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
