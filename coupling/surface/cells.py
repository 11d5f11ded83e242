"""The cells of a plate's surface: a background grid whose cells are built where a part comes to.

On a lattice of actuators cells that are translates of each other share one fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from coupling.surface.cell import Cell, Fitted, misfit
from coupling.surface.cell_maker import OVERHANG, CellMaker
from coupling.surface.translates import PER_PITCH, Lattice, lattice_of
from particle.surface import NOWHERE, UNBUILT, WHOLE, CellPool, Cells

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

WORSE = 2.0  # times as far off a shared fit may be elsewhere
ACROSS = 8  # cells along the plate's longer side, at least
PER_SPACING = 2.0  # cells from one actuator to the next
MAX_ROOTS = 16.0  # cells for each actuator: where some stand much closer together, these alone are divided
BLOCK = 3  # cells a side that are built together
BUILDING = Lock()  # one for all surfaces, as the limit of BLAS threads is the process's


class PlateCells:
    """The cells of a plate's shapes, a `particle.CellStore`.

    tolerance: largest error of a unit shape's fit.  error: the largest one measured so far, relative to the shapes'
    heights at their own actuators.
    """

    def __init__(self, shapes: Fitted, tolerance: float) -> None:
        self.shapes, self.error = shapes, 0.0
        self._maker = CellMaker(shapes, tolerance)
        self._lattice = None if self._maker.few else lattice_of(shapes)
        with BUILDING:
            self._originals = self._shared(self._lattice) if self._lattice else {}
            if not self._originals:
                self._lattice = None
            self._pool = CellPool(*self._grid())
            self.cells: Cells = self._pool.cells()
            if self._maker.few:
                self._build(np.argwhere(self._pool.roots == UNBUILT))

    def _grid(self) -> tuple[FloatArray, FloatArray, IntArray]:
        """The grid's origin and cell width (2,) [m], and which of its cells (nx, ny) there is to build."""
        low, high = self.shapes.outline.box
        longest = float((high - low).max())
        across = float(ACROSS)
        if self._lattice:
            # In step with the lattice, so that cells a pitch apart are alike.
            width = self._lattice.pitch / PER_PITCH
            first = np.floor((low - self._lattice.origin) / width + 1e-9)
            origin = self._lattice.origin + first * width
            counts = np.ceil((high - origin) / width - 1e-9).astype(int)
            return origin, width, self._on_plate(origin, width, counts)
        if not self._maker.few:
            spacing = float(np.median(self._maker.tree.query(self._maker.tree.data, 2)[0][:, 1]))
            limit = np.sqrt(MAX_ROOTS * len(self.shapes.points) * longest / float((high - low).min()))
            across = max(across, min(PER_SPACING * longest / spacing, limit))
        width = longest / np.ceil(across * (1 - 1e-9))
        counts = np.ceil((high - low) / width * (1 - 1e-9)).astype(int)
        origin = (low + high - counts * width) / 2
        return origin, np.full(2, width), self._on_plate(origin, np.full(2, width), counts)

    def _on_plate(self, origin: FloatArray, width: FloatArray, counts: IntArray) -> IntArray:
        """Which of the grid's cells (nx, ny) there is to build: those whose circle reaches the plate."""
        centres = np.stack(np.meshgrid(*(np.arange(n) + 0.5 for n in counts), indexing="ij"), axis=-1) * width + origin
        on_plate = self.shapes.outline.gap(centres) > -np.hypot(*width) / 2
        return np.where(on_plate, UNBUILT, NOWHERE)

    def build(self, places: FloatArray) -> None:
        """Makes sure that there are cells at places (n, 2) [m] on the plate."""
        # Always the same cells together, in whatever order they are asked for: so each has the same bits.
        last = np.array(self._pool.roots.shape) - 1
        at = np.clip(np.floor((places - self._pool.origin) / self._pool.width).astype(int), 0, last)
        blocks = np.unique(at // BLOCK, axis=0)
        for i, j in (blocks * BLOCK).tolist():
            with BUILDING:  # paths on several threads may ask for the same
                block = self._pool.roots[i : i + BLOCK, j : j + BLOCK]
                if (block == UNBUILT).any():
                    self._build(np.argwhere(block == UNBUILT) + (i, j))

    def _build(self, roots: IntArray) -> None:
        pool = self._pool
        moved = [self._translate(place) for place in roots]
        fresh = [self._cell(place) for place, cell in zip(roots, moved, strict=True) if cell is None]
        self._maker.make(fresh)
        cells = iter(fresh)
        for place, translate in zip(roots, moved, strict=True):
            cell = translate or next(cells)
            pool.roots[tuple(place)] = pool.add(cell.centre, cell.half, cell.fit, self._add_quarters(cell))
            self.error = max([self.error, *(leaf.error + leaf.left_out for leaf in cell.leaves())])
        self.cells = pool.cells()

    def _cell(self, place: IntArray) -> Cell:
        half = self._pool.width / 2
        return Cell(self._pool.origin + (2 * place + 1) * half, half)

    def _shared(self, lattice: Lattice) -> dict[tuple[int, int], Cell]:
        """The cells in the middle of a lattice by their place there; none where their translates were not as good."""
        half = lattice.pitch / PER_PITCH / 2
        corner = lattice.origin + lattice.middle * lattice.pitch
        cells = {
            (i, j): Cell(corner + half * (2 * i + 1, 2 * j + 1), half) for i, j in np.ndindex(PER_PITCH, PER_PITCH)
        }
        self._maker.make(list(cells.values()))
        leaves = [leaf for cell in cells.values() for leaf in cell.leaves()]
        fits = [leaf.fit for leaf in leaves if leaf.fit]
        max_errors = [max(self._maker.worth, WORSE * (leaf.error + leaf.left_out)) for leaf in leaves]
        farther = 0
        while len(places := lattice.spread(fits, farther)):
            if all(self._is_good(lattice, leaves, max_errors, pitches) for pitches in places):
                return cells
            farther = 2 * farther + 1
        return {}

    def _is_good(
        self, lattice: Lattice, leaves: Sequence[Cell], max_errors: Sequence[float], pitches: IntArray
    ) -> bool:
        """Whether no cell moved some pitches (2,) exceeds its largest error; keep what they are off by."""
        off = [
            misfit(self._moved(lattice, leaf, pitches), self._maker.checks, self.shapes, self._maker.heights)
            for leaf in leaves
        ]
        good = all(error + left_out <= bound for (error, left_out), bound in zip(off, max_errors, strict=True))
        for leaf, (error, left_out) in zip(leaves, off, strict=True):
            if good:
                leaf.error, leaf.left_out = max(leaf.error, error), max(leaf.left_out, left_out)
        return good

    def _translate(self, place: IntArray) -> Cell | None:
        """A cell of a lattice from its original in the middle; None where it is like no other."""
        lattice = self._lattice
        if not lattice:
            return None
        place = place + np.round((self._pool.origin - lattice.origin) / self._pool.width).astype(np.int64)
        pitches = lattice.pitches(place)
        if pitches is None:
            return None
        i, j = (place % PER_PITCH).tolist()
        return self._moved(lattice, self._originals[i, j], pitches)

    def _moved(self, lattice: Lattice, cell: Cell, pitches: IntArray) -> Cell:
        centre = cell.centre + pitches * lattice.pitch
        clear = float(self.shapes.outline.gap(centre[None])[0]) - OVERHANG * float(np.hypot(*cell.half))
        fit = cell.fit and lattice.moved(cell.fit, pitches, max(clear, 0.0))
        quarters = [self._moved(lattice, quarter, pitches) for quarter in cell.quarters]
        return Cell(centre, cell.half, fit, cell.error, cell.left_out, quarters)

    def _add_quarters(self, cell: Cell) -> int:
        below = [self._add_quarters(quarter) for quarter in cell.quarters]
        rows = [
            self._pool.add(quarter.centre, quarter.half, quarter.fit, first)
            for quarter, first in zip(cell.quarters, below, strict=True)
        ]
        return rows[0] if rows else WHOLE
