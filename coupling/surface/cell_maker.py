"""The making of cells: polynomials fitted to a plate's shapes, in cells as small as that takes.

A cell keeps the logarithms of the actuators close by. What is left of a shape is smooth there, and fitted by least
squares at points that reach a little beyond the cell. A cell whose fit, checked at points that it has not seen, is not
good enough is divided into four, and so is one with too many logarithms.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from threadpoolctl import threadpool_limits

from coupling.surface.cell import Cell, Fitted, InPlane, monomials, powers
from fem_plate.elements import UNIT_STRENGTH, point_value
from meshes import rim_curves
from particle.surface import CellFit

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

DEGREES = range(2, 11)  # of the polynomials: the lowest that does, as it costs least
PLANE_SPARE = 0.1  # the `spare` of motions in the plane, whose second derivatives matter less
OVERHANG = 1.25  # cells are fitted over this many half widths, so that a step may end a little outside
NODES = 12  # Chebyshev points a side that a cell inside the rim is fitted to
CHECKS = 48  # points between those, at which its error is measured
FEW = 8  # actuators whose logarithms are kept everywhere: their exact sum is cheaper than smaller cells
MAX_NEAR = 4  # logarithms in a cell otherwise: each costs as much as 15 monomials
RCOND = 1e-12
MAX_DEPTH = 6  # times that a cell is divided
LESS = 0.1  # of its error: dividing many cells pays if that is left at most
# This is enough for those that stand out of their like, as at corners, and where errors are too large to show an order.
LESS_AT_CORNERS, OUTSTANDING, COARSE = 0.75, 3.0, 1e-3
MAX_DIVIDED = 128  # at once: where more are not good enough, the shapes are not
# The polynomial's error falls with the distance of the nearest logarithm that it takes up, in half widths.
REACH, REACHED, REACH_ORDER = 8.0, 1e-9, 9
MAX_VALUES = 4_000_000  # points times shapes that are evaluated at once


class CellMaker:
    """Makes the cells of a plate's shapes.

    tolerance: largest error of a unit shape's fit.  Shapes that leave something out are not worth a fit that is much
    better than that.
    heights: (K,) each shape's height at its own actuator, what errors are relative to.  worth: the error that is good
    enough.  checks: (CHECKS, 2) where it is measured, in half widths.  tree: of the actuators.
    """

    def __init__(self, shapes: Fitted, tolerance: float) -> None:
        self.shapes, self.heights = shapes, shapes.own_heights()
        self.tree = cKDTree(shapes.points)
        self.few = len(shapes.points) <= FEW
        self._plane_heights = shapes.in_plane_heights() if isinstance(shapes, InPlane) else np.zeros(0)
        truncation = shapes.truncation_error
        self.worth = max(tolerance, truncation)
        self._aim, self._negligible = max(tolerance, 0.1 * truncation), self.worth / 4
        self._reach = REACH * (REACHED / self._aim) ** (1 / REACH_ORDER)
        nodes = OVERHANG * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
        self._nodes = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
        self._inverses: dict[int, FloatArray] = {}
        self._rims: dict[float, FloatArray] = {}
        self.checks = np.random.default_rng(0).uniform(-1, 1, (CHECKS, 2))

    def make(self, cells: Sequence[Cell]) -> None:
        """Fit cells of one size, and divide them where need be."""
        # Many small systems: BLAS threads would only wait for each other (a hundred times slower on two busy cores).
        if cells:
            with threadpool_limits(limits=1, user_api="blas"):
                self._fit(cells)
                self._divide(cells, MAX_DEPTH)

    def _divide(self, cells: Sequence[Cell], depth: int) -> None:
        """Divide those that are not good enough, if it helps: what finite elements are off by stays."""
        crowded = [cell for cell in cells if not self.few and cell.fit and len(cell.fit.near) > MAX_NEAR]
        poor = [cell for cell in cells if cell.error > self._aim and cell not in crowded]
        tried = crowded + poor
        if not tried or depth == 0 or len(tried) > MAX_DIVIDED:
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
        self._divide([quarter for cell in tried for quarter in cell.quarters], depth - 1)

    def _fit(self, cells: Sequence[Cell]) -> None:
        """Fit cells of one size."""
        some = max(1, MAX_VALUES // ((len(self.heights) + 2 * len(self._plane_heights)) * (len(self._nodes) + CHECKS)))
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
            self.checks if inner else self._at_rim(cell, 1.0, 0.63) for cell, inner in zip(cells, inside, strict=True)
        ]
        local = [np.concatenate(both) for both in zip(samples, checks, strict=True)]
        first = np.cumsum([0] + [len(points) for points in local])
        at = np.concatenate([cell.centre + points * half for cell, points in zip(cells, local, strict=True)])
        if not len(at):
            return
        rows, values = self.shapes.nonzero_values(at)
        planar = self.shapes.in_plane_values(at) if isinstance(self.shapes, InPlane) else None
        for k, cell in enumerate(cells):
            if len(samples[k]):
                here = slice(first[k], first[k + 1])
                clear = float(gap[k]) - OVERHANG * radius if inside[k] else 0.0
                self._fit_one(cell, local[k], len(samples[k]), rows, values[here], clear)
                if planar is not None:
                    self._fit_plane(cell, local[k], len(samples[k]), planar[here])

    def _inverse(self, degree: int) -> FloatArray:
        """What turns values at the nodes into the polynomial that fits them best."""
        if degree not in self._inverses:
            self._inverses[degree] = np.asarray(np.linalg.pinv(monomials(self._nodes, degree)), np.float64)
        return self._inverses[degree]

    def _fit_one(
        self, cell: Cell, local: FloatArray, samples: int, rows: IntArray, values: FloatArray, clear: float
    ) -> None:
        """Fit the shapes `rows` with values (n, k) at points, of which the first few are for the fit."""
        weight = np.abs(values).max(axis=0)
        relative = weight / self.heights[rows]
        order = np.argsort(relative, kind="stable")
        dropped = np.cumsum(relative[order])
        least = 0 if self.few else int(np.searchsorted(dropped, self._negligible))
        keep = np.full(len(rows), True)
        keep[order[:least]] = False
        kept = np.flatnonzero(keep)
        left_out = float(relative[~keep].sum())
        rows, target = rows[kept], values[:, kept]
        everything = np.arange(len(self.shapes.points))
        reach = self._reach * float(cell.half.max())
        near = everything if self.few else np.sort(self.tree.query_ball_point(cell.centre, reach)).astype(np.int64)
        forces = self.shapes.strengths[near][:, rows]
        forces = forces if isinstance(forces, np.ndarray) else forces.toarray()
        x = (cell.centre + local * cell.half) / self.shapes.size
        target = target - point_value(x, self.shapes.points[near] / self.shapes.size) @ forces
        chosen = None
        highest, total = monomials(local, DEGREES[-1]), powers(DEGREES[-1]).sum(axis=1)
        for degree in reversed(DEGREES):
            table = highest[:, total <= degree]
            if clear > 0:
                fitted: FloatArray = self._inverse(degree) @ target[:samples]
            else:
                fitted = np.asarray(np.linalg.lstsq(table[:samples], target[:samples], rcond=RCOND)[0])
            wrong = np.abs(table[samples:] @ fitted - target[samples:]) / self.heights[rows]
            error = float(wrong.max(initial=0.0))
            fine = error <= self.shapes.spare * self._aim
            if chosen and not fine and chosen[2] <= self.shapes.spare * self._aim:
                break
            if chosen is None or fine or error < chosen[2]:
                chosen = degree, fitted, error
        assert chosen
        degree, fitted, error = chosen
        cell.error, cell.left_out = error, left_out
        polynomials_and_logarithms = np.concatenate([fitted, UNIT_STRENGTH * forces]).T.copy()
        cell.fit = CellFit(degree, rows, weight[kept], near, polynomials_and_logarithms, clear)

    def _fit_plane(self, cell: Cell, local: FloatArray, samples: int, values: FloatArray) -> None:
        """Fit the motions in the plane, values (n, M, 2), by the lowest degree that does."""
        assert cell.fit
        heights = np.repeat(self._plane_heights, 2)
        target = values.reshape(len(values), -1)
        highest, total = monomials(local, DEGREES[-1]), powers(DEGREES[-1]).sum(axis=1)
        best = math.inf
        for degree in DEGREES:
            table = highest[:, total <= degree]
            if cell.fit.clear > 0:
                fitted: FloatArray = self._inverse(degree) @ target[:samples]
            else:
                fitted = np.asarray(np.linalg.lstsq(table[:samples], target[:samples], rcond=RCOND)[0])
            error = float((np.abs(table[samples:] @ fitted - target[samples:]) / heights).max(initial=0.0))
            if error < best:
                best = error
                plane = fitted.T.reshape(len(self._plane_heights), 2, -1).copy()
                cell.fit = cell.fit._replace(plane=plane, plane_degree=degree)
            if error <= PLANE_SPARE * self._aim:
                break
        cell.error = max(cell.error, best)

    def _at_rim(self, cell: Cell, reach: float, spacing: float) -> FloatArray:
        """Points of a cell that the rim cuts, on the plate and on the rim, in half widths from its centre."""
        side = np.linspace(-reach, reach, round(4 * NODES * spacing))
        grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
        grid = grid[self.shapes.outline.inside(cell.centre + grid * cell.half)][::3]
        # Points near the edges of what there is matter most to a polynomial: hence those on the rim as well.
        step = 2 * float(cell.half.max()) / NODES * spacing
        rim = (self._rim(step) - cell.centre) / cell.half
        return np.concatenate([grid, rim[np.abs(rim).max(axis=1) <= reach]])

    def _rim(self, step: float) -> FloatArray:
        """Points (n, 2) [m] of the rim, so far apart [m]."""
        if step not in self._rims:
            self._rims[step] = np.concatenate(rim_curves(self.shapes.outline, step))
        return self._rims[step]
