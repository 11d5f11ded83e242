"""EnergyForm: the weak form of a plate whose energy is a field, on one space; its matrices and its loads.

With F the response of the infinite plate whose law everywhere is that at the force, and w = F + v, v solves

    a(v, q) = q(x_force) - a(F, q)   for every q,

and the constant law turns F into the force, int M_0(F):H(q) = q(x_force) + rim[ (M_0(F) n).grad q - (div M_0.n) q ].
So what loads v is the rest of the form at F, which grows like ln r times the difference of the laws, or less, and terms
at the rim. The form's Nitsche terms are those of `forms`, of its own moments m = da/dH and forces f = da/dgrad:

    rim[ (m n).T grad q - c ((div m - f).n) q ].
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.anisotropic import MEAN
from fem_plate.elements import forms
from fem_plate.elements.argyris import polynomials
from fem_plate.elements.energy import GRADIENT, HESSIAN, PlateEnergy
from fem_plate.elements.infinite import InfinitePlate
from fem_plate.elements.space import QUADRATURE, PlateSpace
from fem_plate.types import FloatArray, IntArray

CHUNK, SOURCES = 400, 50  # triangles and forces at a time, to bound memory


class EnergyForm:
    """The form of an energy on a space."""

    def __init__(self, space: PlateSpace, energy: PlateEnergy) -> None:
        self.space, self.energy = space, energy

    @property
    def stiffness(self) -> csc_matrix:
        """The symmetric matrix of the form and of its terms at the rim."""
        bending, rest = self.parts
        return (bending + rest).tocsc()

    @cached_property
    def parts(self) -> tuple[csc_matrix, csc_matrix]:
        """The matrices of bending with all terms at the rim, and of the rest of the form."""
        bending, rest = np.zeros((2, len(self.space.triangles.centre), 21, 21))
        for triangle, points, weights in self.space.cells(CHUNK):
            table, own = self._table(points, triangle), self.energy.at(points) * weights[..., None, None]
            moments = _times(own[..., HESSIAN, HESSIAN], table[HESSIAN])
            np.add.at(bending, triangle, forms.products(table[HESSIAN], moments))
            own[..., HESSIAN, HESSIAN] = 0.0
            if np.any(own):
                np.add.at(rest, triangle, forms.products(table, _times(own, table)))
        at_rim = self.space.at_rim(self._traces, self._couplings[0])
        return self.space.of_bending(bending, at_rim), self.space.assembled(rest)

    def mass(self) -> csc_matrix:
        """The matrix of int v q times the thickness over that for reference."""
        matrices = np.zeros((len(self.space.triangles.centre), 21, 21))
        for triangle, points, weights in self.space.cells(CHUNK):
            value = self.space.triangles.derivatives(points, triangle, 0)[0]
            np.add.at(matrices, triangle, forms.mass_at(value, weights * self.energy.relative_thickness(points)))
        return self.space.assembled(matrices)

    def loads(self, sources: FloatArray, infinite: InfinitePlate) -> FloatArray:
        """What loads v for unit forces at sources (N, 2), (unknowns, N)."""
        parts = [self._loads(sources[k : k + SOURCES], infinite) for k in range(0, len(sources), SOURCES)]
        return np.concatenate(parts, axis=1) if parts else np.zeros((self.space.unknowns, 0))

    def _loads(self, sources: FloatArray, infinite: InfinitePlate) -> FloatArray:
        laws = self.energy.laws(sources)
        loads = np.zeros((self.space.unknowns, len(sources)))
        for triangle, points, weights in self.space.cells(CHUNK):
            table, own = self._table(points, triangle), self.energy.at(points)
            known = infinite.point_load(points.reshape(-1, 2), sources)
            value, gradient, hessian = (part.reshape(*weights.shape, *part.shape[1:]) for part in known)
            curvature = np.stack([hessian[..., 0, 0], hessian[..., 0, 1], hessian[..., 1, 1]])
            jets = np.concatenate([value[None], np.moveaxis(gradient, -1, 0), curvature])  # (6, t, n, N)
            with np.errstate(invalid="ignore"):  # inf - inf at a source
                density = _times(own, jets)
                density[HESSIAN] -= np.einsum("Nab,btnN->atnN", laws, curvature)
            density = np.where(np.isfinite(density), density * weights[..., None], 0.0)
            loads -= self.space.assemble_load(forms.products(table, density), triangle)
        at_rim = [infinite.point_derivatives(self.space.rim.points, source) for source in sources]
        own = np.stack([self._traces_of([order[..., None] for order in one]).ravel() for one in at_rim], axis=1)
        pairs = zip(at_rim, laws, strict=True)
        constant = np.stack([forms.rim_traces(one, self.space.rim.normal, law).ravel() for one, law in pairs], axis=1)
        of_own, of_rest = self._rim_loads
        return loads - of_own @ own - of_rest @ (constant - own)

    @cached_property
    def _rim_loads(self) -> tuple[csc_matrix, csc_matrix]:
        """What loads v, with the opposite sign, for the traces of F by the form, and by the law at its force."""
        full = np.zeros((forms.CHANNELS, forms.CHANNELS))
        full[forms.GRADIENT, forms.MOMENT] = np.eye(2)
        full[forms.VALUE, forms.SHEAR] = -1.0
        weighted = self.space.rim.weights[..., None, None] * full
        return self.space.rim_load(self._traces, self._couplings[1]), self.space.rim_load(self._traces, weighted)

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
        fit = np.linalg.pinv(polynomials(*xy.T))  # (21, n)
        own = np.einsum("jn,knab->kjab", fit, self.energy.at(inside), optimize=True)
        u, v = np.moveaxis(triangles.reference(space.rim.points, triangle), 2, 0)
        slopes = np.stack([polynomials(u, v, 1, 0), polynomials(u, v, 0, 1)])  # (2, k, n, 21)
        slopes = np.einsum("krd,rknj->dknj", triangles.inverse[triangle], slopes)
        along_x, along_y = np.einsum("dknj,kjab->dknab", slopes, own, optimize=True)
        return self.energy.at(space.rim.points), along_x, along_y

    @cached_property
    def _traces(self) -> FloatArray:
        """The rim's channels of the triangles' functions, (6, k, n, 21)."""
        rim, triangles = self.space.rim, self.space.triangles
        return self._traces_of([triangles.derivatives(rim.points, rim.triangle, order) for order in range(4)])

    def _traces_of(self, derivatives: Sequence[FloatArray]) -> FloatArray:
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


def _times(matrices: FloatArray, table: FloatArray) -> FloatArray:
    """Matrices (t, n, a, b) times a table (b, t, n, i): (a, t, n, i)."""
    return np.asarray(np.einsum("tnab,btni->atni", matrices, table, optimize=True))
