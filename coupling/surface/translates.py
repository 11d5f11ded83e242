"""Cells of a lattice that are translates of each other, far enough from where it ends: one fit serves them all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coupling.surface.cell import Fitted
from fem_plate import InfluenceShapes, PatchedShapes
from fem_plate.arrays import PITCH_DIGITS, spacing
from particle.surface import CellFit

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

PER_PITCH = 2  # cells from one actuator of a lattice to the next
MIN_ACTUATORS = 100  # actuators of a lattice with an inside
SIDES = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j])  # ways to go from the middle
NEARER = 1e-9  # of places that are equally far out that way, the one nearest to the middle


class Lattice:
    """The actuators of a plate where all stand on a lattice and are held alike.

    Its blocks are the rectangles between four neighbours; one is named by the actuator at its lower left.
    pitch: (2,) m.  origin: (2,) m, of actuator (0, 0).  middle: (2,), the block that is farthest inside.
    """

    def __init__(self, shapes: InfluenceShapes | PatchedShapes, pitch: FloatArray) -> None:
        from scipy.ndimage import distance_transform_edt  # here, because few plates have a lattice

        self.pitch, self.origin = pitch, shapes.points.min(axis=0)
        self._sites = np.round((shapes.points - self.origin) / pitch).astype(np.int64)
        self._rows = np.full(self._sites.max(axis=0) + 1, -1)
        self._rows[tuple(self._sites.T)] = np.arange(len(self._sites))
        blocks = np.stack(np.meshgrid(*map(np.arange, self._rows.shape), indexing="ij"), axis=-1)
        self._gap = shapes.outline.gap(self.origin + (blocks + 0.5) * pitch)
        whole = np.pad(self._full(np.zeros(2, dtype=np.int64), np.ones(2, dtype=np.int64)), 1)
        inside = np.minimum(distance_transform_edt(whole, sampling=pitch)[1:-1, 1:-1], self._gap)
        deepest = np.argwhere(inside > inside.max() - 1e-9 * pitch.min())
        self.middle: IntArray = deepest[np.abs(deepest + 0.5 - self._sites.mean(axis=0)).max(axis=1).argmin()]
        self._alike = np.zeros(self._rows.shape, dtype=np.bool_)

    def _full(self, low: IntArray, high: IntArray) -> NDArray[np.bool_]:
        """From which sites there are actuators all over the columns and rows from `low` (2,) to `high` (2,) off."""
        from scipy.ndimage import minimum_filter

        size = high - low + 1
        there = self._rows >= 0
        return np.asarray(minimum_filter(there, tuple(size), origin=tuple(-low - size // 2), mode="constant", cval=0))

    def spread(self, fits: Sequence[CellFit], farther: int) -> IntArray:
        """Where the block may be moved whose cells have these fits: to where all actuators of theirs are, too.

        farther: rows and columns of actuators that are to be around those.
        Returns the pitches (k, 2) from the middle to the outermost of these places on each side; none where the middle
        itself is too near to where the lattice or the plate ends.
        """
        rows = np.unique(np.concatenate([used for fit in fits for used in (fit.drive, fit.near)]))
        off = np.concatenate([self._sites[rows] - self.middle, [[0, 0], [1, 1]]])
        low, high = off.min(axis=0) - farther, off.max(axis=0) + farther
        reach = float((np.maximum(0.5 - low, high - 0.5) * self.pitch).max())
        self._alike = self._full(low, high) & (self._gap > reach)
        if not self._alike[tuple(self.middle)]:
            return np.empty((0, 2), dtype=np.int64)
        pitches = np.argwhere(self._alike) - self.middle
        along = pitches @ SIDES.T - NEARER * (pitches**2).sum(axis=1)[:, None]
        return np.unique(pitches[along.argmax(axis=0)], axis=0)

    def pitches(self, place: IntArray) -> IntArray | None:
        """How many pitches (2,) from the cell of the middle of which it is a translate a cell is; None: it is none.

        place: (2,), counted from the origin.
        """
        site = place // PER_PITCH
        if (site < 0).any() or (site >= self._alike.shape).any() or not self._alike[tuple(site)]:
            return None
        return np.asarray(site - self.middle)

    def moved(self, fit: CellFit, pitches: IntArray, clear: float) -> CellFit:
        """A cell's fit some pitches (2,) away, `clear` [m] of the rim."""
        drive, near = self._shift(fit.drive, pitches), self._shift(fit.near, pitches)
        return fit._replace(drive=drive, near=near, clear=clear, shared=True)

    def _shift(self, rows: IntArray, pitches: IntArray) -> IntArray:
        return np.asarray(self._rows[tuple((self._sites[rows] + pitches).T)])


def lattice_of(shapes: Fitted) -> Lattice | None:
    """The lattice on which all actuators stand, if they do, hold the plate alike and are enough for an inside."""
    if not isinstance(shapes, InfluenceShapes | PatchedShapes) or len(shapes.points) < MIN_ACTUATORS:
        return None
    if shapes.springs[0] == 0 or np.any(shapes.springs != shapes.springs[0]):
        return None
    pitch = spacing(shapes.points)
    sites = (shapes.points - shapes.points.min(axis=0)) / pitch
    if np.abs(sites - np.round(sites)).max() > 10.0**-PITCH_DIGITS * np.ptp(sites):
        return None
    return Lattice(shapes, pitch)
