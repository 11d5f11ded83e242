"""Cells of a lattice that are translates of each other, far enough from where it ends: one fit serves them all."""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from fem_plate import InfluenceShapes, PatchedShapes, Shapes
from fem_plate.patches import SAME, margin, spacing
from particle.cells import CellFit

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

PER_PITCH = 2  # cells from one actuator of a lattice to the next
FEWEST = 100  # actuators of a lattice with an inside
TRIED = 100  # actuators, from the middle on


class Lattice:
    """The actuators of a plate where all stand on a lattice and are held alike.

    pitch: (2,) m.  origin: (2,) m, of actuator (0, 0).
    middle: an actuator's place (2,) in the lattice that has all its neighbours, as far inside as there is.
    Raises LookupError when no actuator has.
    """

    def __init__(self, shapes: InfluenceShapes | PatchedShapes, pitch: FloatArray, tolerance: float) -> None:
        self.pitch, self.origin = pitch, shapes.points.min(axis=0)
        self._outline = shapes.outline
        self._sites = np.round((shapes.points - self.origin) / pitch).astype(np.int64)
        self._rows = np.full(self._sites.max(axis=0) + 1, -1)
        self._rows[tuple(self._sites.T)] = np.arange(len(self._sites))
        truncation = shapes.truncation_error if isinstance(shapes, PatchedShapes) else 0.0
        # As far off as a patch's cut must be, so that the lattice's end does not show.
        self._depth = math.ceil(margin(max(truncation, 0.1 * tolerance)))
        self.middle = self._deepest()

    def _deepest(self) -> IntArray:
        by_distance = np.argsort(np.abs(self._sites - self._sites.mean(axis=0)).max(axis=1), kind="stable")
        for site in self._sites[by_distance[:TRIED]]:
            if self._is_deep(site):
                return np.asarray(site)
        raise LookupError("no actuator of the lattice has all its neighbours")

    def _is_deep(self, site: IntArray) -> bool:
        """Whether a site has all its neighbours as far as they count, and the rim is farther off than these."""
        low, high = site - self._depth + 1, site + self._depth + 1
        if (low < 0).any() or (high > self._rows.shape).any():
            return False
        middle = self.origin + (site + 0.5) * self.pitch
        reach = self._depth * float(self.pitch.max())
        square = self._rows[low[0] : high[0], low[1] : high[1]]
        return bool((square >= 0).all() and float(self._outline.gap(middle[None])[0]) > reach)

    def pitches(self, place: IntArray) -> IntArray | None:
        """How many pitches (2,) from the cell around `middle` of which it is a translate a cell is; None: it is none.

        place: (2,), counted from the origin.
        """
        site = place // PER_PITCH
        return site - self.middle if self._is_deep(site) else None

    def nearby(self, centre: FloatArray, rows: IntArray) -> NDArray[np.bool_]:
        """Which of the actuators are so near to a cell that each of its translates has them, too."""
        away = self._sites[rows] - np.floor((centre - self.origin) / self.pitch)
        return np.asarray((np.abs(away - 0.5) < self._depth).all(axis=1))

    def moved(self, fit: CellFit, pitches: IntArray, clear: float) -> CellFit:
        """A cell's fit some pitches (2,) away, `clear` [m] of the rim."""
        return fit._replace(drive=self._shift(fit.drive, pitches), near=self._shift(fit.near, pitches), clear=clear)

    def _shift(self, rows: IntArray, pitches: IntArray) -> IntArray:
        return np.asarray(self._rows[tuple((self._sites[rows] + pitches).T)])


def lattice_of(shapes: Shapes, tolerance: float) -> Lattice | None:
    """The lattice on which all actuators stand, if they do, are held alike and are so many that cells may be shared."""
    if not isinstance(shapes, InfluenceShapes | PatchedShapes) or np.any(shapes.springs != shapes.springs[0]):
        return None
    if len(shapes.points) < FEWEST:
        return None
    pitch = spacing(shapes.points)
    sites = (shapes.points - shapes.points.min(axis=0)) / pitch
    if np.abs(sites - np.round(sites)).max() > 10.0**-SAME * np.ptp(sites):
        return None
    with suppress(LookupError):
        return Lattice(shapes, pitch, tolerance)
    return None
