"""Display mesh: a triangle mesh of the plate fine enough for pictures, with the actuators among its points."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem_plate.arrays import spacing
from meshes import PlateMesh, delaunay, edge_numbers, sides

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

CELLS = 3000  # about, of a plate with few actuators
PER_PITCH = 3  # cells from one actuator to the next, where that is not too many
PER_ACTUATOR = 10  # points
MAX_POINTS = 100_000  # larger arrays, or those that fill only part of the plate, get fewer cells per pitch
CLEARANCE = 0.6  # of a cell: no grid point lies closer to an actuator or to a point of the rim
MAX_ROUNDS = 60  # an actuator almost on the rim takes about 30


def display_mesh(mesh: PlateMesh, actuators: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points (n, 2) [m], the actuators (N, 2) [m] first, and triangles (m, 3) that cover the plate of a mesh.

    The other points are those of a grid aligned with the actuators, and points of the rim. The triangulation is
    Delaunay's.
    """
    cell = _cell(mesh, actuators)
    low, high = mesh.outline.box
    origin = actuators[0] if len(actuators) else low
    steps = [np.arange(np.ceil((low[k] - origin[k]) / cell[k]), (high[k] - origin[k]) / cell[k]) for k in (0, 1)]
    grid = origin + np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2) * cell
    grid = grid[cKDTree(actuators / cell).query(grid / cell)[0] > CLEARANCE]
    grid = grid[mesh.outline.inside(grid)]
    rim, edges = mesh.points, np.concatenate(list(mesh.boundaries.values()))
    used, rows = np.unique(edges, return_inverse=True)
    rim, edges = rim[used], rows.reshape(-1, 2)
    tree, longest = cKDTree(actuators), float(cell.max())
    points, triangles = rim, np.empty((0, 3), dtype=np.int64)
    for _ in range(MAX_ROUNDS):
        ends = rim[edges]
        length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
        # Halve an edge while it is long, sees an actuator at an obtuse angle, or is no edge of the triangulation.
        cut = (length > 1.5 * longest) | (tree.query(ends.mean(axis=1))[0] < length / 2)
        if not cut.any():
            kept = grid[cKDTree(rim).query(grid)[0] > CLEARANCE * longest]
            points = np.concatenate([actuators, kept, rim])
            triangles = delaunay(points, mesh.outline)
            number = edge_numbers(edges + len(actuators) + len(kept), len(points))
            cut = ~np.isin(number, edge_numbers(sides(triangles), len(points)))
            if not cut.any():
                break
        middle = len(rim) + np.arange(int(cut.sum()))
        rim = np.concatenate([rim, mesh.outline.project(ends[cut].mean(axis=1))])
        halves = [np.stack([edges[cut, 0], middle], axis=1), np.stack([middle, edges[cut, 1]], axis=1)]
        edges = np.concatenate([edges[~cut], *halves])
    used = np.union1d(np.arange(len(actuators)), triangles)
    return points[used], np.searchsorted(used, triangles)


def display_points(mesh: PlateMesh, actuators: FloatArray) -> int:
    """How many points `display_mesh` has, about."""
    cell = _cell(mesh, actuators)
    ends = mesh.points[np.concatenate(list(mesh.boundaries.values()))]
    rim = float(np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum())
    return int(_area(mesh) / cell.prod() + rim / cell.max())


def _area(mesh: PlateMesh) -> float:
    a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
    return float(np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum() / 2)


def _cell(mesh: PlateMesh, actuators: FloatArray) -> FloatArray:
    """The width and height (2,) [m] of the grid's cells: fractions of the pitch, unless the array is a small spot."""
    area = _area(mesh)
    coarse = math.sqrt(2 * area / CELLS)
    if len(actuators) <= 1:
        return np.full(2, coarse)
    pitch = spacing(actuators)
    max_points = min(max(CELLS / 2, PER_ACTUATOR * len(actuators)), MAX_POINTS)
    parts = np.maximum(np.ceil(pitch / coarse * (1 - 1e-9)), PER_PITCH if len(actuators) > CELLS / 100 else 1)
    while area / float((pitch / parts).prod()) > 2 * max_points:
        if parts.max() == 1:
            return np.full(2, math.sqrt(area / max_points))
        parts = np.maximum(parts - 1, 1)
    return np.asarray(pitch / parts)
