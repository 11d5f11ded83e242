"""MovingShapes: what the surface of a plate is made of that does more than its actuators hold it to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.elements import Derivatives, PlateFunctions
from fem_plate.influence import InfluenceShapes
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray
from meshes import Outline

if TYPE_CHECKING:
    from fem_plate.large_deflection import Reduction


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


class HeldShapes(MovingShapes):
    """The shapes of N actuators of a plate on one mesh, with what its modes are found from."""

    def __init__(self, reduction: Reduction, points: FloatArray, springs: FloatArray) -> None:
        discrete = reduction.discrete
        units = np.where(springs > 0, 1.0, discrete.thickness / discrete.force_unit)
        linear = reduction.linear.weighted(np.diag(units))
        functions = discrete.trial.functions(linear.v, linear.extra)
        super().__init__(functions, points, springs, discrete.size, discrete.mesh.outline, np.ones(len(points)))
        self.model = discrete.model


class StretchedShapes(MovingShapes):
    """The shapes of N actuators and n corrections, and M in-plane motions.

    reduction: of the plate.  points: (N, 2) m.  springs: (N,) N/m.
    scales, in_plane_scales: (N + n,) and (M,), what errors of each are relative to.
    """

    truncation_error = 1e-6  # cells need not follow the shapes any closer: finite elements do not either
    spare = 0.3  # the degree of a cell's polynomials does not pay for a closer fit, as each step costs it

    def __init__(
        self,
        reduction: Reduction,
        points: FloatArray,
        springs: FloatArray,
        scales: FloatArray,
        in_plane_scales: FloatArray,
    ) -> None:
        discrete = reduction.discrete
        units = np.where(springs > 0, 1.0, discrete.thickness / discrete.force_unit)
        linear = reduction.linear.weighted(np.diag(units))
        v = np.concatenate([linear.v, reduction.corrections.v], axis=1)
        extra = np.concatenate([linear.extra, reduction.corrections.extra], axis=1)
        functions = discrete.trial.functions(v, extra)
        super().__init__(functions, points, springs, discrete.size, discrete.mesh.outline, scales)
        self._reduction, self._in_plane_scales = reduction, in_plane_scales

    def in_plane_values(self, xy: FloatArray) -> FloatArray:
        """The in-plane motions (n, M, 2) at points (n, 2) [m]."""
        plane_stress = self._reduction.discrete.plane_stress
        motions = plane_stress.values(np.asarray(xy, dtype=float) / self.size, self._reduction.motions)
        return np.ascontiguousarray(motions.transpose(0, 2, 1))

    def in_plane_gradients(self, xy: FloatArray) -> FloatArray:
        """The gradients (n, 2, 2, M) [1/m] of in-plane motions at points (n, 2) [m]: component, direction, motion."""
        plane_stress = self._reduction.discrete.plane_stress
        return plane_stress.gradients(np.asarray(xy) / self.size, self._reduction.motions) / self.size

    def in_plane_heights(self) -> FloatArray:
        """What the errors of in-plane motions are relative to, (M,)."""
        return self._in_plane_scales
