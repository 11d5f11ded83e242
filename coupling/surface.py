"""From the plate's shapes and the drives to the moving surface: where statics meets time.

The shapes' logarithms are kept; their smooth parts are fitted by polynomials on square cells of a grid. The grid is
made finer until the fit, checked at points that it has not seen, is as good as asked for.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fem_plate.influence import Shapes
from particle import Drive, SurfaceMotion
from particle.drive import drive_table
from particle.surface import DISC

FloatArray = NDArray[np.float64]

SURFACE_TOLERANCE = 1e-8  # of a unit stroke
DEGREE = 8
OVERHANG = 1.25  # cells are fitted over this many half widths, so that a step may end a little outside
CELLS_ACROSS = (8, 16, 32, 64)
NODES = 12  # Chebyshev points a side that a cell inside the rim is fitted to
FLOOR = 1e-6  # of the plate's size: the radius below which a point load's Hessian grows no more


def surface_motion(shapes: Shapes, drives: Sequence[Drive], tolerance: float = SURFACE_TOLERANCE) -> SurfaceMotion:
    """The surface over time, w(x, t) = sum_i h_i(t) phi_i(x).

    shapes: influence shapes of N actuators, from finite elements or in closed form.  drives: one for each.
    tolerance: largest error of a unit shape's fit; the record's `error` says what was measured.
    Raises ValueError when there is not one drive for each actuator.
    """
    if len(drives) != len(shapes.points):
        raise ValueError(f"Input drives must be one an actuator, {len(shapes.points)}; got {len(drives)}")
    # Many small systems: BLAS threads would only wait for each other (a hundred times slower on two busy cores).
    with threadpool_limits(limits=1, user_api="blas"):
        fit = CellFit(shapes, CELLS_ACROSS[0])
        for across in CELLS_ACROSS[1:]:
            finer = CellFit(shapes, across) if fit.error > tolerance else fit
            # Once smaller cells gain nothing, what is left is the finite elements' own error.
            if finer.error > 0.5 * fit.error:
                break
            fit = finer
    return SurfaceMotion(
        drives=drive_table(drives),
        sources=shapes.points,
        strengths=shapes.strengths,
        size=shapes.size,
        floor=FLOOR * shapes.size,
        origin=np.array([-shapes.size, -shapes.size]),
        cell_width=fit.width,
        cell_rows=fit.rows,
        cells=fit.cells,
        degree=DEGREE,
        overhang=OVERHANG,
        outline=DISC,
        rim=np.array([shapes.outline.radius]),
        moving_base=False,
        error=fit.error,
    )


class CellFit:
    """Polynomials of the smooth parts on a grid of `across` x `across` cells around the plate.

    rows (across, across): a cell's row in `cells`, -1 off the plate.  cells: (C, N, M).  error: largest one measured.
    """

    def __init__(self, shapes: Shapes, across: int) -> None:
        self.shapes = shapes
        self.width = 2 * shapes.size / across
        centres = self.width * (np.arange(across) + 0.5) - shapes.size
        grid = np.stack(np.meshgrid(centres, centres, indexing="ij"), axis=-1)
        self.rows = np.full((across, across), -1, dtype=np.int64)
        nearest = np.sign(grid) * np.maximum(np.abs(grid) - self.width / 2, 0)  # the cell's point nearest the centre
        on_plate = shapes.outline.gap(nearest) > 0
        self.rows[on_plate] = np.arange(on_plate.sum())
        self.centres = grid[on_plate]
        inside = shapes.outline.gap(self.centres) > OVERHANG * self.width / np.sqrt(2)
        self.cells = np.empty((len(self.centres), len(shapes.points), (DEGREE + 1) * (DEGREE + 2) // 2))
        self._fit_inner(np.flatnonzero(inside))
        for cell in np.flatnonzero(~inside).tolist():
            self.cells[cell] = self._fit_at_rim(cell)
        self.error = self._measure()

    def _fit_inner(self, inner: NDArray[np.int64]) -> None:
        """Cells that lie inside the rim share their points, and so one least-squares matrix."""
        nodes = OVERHANG * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
        local = np.stack(np.meshgrid(nodes, nodes, indexing="ij"), axis=-1).reshape(-1, 2)
        points = self.centres[inner, None] + local * self.width / 2
        values = self.shapes.smooth(points.reshape(-1, 2)).reshape(len(inner), len(local), -1)
        self.cells[inner] = np.einsum("mp,cpi->cim", np.linalg.pinv(_monomials(local)), values, optimize=True)

    def _fit_at_rim(self, cell: int) -> FloatArray:
        """A cell that the rim cuts is fitted to its points on the plate."""
        side = np.linspace(-OVERHANG, OVERHANG, 4 * NODES)
        local = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
        points = self.centres[cell] + local * self.width / 2
        on_plate = self.shapes.outline.gap(points) >= 0
        # Points near the edges of what there is matter most to a polynomial: keep those on the rim as well.
        points = self.shapes.outline.project(points[~on_plate])
        reach = np.abs(points - self.centres[cell]).max(axis=1) <= OVERHANG * self.width / 2
        local = np.concatenate([local[on_plate][::3], (points[reach][::3] - self.centres[cell]) / (self.width / 2)])
        values = self.shapes.smooth(self.centres[cell] + local * self.width / 2)
        return np.asarray(np.linalg.lstsq(_monomials(local), values, rcond=1e-12)[0].T)

    def _measure(self) -> float:
        """The largest error at points between those of the fits."""
        local = np.random.default_rng(0).uniform(-1, 1, (16, 2))
        points = self.centres[:, None] + local * self.width / 2
        on_plate = self.shapes.outline.gap(points) >= 0
        fitted = np.einsum("pm,cim->cpi", _monomials(local), self.cells, optimize=True)
        return float(np.abs(fitted[on_plate] - self.shapes.smooth(points[on_plate])).max())


def _monomials(local: FloatArray) -> FloatArray:
    """x^i y^j at points (n, 2), sorted by powers of x, then of y: (n, M)."""
    powers = local[:, :, None] ** np.arange(DEGREE + 1)
    return np.stack(
        [powers[:, 0, i] * powers[:, 1, j] for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)], axis=1
    )
