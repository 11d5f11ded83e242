"""The plate as drawn: a mesh fine enough for pictures and animations, with the actuators among its points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshes import PlateMesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

CELLS = 3000  # at least
ON_EDGE = 1e-9  # of a cell's area: smaller pieces are none
LEAST_AREA = 0.2  # of the smallest cell around a point, below which a cell must not shrink when the point is moved


def drawn_plate(mesh: PlateMesh, actuators: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points (n, 2) [m], the actuators (N, 2) [m] first, and triangles (m, 3) for drawing the plate of a mesh.

    A nearby point inside the plate is moved to each actuator; where none can be, the cell around it is cut in three.
    """
    while len(mesh.triangles) < CELLS:
        mesh = mesh.refined()
    points, triangles = mesh.points.copy(), mesh.triangles.copy()
    fixed = np.zeros(len(points) + len(actuators), dtype=bool)
    fixed[np.concatenate(list(mesh.boundaries.values())).ravel()] = True
    rows = []
    for place in actuators:
        shares = _coordinates(points, triangles, place)
        cell = int(np.argmax(shares.min(axis=1)))
        corners = triangles[cell]
        row = int(corners[np.argmin(np.linalg.norm(points[corners] - place, axis=1))])
        moved = points.copy()
        moved[row] = place
        around = triangles[(triangles == row).any(axis=1)]
        if not fixed[row] and _areas(moved, around).min() > LEAST_AREA * _areas(points, around).min():
            points = moved
        else:
            row = len(points)
            points = np.concatenate([points, place[None]])
            cells = triangles[shares.min(axis=1) > -ON_EDGE]  # two where the place is on an edge
            sides = np.stack([cells, np.roll(cells, -1, axis=1), np.full(cells.shape, row)], axis=2)
            pieces = sides[np.roll(shares, -2, axis=1)[shares.min(axis=1) > -ON_EDGE] > ON_EDGE]
            triangles = np.concatenate([triangles[shares.min(axis=1) <= -ON_EDGE], pieces])
        fixed[row] = True
        rows.append(row)
    order = np.concatenate([rows, np.setdiff1d(np.arange(len(points)), rows)]).astype(np.int64)
    return points[order], np.argsort(order)[triangles]


def _areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Twice the areas (m,) [m^2] of triangles, negative clockwise."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return _cross(b - a, c - a)


def _coordinates(points: FloatArray, triangles: IntArray, place: FloatArray) -> FloatArray:
    """The place's barycentric coordinates (m, 3) in triangles: none is negative in the one that holds it."""
    a, b, c = np.moveaxis(points[triangles] - place, 1, 0)
    return np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1) / _cross(b - a, c - a)[:, None]


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
