"""The cells of a plate's surface: polynomials fitted to its shapes, built where a part comes to.

A cell keeps the logarithms of the actuators close by. What is left of a shape is smooth there, and fitted by least
squares at points that reach a little beyond the cell. A cell whose fit, checked at points that it has not seen, is not
good enough is divided into four, and so is one with too many logarithms.
"""

from __future__ import annotations

from collections.abc import Sequence
from threading import Lock

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from threadpoolctl import threadpool_limits

from coupling.cell import Cell, misfit, monomials, powers
from coupling.rim import rim_curves
from coupling.translates import PER_PITCH, Lattice, lattice_of
from fem_plate import PatchedShapes, Shapes
from fem_plate.singular import UNIT_STRENGTH, point_value
from particle.cells import NOWHERE, UNBUILT, WHOLE, CellFit, CellPool, Cells

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

DEGREES = range(2, 11)  # of the polynomials: the lowest that does, as it costs least
SPARE = 0.01  # of the tolerance: how good it must then be
OVERHANG = 1.25  # cells are fitted over this many half widths, so that a step may end a little outside
NODES = 12  # Chebyshev points a side that a cell inside the rim is fitted to
CHECKS = 48  # points between those, at which its error is measured
FEW = 8  # actuators whose logarithms are kept everywhere: their exact sum is cheaper than smaller cells
RCOND = 1e-12
DEEPEST = 6  # times that a cell is divided
LESS = 0.1  # of its error: dividing many cells pays if that is left at most
# This is enough for those that stand out of their like, as at corners, and where errors are too large to show an order.
LESS_AT_CORNERS, OUTSTANDING, COARSE = 0.75, 10.0, 1e-3
WORSE = 2.0  # times as far off a shared fit may be elsewhere
ACROSS = 8  # cells along the plate's longer side, at least
PER_SPACING = 2.0  # cells from one actuator to the next
MOST_ROOTS = 16.0  # cells for each actuator: where some stand much closer together, these alone are divided
# The polynomial's error falls with the distance of the nearest logarithm that it takes up, in half widths.
REACH, REACHED, REACH_ORDER = 8.0, 1e-9, 9
BLOCK = 3  # cells a side that are built together
MOST_DIVIDED = 128  # at once: where more are not good enough, the shapes are not
BUILDING = Lock()  # one for all surfaces, as the limit of BLAS threads is the process's
MOST_VALUES = 4_000_000  # points times shapes that are evaluated at once


