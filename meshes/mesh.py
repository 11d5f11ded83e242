"""PlateMesh: the triangles of a plate, its named boundaries and the curves that they stand for."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from meshes.curves import Curve
from meshes.outline import Outline, outline_of
from meshes.triangles import edge_numbers, refine, sides
from meshes.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from skfem import MeshTri1, MeshTri2

CORNER = np.deg2rad(15)  # a tangent that turns by more than this turns at a corner
SAME_PLACE = 1e-9  # of half the longer side: points closer than this coincide
LEAST_GAP = 6e-4  # of half the longer side
CUT = "cut"  # the boundary along which a part was cut out


@dataclass(frozen=True)
class Corner:
    """A boundary point where the rim turns sharply or the boundary's name changes.

    Attributes
    ----------
    row : int
        The point's row in the mesh.
    angle : float
        Between the true tangents, through the plate [rad].
    sides : tuple of str
        The boundaries before and after the corner, walking with the plate on the left.
    direction : float
        Of the rim after the corner, from the x axis, counter-clockwise [rad].
    """

    row: int
    angle: float
    sides: tuple[str, str]
    direction: float


@dataclass(frozen=True, eq=False)
class PlateMesh:
    """A conforming triangulation of a plate.

    Parameters
    ----------
    points : (n, 2) array
        [m].
    triangles : (m, 3) integer array
        Rows of points, counter-clockwise.
    boundaries : mapping of str to (k, 2) integer array
        Rows of points of the edges on each boundary, in either direction; kept with the plate on their left.
    curves : mapping of str to Circle, Ellipse or Parabolas, optional
        The true curve of a boundary; the edges of other boundaries are straight.
    outline : Outline, optional
        The plate's true rim; by default made from boundaries and curves.

    Raises
    ------
    ValueError
        A Circle or Ellipse is only part of a rim; arcs of it can be `Parabolas`.
    """

    points: FloatArray
    triangles: IntArray
    boundaries: Mapping[str, IntArray]
    curves: Mapping[str, Curve] = field(default_factory=dict)
    outline: Outline = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        object.__setattr__(self, "boundaries", _turned(self.triangles, self.boundaries, len(self.points)))
        if self.outline is None:
            object.__setattr__(self, "outline", outline_of(self.points, self.boundaries, self.curves))

    @cached_property
    def size(self) -> float:
        """Half of the longer side of the box around the plate [m]; it makes the equations dimensionless."""
        return float(np.max(np.ptp(self.points, axis=0)) / 2)

    @property
    def least_gap(self) -> float:
        """How far inside the rim an actuator must lie [m]: rounding spoils the cells that nearer ones need."""
        return LEAST_GAP * self.size

    def on_rim(self, xy: ArrayLike, names: Collection[str] | None = None) -> BoolArray:
        """Which points (n, 2) [m] lie on the rim, on some boundaries and off all others by `least_gap`: (n,)."""
        on = np.abs(self.outline.gap(xy)) <= SAME_PLACE * self.size
        ends = np.array([0.0, 0.5, 1.0])
        others = [self.arcs(name, ends)[0] for name in self.boundaries if names is not None and name not in names]
        if others and on.any():
            on &= np.abs(Outline(edges=np.concatenate(others)).gap(xy)) > self.least_gap
        return np.asarray(on)

    def spans(self, places: ArrayLike) -> bool:
        """Whether places (n, 2) [m] are three or more that are not in a line."""
        points = np.reshape(np.asarray(places, dtype=float), (-1, 2)) / self.size
        return len(points) >= 3 and bool(np.linalg.matrix_rank(np.insert(points, 0, 1.0, axis=1), tol=1e-6) == 3)

    def mirrored(self, xy: ArrayLike) -> FloatArray:
        """Points (n, 2) [m] reflected at every boundary of the outline, (r, 2) [m], all off the plate."""
        return self.outline.mirrored(xy)

    def arcs(self, name: str, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A boundary's edges along its true curve.

        Parameters
        ----------
        name : str
            The boundary, of k edges.
        s : (n,) array
            Parameters in [0, 1], from the start to the end of each edge.

        Returns
        -------
        points : (k, n, 2) array
            [m].
        tangents : (k, n, 2) array
            Derivatives with respect to s [m].
        """
        start, end = self.points[self.boundaries[name].T]
        if name in self.curves:
            return self.curves[name].arc(start, end, s)
        along = np.repeat((end - start)[:, None], len(s), axis=1)
        return start[:, None] + np.asarray(s)[:, None] * along, along

    @property
    def middles(self) -> dict[str, FloatArray]:
        """The middles of each boundary's edges on its true curve, (k, 2) [m]."""
        return {name: self.arcs(name, np.array([0.5]))[0][:, 0] for name in self.boundaries}

    def to_skfem(self) -> MeshTri1 | MeshTri2:
        """The mesh for scikit-fem, with its named boundaries; a `MeshTri2` where a rim is curved [m].

        The points keep their order. Cells of second order meet a curved rim at three points of each edge.
        """
        middles = self.middles if self.curves else None
        return skfem_mesh(self.points, self.triangles, self.boundaries, middles)

    @cached_property
    def cell_sizes(self) -> FloatArray:
        """The longest edge of each triangle [m], (m,)."""
        corners = self.points[self.triangles]
        return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1))

    @cached_property
    def corners(self) -> tuple[Corner, ...]:
        """The points where the rim turns by more than 15 degrees or the boundary's name changes."""
        return self.turns(CORNER)

    def turns(self, least: float) -> tuple[Corner, ...]:
        """The points where the rim turns by more than an angle [rad] or the boundary's name changes."""
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
            before_and_after = (names[arriving[k]], names[leaving])
            if abs(angles[k] - np.pi) > least or before_and_after[0] != before_and_after[1]:
                corners.append(
                    Corner(int(after[leaving]), float(angles[k]), before_and_after, float(direction[leaving, 0]))
                )
        return tuple(corners)

    def same_as(self, other: PlateMesh) -> bool:
        """Whether another mesh has the same cells, boundaries and curves."""
        names = self.boundaries.keys()
        return (
            np.array_equal(self.points, other.points)
            and np.array_equal(self.triangles, other.triangles)
            and names == other.boundaries.keys()
            and all(np.array_equal(self.boundaries[name], other.boundaries[name]) for name in names)
            and self.curves.keys() == other.curves.keys()
            and all(_same(curve, other.curves[name]) for name, curve in self.curves.items())
        )

    def part(self, keep: BoolArray) -> PlateMesh:
        """The mesh of the triangles to keep (m,); new boundary edges are straight and named "cut".

        The outline stays that of the whole plate.
        """
        triangles = self.triangles[keep]
        pairs = sides(triangles)
        number = edge_numbers(pairs, len(self.points))
        _, first, count = np.unique(number, return_index=True, return_counts=True)
        rim = np.sort(first[count == 1])
        kept = {name: np.isin(edge_numbers(p, len(self.points)), number[rim]) for name, p in self.boundaries.items()}
        boundaries = {name: self.boundaries[name][which] for name, which in kept.items() if which.any()}
        named = [edge_numbers(p, len(self.points)) for p in boundaries.values()]
        cut = pairs[rim[~np.isin(number[rim], np.concatenate([np.empty(0, np.int64), *named]))]]
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

    def refined(self, marked: BoolArray | None = None) -> PlateMesh:
        """The mesh with marked triangles cut in four and their neighbours cut to fit.

        Cells cut in four keep their angles; their neighbours are cut through their longest edge. New boundary points
        lie on the true curve.

        Parameters
        ----------
        marked : (m,) boolean array, optional
            By default all triangles.
        """
        points, triangles, boundaries = refine(self.points, self.triangles, self.boundaries, self.curves, marked)
        return PlateMesh(points, triangles, boundaries, self.curves, self.outline)


