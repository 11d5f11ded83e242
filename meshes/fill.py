"""Triangles inside a closed walk of boundary points, by Delaunay refinement."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.outline import Outline
from meshes.triangles import angles, areas, cross, edge_numbers, sides
from meshes.types import BoolArray, FloatArray, IntArray

MIN_ANGLE = np.deg2rad(27)  # cells with a smaller angle get a new point, where the corners of the rim allow it
MAX_CELLS = 1_000_000
ROUNDS = 200  # most refinements end within 30
SMOOTHINGS = 10


@dataclass
class RimEdges:
    """The boundary while it is cut: edges (k, 2), rows of points with the plate on their left, on sides (k,).

    project: moves points (n, 2) between the ends of edges on sides (n,) onto the true rim.
    min_length: the length (n,) [m] below which edges from points (n, 2) to points (n, 2) on sides (n,) are not cut.
    """

    edges: IntArray
    sides: IntArray
    project: Callable[[FloatArray, IntArray], FloatArray]
    min_length: Callable[[FloatArray, FloatArray, IntArray], FloatArray]

    def cut(self, points: FloatArray, which: BoolArray) -> FloatArray:
        """The points with the middles of edges `which` (k,) added."""
        edges, sides = self.edges[which], self.sides[which]
        middle = len(points) + np.arange(len(edges))
        halves = np.concatenate([np.stack([edges[:, 0], middle], 1), np.stack([middle, edges[:, 1]], 1)])
        self.edges = np.concatenate([self.edges[~which], halves])
        self.sides = np.concatenate([self.sides[~which], sides, sides])
        return np.concatenate([points, self.project(points[edges].mean(axis=1), sides)])


def check_count(shape: str, cells: float, cell_size: float) -> None:
    """Raise ValueError where an outline has too many cells, before there is room for them."""
    if not cells <= MAX_CELLS:
        few = f"so large that there are at most {MAX_CELLS} cells"
        raise ValueError(f"Input cell_size of {shape} must be {few}; got {cell_size!r} m, which makes {cells:.3g}")


def fill(points: FloatArray, rim: RimEdges, outline: Outline, cell_size: float) -> tuple[FloatArray, IntArray]:
    """Points (n, 2), rim points first, and triangles (m, 3) of about `cell_size` [m]; cuts the rim's edges.

    A hexagonal lattice, kept off the rim, is completed by J. Ruppert's refinement (J. Algorithms 18, 1995): rim edges
    that are no edges of the Delaunay triangulation, or see a point at an obtuse angle, are cut; thin and large cells
    get a new point at their circumcentre, unless that is so near a rim edge that the edge is cut instead.
    """
    check_count("a plate", 4 * float(((outline.box[1] - outline.box[0]) / cell_size + 1).prod()), cell_size)
    points = np.concatenate([points, _lattice(outline, cell_size)])
    for _ in range(ROUNDS):
        triangles = delaunay(points, outline)
        ends = points[rim.edges]
        missing = ~np.isin(edge_numbers(rim.edges, len(points)), edge_numbers(sides(triangles), len(points)))
        long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > rim.min_length(ends[:, 0], ends[:, 1], rim.sides)
        cut = missing | (long & ~missing & _obtuse(points, triangles, rim.edges))
        if not cut.any():
            centres, radii = _poor_cells(points, triangles, rim, cell_size)
            at_rim = np.zeros(len(centres), dtype=bool)
            middle, half = ends.mean(axis=1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
            for k, centre in enumerate(centres):
                encroached = np.hypot(*(middle - centre).T) < half * (1 - 1e-9)
                cut |= encroached & long
                at_rim[k] = encroached.any()
            centres = _apart(centres[~at_rim], radii[~at_rim])
            centres = centres[outline.inside(centres)]
            if not (len(centres) or cut.any()):
                break
            points = np.concatenate([points, centres])
        points = rim.cut(points, cut)
        check_count("a plate", 2.0 * len(points), cell_size)
    else:
        raise ValueError(
            f"Input cell_size of a plate must be small enough for cells to fit the outline; got {cell_size!r} m"
        )
    used, rows = np.unique(triangles, return_inverse=True)
    rim.edges = np.searchsorted(used, rim.edges)
    return _smoothed(points[used], rows.reshape(-1, 3), rim), rows.reshape(-1, 3)


def _lattice(outline: Outline, cell_size: float) -> FloatArray:
    low, high = outline.box
    centre, rows = (low + high) / 2, np.ceil((high - low) / cell_size).astype(int)
    i, j = np.meshgrid(np.arange(-rows[0], rows[0] + 1), np.arange(-rows[1], rows[1] + 1), indexing="ij")
    xy = np.stack([i + j % 2 / 2, j * np.sqrt(3) / 2], axis=-1).reshape(-1, 2) * cell_size + centre
    xy = xy[((xy > low) & (xy < high)).all(axis=1)]
    return np.asarray(xy[outline.gap(xy) > 0.65 * cell_size])


def delaunay(points: FloatArray, outline: Outline) -> IntArray:
    """The counter-clockwise Delaunay triangles (m, 3) inside the outline."""
    from scipy.spatial import Delaunay, QhullError  # here, because standard outlines do without it

    try:
        triangles = Delaunay(points).simplices.astype(np.int64)
    except (QhullError, ValueError):
        raise ValueError("Input corners of a plate must be far enough apart for cells between them") from None
    area = areas(points, triangles)
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    # Rounding leaves flat triangles between points on one straight side.
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    flat = 2 * np.abs(area) < 1e-9 * np.max([_square(b - a), _square(c - b), _square(a - c)], axis=0)
    triangles = triangles[~flat]
    return np.asarray(triangles[outline.inside(points[triangles].mean(axis=1))])


def _poor_cells(
    points: FloatArray, triangles: IntArray, rim: RimEdges, cell_size: float
) -> tuple[FloatArray, FloatArray]:
    """Circumcentres (n, 2) and circumradii (n,) of triangles that are thin or large, the thinnest first."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    b, c = b - a, c - a
    centre = (_square(b)[:, None] * _turned(c) - _square(c)[:, None] * _turned(b)) / (-2 * cross(b, c))[:, None]
    radius = np.hypot(*centre.T)
    angle = angles(points, triangles)
    thinnest = np.argmin(angle, axis=1)
    # The edge opposite to the smallest angle: where it runs across a sharp corner, no point would help.
    ends = np.stack([np.take_along_axis(triangles, (thinnest[:, None] + k) % 3, axis=1)[:, 0] for k in (1, 2)], axis=1)
    side = np.full(len(points), -1)
    side[rim.edges[:, 0]] = rim.sides
    side[rim.edges[:, 1]] = np.where(side[rim.edges[:, 1]] == rim.sides, rim.sides, -2)  # a corner has two sides
    across = (side[ends] >= 0).all(axis=1) & (side[ends[:, 0]] != side[ends[:, 1]])
    at_corner = side[np.take_along_axis(triangles, thinnest[:, None], axis=1)[:, 0]] == -2
    smallest = angle.min(axis=1)
    poor = ((smallest < MIN_ANGLE) & ~(across & at_corner)) | (radius > 0.9 * cell_size)
    order = np.flatnonzero(poor)[np.argsort(smallest[poor], kind="stable")]
    return (a + centre)[order], radius[order]


