"""Unknowns near corners, counted from the corner's own height and slope.

Cells at a corner are so small that their matrices, of the order of their size to the power -2, leave rounding where a
rigid motion of the cell must cancel. Unknowns that count from the corner's plane do not contain that motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix, diags, identity

from fem_plate.elements.argyris import Triangles
from fem_plate.types import BoolArray, FloatArray, IntArray

REACH = 0.2  # of the plate's size: how far from a corner unknowns count from it,
NEXT = 0.45  # or of the distance to the next corner, if that is less


class Relative(NamedTuple):
    """Unknowns counted from the planes of nearby corners."""

    inside: BoolArray  # (m,), the triangles all of whose unknowns count from one corner
    absolute: csr_matrix  # (n, n), gives the mesh's unknowns from relative ones
    bent: csr_matrix  # (n, n), the same without the planes
    planes: IntArray  # the unknowns of the mesh that count from a plane


def relative(triangles: Triangles, points: IntArray, edges: IntArray, corners: Sequence[int], count: int) -> Relative:
    """The relative unknowns around corners.

    points: (m, 3), rows of each triangle's corners.  edges: (m, 3), the unknowns of their edges.
    corners: rows of points.  count: number of unknowns; point i has 6 i and the five after it.
    """
    at = np.zeros((points.max() + 1, 2))
    at[points] = triangles.points
    places = at[list(corners)]
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + np.where(np.eye(len(places)), np.inf, 0.0)
    inside = np.zeros(len(points), dtype=bool)
    rows, columns, data, planes = [], [], [], []

    def add(row: IntArray, column: int, value: FloatArray | float) -> None:
        rows.append(row)
        columns.append(np.full(len(row), column))
        data.append(np.broadcast_to(value, len(row)))

    for corner, place, nearest in zip(corners, places, apart.min(axis=1, initial=np.inf), strict=True):
        reach = min(REACH, NEXT * nearest)
        around = (np.linalg.norm(triangles.points - place, axis=2) < reach).all(axis=1)
        inside |= around
        of_point = np.setdiff1d(points[around], [corner])
        first = np.flatnonzero(around[:, None].repeat(3, 1))
        of_edge, which = np.unique(edges[around].reshape(-1), return_index=True)
        normal = triangles.normals.reshape(-1, 2)[first[which]]
        dx, dy = (at[of_point] - place).T
        add(6 * of_point, 6 * corner, 1.0)
        for k, along in enumerate((dx, dy)):
            slope = 6 * corner + 1 + k
            add(6 * of_point, slope, along)
            add(6 * of_point + 1 + k, slope, 1.0)
            add(of_edge, slope, normal[:, k])
        planes.append(np.concatenate([6 * of_point, 6 * of_point + 1, 6 * of_point + 2, of_edge]))
    flat = [np.concatenate(parts) for parts in (data, rows, columns)]
    shift = coo_matrix((flat[0], (flat[1], flat[2])), shape=(count, count)).tocsr()
    own = np.ones(count)
    own[(6 * np.asarray(corners)[:, None] + np.arange(3)).ravel()] = 0.0
    return Relative(inside, identity(count, format="csr") + shift, diags(own, format="csr"), np.concatenate(planes))
