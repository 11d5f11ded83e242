"""From the plate's shapes and the drives to the moving surface: where statics meets time.

The shapes' logarithms are kept; their smooth parts are fitted by polynomials on square cells of a grid. The grid is
made finer until the fit, checked at points that it has not seen, is as good as asked for.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from coupling.rim import rim_curves
from fem_plate import PatchedShapes, Shapes
from particle import AnyDrive, SurfaceMotion
from particle.drive import drive_table

FloatArray = NDArray[np.float64]

SURFACE_TOLERANCE = 1e-8  # of a unit stroke
DEGREE = 8
OVERHANG = 1.25  # cells are fitted over this many half widths, so that a step may end a little outside
CELLS_ACROSS = (8, 16, 32, 64)
NODES = 12  # Chebyshev points a side that a cell inside the rim is fitted to
FLOOR = 1e-6  # of the plate's size: the radius below which a point load's Hessian grows no more


def surface_motion(shapes: Shapes, drives: Sequence[AnyDrive], tolerance: float = SURFACE_TOLERANCE) -> SurfaceMotion:
    """The surface over time, w(x, t) = sum_i h_i(t) phi_i(x).

    shapes: influence shapes of N actuators, from finite elements or in closed form.  drives: one for each.
    tolerance: largest error of a unit shape's fit; the record's `error` says what was measured.
    Raises ValueError when there is not one drive for each actuator.
    """
    if len(drives) != len(shapes.points):
        raise ValueError(f"Input drives must be one an actuator, {len(shapes.points)}; got {len(drives)}")
    # Many small systems: BLAS threads would only wait for each other (a hundred times slower on two busy cores).
    with threadpool_limits(limits=1, user_api="blas"):
        heights = np.abs(np.diag(shapes.evaluate(shapes.points)[0]))
        fit = CellFit(shapes, heights, CELLS_ACROSS[0])
        for across in CELLS_ACROSS[1:]:
            finer = CellFit(shapes, heights, across) if fit.error > tolerance else fit
            # Once smaller cells gain nothing, what is left is the finite elements' own error.
            if finer.error > 0.5 * fit.error:
                break
            fit = finer
    return SurfaceMotion(
        drives=drive_table(drives),
        sources=shapes.points,
        strengths=shapes.strengths.toarray() if isinstance(shapes, PatchedShapes) else shapes.strengths,
        size=shapes.size,
        floor=FLOOR * shapes.size,
        origin=fit.origin,
        cell_width=fit.width,
        cell_rows=fit.rows,
        cells=fit.cells,
        degree=DEGREE,
        overhang=OVERHANG,
        conics=np.ascontiguousarray(shapes.outline.conics),
        edges=np.ascontiguousarray(shapes.outline.edges),
        moving_base=False,
        error=fit.error,
    )


class CellFit:
    """Polynomials of the smooth parts on a grid of square cells over the plate's box, `across` along its longer side.

    origin: (2,) m, the grid's lower left corner.  rows (nx, ny): a cell's row in `cells`, -1 off the plate.
    cells: (C, N, M).  error: largest one measured, relative to the shapes' heights (N,), 1 where not driven by a force.
    """

    def __init__(self, shapes: Shapes, heights: FloatArray, across: int) -> None:
        self.shapes, self.heights = shapes, heights
        low, high = shapes.outline.box
        self.width = float((high - low).max()) / across
        counts = np.ceil((high - low) / self.width * (1 - 1e-9)).astype(int)
        self.origin = (low + high - counts * self.width) / 2
        places = [
            self.width * (np.arange(count) + 0.5) + start for count, start in zip(counts, self.origin, strict=True)
        ]
        grid = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1)
        gap = shapes.outline.gap(grid)
        on_plate = gap > -self.width / np.sqrt(2)  # the circle around the cell reaches the plate
        self.rows = np.where(on_plate, np.cumsum(on_plate).reshape(on_plate.shape) - 1, -1)
        self.centres = grid[on_plate]
        inside = gap[on_plate] > OVERHANG * self.width / np.sqrt(2)
        self.cells = np.zeros((len(self.centres), len(shapes.points), (DEGREE + 1) * (DEGREE + 2) // 2))
        if inside.any():
            self._fit_inner(np.flatnonzero(inside))
        rim = np.concatenate(rim_curves(shapes.outline, self.width / NODES))
        for cell in np.flatnonzero(~inside).tolist():
            self._fit_at_rim(cell, rim)
        self.error = self._measure()

    def _fit_inner(self, inner: NDArray[np.int64]) -> None:
        """Cells that lie inside the rim share their points, and so one least-squares matrix."""
        nodes = OVERHANG * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
        local = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
        points = self.centres[inner, None] + local * self.width / 2
        values = self.shapes.smooth(points.reshape(-1, 2)).reshape(len(inner), len(local), -1)
        self.cells[inner] = np.einsum("mp,cpi->cim", np.linalg.pinv(_monomials(local)), values, optimize=True)

    def _fit_at_rim(self, cell: int, rim: FloatArray) -> None:
        """A cell that the rim cuts is fitted to its points on the plate and on the rim (r, 2) [m]."""
        side = np.linspace(-OVERHANG, OVERHANG, 4 * NODES)
        grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
        grid = grid[self.shapes.outline.inside(self.centres[cell] + grid * self.width / 2)][::3]
        # Points near the edges of what there is matter most to a polynomial: hence those on the rim as well.
        rim = (rim - self.centres[cell]) / (self.width / 2)
        local = np.concatenate([grid, rim[np.abs(rim).max(axis=1) <= OVERHANG]])
        if len(local):
            values = self.shapes.smooth(self.centres[cell] + local * self.width / 2)
            self.cells[cell] = np.linalg.lstsq(_monomials(local), values, rcond=1e-12)[0].T

    def _measure(self) -> float:
        """The largest error at points between those of the fits."""
        local = np.random.default_rng(0).uniform(-1, 1, (16, 2))
        points = self.centres[:, None] + local * self.width / 2
        on_plate = self.shapes.outline.inside(points.reshape(-1, 2)).reshape(points.shape[:2])
        fitted = np.einsum("pm,cim->cpi", _monomials(local), self.cells, optimize=True)
        wrong = np.abs(fitted[on_plate] - self.shapes.smooth(points[on_plate])).max(axis=0)
        return float((wrong / self.heights).max())


def _monomials(local: FloatArray) -> FloatArray:
    """x^i y^j at points (n, 2), sorted by powers of x, then of y: (n, M)."""
    powers = local[:, :, None] ** np.arange(DEGREE + 1)
    return np.stack(
        [powers[:, 0, i] * powers[:, 1, j] for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)], axis=1
    )
