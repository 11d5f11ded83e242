"""The problem by scikit-fem's own elements: point loads on the polygon, after its example of a Kirchhoff plate.

It is given what helps it: actuators at mesh vertices (off them the Hessian is worse), the quadrature that is just
exact, no table of dof locations, and the factorisation that this project uses. Argyris leaves the second derivatives
free at the rim; held at zero, as `get_dofs` suggests, they keep the Hessian's error above a half.
"""

from __future__ import annotations

import numpy as np
from problem import ACTUATORS, FloatArray, Run, Solution, forces
from scipy.sparse import diags
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, Element, ElementTriArgyris, ElementTriMorley, MeshTri
from skfem.helpers import dd, ddot

from meshes import disc

ARGYRIS = [(6, 0.6), (12, 0.4), (24, 0.2), (36, 0.12)]
MORLEY = [(24, 1.0), (48, 0.7), (96, 0.3)]


@BilinearForm
def bending(u, v, _):  # type: ignore[no-untyped-def]
    return ddot(dd(u), dd(v))


def polygon(cells: int) -> MeshTri:
    """The disc's mesh with the vertices nearest to the actuators moved there."""
    mesh = disc(1.0, 1 / cells)
    points = mesh.points.copy()
    for at in ACTUATORS:
        points[np.argmin(((points - at) ** 2).sum(axis=1))] = at
    return MeshTri(np.ascontiguousarray(points.T), np.ascontiguousarray(mesh.triangles.T))


def solve(mesh: MeshTri, element: Element, order: int, held: int) -> Solution:
    """held: how many of a rim vertex's unknowns are 0, from the first."""
    basis = Basis(mesh, element, intorder=order, disable_doflocs=True)
    matrix = bending.assemble(basis)
    clamped = [basis.nodal_dofs[:held, mesh.boundary_nodes()], basis.facet_dofs[:, mesh.boundary_facets()]]
    free = np.setdiff1d(np.arange(basis.N), np.concatenate([dofs.ravel() for dofs in clamped]))
    matrix = matrix[free][:, free]
    scale = 1 / np.sqrt(matrix.diagonal())
    scaled = (diags(scale) @ matrix @ diags(scale)).tocsc()
    factor = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    take = basis.probes(ACTUATORS.T)
    answers = np.zeros((basis.N, len(ACTUATORS)))
    answers[free] = scale[:, None] * factor.solve(scale[:, None] * take.toarray().T[free])
    unknowns = answers @ forces(take @ answers)
    return Solution(len(free), lambda xy: evaluate(basis, unknowns, xy))


def evaluate(basis: Basis, unknowns: FloatArray, xy: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """w, gradient and Hessian at points (n, 2); beyond the polygon the nearest cell's polynomial goes on."""
    apothem = np.cos(np.pi / len(basis.mesh.boundary_facets())) - 1e-9
    within = xy * np.minimum(1, apothem / np.hypot(*xy.T))[:, None]
    cells = basis.mesh.element_finder()(*within.T)
    reference = basis.mapping.invF(xy.T[:, :, None], tind=cells)
    value, gradient, hessian = np.zeros(len(xy)), np.zeros((2, len(xy))), np.zeros((2, 2, len(xy)))
    for k in range(basis.Nbfun):
        function = basis.elem.gbasis(basis.mapping, reference, k, tind=cells)[0]
        share = unknowns[basis.element_dofs[k, cells]]
        value += function.value[..., 0] * share
        gradient += function.grad[..., 0] * share
        hessian += function.hess[..., 0] * share
    return value, gradient.T, hessian.transpose(2, 0, 1)


def runs() -> list[Run]:
    # An element keeps its first mesh's basis: each solve needs a new one.
    argyris = [
        Run("scikit-fem Argyris", lambda n=n: polygon(n), lambda mesh: solve(mesh, ElementTriArgyris(), 6, 3), bound)
        for n, bound in ARGYRIS
    ]
    morley = [
        Run("scikit-fem Morley", lambda n=n: polygon(n), lambda mesh: solve(mesh, ElementTriMorley(), 2, 1), bound)
        for n, bound in MORLEY
    ]
    return argyris + morley
