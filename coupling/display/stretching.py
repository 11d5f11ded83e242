"""Stretching: the membrane force and the strain of a plate that stretches, at the points of its display surface."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from coupling.drives import stroke_heights
from coupling.scene import PlateScene
from coupling.stretch import Stretch
from fem_plate import PlateSection

FloatArray = NDArray[np.float64]

STAR = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
NEAR = 0.999  # of half a thickness: points closer to an actuator get the mean of those around it


class Stretching:
    """A plate that stretches, at points (n, 2) [m] of it.

    Within half a thickness of an actuator, where curvature grows without bound, all is the mean of four points at that
    distance.
    """

    def __init__(self, scene: PlateScene, stretch: Stretch, points: FloatArray) -> None:
        self._plate, self._stretch = scene.plate, stretch
        shapes, half = stretch.shapes, scene.plate.section.thickness / 2
        distance, nearest = cKDTree(shapes.points).query(points)
        near = np.flatnonzero(distance < NEAR * half)
        around = shapes.points[nearest[near], None] + half * STAR
        inside = (shapes.outline.gap(around.reshape(-1, 2)) >= 0).reshape(-1, len(STAR))
        self._far = np.setdiff1d(np.arange(len(points)), near)
        every = np.concatenate([points[self._far], around[inside]])
        counts = inside.sum(axis=1)
        owner = np.repeat(np.arange(len(near)), counts)
        self._near, self._means = near, np.eye(len(near))[owner].T / np.maximum(counts, 1)[:, None]
        _, gradient, hessian = shapes.evaluate(every)
        in_plane = shapes.in_plane_gradients(every)
        self._gradient = [np.ascontiguousarray(gradient[..., k]) for k in (0, 1)]
        self._hessian = [np.ascontiguousarray(hessian[..., i, j]) for i, j in ((0, 0), (0, 1), (1, 1))]
        self._in_plane = [(in_plane[:, i, j] + in_plane[:, j, i]) / 2 for i, j in ((0, 0), (0, 1), (1, 1))]

    def fields(self, times: FloatArray) -> dict[str, FloatArray]:
        """The membrane force [N/m] and the top face's strain, xx, xy and yy (k, n, 3), at times (k,) [s]."""
        heights = stroke_heights(self._stretch.moving_drives, times)
        motions = stroke_heights(self._stretch.corrections.in_plane, times)
        x, y = (heights @ slope.T for slope in self._gradient)
        quadratic = x * x, x * y, y * y
        middle = [motions @ e.T + q / 2 for e, q in zip(self._in_plane, quadratic, strict=True)]
        section, tension = self._plate.section, self._plate.tension
        assert isinstance(section, PlateSection)  # as of all plates that stretch
        xx, xy, yy = middle
        of_x, of_y, of_xy = np.tensordot(section.membrane_stiffness, np.stack([xx, yy, 2 * xy]), axes=1)
        force = of_x + tension, of_xy, of_y + tension
        strain = [e - section.thickness / 2 * (heights @ h.T) for e, h in zip(middle, self._hessian, strict=True)]
        return {"membrane_force": self._at_points(force), "strain": self._at_points(strain)}

    def _at_points(self, parts: Sequence[FloatArray]) -> FloatArray:
        sampled = np.stack(parts, axis=-1)
        count = len(self._far)
        values = np.empty((len(sampled), count + len(self._near), 3))
        values[:, self._far] = sampled[:, :count]
        values[:, self._near] = self._means @ sampled[:, count:]
        return values