class PlateCells:
    """The cells of a plate's shapes, a `particle.CellStore`.

    tolerance: largest error of a unit shape's fit.  error: the largest one measured so far, relative to the shapes'
    heights at their own actuators.
    """

    def __init__(self, shapes: Shapes, tolerance: float) -> None:
        self.shapes, self.error = shapes, 0.0
        # Shapes that are cut off are not worth a fit that is much better than that.
        truncation = shapes.truncation_error if isinstance(shapes, PatchedShapes) else 0.0
        self._worth = max(tolerance, truncation)
        self._aim, self._negligible = max(tolerance, 0.1 * truncation), self._worth / 4
        self._heights = shapes.own_heights()
        self._few = len(shapes.points) <= FEW
        self._reach = REACH * (REACHED / self._aim) ** (1 / REACH_ORDER)
        self._tree = cKDTree(shapes.points)
        nodes = OVERHANG * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
        self._nodes = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
        self._inverses = {degree: np.linalg.pinv(monomials(self._nodes, degree)) for degree in DEGREES}
        self._checks = np.random.default_rng(0).uniform(-1, 1, (CHECKS, 2))
        self._lattice = None if self._few else lattice_of(shapes)
        with BUILDING:
            self._originals = self._shared(self._lattice) if self._lattice else {}
            if not self._originals:
                self._lattice = None
            self._pool = CellPool(*self._grid())
            self.cells: Cells = self._pool.cells()
            if self._few:
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
            return origin, width, self._wanted(origin, width, counts)
        if not self._few:
            spacing = float(np.median(self._tree.query(self._tree.data, 2)[0][:, 1]))
            most = np.sqrt(MOST_ROOTS * len(self.shapes.points) * longest / float((high - low).min()))
            across = max(across, min(PER_SPACING * longest / spacing, most))
        width = longest / np.ceil(across * (1 - 1e-9))
        counts = np.ceil((high - low) / width * (1 - 1e-9)).astype(int)
        origin = (low + high - counts * width) / 2
        return origin, np.full(2, width), self._wanted(origin, np.full(2, width), counts)

    def _wanted(self, origin: FloatArray, width: FloatArray, counts: IntArray) -> IntArray:
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
        self._make(fresh)
        cells = iter(fresh)
        for place, translate in zip(roots, moved, strict=True):
            cell = translate or next(cells)
            pool.roots[tuple(place)] = pool.add(cell.centre, cell.half, cell.fit, self._add_quarters(cell))
            self.error = max([self.error, *(leaf.error + leaf.left_out for leaf in cell.leaves())])
        self.cells = pool.cells()

    def _cell(self, place: IntArray) -> Cell:
        half = self._pool.width / 2
        return Cell(self._pool.origin + (2 * place + 1) * half, half)

    def _make(self, cells: Sequence[Cell]) -> None:
        # Many small systems: BLAS threads would only wait for each other (a hundred times slower on two busy cores).
        if cells:
            with threadpool_limits(limits=1, user_api="blas"):
                self._fit(cells)
                self._divide(cells, DEEPEST)

    def _shared(self, lattice: Lattice) -> dict[tuple[int, int], Cell]:
        """The cells in the middle of a lattice by their place there; none where their translates were not as good."""
        half = lattice.pitch / PER_PITCH / 2
        corner = lattice.origin + lattice.middle * lattice.pitch
        found = {
            (i, j): Cell(corner + half * (2 * i + 1, 2 * j + 1), half) for i, j in np.ndindex(PER_PITCH, PER_PITCH)
        }
        self._make(list(found.values()))
        leaves = [leaf for cell in found.values() for leaf in cell.leaves()]
        fits = [leaf.fit for leaf in leaves if leaf.fit]
        most = [max(self._worth, WORSE * (leaf.error + leaf.left_out)) for leaf in leaves]
        farther = 0
        while len(places := lattice.spread(fits, farther)):
            if all(self._is_good(lattice, leaves, most, pitches) for pitches in places):
                return found
            farther = 2 * farther + 1
        return {}

    def _is_good(self, lattice: Lattice, leaves: Sequence[Cell], most: Sequence[float], pitches: IntArray) -> bool:
        """Whether cells moved some pitches (2,) are off by `most` each, at most; what they are off by is kept."""
        off = [misfit(self._moved(lattice, leaf, pitches), self._checks, self.shapes, self._heights) for leaf in leaves]
        good = all(error + left_out <= bound for (error, left_out), bound in zip(off, most, strict=True))
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

    def _divide(self, cells: Sequence[Cell], deepest: int) -> None:
        """Divide those that are not good enough, if it helps: what finite elements are off by stays."""
        crowded = [cell for cell in cells if not self._few and cell.fit and len(cell.fit.near) > FEW]
        poor = [cell for cell in cells if cell.error > self._aim and cell not in crowded]
        tried = crowded + poor
        if not tried or deepest == 0 or len(tried) > MOST_DIVIDED:
            return
        quarters = []
        for cell in tried:
            centres = [cell.centre + cell.half / 2 * side for side in ([-1, -1], [-1, 1], [1, -1], [1, 1])]
            quarters.append([Cell(centre, cell.half / 2) for centre in centres])
        self._fit([quarter for four in quarters for quarter in four])
        typical = float(np.median([cell.error for cell in cells]))
        for cell, four in zip(tried, quarters, strict=True):
            errors = np.array([quarter.error for quarter in four])
            less = LESS_AT_CORNERS if cell.error > min(COARSE, OUTSTANDING * typical) else LESS
            helps = errors.max() < less * cell.error or (errors <= self._aim).sum() >= 2
            if cell in crowded or helps:
                cell.quarters, cell.fit = four, None
        self._divide([quarter for cell in tried for quarter in cell.quarters], deepest - 1)

    def _fit(self, cells: Sequence[Cell]) -> None:
        """Fit cells of one size."""
        some = max(1, MOST_VALUES // (len(self.shapes.points) * (len(self._nodes) + CHECKS)))
        for start in range(0, len(cells), some):
            self._fit_some(cells[start : start + some])

    def _fit_some(self, cells: Sequence[Cell]) -> None:
        half = cells[0].half
        centres = np.array([cell.centre for cell in cells])
        gap, radius = self.shapes.outline.gap(centres), float(np.hypot(*half))
        inside = gap > OVERHANG * radius
        samples = [
            self._nodes if inner else self._at_rim(cell, OVERHANG, 1.0)
            for cell, inner in zip(cells, inside, strict=True)
        ]
        checks = [
            self._checks if inner else self._at_rim(cell, 1.0, 0.63) for cell, inner in zip(cells, inside, strict=True)
        ]
        local = [np.concatenate(both) for both in zip(samples, checks, strict=True)]
        first = np.cumsum([0] + [len(points) for points in local])
        at = np.concatenate([cell.centre + points * half for cell, points in zip(cells, local, strict=True)])
        if not len(at):
            return
        rows, values = self.shapes.nearby(at)
        for k, cell in enumerate(cells):
            if len(samples[k]):
                here = slice(first[k], first[k + 1])
                clear = float(gap[k]) - OVERHANG * radius if inside[k] else 0.0
                self._fit_one(cell, local[k], len(samples[k]), rows, values[here], clear)

    def _fit_one(
        self, cell: Cell, local: FloatArray, samples: int, rows: IntArray, values: FloatArray, clear: float
    ) -> None:
        """Fit the shapes `rows` with values (n, k) at points, of which the first few are for the fit."""
        relative = np.abs(values).max(axis=0) / self._heights[rows]
        order = np.argsort(relative, kind="stable")
        dropped = np.cumsum(relative[order])
        least = 0 if self._few else int(np.searchsorted(dropped, self._negligible))
        keep = np.full(len(rows), True)
        keep[order[:least]] = False
        kept = np.flatnonzero(keep)
        left_out = float(relative[~keep].sum())
        rows, target = rows[kept], values[:, kept]
        everything = np.arange(len(self.shapes.points))
        reach = self._reach * float(cell.half.max())
        near = everything if self._few else np.sort(self._tree.query_ball_point(cell.centre, reach)).astype(np.int64)
        strengths = self.shapes.strengths[near][:, rows]
        strengths = strengths if isinstance(strengths, np.ndarray) else strengths.toarray()
        x = (cell.centre + local * cell.half) / self.shapes.size
        target = target - point_value(x, self.shapes.points[near] / self.shapes.size) @ strengths
        chosen = None
        highest, total = monomials(local, DEGREES[-1]), powers(DEGREES[-1]).sum(axis=1)
        for degree in reversed(DEGREES):
            table = highest[:, total <= degree]
            if clear > 0:
                fitted: FloatArray = self._inverses[degree] @ target[:samples]
            else:
                fitted = np.asarray(np.linalg.lstsq(table[:samples], target[:samples], rcond=RCOND)[0])
            wrong = np.abs(table[samples:] @ fitted - target[samples:]) / self._heights[rows]
            error = float(wrong.max(initial=0.0))
            fine = error <= SPARE * self._aim
            if chosen and not fine and chosen[2] <= SPARE * self._aim:
                break
            if chosen is None or fine or error < chosen[2]:
                chosen = degree, fitted, error
        assert chosen
        degree, fitted, error = chosen
        cell.error, cell.left_out = error, left_out
        cell.fit = CellFit(degree, rows, near, np.concatenate([fitted, UNIT_STRENGTH * strengths]).T.copy(), clear)

    def _at_rim(self, cell: Cell, reach: float, spacing: float) -> FloatArray:
        """Points of a cell that the rim cuts, on the plate and on the rim, in half widths from its centre."""
        side = np.linspace(-reach, reach, round(4 * NODES * spacing))
        grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
        grid = grid[self.shapes.outline.inside(cell.centre + grid * cell.half)][::3]
        # Points near the edges of what there is matter most to a polynomial: hence those on the rim as well.
        step = 2 * float(cell.half.max()) / NODES * spacing
        rim = (np.concatenate(rim_curves(self.shapes.outline, step)) - cell.centre) / cell.half
        return np.concatenate([grid, rim[np.abs(rim).max(axis=1) <= reach]])
