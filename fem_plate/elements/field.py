"""Functions on the plate: finite elements plus what is known in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fem_plate.elements.singular import point_laplacian, point_load, point_value, pressure_derivatives
from fem_plate.elements.space import PlateSpace

FloatArray = NDArray[np.float64]
Fields = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True, eq=False)
class Field:
    """k functions w = v + sum_j forces_j F(x - sources_j) + pressure r^4 / 64 + rigid . (1, x, y), dimensionless.

    r counts from the middle of the plate's box.
    """

    space: PlateSpace
    unknowns: FloatArray  # (unknowns, k), of v
    sources: FloatArray  # (N, 2)
    forces: FloatArray  # (N, k)
    rigid: FloatArray  # (3, k)
    pressure: FloatArray  # (k,)

    def weighted(self, weights: FloatArray) -> Field:
        """The sum of the functions times weights (k,) or (k, m)."""
        weights = weights.reshape(len(weights), -1)
        return Field(
            self.space,
            self.unknowns @ weights,
            self.sources,
            self.forces @ weights,
            self.rigid @ weights,
            self.pressure @ weights,
        )

    def values(self, x: FloatArray) -> FloatArray:
        """The functions' values alone, (n, k)."""
        (value,) = self.space.evaluate(x, self.unknowns, orders=1)
        value += np.column_stack([np.ones(len(x)), x]) @ self.rigid
        if np.any(self.pressure):
            value += np.outer(pressure_derivatives(x - self.space.middle)[0][0], self.pressure)
        return value + point_value(x, self.sources) @ self.forces

    def laplacians(self, x: FloatArray, floor: float) -> FloatArray:
        """The functions' Laplacians, (n, k), bounded within the floor of each source."""
        bend = self.space.laplacians(x, self.unknowns) + point_laplacian(x, self.sources, floor) @ self.forces
        if np.any(self.pressure):
            second = pressure_derivatives(x - self.space.middle)[2]
            bend += np.outer(second[0] + second[2], self.pressure)
        return bend

    def smooth(self, x: FloatArray) -> Fields:
        """All but the forces' part at points (n, 2): value (n, k), gradient (n, k, 2), Hessian (n, k, 2, 2)."""
        value, gradient, hessian = self.space.evaluate(x, self.unknowns, orders=3)
        value += np.column_stack([np.ones(len(x)), x]) @ self.rigid
        gradient += self.rigid[1:].T
        if np.any(self.pressure):
            (w,), slope, (xx, xy, yy), _ = pressure_derivatives(x - self.space.middle)
            value += np.outer(w, self.pressure)
            gradient += slope.T[:, None] * self.pressure[:, None]
            bend = np.stack([np.stack([xx, xy], -1), np.stack([xy, yy], -1)], -1)
            hessian += bend[:, None] * self.pressure[:, None, None]
        return value, gradient, hessian

    def evaluate(self, x: FloatArray) -> Fields:
        """The functions at points (n, 2); at a source the Hessian is infinite."""
        value, gradient, hessian = self.smooth(x)
        f, f_x, f_xx = point_load(x, self.sources)
        with np.errstate(invalid="ignore"):
            return (
                value + f @ self.forces,
                gradient + np.einsum("njd,jk->nkd", f_x, self.forces, optimize=True),
                hessian + np.einsum("njde,jk->nkde", f_xx, self.forces, optimize=True),
            )


class Estimated:
    """An answer of the plate that can say how large its error is."""

    field: Field
    size: float  # m, that the field's lengths are divided by
    refine: Callable[[], Self]  # the same on cells of half the size

    @property
    def unknowns(self) -> int:
        """How many unknowns the mesh has."""
        return self.field.space.unknowns

    @cached_property
    def error_estimate(self) -> float:
        """Largest error in w, estimated and relative to each function's largest deflection.

        Found by comparison with cells of half the size, on which it is solved when this is first asked for.
        """
        return self.refine().difference(self)

    def difference(self, coarser: Estimated) -> float:
        """The largest difference from an answer on another mesh over this one's points, relative as the estimate."""
        x = self.field.space.points
        here = self.field.values(x)
        # New points on a curved rim may make the refined mesh's box, and so its size, a little larger.
        there = coarser.field.values(x * (self.size / coarser.size))
        largest = np.abs(here).max(axis=0)
        return float(np.max(np.abs(here - there) / np.where(largest > 0, largest, 1.0)))
