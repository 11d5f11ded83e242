"""The membrane by in-plane motion u: plane stress, force = A : (sym grad u + 1/2 grad w grad w).

scikit-fem's triangles of degree four for each component of u, on cells whose sides along the rim are parabolas through
the true rim's middles. It serves plates with holes too, and those of which only part of the rim is held in the plane.
It bounds the membrane energy from above.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np
from skfem import Basis, BilinearForm, ElementTriP4, ElementVector, MeshTri2
from skfem.element import DiscreteField
from skfem.helpers import ddot, sym_grad

from fem_plate.elements import PlateSpace, factorised
from fem_plate.large_deflection.membrane import PLANE_STRESS, Membrane, Samples
from fem_plate.types import FloatArray, IntArray
from meshes import PlateMesh, facets_of, skfem_mesh

DEGREE = 14  # of the quadrature
NEWTON = 4  # steps to reference coordinates; cells at the rim are curved a little


class PlaneStress:
    """The in-plane motion of a plate, dimensionless.

    space: of its deflection, on the same cells.  movable: by boundary.
    """

    def __init__(self, mesh: PlateMesh, space: PlateSpace, movable: Mapping[str, bool], poisson_ratio: float) -> None:
        self.space = space
        self.basis = basis = Basis(curved(mesh), ElementVector(ElementTriP4()), intorder=DEGREE)
        self.law = 12 * np.array([[1, 0, poisson_ratio], [0, (1 - poisson_ratio) / 2, 0], [poisson_ratio, 0, 1]])
        self._free = np.setdiff1d(np.arange(basis.N), _held(mesh, basis, movable))
        self._poisson_ratio = poisson_ratio

    @cached_property
    def membrane(self) -> Membrane:
        """How the plate stretches."""
        basis = self.basis
        strain = np.stack([np.stack([g[0, 0], g[0, 1] + g[1, 0], g[1, 1]]) for g in (f[0].grad for f in basis.basis)])
        force = np.einsum("ab,fbkn->kanf", self.law, strain, optimize=True)  # (k, 3, n, 30)
        points = np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1)
        operator = force.reshape(len(points), -1, force.shape[-1])
        samples = Samples.at(self.space, np.arange(len(points)), points, np.asarray(basis.dx), operator)
        stiffness = _stiffness(self._poisson_ratio).assemble(basis)[self._free][:, self._free].tocsc()
        return Membrane(
            name=PLANE_STRESS,
            samples=(samples,),
            dofs=np.ascontiguousarray(basis.element_dofs.T).astype(np.int64),
            stiffness=stiffness,
            solve=factorised(stiffness),
            sign=1.0,
            law=self.law,
            expand=self._expand,
            reduce=lambda rows: rows[self._free],
        )

    def _expand(self, u: FloatArray) -> FloatArray:
        everything = np.zeros((self.basis.N, *u.shape[1:]))
        everything[self._free] = u
        return everything

    def values(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Motions (n, 2, c) at points x (n, 2); u: (unknowns, c)."""
        value = np.zeros((len(x), 2, u.shape[1]))
        for along, function, weight in self._shares(x, u):
            value[:, along] += np.asarray(function)[along] * weight
        return value

    def gradients(self, x: FloatArray, u: FloatArray) -> FloatArray:
        """Their gradients (n, 2, 2, c), the last but one the direction, likewise."""
        gradient = np.zeros((len(x), 2, 2, u.shape[1]))
        for along, function, weight in self._shares(x, u):
            gradient[:, along] += function.grad[along].transpose(1, 0, 2) * weight[:, None]
        return gradient

    def _shares(self, x: FloatArray, u: FloatArray) -> Iterator[tuple[int, DiscreteField, FloatArray]]:
        """Each basis function at points x (n, 2): the one direction along which it moves, itself, weights (n, c)."""
        basis, everything = self.basis, self._expand(u)
        triangle = self.space.triangle_of(x)
        local = self._local(x, triangle)
        for i in range(basis.Nbfun):
            (function,) = basis.elem.gbasis(basis.mapping, local, i, triangle)
            yield i % 2, function, everything[basis.element_dofs[i, triangle]]

    def _local(self, x: FloatArray, triangle: IntArray) -> FloatArray:
        """The reference coordinates (2, n, 1) of points (n, 2) on triangles (n,), curved ones by Newton's method."""
        mapping = self.basis.mapping
        corners = mapping.mesh.p[:, mapping.mesh.t[:3, triangle]]  # (2, 3, n)
        sides = np.moveaxis(corners[:, 1:] - corners[:, :1], 2, 0)
        local = np.linalg.solve(sides, (x - corners[:, 0].T)[..., None]).transpose(1, 0, 2)
        for _ in range(NEWTON):
            missed = mapping.F(local, triangle) - x.T[:, :, None]
            local = local - np.einsum("ijnk,jnk->ink", mapping.invDF(local, triangle), missed)
        return np.asarray(local)


def curved(mesh: PlateMesh) -> MeshTri2:
    """The mesh for scikit-fem, lengths by the plate's size, with the middles of its rim's sides on the true rim."""
    middles = {name: xy / mesh.size for name, xy in mesh.middles.items()}
    return skfem_mesh(mesh.points / mesh.size, mesh.triangles, mesh.boundaries, middles)


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