def _apart(centres: FloatArray, radii: FloatArray) -> FloatArray:
    """Centres (n, 2), without those that lie in the circle of an earlier one."""
    from scipy.spatial import cKDTree

    if not len(centres):
        return centres
    kept = np.ones(len(centres), dtype=bool)
    for k, within in enumerate(cKDTree(centres).query_ball_point(centres, radii)):
        if kept[k]:
            kept[[other for other in within if other > k]] = False
    return centres[kept]


def _obtuse(points: FloatArray, triangles: IntArray, edges: IntArray) -> BoolArray:
    """Whether the triangle on edges (k, 2) sees them at an obtuse angle."""
    pairs = sides(triangles)
    code = pairs[:, 0] * len(points) + pairs[:, 1]
    order = np.argsort(code)
    place = np.searchsorted(code[order], edges[:, 0] * len(points) + edges[:, 1]).clip(max=len(code) - 1)
    apex = points[np.roll(triangles, -2, axis=1).reshape(-1)[order[place]]]
    a, b = points[edges[:, 0]] - apex, points[edges[:, 1]] - apex
    return np.asarray((a * b).sum(axis=1) < -1e-9 * _square(a - b))


def _smoothed(points: FloatArray, triangles: IntArray, rim: RimEdges) -> FloatArray:
    """The points with inner ones moved to the mean of their neighbours, where no angle around them gets smaller."""
    points, pairs = points.copy(), sides(triangles)
    count = np.bincount(pairs[:, 0], minlength=len(points))
    inner = np.setdiff1d(np.arange(len(points)), rim.edges)
    for _ in range(SMOOTHINGS):
        mean = np.stack([np.bincount(pairs[:, 0], points[pairs[:, 1], k], len(points)) for k in (0, 1)], axis=1)
        before, moved = _star_angle(points, triangles), points.copy()
        moved[inner] = mean[inner] / count[inner, None]
        while (worse := _star_angle(moved, triangles) < before - 1e-12).any():
            moving = worse & (moved != points).any(axis=1)
            around = np.unique(triangles[worse[triangles].any(axis=1)])
            moved[moving if moving.any() else around] = points[moving if moving.any() else around]
        points = moved
    return points


def _star_angle(points: FloatArray, triangles: IntArray) -> FloatArray:
    """The smallest angle of the triangles around each point, (n,); clockwise ones count as negative."""
    smallest = np.full(len(points), np.inf)
    np.minimum.at(smallest, triangles.ravel(), np.repeat(angles(points, triangles).min(axis=1), 3))
    return smallest


def _square(a: FloatArray) -> FloatArray:
    return np.asarray((a**2).sum(axis=-1))


def _turned(a: FloatArray) -> FloatArray:
    return np.stack([-a[..., 1], a[..., 0]], axis=-1)
