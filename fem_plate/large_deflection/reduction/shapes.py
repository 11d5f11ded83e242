"""StretchedShapes: what a stretching plate's surface is made of, the linear shapes and their corrections."""

from __future__ import annotations

import numpy as np

from fem_plate.large_deflection.reduction.reduction import Reduction
from fem_plate.moving_shapes import MovingShapes
from fem_plate.types import FloatArray


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
        motions = plane_stress.evaluate(np.asarray(xy, dtype=float) / self.size, self._reduction.motions)[0]
        return np.ascontiguousarray(motions.transpose(0, 2, 1))

    def in_plane_gradients(self, xy: FloatArray) -> FloatArray:
        """The gradients (n, 2, 2, M) [1/m] of in-plane motions at points (n, 2) [m]: component, direction, motion."""
        plane_stress = self._reduction.discrete.plane_stress
        return plane_stress.evaluate(np.asarray(xy) / self.size, self._reduction.motions)[1] / self.size

    def in_plane_heights(self) -> FloatArray:
        """What the errors of in-plane motions are relative to, (M,)."""
        return self._in_plane_scales
