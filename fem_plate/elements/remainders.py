"""Remainders: what elements leave of corner functions, integrated as such.

A corner function s less the elements' share X of it is small but at its corner. The energy of s - X as a difference of
those of s and X would be one of large numbers, the penalties where other sides hold s; rounding would be all of it.
"""

from __future__ import annotations

import numpy as np

from fem_plate.elements import forms
from fem_plate.elements.corner_functions import CornerFunctions, singular_weights
from fem_plate.elements.rim import RIM_POINTS, unit_gauss
from fem_plate.elements.space import CHUNK, QUADRATURE, PlateSpace
from fem_plate.types import FloatArray, IntArray

ACROSS = 16  # quadrature points of a triangle at a corner, across the rays from there
SAME = 1e-9  # of the plate's size: points closer than this coincide


class Remainders:
    """The functions s - X (E,) on a space.

    lifts: (m, 21, E), the unknowns of X by triangles.  to_integrate: derivatives of s at the rim, as of `at_rim`.
    """

    def __init__(
        self,
        space: PlateSpace,
        functions: CornerFunctions,
        lifts: FloatArray,
        to_integrate: list[FloatArray],
        law: FloatArray,
    ) -> None:
        self.space, self.functions, self.lifts, self.law = space, functions, lifts, law
        of_elements = space.traces(law)
        self.traces = forms.rim_traces(to_integrate, space.rim.normal, law)  # (6, k, n, E)
        self.traces -= of_elements @ lifts[space.rim.triangle]

    @property
    def _step(self) -> int:
        """Triangles evaluated at a time, to bound memory."""
        return max(1, CHUNK // (QUADRATURE**2 * len(self.functions)))

    def bending(self) -> tuple[FloatArray, FloatArray]:
        """int M(v):H(s - X) of the triangles' functions v, (all unknowns, E), and of s - X itself, (E, E)."""
        triangles, count = self.space.triangles, len(self.functions)
        with_elements, own = np.zeros((self.space.all_count, count)), np.zeros((count, count))
        touching = np.zeros(len(triangles.points), dtype=bool)
        for place in dict.fromkeys(function.place for function in self.functions.functions):
            corner = np.abs(triangles.points @ [1, 1j] - place) < SAME
            touching |= corner.any(axis=1)
            for row, first in np.argwhere(corner).tolist():
                of_triangle, energy = self._at_corner(place, row, first)
                with_elements[self.space.dofs[row]] += of_triangle
                own += energy
        for triangle, points, weights in self.space.cells(self._step, np.flatnonzero(~touching)):
            rest, table = self._derivatives(points, triangle, 2), triangles.derivatives(points, triangle, 2)
            moments = np.tensordot(self.law, rest * weights[..., None], axes=1)
            np.add.at(with_elements, self.space.dofs[triangle], forms.products(table, moments))
            own += np.tensordot(rest, moments, axes=([0, 1, 2], [0, 1, 2]))
        return with_elements, own

    def _at_corner(self, place: complex, triangle: int, first: int) -> tuple[FloatArray, FloatArray]:
        """The same of the triangle whose point `first` is the corner, (21, E) and (E, E), on rays from there."""
        functions, triangles = self.functions.functions, self.space.triangles
        corner, one, other = np.roll(triangles.points[triangle], -first, axis=0)
        (s, along), (t, across) = unit_gauss(RIM_POINTS), unit_gauss(ACROSS)
        points = corner + s[:, None, None] * (one - corner + t[:, None] * (other - one))  # (s, t, 2)
        weights = triangles.determinant[triangle] * np.outer(along * s, across)
        table = triangles.derivatives(points.reshape(1, -1, 2), np.array([triangle]), 2)[:, 0]
        table = table.reshape(3, *weights.shape, -1)
        known = self.functions.derivatives(points, 3)[2]  # (3, s, t, E)
        here = np.flatnonzero([function.place == place for function in functions])
        singular = known[..., here]
        exponents = np.array([functions[e].exponent for e in here.tolist()])
        known[..., here] = 0.0
        smooth = known - table @ self.lifts[triangle]
        moments = np.einsum("ab,bste,st->aste", self.law, smooth, weights)
        with_elements = np.einsum("astj,aste->je", table, moments)
        own = np.einsum("aste,astf->ef", smooth, moments)
        # Second derivatives of s grow as r^(p - 2), and the area has another r.
        exact = np.stack([singular_weights(p - 1) for p in exponents.tolist()], axis=1)
        moments = np.einsum("ab,bste,st,se->aste", self.law, singular, weights, exact)
        with_elements[:, here] += np.einsum("astj,aste->je", table, moments)
        mixed = np.einsum("aste,astf->ef", moments, smooth)
        own[here] += mixed
        own[:, here] += mixed.T
        at_end = singular[:, 0] / s[0] ** (exponents - 2)  # (3, t, e), at s = 1
        both = np.einsum("ate,ab,btf,t->ef", at_end, self.law, at_end, across)
        powers = exponents + exponents[:, None] - 2
        own[np.ix_(here, here)] += triangles.determinant[triangle] / powers * both
        return with_elements, own

    def stretching(self) -> tuple[FloatArray, FloatArray]:
        """int grad v.grad(s - X) of the triangles' functions v, (all unknowns, E), and of s - X itself, (E, E)."""
        triangles, count = self.space.triangles, len(self.functions)
        with_elements, own = np.zeros((self.space.all_count, count)), np.zeros((count, count))
        for triangle, points, weights in self.space.cells(self._step):
            rest, table = self._derivatives(points, triangle, 1), triangles.derivatives(points, triangle, 1)
            weighted = weights[..., None] * rest
            np.add.at(with_elements, self.space.dofs[triangle], forms.products(table, weighted))
            own += np.tensordot(rest, weighted, axes=([0, 1, 2], [0, 1, 2]))
        return with_elements, own

    def at_rim(self, coupling: FloatArray, of_elements: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A coupling (k, n, 6, 6) at the rim of the triangles' functions, (all unknowns, E), and of s - X, (E, E).

        of_elements: (6, k, n, 21), the traces of the triangles' functions.
        """
        with_elements = np.zeros((self.space.all_count, len(self.functions)))
        coupled = np.einsum("kncd,dkne->ckne", coupling, self.traces)
        local = np.einsum("cknj,ckne->kje", of_elements, coupled, optimize=True)
        np.add.at(with_elements, self.space.dofs[self.space.rim.triangle], local)
        return with_elements, np.einsum("ckne,cknf->ef", self.traces, coupled, optimize=True)

    def _derivatives(self, points: FloatArray, triangle: IntArray, order: int) -> FloatArray:
        """Derivatives (d, t, n, E) of one order of s - X at points (t, n, 2) of triangles (t,)."""
        table = self.space.triangles.derivatives(points, triangle, order)
        return np.asarray(self.functions.derivatives(points, order + 1)[order] - table @ self.lifts[triangle])
