"""The true curves of plate rims: a mesh only has chords, integrals and the part need the curve itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Circle:
    """A circle that bounds the plate from outside.

    radius: m.  centre: m.
    """

    radius: float
    centre: tuple[float, float] = (0.0, 0.0)

    def gap(self, xy: ArrayLike) -> FloatArray:
        """Distance [m] of points (..., 2) from the circle, positive on the plate's side."""
        offset = np.asarray(xy, dtype=float) - np.asarray(self.centre)
        return np.asarray(self.radius - np.hypot(offset[..., 0], offset[..., 1]))

    def project(self, xy: ArrayLike) -> FloatArray:
        """The nearest points of the circle to points (..., 2) [m]; for its centre, one of them."""
        offset = np.asarray(xy, dtype=float) - np.asarray(self.centre)
        offset = np.where((offset == 0).all(axis=-1, keepdims=True), (1.0, 0.0), offset)
        distance = np.hypot(offset[..., 0], offset[..., 1])[..., None]
        return np.asarray(self.centre) + self.radius * offset / distance

    def arc(self, start: FloatArray, end: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The shorter arcs between points on the circle, by a parameter s from 0 (start) to 1 (end).

        start, end: (k, 2) m.  s: (n,).  Returns the points (k, n, 2) m and their derivative with respect to s.
        """
        centre = np.asarray(self.centre)
        first = np.arctan2(start[:, 1] - centre[1], start[:, 0] - centre[0])
        sweep = np.arctan2(end[:, 1] - centre[1], end[:, 0] - centre[0]) - first
        sweep = (sweep + np.pi) % (2 * np.pi) - np.pi
        angle = first[:, None] + sweep[:, None] * s
        radial = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        tangent = np.stack([-radial[..., 1], radial[..., 0]], axis=-1)
        return centre + self.radius * radial, self.radius * sweep[:, None, None] * tangent