def _same(curve: Curve, other: Curve) -> bool:
    return type(curve) is type(other) and all(
        np.array_equal(getattr(curve, one.name), getattr(other, one.name)) for one in fields(curve)
    )


def _turned(triangles: IntArray, boundaries: Mapping[str, IntArray], points: int) -> dict[str, IntArray]:
    """Boundaries whose edges run as the sides of the counter-clockwise triangles do."""
    numbers = sides(triangles) @ [points, 1]
    return {
        name: np.where(np.isin(pairs @ [points, 1], numbers)[:, None], pairs, pairs[:, ::-1])
        for name, pairs in boundaries.items()
    }


def skfem_mesh(
    points: FloatArray,
    triangles: IntArray,
    boundaries: Mapping[str, IntArray],
    middles: Mapping[str, FloatArray] | None = None,
) -> MeshTri1 | MeshTri2:
    """The mesh with named boundaries, whose order of points is kept.

    points: (n, 2).  triangles: (m, 3).  boundaries: (k, 2) rows of points.
    middles: of a boundary's edges, (k, 2), on its true curve; None: cells of first order.
    """
    from skfem import MeshTri1, MeshTri2  # here, because it takes a while

    # Contiguous, or scikit-fem prints that it makes them so.
    mesh = MeshTri1(np.ascontiguousarray(points.T), np.ascontiguousarray(np.sort(triangles, axis=1).T))
    facets = {name: facets_of(mesh, pairs) for name, pairs in boundaries.items()}
    if middles is not None:
        mesh = MeshTri2.from_mesh(mesh)
        places = mesh.doflocs.copy()
        for name, xy in middles.items():
            places[:, mesh.dofs.facet_dofs[0, facets[name]]] = xy.T
        mesh = replace(mesh, doflocs=places)
    return mesh.with_boundaries(facets)


def facets_of(mesh: MeshTri1, pairs: IntArray) -> IntArray:
    """The facets between pairs of points (k, 2)."""
    count = mesh.p.shape[1]
    number = edge_numbers(mesh.facets.T.astype(np.int64), count)
    order = np.argsort(number)
    return np.asarray(order[np.searchsorted(number[order], edge_numbers(pairs, count))])
