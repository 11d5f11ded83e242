"""The membrane by in-plane motion u: plane stress, force = A : (sym grad u + 1/2 grad w grad w).

scikit-fem's triangles of degree four for each component of u, on cells whose sides along the rim are parabolas through
the true rim's middles. It serves plates with holes too, and those of which only part of the rim is held in the plane.
It bounds the membrane energy from above.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csc_matrix
from skfem import Basis, BilinearForm, ElementTriP4, ElementVector, MeshTri1, MeshTri2
from skfem.helpers import ddot, sym_grad

from fem_plate.elements import PlateSpace
from fem_plate.large_deflection.factor import factorised
from fem_plate.large_deflection.membrane import Membrane
from fem_plate.large_deflection.samples import Samples
from meshes import PlateMesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

DEGREE = 14  # of the quadrature


def plane_stress(
    mesh: PlateMesh, space: PlateSpace, movable: Mapping[str, bool], poisson_ratio: float
) -> tuple[Membrane, Basis]:
    """The membrane of a plate with rims that are free to move in the plane or not, and the basis of its motion.

    space: of the plate's deflection, on the same cells.
    """
    basis = Basis(curved(mesh), ElementVector(ElementTriP4()), intorder=DEGREE)
    law = 12 * np.array([[1, 0, poisson_ratio], [0, (1 - poisson_ratio) / 2, 0], [poisson_ratio, 0, 1]])
    free = np.setdiff1d(np.arange(basis.N), _held(mesh, basis, movable))
    whole = _stiffness(poisson_ratio).assemble(basis)
    stiffness = whole[free][:, free].tocsc()
    strain = [np.stack([g[0, 0], g[0, 1] + g[1, 0], g[1, 1]]) for g in (f[0].grad for f in basis.basis)]
    operator = np.einsum("ab,fbkn->kanf", law, np.stack(strain), optimize=True)
    points = np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1)
    every = np.arange(len(points))
    flat = operator.reshape(len(points), -1, operator.shape[-1])
    samples = Samples.at(space, every, points, np.asarray(basis.dx), np.ascontiguousarray(flat))

    def expand(u: FloatArray) -> FloatArray:
        everything = np.zeros((basis.N, *u.shape[1:]))
        everything[free] = u
        return everything

    membrane = Membrane(
        samples=(samples,),
        dofs=np.ascontiguousarray(basis.element_dofs.T).astype(np.int64),
        stiffness=stiffness,
        solve=factorised(stiffness),
        sign=1.0,
        law=law,
        expand=expand,
        reduce=lambda rows: rows[free],
    )
    return membrane, basis


def curved(mesh: PlateMesh) -> MeshTri2:
    """The mesh for scikit-fem, lengths by the plate's size, with the middles of its rim's sides on the true rim."""
    bent = MeshTri2.from_mesh(MeshTri1(mesh.points.T / mesh.size, mesh.triangles.T, sort_t=False))
    places = bent.doflocs.copy()
    for name, pairs in mesh.boundaries.items():
        middles = mesh.arcs(name, np.array([0.5]))[0][:, 0] / mesh.size
        places[:, bent.dofs.facet_dofs[0, facets_of(bent, pairs)]] = middles.T
    return replace(bent, doflocs=places)


def facets_of(mesh: MeshTri1, pairs: IntArray) -> IntArray:
    """The facets between pairs of points (k, 2)."""
    count = mesh.p.shape[1]
    number = mesh.facets.min(axis=0).astype(np.int64) * count + mesh.facets.max(axis=0)
    order = np.argsort(number)
    wanted = pairs.min(axis=1).astype(np.int64) * count + pairs.max(axis=1)
    return np.asarray(order[np.searchsorted(number[order], wanted)])


def _held(mesh: PlateMesh, basis: Basis, movable: Mapping[str, bool]) -> IntArray:
    """The unknowns that rims hold, or three that keep a plate in place that no rim holds."""
    pairs = [mesh.boundaries[name] for name, moves in movable.items() if not moves]
    if pairs:
        return np.asarray(basis.get_dofs(facets_of(basis.mesh, np.concatenate(pairs))).flatten())
    x = basis.mesh.p[:, : len(mesh.points)]
    first = int(np.argmin(x[0]))
    second = int(np.argmax(np.abs(x[0] - x[0, first])))
    return np.array([*basis.nodal_dofs[:, first], basis.nodal_dofs[1, second]])


def _stiffness(poisson_ratio: float) -> BilinearForm:
    """int (A : sym grad u) : sym grad q."""

    def form(u, q, _):  # type: ignore[no-untyped-def]
        e, d = sym_grad(u), sym_grad(q)
        return 12 * ((1 - poisson_ratio) * ddot(e, d) + poisson_ratio * (e[0, 0] + e[1, 1]) * (d[0, 0] + d[1, 1]))

    return BilinearForm(form)
