"""Time nodes of a stretching plate's reduced model: full solutions there, and what the model differs from them by."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from full_solutions import FullSolutions, Node
from numpy.typing import NDArray
from scipy.interpolate import BPoly, PPoly

from coupling.stretch import Corrections
from fem_plate.large_deflection import Columns, Reduction
from fem_plate.large_deflection.reduction.snapshots import bending_products
from particle import AnyDrive, SurfaceMotion
from particle.drives import QuinticDrive, quintic_drives

FloatArray = NDArray[np.float64]

EXACT = 1e-9  # of w: differences of less are left out
STEP, AGREEMENT = 2e-3, 1e-4  # of a stroke's time, of differences that the derivatives must agree with
CELLS = 3e-3  # what cells may smooth of a gradient: it is as exact as that on the mesh at 30 t
AT_REST = 1e-12  # of the thickness


class Nodes:
    """The full plate at the time nodes of a model's corrections, and what it differs from the model by.

    Times are over the pace of the corrections, heights over the thickness.  xy: (n, 2) m, where errors are measured.
    """

    def __init__(
        self, reduction: Reduction, actuators: Sequence[AnyDrive], corrections: Corrections, xy: FloatArray
    ) -> None:
        self.reduction, self.actuators, self.corrections, self.xy = reduction, actuators, corrections, xy
        self.discrete = reduction.discrete
        self.full = FullSolutions(self.discrete)
        pieces = corrections.drives[0].segments()
        assert corrections.period is not None and pieces.tail == 0
        self.edges = np.append(pieces.start, pieces.start[-1] + pieces.scale[-1]) - pieces.start[0]
        self.pace, self.loop = corrections.drives[0].stroke_time, pieces.lead
        nodes = [self.node(self.edges[k], self.modelled(k)[0]) for k in range(len(pieces.start))]
        self.nodes = [*nodes, nodes[self.loop]]
        self._find_differences()

    def strokes(self, time: float) -> FloatArray:
        """The strokes (3, N) and their derivatives."""
        rows = np.array([drive.evaluate(time) for drive in self.actuators])
        return rows.T * self.pace ** np.arange(3)[:, None] / self.discrete.thickness

    def modelled(self, k: int) -> tuple[FloatArray, FloatArray]:
        """The model's corrections (n, 3) and in-plane motions (M, 3) at a node."""
        k = k if k + 1 < len(self.edges) else self.loop
        unit = self.pace / (self.edges[k + 1] - self.edges[k])
        sets = self.corrections.drives, self.corrections.in_plane
        c, g = (np.array([drive.segments().coefficients[k, :3] for drive in drives]) for drives in sets)
        factors = np.array([1.0, unit, 2 * unit**2])
        return c * factors / self.discrete.thickness, g * factors / self.discrete.motion_unit

    def node(self, time: float, c: FloatArray) -> Node:
        """The full plate at a time, from the model's corrections (n, 3)."""
        strokes = self.strokes(time)
        if np.abs(strokes[0]).max() < AT_REST:  # what Newton's method changes is relative to w
            return self.full.node(strokes * [[0], [1], [1]], None)
        near = self._model(strokes, c)
        return self.full.node(strokes, self.full.equilibrium.at(near.v[:, 0], near.extra[:, 0], 0.0))

    def _model(self, strokes: FloatArray, c: FloatArray) -> Columns:
        linear, own = self.reduction.linear.weighted(strokes.T), self.reduction.corrections.weighted(c)
        return Columns(linear.v + own.v, linear.extra + own.extra)

    def _find_differences(self) -> None:
        """Shapes of what the full plate and its model differ by, and their quintics."""
        stiffness, w, u = self.discrete.plane_stress.membrane.stiffness, [], []
        for k, node in enumerate(self.nodes):
            c, g = self.modelled(k)
            model = self._model(self.strokes(self.edges[k]), c)
            w.append(Columns(node.w.v - model.v, node.w.extra - model.extra))
            u.append(node.u - self.reduction.motions @ g)
        self.whole, self.differences = Columns.joined([node.w for node in self.nodes]), Columns.joined(w)
        full, motions = np.concatenate([node.u for node in self.nodes], axis=1), np.concatenate(u, axis=1)
        largest = np.sqrt(np.diag(bending_products(self.discrete, self.whole)).max())
        weights, coefficients = _leading(bending_products(self.discrete, self.differences), EXACT * largest)
        self.shapes, self.coefficients = self.differences.weighted(weights), coefficients * self.discrete.thickness
        largest = np.sqrt(np.einsum("ij,ij->j", full, stiffness @ full).max())
        weights, coefficients = _leading(motions.T @ (stiffness @ motions), EXACT * largest)
        self.motions, self.motion_coefficients = motions @ weights, coefficients * self.discrete.motion_unit

    def drives(self, coefficients: FloatArray) -> list[QuinticDrive]:
        """Quintics (m) through coefficients (m, 3 nodes) with their derivatives."""
        ends = coefficients.reshape(len(coefficients), -1, 3).transpose(1, 2, 0)
        powers = PPoly.from_bernstein_basis(BPoly.from_derivatives(self.edges / self.pace, ends)).c[::-1]
        rows = powers * (np.diff(self.edges) / self.pace)[:, None] ** np.arange(6)[:, None, None]
        like = self.corrections.drives[0]
        return quintic_drives(
            self.edges, rows.transpose(2, 1, 0), self.loop, like.stroke_time, like.frequency, np.zeros(len(rows.T))
        )

    def errors(self) -> FloatArray:
        """The model's largest errors of w, of its gradient, of w_tt and of grad w_tt, each over the largest."""
        found = []
        for columns in (self.differences, self.whole):
            w, gradient, _ = self._at_points(columns)
            found.append([np.abs(rows[:, order::3]).max() for order in (0, 2) for rows in (w, gradient)])
        return np.array(found[0]) / found[1]

    def _at_points(self, columns: Columns) -> tuple[FloatArray, FloatArray, FloatArray]:
        return self.discrete.trial.functions(*columns).evaluate(self.xy / self.discrete.size)

    def check(self, surface: SurfaceMotion, name: str) -> None:
        """The derivatives are those of differences, and a surface is the full plate at a node."""
        k = len(self.edges) // 3
        middle, step = (self.edges[k] + self.edges[k + 1]) / 2, STEP * self.pace  # no breakpoint of a drive
        before, now, after = (
            self._at_points(self.node(time, self._near(time)).w)[0] for time in (middle - step, middle, middle + step)
        )
        for order in (1, 2):
            change = (after - before)[:, order - 1] / (2 * STEP)
            off = np.abs(change - now[:, order]).max() / np.abs(change).max()
            assert off < AGREEMENT, f"derivative {order} is off by {off:.1e}"
        w, gradient, _ = self._at_points(self.nodes[k].w)
        state, unit = surface.evaluate(self.xy, self.edges[k]), self.discrete.thickness
        for quantity, bound, one, other in (
            ("w", AGREEMENT, state.w, unit * w[:, 0]),
            ("the gradient", CELLS, state.gradient, unit / self.discrete.size * gradient[:, 0]),
            ("w_tt", CELLS, state.w_tt, unit / self.pace**2 * w[:, 2]),
        ):
            off = float(np.abs(one - other).max() / np.abs(other).max())
            print(f"{name}: cells are off by {off:.1e} of {quantity}", flush=True)
            assert off < bound, f"{quantity} of the full plate's surface is off by {off:.1e}"

    def _near(self, time: float) -> FloatArray:
        """The model's corrections (n, 3) at any time, but for derivatives."""
        values = [drive.evaluate(time)[0] for drive in self.corrections.drives]
        return np.outer(values, np.eye(1, 3)) / self.discrete.thickness


def _leading(products: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """What combines k functions into orthonormal leading ones (k, m), and these' coefficients (m, k) in them."""
    squares, directions = np.linalg.eigh(products)
    kept = squares > least**2
    kept[-1] = True
    weights = directions[:, kept] / np.sqrt(squares[kept])
    return weights, weights.T @ products
