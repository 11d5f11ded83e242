"""Argyris functions and corner functions together: their matrices, and their values at points."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import block_diag, bmat, csc_matrix, hstack

from fem_plate.elements import forms
from fem_plate.elements.corner_functions import CornerFunctions
from fem_plate.elements.factor import factorised
from fem_plate.elements.remainders import Remainders
from fem_plate.elements.space import CHUNK, PlateSpace
from fem_plate.types import FloatArray, IntArray
from meshes import PlateMesh

# Of s - X, dimensionless: with less it counts for nothing, and rounding of X would be a large part of it.
LEAST_ENERGY = 1e-8


class EnrichedSpace(PlateSpace):
    """A `PlateSpace` whose last unknowns (E,) are the shares of corner functions s, less what elements follow of them.

    With X the elements' answer to s, a(s - X, q) = 0 for all q of the elements: the stiffness has two blocks, and
    elements and shares are solved for apart. s carries no load. So a(s, q) is an integral over the rim, that of the
    right side of `forms` for what is known in closed form, and exact. Corner functions stand for one isotropic
    law and one tension, under which they must be harmonic.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        supports: Mapping[str, str],
        free_corners: Sequence[int],
        functions: CornerFunctions,
        law: FloatArray,
        tension: float,
    ) -> None:
        super().__init__(mesh, supports, free_corners)
        self.functions, self._law, self._tension = functions, law, tension
        self.plain = self.unknowns
        self.unknowns += len(functions)

    @cached_property
    def _of_elements(self) -> csc_matrix:
        bending = super().stiffness(self._law)
        return bending + self._tension * super().stretching() if self._tension else bending

    @cached_property
    def _solve_elements(self) -> Callable[[FloatArray], FloatArray]:
        return factorised(self._of_elements)

    @cached_property
    def _lifts(self) -> FloatArray:
        """X, (plain, E)."""
        known, _ = self._at_rim
        traces = forms.rim_traces(known, self.rim.normal, self._law).reshape(-1, len(self.functions))
        load = self.load(self._law, self._tension) @ traces
        lifts = self._solve_elements(load)
        return np.asarray(lifts + self._solve_elements(load - self._of_elements @ lifts))

    @cached_property
    def _at_rim(self) -> tuple[list[FloatArray], list[FloatArray]]:
        return self.functions.at_rim(self.rim)

    @cached_property
    def _remainders(self) -> Remainders:
        lifts = super().element_dofs(self._lifts)[self.dofs]
        return Remainders(self, self.functions, lifts, self._at_rim[1], self._law)

    @cached_property
    def _energies(self) -> tuple[FloatArray, FloatArray]:
        """The energies of s - X without the rim's terms: with elements (plain, E), by quadrature; its own, (E, E)."""
        with_elements, own = self._remainders.bending()
        if self._tension:
            stretched, own_stretched = self._remainders.stretching()
            with_elements, own = with_elements + self._tension * stretched, own + self._tension * own_stretched
        return self.to_independent(with_elements), own

    @cached_property
    def _own_stiffness(self) -> FloatArray:
        """The energies of s - X, (E, E)."""
        left, _ = self.couplings(self._tension)
        energy = self._energies[1] + self._remainders.at_rim(left, self.traces(self._law))[1]
        return np.asarray((energy + energy.T) / 2)

    def stiffness(self, law: FloatArray, tension: float = 0.0) -> csc_matrix:
        """As of any space; for the law and tension that it was made for."""
        return block_diag([self._of_elements, self._own_stiffness], format="csc")

    def solve(self, load: FloatArray) -> FloatArray:
        """Solves with the stiffness for loads (unknowns, ...)."""
        return np.concatenate([self._solve_elements(load[: self.plain]), self._shares(load[self.plain :])])

    def _shares(self, load: FloatArray) -> FloatArray:
        """The shares (E, ...) under loads (E, ...); 0 of functions that elements follow well enough."""
        counts = np.diag(self._own_stiffness) > LEAST_ENERGY
        shares = np.zeros_like(load)
        shares[counts] = np.linalg.solve(self._own_stiffness[np.ix_(counts, counts)], load[counts])
        return shares

    def follow(self, traces: FloatArray) -> FloatArray:
        """The unknowns (unknowns, k) that make up at the rim for known functions, given by the traces (6 points, k).

        What the shares are loaded with is taken from the misfit g - v that elements leave, not from g: rounding of the
        large penalties would hide it.
        """
        elements = self._solve_elements(self.load(self._law, self._tension) @ traces)
        local = super().element_dofs(elements)[self.dofs][self.rim.triangle]
        loads = self.misfit(self.traces(self._law), self.couplings(self._tension), traces, local)
        with_elements, _ = self._energies
        load = np.einsum("ckne,cknf->ef", self._remainders.traces, loads, optimize=True) - with_elements.T @ elements
        return np.concatenate([elements, self._shares(load)])

    def stretching(self) -> csc_matrix:
        coupling, of_elements = forms.rim_tension_forms(self.rim)[0], self.traces(self._law)
        inside, at_rim = self._remainders.stretching(), self._remainders.at_rim(coupling, of_elements)
        border = [self.to_independent(inside[0] + at_rim[0]), inside[1] + at_rim[1]]
        return self._bordered(super().stretching(), np.concatenate(border))

    def load_at(self, triangle: IntArray, points: FloatArray, loads: FloatArray) -> FloatArray:
        of_elements = super().load_at(triangle, points, loads)
        of_corners = self.functions.derivatives(points.reshape(-1, 2), 1)[0][0]
        shares = of_corners.T @ loads.reshape(len(of_corners), -1) - self._lifts.T @ of_elements
        return np.concatenate([of_elements, shares])

    def mass(self) -> csc_matrix:
        (points, weights), triangles = self.quadrature, self.quadrature_triangles
        border = np.zeros((self.unknowns, len(self.functions)))
        step = max(1, CHUNK // len(self.functions))
        for start in range(0, len(points), step):
            part = slice(start, start + step)
            values = self.point_values(points[part], triangles[part])
            border += values.T @ (weights[part, None] * values[:, self.plain :].toarray())
        return self._bordered(super().mass(), border)

    def _bordered(self, matrix: csc_matrix, border: FloatArray) -> csc_matrix:
        """A symmetric matrix with further rows and columns, given as (unknowns, E)."""
        inner, of_plain = border[self.plain :], csc_matrix(border[: self.plain])
        return bmat([[matrix, of_plain], [of_plain.T, (inner + inner.T) / 2]], format="csc")

    def point_values(self, xy: FloatArray, triangle: IntArray | None = None) -> csc_matrix:
        of_elements = super().point_values(xy, triangle)
        of_corners = self.functions.derivatives(xy, 1)[0][0] - of_elements @ self._lifts
        return hstack([of_elements, csc_matrix(of_corners)], format="csc")

    def element_dofs(self, unknowns: FloatArray) -> FloatArray:
        """Those of the triangles' polynomials, which leave s out."""
        return super().element_dofs(unknowns[: self.plain] - self._lifts @ unknowns[self.plain :])

    def evaluate(self, xy: FloatArray, unknowns: FloatArray, orders: int) -> list[FloatArray]:
        results, shares = super().evaluate(xy, unknowns, orders), unknowns[self.plain :]
        step = max(1, CHUNK // len(self.functions))
        for start in range(0, len(xy), step):
            part = slice(start, start + step)
            for result, tables in zip(results, self.functions.derivatives(xy[part], orders), strict=True):
                values = tables @ shares  # (d, n, k)
                for axes in np.ndindex(*result.shape[2:]):
                    result[(part, slice(None), *axes)] += values[sum(axes)]
        return results

    def laplacians(self, xy: FloatArray, unknowns: FloatArray) -> FloatArray:
        result, shares = super().laplacians(xy, unknowns), unknowns[self.plain :]
        step = max(1, CHUNK // len(self.functions))
        for start in range(0, len(xy), step):
            part = slice(start, start + step)
            xx, _, yy = self.functions.derivatives(xy[part], 3)[2]
            result[part] += (xx + yy) @ shares
        return result

    def linear(self) -> FloatArray:
        return np.concatenate([super().linear(), np.zeros((len(self.functions), 3))])
