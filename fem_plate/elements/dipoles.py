"""Sources that all but coincide: each is taken as its difference from another one.

Two actuators a distance d apart, one raised, push against each other with forces of the order of 1 / d^2. Their sum
follows from second differences of Green's functions, of the order of d^2 ln d, which rounding of the functions
themselves would hide: at d = 1e-8 by a hundredth. A difference over d, a dipole, loses no more than rounding over d.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from fem_plate.elements.infinite import InfinitePlate
from fem_plate.types import BoolArray, FloatArray, IntArray

CLOSE = 1e-3  # of the plate's size: sources nearer than that are taken as differences
EPSILON = float(np.finfo(float).eps)
APART = 8.0  # times the longer of two dipoles: beyond that their second difference is a mean of Hessians
NODES, WEIGHTS = (0.5 * values for values in leggauss(6))


@dataclass(frozen=True)
class SourceBasis:
    """N sources, or dipoles in place of some: each row of `matrix`, times a column's coefficient, is its force."""

    x: FloatArray  # (N, 2)
    matrix: csr_matrix  # (N, N)
    dipoles: IntArray  # (m,), columns that are differences
    parents: IntArray  # (m,), rows of what they are differences from
    lengths: FloatArray  # (m,)

    @property
    def rounding(self) -> float:
        """The error, relative to the largest value, of a function that tells the sources of a dipole apart."""
        return float(EPSILON / self.lengths.min(initial=np.inf))

    def within(self, columns: range) -> list[tuple[int, int, float]]:
        """The dipoles among some columns: column, parent, length."""
        rows = zip(self.dipoles.tolist(), self.parents.tolist(), self.lengths.tolist(), strict=True)
        return [row for row in rows if row[0] in columns]

    def point_values(self, infinite: InfinitePlate) -> FloatArray:
        """The infinite plate's compliance (N, N) in this basis."""
        values = infinite.point_value(self.x, self.x)
        if not self.dipoles.size:
            return values
        values = np.asarray(self.matrix.T @ (self.matrix.T @ values.T).T)
        middle = (self.x[self.dipoles] + self.x[self.parents]) / 2
        arm = self.x[self.dipoles] - self.x[self.parents]
        distance = np.linalg.norm(middle[:, None] - middle, axis=-1)
        i, j = np.nonzero(distance > APART * np.maximum(self.lengths[:, None], self.lengths))
        along = arm / self.lengths[:, None]
        mean = np.zeros(len(i))
        for a, weight in zip(NODES, WEIGHTS, strict=True):
            for b, other in zip(NODES, WEIGHTS, strict=True):
                offset = middle[i] + a * arm[i] - middle[j] - b * arm[j]
                ((xx, xy, yy),) = infinite.derivatives(offset[:, None], self.x[self.parents[:1]], [2])
                hessian = np.stack([xx, xy, xy, yy], axis=-1).reshape(-1, 2, 2)
                mean -= weight * other * np.einsum("kd,kde,ke->k", along[i], hessian, along[j])
        values[self.dipoles[i], self.dipoles[j]] = mean
        return values

    def green(self, compliance: FloatArray) -> FloatArray:
        """The compliance (N, N) between sources from that in this basis."""
        values = compliance.copy()
        for row, parent, length in self.within(range(len(self.x))):  # a parent comes before its dipoles
            values[row] = length * values[row] + values[parent]
            values[:, row] = length * values[:, row] + values[:, parent]
        return values


def source_basis(x: FloatArray, held: BoolArray) -> SourceBasis:
    """The basis for sources at x (N, 2): those of held actuators that have an earlier one close by are dipoles."""
    rows = np.flatnonzero(held)
    nearest: dict[int, tuple[float, int]] = {}
    for i, j in rows[cKDTree(x[rows]).query_pairs(CLOSE, output_type="ndarray")].tolist() if len(rows) > 1 else []:
        first, second = sorted((i, j))
        found = float(np.linalg.norm(x[second] - x[first])), first
        nearest[second] = min(nearest.get(second, found), found)
    dipoles = np.array(sorted(nearest), dtype=np.int64)
    parents = np.array([nearest[k][1] for k in sorted(nearest)], dtype=np.int64)
    lengths = np.array([nearest[k][0] for k in sorted(nearest)])
    scale = np.ones(len(x))
    scale[dipoles] = 1 / lengths
    every = np.arange(len(x))
    data = np.concatenate([scale, -1 / lengths])
    where = np.concatenate([every, parents]), np.concatenate([every, dipoles])
    return SourceBasis(x, csr_matrix((data, where), shape=(len(x), len(x))), dipoles, parents, lengths)
