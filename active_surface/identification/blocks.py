"""Blocks: which parameters act on which track's residuals, as shared fields act on all and own fields on one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import BoolArray, FloatArray

SMALL: Final = 1e-5  # singular values of slopes, over the largest: directions without effect
FLAT: Final = 1e-12  # the diagonal of a field without effect, over the largest


@dataclass(frozen=True)
class Blocks:
    """N tracks with m residuals in all, and n parameters in s slots: those shared, then those that each has for itself.

    An own slot stands for N parameters, and as none of them acts on another's track, two paths of each track give the
    slopes of all. So slopes are an array (m, s), and a step costs as much for each track, however many there are.
    """

    shared: int
    columns: NDArray[np.intp]  # (N, s) the number of the parameter in each slot
    rows: tuple[slice, ...]  # of each track's residuals

    @classmethod
    def of(cls, sizes: Sequence[int], shared: int, own: int) -> Blocks:
        """Those of tracks with numbers of residuals (N,), and numbers of shared and own fields."""
        alone = shared + np.arange(len(sizes) * own).reshape(len(sizes), own)
        columns = np.hstack([np.tile(np.arange(shared), (len(sizes), 1)), alone]).astype(np.intp)
        ends = np.cumsum(sizes).tolist()
        return cls(shared, columns, tuple(slice(end - size, end) for end, size in zip(ends, sizes, strict=True)))

    @property
    def count(self) -> int:
        """n, of parameters."""
        return int(self.columns.max()) + 1

    @property
    def several(self) -> bool:
        """Whether any track has fields that others lack."""
        tracks, slots = self.columns.shape
        return tracks > 1 and slots > self.shared

    @property
    def freedom(self) -> FloatArray:
        """Degrees of freedom (N,) of residuals: own fields take theirs, shared ones in proportion to places."""
        sizes = np.array([rows.stop - rows.start for rows in self.rows], dtype=float)
        return np.asarray(sizes - (self.columns.shape[1] - self.shared) - self.shared * sizes / sizes.sum())

    def everywhere(self, points: FloatArray) -> FloatArray:
        """Shares (k, n) in which each track has the values of points (k, s)."""
        shares = np.empty((len(points), self.count))
        for columns in self.columns:
            shares[:, columns] = points
        return shares

    def differences(self, shares: FloatArray, free: BoolArray, width: float | FloatArray) -> FloatArray:
        """Two points (2 f, n) for each free slot, below and above the shares (n,) as far as the bounds allow."""
        widths, rows = np.broadcast_to(width, shares.shape), []
        for columns in self._free(free):
            for side in (-1, 1):
                rows.append(np.array(shares))
                rows[-1][columns] = np.clip(shares[columns] + side * widths[columns], 0, 1)
        return np.array(rows).reshape(-1, len(shares))

    def slopes(self, points: Sequence[FloatArray], residuals: Sequence[FloatArray], free: BoolArray) -> FloatArray:
        """The derivatives (m, s) of residuals, from those at the points of `differences`; 0 of a fixed parameter, and
        where residuals are infinite."""
        slope = np.zeros((self.rows[-1].stop, self.columns.shape[1]))
        slots = [slot for slot, columns in enumerate(self.columns.T) if free[columns].any()]
        for place, slot in enumerate(slots):
            pair = slice(2 * place, 2 * place + 2)
            for column, rows in zip(self.columns[:, slot], self.rows, strict=True):
                (low, high), (before, after) = points[pair], (one[rows] for one in residuals[pair])
                if free[column] and np.isfinite([before, after]).all():
                    slope[rows, slot] = (after - before) / (high[column] - low[column])
        return slope

    def information(self, slope: FloatArray, weights: FloatArray) -> FloatArray:
        """For each track the matrix (N, n, n) of its slopes times themselves, with weights (N,)."""
        found = np.zeros((len(self.rows), self.count, self.count))
        for matrix, weight, columns, rows in zip(found, weights, self.columns, self.rows, strict=True):
            matrix[np.ix_(columns, columns)] = weight * slope[rows].T @ slope[rows]
        return found

    def along(self, slope: FloatArray, change: FloatArray) -> FloatArray:
        """The change (m,) of residuals along slopes (m, s) where shares change (n,)."""
        pairs = zip(self.columns, self.rows, strict=True)
        return np.concatenate([slope[rows] @ change[columns] for columns, rows in pairs])

    def step(self, slope: FloatArray, residuals: FloatArray, weights: FloatArray, damping: float) -> FloatArray:
        """The change (n,) of shares that makes the weighted squares of residuals (m,) least along slopes (m, s).

        Variable projection: for any change of the shared fields each track's own are known, so what its own slopes
        can describe is projected out of its shared slopes and residuals, and the shared ones follow from what is left.

        damping: of each parameter, over the diagonal of the matrix of all.
        """
        root, change, shared = np.sqrt(weights), np.zeros(self.count), self.shared
        brake = np.sqrt(damping * self._diagonal(slope, weights))
        left, follow = [], []
        for columns, rows in zip(self.columns, self.rows, strict=True):
            own = columns[shared:]
            scaled = root[rows, None] * np.column_stack([slope[rows], residuals[rows]])
            target = np.vstack([np.delete(scaled, np.s_[shared:-1], axis=1), np.zeros((len(own), shared + 1))])
            basis = np.vstack([scaled[:, shared:-1], np.diag(brake[own])])
            follow.append(np.linalg.lstsq(basis, target, rcond=SMALL)[0] if len(own) else target[:0])
            left.append(target - basis @ follow[-1])
        braked = np.column_stack([np.diag(brake[:shared]), np.zeros(shared)])
        rest = np.vstack([*left, braked])
        if shared:
            change[:shared] = np.linalg.lstsq(rest[:, :-1], rest[:, -1], rcond=SMALL)[0]
        for columns, answer in zip(self.columns, follow, strict=True):
            change[columns[shared:]] = answer[:, -1] - answer[:, :-1] @ change[:shared]
        return -change

    def _diagonal(self, slope: FloatArray, weights: FloatArray) -> FloatArray:
        squares, diagonal = weights[:, None] * slope**2, np.zeros(self.count)
        for columns, rows in zip(self.columns, self.rows, strict=True):
            diagonal[columns] += squares[rows].sum(axis=0)
        return np.maximum(diagonal, FLAT * max(float(diagonal.max()), np.finfo(float).tiny))

    def _free(self, free: BoolArray) -> list[NDArray[np.intp]]:
        """The free parameters of each slot that has any."""
        slots = [np.unique(columns[free[columns]]) for columns in self.columns.T]
        return [columns for columns in slots if len(columns)]
