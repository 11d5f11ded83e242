"""MovingShapes: what the surface of a plate is made of that does more than its actuators hold it to."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import Derivatives, PlateFunctions
from fem_plate.influence import InfluenceShapes
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray
from meshes import Outline


class MovingShapes(Shapes):
    """The shapes of N actuators and n further ones.

    functions: N + n, of places over `size`.  points: (N, 2) m.  springs: (N,) N/m, inf where rigid, 0 of forces.
    size: m, half of the longer side.  scales: (N + n,), what errors of each are relative to.
    """

    def __init__(
        self,
        functions: PlateFunctions,
        points: FloatArray,
        springs: FloatArray,
        size: float,
        outline: Outline,
        scales: FloatArray,
    ) -> None:
        self.functions = functions
        self.strengths = functions.infinite.logarithms(functions.sources)[:, None] * functions.forces
        self.points, self.springs = np.ascontiguousarray(points), springs
        self.size, self.outline = size, outline
        self._scales = scales

    @classmethod
    def beside(cls, shapes: InfluenceShapes, further: PlateFunctions, scales: FloatArray) -> MovingShapes:
        """Influence shapes, then further ones on their cells; scales: (N + n,)."""
        functions = shapes.functions.beside(further)
        return cls(functions, shapes.points, shapes.springs, shapes.size, shapes.outline, scales)

    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        return (self.functions if weights is None else self.functions.weighted(weights)).evaluate(x)

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        functions = self.functions if weights is None else self.functions.weighted(weights)
        return functions.values(np.asarray(xy, dtype=float) / self.size)

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        return np.arange(self.strengths.shape[1]), self.functions.values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return self._scales

    def laplacians(self, xy: ArrayLike, floor: float) -> FloatArray:
        """The Laplacians (n, N + n) [1/m^2], as `InfluenceShapes.laplacians`."""
        return self.functions.laplacians(np.asarray(xy, dtype=float) / self.size, floor / self.size) / self.size**2

    def _checked(self, weights: ArrayLike, caller: str) -> FloatArray:
        array = np.asarray(weights, dtype=float)
        count = self.strengths.shape[1]
        if array.shape != (count,):
            raise ValueError(f"Input weights of {caller} must be one a shape, {count}; got shape {array.shape}")
        return array
