"""A cell of a plate's surface in the making, and how far it is off."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from fem_plate.elements import UNIT_STRENGTH, point_value
from meshes import Outline
from particle.surface import CellFit

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Fitted(Protocol):
    """Shapes that cells are fitted to: `fem_plate.Shapes`, or K shapes with logarithms at J points."""

    @property
    def points(self) -> FloatArray:
        """(J, 2) m."""

    @property
    def strengths(self) -> Any:
        """(J, K), the force at each point in each shape, dense or sparse."""

    @property
    def size(self) -> float:
        """m, of the logarithms."""

    @property
    def outline(self) -> Outline:
        """The rim."""

    @property
    def truncation_error(self) -> float:
        """The largest value left out of a shape, over its largest."""

    @property
    def spare(self) -> float:
        """The share of the tolerance that a fit must be good to, of the lowest degree that is."""

    def own_heights(self) -> FloatArray:
        """(K,) what the errors of each shape are relative to.

        A shape that is driven by a c-th of the others' strokes at most may be off by 1/c of what they may.
        """

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        """The shapes (k,) that do not vanish at all of the points (n, 2) [m], and their values (n, k)."""


@runtime_checkable
class InPlane(Protocol):
    """Shapes that also move the mid-plane in its plane."""

    def in_plane_values(self, xy: FloatArray) -> FloatArray:
        """(n, M, 2), M motions at points (n, 2) [m]."""

    def in_plane_heights(self) -> FloatArray:
        """(M,) what the errors of each motion are relative to."""


@dataclass(eq=False)
class Cell:
    """A rectangle around a centre (2,) [m], half as wide as (2,) [m], with its fit or the four it is divided into."""

    centre: FloatArray
    half: FloatArray
    fit: CellFit | None = None  # None: off the plate, or divided
    error: float = 0.0  # of the fit, over the shapes' heights
    left_out: float = 0.0  # the sum of what the shapes left out reach there, over their heights
    quarters: list[Cell] = field(default_factory=list)

    def leaves(self) -> list[Cell]:
        """Those that are not divided."""
        return [leaf for quarter in self.quarters for leaf in quarter.leaves()] if self.quarters else [self]


def misfit(cell: Cell, local: FloatArray, shapes: Fitted, heights: FloatArray) -> tuple[float, float]:
    """The largest error of a cell's fit, and the sum of the shapes left out, at points (n, 2) in half widths.

    heights: (K,), what both are relative to.
    """
    fit = cell.fit
    assert fit
    at = cell.centre + local * cell.half
    rows, values = shapes.nonzero_values(at)
    column = np.full(len(heights), len(rows))  # of zeros, for those that are not near
    column[rows] = np.arange(len(rows))
    exact = np.concatenate([values, np.zeros((len(at), 1))], axis=1)[:, column[fit.drive]]
    table = monomials(local, fit.degree)
    polynomial, forces = np.split(fit.rows, [table.shape[1]], axis=1)
    logarithms = point_value(at / shapes.size, shapes.points[fit.near] / shapes.size)
    fitted = table @ polynomial.T + logarithms @ forces.T / UNIT_STRENGTH
    out = ~np.isin(rows, fit.drive)
    error = np.abs(fitted - exact) / heights[fit.drive]
    left_out = np.abs(values[:, out]).max(axis=0) / heights[rows[out]]
    return float(error.max(initial=0.0)), float(left_out.sum())


def monomials(local: FloatArray, degree: int) -> FloatArray:
    """x^i y^j at points (n, 2), sorted by powers of x, then of y: (n, M)."""
    i, j = powers(degree).T
    each = local[:, :, None] ** np.arange(degree + 1)
    return np.asarray(each[:, 0, i] * each[:, 1, j])


def powers(degree: int) -> NDArray[np.int64]:
    """The powers (M, 2) of x and y in a polynomial of a degree."""
    return np.array([(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)])
