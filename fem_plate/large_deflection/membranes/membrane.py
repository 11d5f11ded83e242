"""Membrane: what stretching adds to a plate's energy, in one of two discretisations.

Dimensionless: lengths by the plate's size a, w by the thickness t, membrane forces by D / a^2, in-plane motion by
t^2 / a, energies by D t^2 / a^2. With p = grad w, pp = p p^T and m the membrane's unknowns, whose force is L m,

    energy = sign 1/2 m.S m + 1/2 int (L m) : pp + 1/8 int pp : A : pp

The Airy function has sign -1 and no A; in-plane motion has +1 and the plate's membrane law A. At rest the energy is
stationary in m: m = -sign S^-1 t with t = 1/2 int L : pp.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.large_deflection.membranes.samples import Samples, halves, squares, thirds
from fem_plate.types import FloatArray, IntArray

AIRY, PLANE_STRESS = "airy", "plane-stress"


@dataclass(frozen=True, eq=False)
class Membrane:
    """One discretisation of a plate's stretching."""

    name: str  # "airy" or "plane-stress"
    samples: tuple[Samples, ...]
    dofs: IntArray  # (triangles, m), all unknowns of each triangle
    stiffness: csc_matrix  # S, of the independent ones
    solve: Callable[[FloatArray], FloatArray]  # S^-1
    sign: float
    law: FloatArray | None  # A (3, 3), from strains (xx, 2 xy, yy) to forces (xx, xy, yy); None: there is none
    expand: Callable[[FloatArray], FloatArray]  # all unknowns from the independent ones
    reduce: Callable[[FloatArray], FloatArray]  # its transpose

    def respond(self, slopes: list[FloatArray]) -> tuple[FloatArray, float]:
        """The unknowns at rest and the energy, for slopes p (k, 2 n) at each set of samples."""
        t = np.zeros(int(self.dofs.max()) + 1)
        beyond = 0.0
        for samples, p in zip(self.samples, slopes, strict=True):
            square = squares(p)
            element = np.einsum("kni,kn->ki", samples.operator, samples.weighted(0.5 * square), optimize=True)
            np.add.at(t, self.dofs[samples.triangle], element)
            if self.law is not None:
                beyond += 0.125 * float((samples.weighted(square) * self._by_law(square)).sum())
        t = self.reduce(t)
        m = -self.sign * self.solve(t)
        return m, 0.5 * float(m @ t) + beyond

    def linear_force(self, samples: Samples, everything: FloatArray) -> FloatArray:
        """The membrane force (k, 3 n, c) of all unknowns (all, c)."""
        return np.asarray(samples.operator @ everything[self.dofs[samples.triangle]])

    def force(self, samples: Samples, everything: FloatArray, p: FloatArray) -> FloatArray:
        """The membrane force (k, 3 n), from all unknowns and the plate's slopes p (k, 2 n)."""
        force = self.linear_force(samples, everything[:, None])[..., 0]
        return np.asarray(force if self.law is None else force + 0.5 * self._by_law(squares(p)))

    def stiffening(self, p: FloatArray) -> FloatArray:
        """What adds to the force in the energy's second derivative: B (k, 3 n) with q.B q = (p q) : A : (p q)."""
        if self.law is None:
            return np.zeros((len(p), 3 * p.shape[1] // 2))
        (x, y), A = halves(p), self.law
        xx = A[0, 0] * x * x + 2 * A[0, 1] * x * y + A[1, 1] * y * y
        xy = A[0, 1] * x * x + (A[0, 2] + A[1, 1]) * x * y + A[1, 2] * y * y
        yy = A[1, 1] * x * x + 2 * A[1, 2] * x * y + A[2, 2] * y * y
        return np.concatenate([xx, xy, yy], axis=1)

    def _by_law(self, strain: FloatArray) -> FloatArray:
        """A times stacked strains (k, 3 n)."""
        assert self.law is not None
        return np.concatenate(
            [sum(a * part for a, part in zip(row, thirds(strain), strict=True)) for row in self.law], axis=1
        )
