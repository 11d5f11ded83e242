"""Triangles inside a closed walk of boundary points, by Delaunay refinement."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from meshes.nearest import FloatArray, IntArray
from meshes.outline import BoolArray, Outline
from meshes.refine import edge_numbers

LEAST_ANGLE = np.deg2rad(27)  # cells with a smaller angle get a new point, where the corners of the rim allow it
ROUNDS = 200  # most refinements end within 30
SMOOTHINGS = 10


@dataclass
class Rim:
    """The boundary while it is cut: points (n, 2) m, its edges (k, 2) with the plate on their left, sides (k,).

    foot: moves points (n, 2) between the ends of edges on sides (n,) to the true rim.
    least: the length [m] below which an edge between points (n, 2), (n, 2) on sides (n,) is not cut any more.
    """

    edges: IntArray
    sides: IntArray
    foot: Callable[[FloatArray, IntArray], FloatArray]
    least: Callable[[FloatArray, FloatArray, IntArray], FloatArray]

    def cut(self, points: FloatArray, which: BoolArray) -> FloatArray:
        """The points with the middles of edges `which` (k,) added."""
        edges, sides = self.edges[which], self.sides[which]
        middle = len(points) + np.arange(len(edges))
        halves = np.concatenate([np.stack([edges[:, 0], middle], 1), np.stack([middle, edges[:, 1]], 1)])
        self.edges = np.concatenate([self.edges[~which], halves])
        self.sides = np.concatenate([self.sides[~which], sides, sides])
        return np.concatenate([points, self.foot(points[edges].mean(axis=1), sides)])


def fill(points: FloatArray, rim: Rim, outline: Outline, cell_size: float) -> tuple[FloatArray, IntArray]:
    """Points (n, 2), rim points first, and triangles (m, 3) of cells about `cell_size` [m] large; cuts the rim's edges.

    A hexagonal lattice, kept off the rim, is completed by J. Ruppert's refinement (J. Algorithms 18, 1995): rim edges
    that are no edges of the Delaunay triangulation, or see a point at an obtuse angle, are cut, and cells that are
    thin or large get their circumcentre as a new point, unless it is so near a rim edge that this is cut instead.
    """
    points = np.concatenate([points, _lattice(outline, cell_size)])
    for _ in range(ROUNDS):
        triangles = delaunay(points, outline)
        ends = points[rim.edges]
        missing = ~np.isin(edge_numbers(rim.edges, len(points)), edge_numbers(sides(triangles), len(points)))
        long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > rim.least(ends[:, 0], ends[:, 1], rim.sides)
        cut = missing | (long & ~missing & _obtuse(points, triangles, rim.edges))
        if not cut.any():
            centres, radii = _wanted(points, triangles, rim, cell_size)
            near = np.zeros(len(centres), dtype=bool)
            middle, half = ends.mean(axis=1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / 2
            for k, centre in enumerate(centres):
                seen = np.hypot(*(middle - centre).T) < half * (1 - 1e-9)
                cut |= seen & long
                near[k] = seen.any()
            centres = _apart(centres[~near], radii[~near])
            centres = centres[outline.inside(centres)]
            if not (len(centres) or cut.any()):
                break
            points = np.concatenate([points, centres])
        points = rim.cut(points, cut)
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
    triangles = Delaunay(points).simplices.astype(np.int64)
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    area = _cross(b - a, c - a)
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    # Rounding leaves flat triangles between points on one straight side.
    flat = np.abs(area) < 1e-9 * np.max([_square(b - a), _square(c - b), _square(a - c)], axis=0)
    triangles = triangles[~flat]
    return np.asarray(triangles[outline.inside(points[triangles].mean(axis=1))])


def _wanted(points: FloatArray, triangles: IntArray, rim: Rim, cell_size: float) -> tuple[FloatArray, FloatArray]:
    """Circumcentres (n, 2) and circumradii (n,) of triangles that are thin or large, the worst first."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    b, c = b - a, c - a
    centre = (_square(b)[:, None] * _turned(c) - _square(c)[:, None] * _turned(b)) / (-2 * _cross(b, c))[:, None]
    radius = np.hypot(*centre.T)
    angle = angles(points, triangles)
    smallest = np.argmin(angle, axis=1)
    # The edge opposite to the smallest angle: where it runs across a sharp corner, no point would help.
    ends = np.stack([np.take_along_axis(triangles, (smallest[:, None] + k) % 3, axis=1)[:, 0] for k in (1, 2)], axis=1)
    side = np.full(len(points), -1)
    side[rim.edges[:, 0]] = rim.sides
    side[rim.edges[:, 1]] = np.where(side[rim.edges[:, 1]] == rim.sides, rim.sides, -2)  # a corner has two sides
    across = (side[ends] >= 0).all(axis=1) & (side[ends[:, 0]] != side[ends[:, 1]])
    at_corner = side[np.take_along_axis(triangles, smallest[:, None], axis=1)[:, 0]] == -2
    least = angle.min(axis=1)
    wanted = ((least < LEAST_ANGLE) & ~(across & at_corner)) | (radius > 0.9 * cell_size)
    order = np.flatnonzero(wanted)[np.argsort(least[wanted], kind="stable")]
    return (a + centre)[order], radius[order]


def _apart(centres: FloatArray, radii: FloatArray) -> FloatArray:
    """Centres (n, 2), without those that lie in the circle of an earlier one."""
    if not len(centres):
        return centres
    tree, left = cKDTree(centres), np.ones(len(centres), dtype=bool)
    for k, near in enumerate(tree.query_ball_point(centres, radii)):
        if left[k]:
            left[[other for other in near if other > k]] = False
    return centres[left]


def _obtuse(points: FloatArray, triangles: IntArray, edges: IntArray) -> BoolArray:
    """Whether the triangle on edges (k, 2) sees them at an obtuse angle."""
    pairs = sides(triangles)
    code = pairs[:, 0] * len(points) + pairs[:, 1]
    order = np.argsort(code)
    place = np.searchsorted(code[order], edges[:, 0] * len(points) + edges[:, 1]).clip(max=len(code) - 1)
    apex = points[np.roll(triangles, -2, axis=1).reshape(-1)[order[place]]]
    a, b = points[edges[:, 0]] - apex, points[edges[:, 1]] - apex
    return np.asarray((a * b).sum(axis=1) < -1e-9 * _square(a - b))


def _smoothed(points: FloatArray, triangles: IntArray, rim: Rim) -> FloatArray:
    """The points with inner ones moved to the middle of their neighbours, where no angle around them gets worse."""
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
    least = np.full(len(points), np.inf)
    np.minimum.at(least, triangles.ravel(), np.repeat(angles(points, triangles).min(axis=1), 3))
    return least


def angles(points: FloatArray, triangles: IntArray) -> FloatArray:
    """The angles (m, 3) [rad] of triangles at their corners."""
    corners = points[triangles]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    return np.asarray(np.arctan2(_cross(to_next, to_last), (to_next * to_last).sum(axis=-1)))


def sides(triangles: IntArray) -> IntArray:
    """The sides (3 m, 2) of triangles (m, 3), those of each in its own sense."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _square(a: FloatArray) -> FloatArray:
    return np.asarray((a**2).sum(axis=-1))


def _turned(a: FloatArray) -> FloatArray:
    return np.stack([-a[..., 1], a[..., 0]], axis=-1)
