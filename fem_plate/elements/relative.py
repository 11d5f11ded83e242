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


def relative(triangles: Triangles, dofs: IntArray, corners: Sequence[int], places: FloatArray, count: int) -> Relative:
    """The relative unknowns around corners.

    dofs: (m, n), the unknowns of each triangle.  corners: rows of points, of which i has the unknowns 6 i and the five
    after it.  places: (c, 2), of these.  count: number of unknowns.
    """
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + np.where(np.eye(len(places)), np.inf, 0.0)
    inside = np.zeros(len(dofs), dtype=bool)
    rows, columns, data, planes = [], [], [], []
    for corner, place, nearest in zip(corners, places, apart.min(axis=1, initial=np.inf), strict=True):
        reach = min(REACH, NEXT * nearest)
        around = (np.linalg.norm(triangles.points - place, axis=2) < reach).all(axis=1)
        inside |= around
        own, first = np.unique(dofs[around], return_index=True)
        plane = triangles.linear[around].reshape(-1, 3)[first]  # of 1, x and y,
        plane[:, 1:] -= plane[:, :1] * place  # counted from the corner
        counts = plane.any(axis=1) & (own // 6 != corner)
        planes.append(own[counts])
        rows.append(own[counts].repeat(3))
        columns.append(np.tile(6 * corner + np.arange(3), counts.sum()))
        data.append(plane[counts].ravel())
    flat = [np.concatenate(parts) for parts in (data, rows, columns)]
    shift = coo_matrix((flat[0], (flat[1], flat[2])), shape=(count, count)).tocsr()
    own = np.ones(count)
    own[(6 * np.asarray(corners)[:, None] + np.arange(3)).ravel()] = 0.0
    return Relative(inside, identity(count, format="csr") + shift, diags(own, format="csr"), np.concatenate(planes))
