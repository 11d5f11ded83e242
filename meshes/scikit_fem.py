"""A plate's mesh as scikit-fem has it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from meshes.nearest import FloatArray, IntArray
from meshes.triangles import edge_numbers

if TYPE_CHECKING:
    from skfem import MeshTri1, MeshTri2


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
