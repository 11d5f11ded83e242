"""GeneralModel: a plate of any energy on one mesh; its stiffness, and its responses to unit loads.

With F the response of the infinite plate whose law everywhere is that at the force, and w = F + v, v solves

    a(v, q) = q(x_force) - a(F, q)   for every q,

and the constant law turns F into the force, int M_0(F):H(q) = q(x_force) + rim[ (M_0(F) n).grad q - (div M_0.n) q ].
So what loads v is the rest of the form at F, which grows like ln r times the difference of the laws, or less, and terms
at the rim. The form's Nitsche terms are those of `forms`, of its own moments m = da/dH and forces f = da/dgrad:

    rim[ (m n).T grad q - c ((div m - f).n) q ].
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.anisotropic import MEAN
from fem_plate.elements import (
    QUADRATURE,
    AnisotropicPlate,
    PlateModel,
    PlateSpace,
    SourceBasis,
    forms,
    monomials,
    rigid_motions,
    source_basis,
)
from fem_plate.general.energy import GRADIENT, HESSIAN, PlateEnergy
from fem_plate.types import BoolArray, FloatArray, IntArray
from meshes import PlateMesh

CHUNK, SOURCES = 400, 50  # triangles and forces at a time, to bound memory
FREE = 1e-10  # of the largest energy of a rigid motion: those with less are free
EPSILON = float(np.finfo(float).eps)


class GeneralModel(PlateModel):
    """A plate of one energy on one mesh; supports and free_corners as of `PlateModel`."""

    def __init__(
        self, mesh: PlateMesh, supports: Mapping[str, str], energy: PlateEnergy, free_corners: Sequence[int] = ()
    ) -> None:
        self.mesh, self.energy = mesh, energy
        self.infinite = AnisotropicPlate(energy.laws)
        self.space = PlateSpace(mesh, supports, free_corners)
        self.rigid = self._orthonormal(self._free(rigid_motions(self.space.rim)))

    def _free(self, rigid: FloatArray) -> FloatArray:
        """The rigid motions (3, r) among those that the supports allow which cost no energy."""
        if not rigid.size:
            return rigid
        even = self._orthonormal(rigid)
        motions = self.space.linear() @ even
        energies, turned = np.linalg.eigh(motions.T @ (self._parts[1] @ motions))
        return np.asarray(even @ turned[:, np.abs(energies) <= FREE * np.abs(energies).max()])

    @cached_property
    def mass(self) -> csc_matrix:
        matrices = np.zeros((len(self.space.triangles.centre), 21, 21))
        for triangle, points, weights in self._cells():
            value = self.space.triangles.derivatives(points, triangle, 0)[0]
            np.add.at(matrices, triangle, forms.mass_at(value, weights * self.energy.relative_thickness(points)))
        return self.space.assembled(matrices)

    @property
    def masses(self) -> tuple[FloatArray, FloatArray]:
        points, weights = self.space.quadrature
        return points, weights * self.energy.relative_thickness(points)

    @property
    def stiffness(self) -> csc_matrix:
        """The symmetric matrix of the form and of its terms at the rim."""
        bending, rest = self._parts
        return (bending + rest).tocsc()

    @cached_property
    def _parts(self) -> tuple[csc_matrix, csc_matrix]:
        """The matrices of bending with all terms at the rim, and of the rest of the form."""
        bending, rest = np.zeros((2, len(self.space.triangles.centre), 21, 21))
        for triangle, points, weights in self._cells():
            table, own = self._table(points, triangle), self.energy.at(points) * weights[..., None, None]
            np.add.at(bending, triangle, _products(table[HESSIAN], _times(own[..., HESSIAN, HESSIAN], table[HESSIAN])))
            own[..., HESSIAN, HESSIAN] = 0.0
            if np.any(own):
                np.add.at(rest, triangle, _products(table, _times(own, table)))
        at_rim = self.space.at_rim(self._own_traces, self._couplings[0])
        return self.space.of_bending(bending, at_rim), self.space.assembled(rest)

    @property
    def pinned_stiffness(self) -> csc_matrix:
        return (self.stiffness + self.pins.T @ self.pins).tocsc()

    def _smooth_under(self, sources: FloatArray, basis: SourceBasis | None) -> FloatArray:
        parts = [self._loads(sources[start : start + SOURCES]) for start in range(0, len(sources), SOURCES)]
        return self.solve(np.concatenate(parts, axis=1)) if parts else np.zeros((self.unknowns, 0))

    def under_pressure(self) -> FloatArray:
        return self.solve(self.space.mass() @ self.space.linear()[:, :1])

    def basis(self, x: FloatArray, held: BoolArray) -> SourceBasis:
        """Without dipoles: forces at different places have different laws."""
        return source_basis(x, np.zeros_like(held))

    def rounding(self, x: FloatArray, held: BoolArray) -> float:
        """Second differences of Green's functions lose digits with the square of the distance between actuators."""
        apart = np.linalg.norm(x[held][:, None] - x[held], axis=-1) + np.where(np.eye(int(held.sum())), np.inf, 0.0)
        return float(EPSILON / apart.min(initial=1.0) ** 2)

    def _loads(self, sources: FloatArray) -> FloatArray:
        """What loads v for unit forces at sources (N, 2), (unknowns, N)."""
        laws = self.energy.laws(sources)
        loads = np.zeros((self.unknowns, len(sources)))
        for triangle, points, weights in self._cells():
            table, own = self._table(points, triangle), self.energy.at(points)
            known = self.infinite.point_load(points.reshape(-1, 2), sources)
            value, gradient, hessian = (part.reshape(*weights.shape, *part.shape[1:]) for part in known)
            curvature = np.stack([hessian[..., 0, 0], hessian[..., 0, 1], hessian[..., 1, 1]])
            jets = np.concatenate([value[None], np.moveaxis(gradient, -1, 0), curvature])  # (6, t, n, N)
            with np.errstate(invalid="ignore"):  # inf - inf at a source
                density = _times(own, jets)
                density[HESSIAN] -= np.einsum("Nab,btnN->atnN", laws, curvature)
            density = np.where(np.isfinite(density), density * weights[..., None], 0.0)
            loads -= self.space.summed(_products(table, density), triangle)
        return loads - self.space.summed(self._rim_loads(sources, laws), self.space.rim.triangle)

    def _rim_loads(self, sources: FloatArray, laws: FloatArray) -> FloatArray:
        """The same at the rim, of the opposite sign, (k, 21, N)."""
        rim, results = self.space.rim, []
        full = np.zeros((forms.CHANNELS, forms.CHANNELS))
        full[forms.GRADIENT, forms.MOMENT] = np.eye(2)
        full[forms.VALUE, forms.SHEAR] = -1.0
        for source, law in zip(sources, laws, strict=True):
            derivatives = self.infinite.point_derivatives(rim.points, source)
            own = self._traces([order[..., None] for order in derivatives])[..., 0]
            constant = forms.rim_traces(derivatives, rim.normal, law)
            coupled = np.einsum("kncd,dkn->ckn", self._couplings[1], own)
            coupled += np.einsum("cd,dkn->ckn", full, constant - own) * rim.weights
            results.append(np.einsum("ckni,ckn->ki", self._own_traces, coupled, optimize=True))
        return np.stack(results, axis=-1)

    @cached_property
    def _couplings(self) -> tuple[FloatArray, FloatArray]:
        own = self._at_rim[0]
        pulls = np.abs(own[..., GRADIENT, GRADIENT]).sum(axis=(-1, -2))
        h = self.space.rim.h[:, None]
        # The penalty of values holds against a tension, too.
        stiff = (own[..., HESSIAN, HESSIAN] * MEAN).sum(axis=(-1, -2)) + forms.GAMMA_0 / forms.GAMMA_2 * h**2 * pulls
        return forms.rim_forms(self.space.rim, stiff)

    @cached_property
    def _at_rim(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The form's matrices at the rim and their derivatives along x and y, (k, n, 6, 6).

        The derivatives are those of the polynomial that is closest in the rim's triangle, of degree five: beyond the
        rim the form may not be defined.
        """
        space, triangle = self.space, self.space.rim.triangle
        xy, _ = forms.triangle_quadrature(QUADRATURE)
        triangles = space.triangles
        inside = triangles.centre[triangle, None] + np.einsum("mij,nj->mni", triangles.jacobian[triangle], xy)
        fit = np.linalg.pinv(monomials(*xy.T))  # (21, n)
        own = np.einsum("jn,knab->kjab", fit, self.energy.at(inside), optimize=True)
        u, v = np.moveaxis(triangles.reference(space.rim.points, triangle), 2, 0)
        slopes = np.stack([monomials(u, v, 1, 0), monomials(u, v, 0, 1)])  # (2, k, n, 21)
        slopes = np.einsum("krd,rknj->dknj", triangles.inverse[triangle], slopes)
        along_x, along_y = np.einsum("dknj,kjab->dknab", slopes, own, optimize=True)
        return self.energy.at(space.rim.points), along_x, along_y

    @cached_property
    def _own_traces(self) -> FloatArray:
        """The rim's channels of the triangles' functions, (6, k, n, 21)."""
        rim, triangles = self.space.rim, self.space.triangles
        return self._traces([triangles.derivatives(rim.points, rim.triangle, order) for order in range(4)])

    def _traces(self, derivatives: Sequence[FloatArray]) -> FloatArray:
        """The rim's channels of functions, (6, k, n, i): value, gradient, m n, (div m - f).n.

        derivatives: of orders 0 to 3, each (d, k, n, i).
        """
        (value,), slopes, second, third = derivatives
        own, own_x, own_y = self._at_rim
        nx, ny = (self.space.rim.normal[..., i, None] for i in range(2))
        jet = np.concatenate([value[None], slopes, second])
        along_x = np.concatenate([slopes[:1], second[:2], third[:3]])
        along_y = np.concatenate([slopes[1:], second[1:], third[1:]])
        half = np.array([1.0, 0.5, 1.0])[:, None, None, None]
        xx, xy, yy = half * _times(own[..., HESSIAN, :], jet)
        m_x = half * (_times(own_x[..., HESSIAN, :], jet) + _times(own[..., HESSIAN, :], along_x))
        m_y = half * (_times(own_y[..., HESSIAN, :], jet) + _times(own[..., HESSIAN, :], along_y))
        f_x, f_y = _times(own[..., GRADIENT, :], jet)
        shear = (m_x[0] + m_y[1] - f_x) * nx + (m_x[1] + m_y[2] - f_y) * ny
        return np.stack([value, *slopes, xx * nx + xy * ny, xy * nx + yy * ny, shear])

    def _table(self, points: FloatArray, triangle: IntArray) -> FloatArray:
        """The triangles' functions with first and second derivatives, (6, t, n, 21)."""
        return np.concatenate([self.space.triangles.derivatives(points, triangle, order) for order in range(3)])

    def _cells(self) -> Iterator[tuple[IntArray, FloatArray, FloatArray]]:
        """Triangles (t,), quadrature points (t, n, 2) and weights (t, n), some at a time, and then the slivers."""
        triangles = self.space.triangles
        xy, weights = forms.triangle_quadrature(QUADRATURE)
        for start in range(0, len(triangles.centre), CHUNK):
            triangle = np.arange(start, min(start + CHUNK, len(triangles.centre)))
            points = np.einsum("mij,nj->mni", triangles.jacobian[triangle], xy) + triangles.centre[triangle, None]
            yield triangle, points, triangles.determinant[triangle, None] * weights
        if len(self.space.slivers.triangle):
            yield self.space.slivers


def _times(matrices: FloatArray, table: FloatArray) -> FloatArray:
    """Matrices (t, n, a, b) times a table (b, t, n, i): (a, t, n, i)."""
    return np.asarray(np.einsum("tnab,btni->atni", matrices, table, optimize=True))


def _products(one: FloatArray, other: FloatArray) -> FloatArray:
    """The sums (t, i, j) over d and n of tables (d, t, n, i) and (d, t, n, j)."""
    return np.asarray(sum(a.transpose(0, 2, 1) @ b for a, b in zip(one, other, strict=True)))
