"""A uniform plate on functions of a degree above five, solved for without the unknowns that triangles have alone.

Those of each triangle follow from its others, v_own = A^-1 (f_own - B v): dense algebra for all triangles at once. What
is left are the unknowns of points and edges, with the matrix C - B^T A^-1 B of each triangle.
"""

from __future__ import annotations

import numpy as np

from fem_plate.elements.factor import factorised
from fem_plate.elements.space import PlateSpace
from fem_plate.types import FloatArray

PASSES = 2  # a third changes nothing


class Condensed:
    """The equations of a plate of one law that its supports hold, on a space without corners of their own."""

    def __init__(self, space: PlateSpace, law: FloatArray) -> None:
        self.space = space
        self._bending = space.bending_inside(law)
        self._traces, self._couplings = space.traces(law), space.couplings(0.0)
        matrices = self._bending.copy()
        np.add.at(matrices, space.rim.triangle, space.at_rim(self._traces, self._couplings[0]))
        self._shared = space.triangles.functions.count - space.triangles.functions.own
        shared, own = slice(self._shared), slice(self._shared, None)
        self._border = matrices[:, own, shared]
        self._inverse = np.linalg.inv(matrices[:, own, own])
        self._follow = self._inverse @ self._border
        rest = matrices[:, shared, shared] - self._border.transpose(0, 2, 1) @ self._follow
        self._dofs = space.dofs[:, shared]
        self._count = int(self._dofs.max()) + 1
        self._factor = factorised(space.assembled_shared(rest))

    def solve(self, load: FloatArray) -> FloatArray:
        """The unknowns (unknowns, ...) under loads (unknowns, ...)."""
        loads = load.reshape(len(load), -1)
        own = self._inverse @ loads[self._count :].reshape(*self._inverse.shape[:2], loads.shape[1])
        shared = loads[: self._count].copy()
        np.subtract.at(shared, self._dofs, self._border.transpose(0, 2, 1) @ own)
        shared = self._factor(shared)
        own -= self._follow @ shared[self._dofs]
        return np.concatenate([shared, own.reshape(len(load) - self._count, -1)]).reshape(load.shape)

    def follow(self, traces: FloatArray) -> FloatArray:
        """The unknowns (unknowns, k) that make up at the rim for known functions, given by the traces (6 points, k).

        Rounding of the large penalties would be most of the error. So the answer is corrected by what it leaves, where
        they multiply the misfit at the rim.
        """
        space, unknowns = self.space, np.zeros((self.space.unknowns, traces.shape[1]))
        for _ in range(PASSES):
            local = unknowns[space.dofs]
            loads = space.misfit(self._traces, self._couplings, traces, local[space.rim.triangle])
            at_rim = np.einsum("ckni,cknf->kif", self._traces, loads, optimize=True)
            rest = space.assemble_load(at_rim, space.rim.triangle)
            np.subtract.at(rest, space.dofs, self._bending @ local)
            unknowns += self.solve(rest)
        return unknowns
