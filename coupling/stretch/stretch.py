"""Stretch: a plate that stretches under the drives of one run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.drives import moments, stroke_heights
from coupling.extremes import sharp_points
from coupling.stretch.corrections import Corrections
from coupling.stretch.model import StretchModel
from coupling.surface import surface_motion
from fem_plate import StretchedShapes
from particle import AnyDrive, SurfaceMotion

FloatArray = NDArray[np.float64]

AROUND = 16  # directions around an actuator in which strains are sampled


@dataclass(frozen=True, eq=False)
class Stretch:
    """A plate that stretches under N drives up to a time `end` [s]."""

    model: StretchModel
    drives: Sequence[AnyDrive]
    corrections: Corrections
    end: float

    @staticmethod
    def under(model: StretchModel, drives: Sequence[AnyDrive], end: float) -> Stretch:
        """The plate under drives."""
        return Stretch(model, drives, model.corrections(drives, end), end)

    @property
    def shapes(self) -> StretchedShapes:
        """Shapes of the actuators, then of corrections."""
        return self.model.shapes

    @property
    def moving_drives(self) -> list[AnyDrive]:
        """The drive of each of these."""
        return [*self.drives, *self.corrections.drives]

    def surface(self, tolerance: float, half_thickness: float) -> SurfaceMotion:
        """The moving surface."""
        return surface_motion(self.shapes, self.moving_drives, tolerance, half_thickness, self.corrections.in_plane)

    @property
    def solutions(self) -> int:
        """How many full solutions the model is made of."""
        return self.model.reduction.solutions

    @property
    def mesh_error(self) -> float:
        """Of a full solution, over the largest w."""
        return self.model.mesh_error

    @property
    def reduction_error(self) -> float:
        """Of the model against full solutions that were not used to make it, over the largest w."""
        return self.model.reduction.error

    @property
    def piece_error(self) -> float:
        """Of the corrections' quintics in time, over the largest correction."""
        return self.corrections.error

    def states(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Heights of actuators and corrections (k, N + n), and in-plane motions (k, M) [m], at times (k,) [s]."""
        return stroke_heights(self.moving_drives, times), stroke_heights(self.corrections.in_plane, times)

    @cached_property
    def extremes(self) -> Extremes:
        """The largest deflection, slope and strain, on halved cells, half a thickness off infinite moments."""
        plate, mesh = self.model.large.plate, self.model.reduction.discrete.mesh.refined()
        sharp, thickness = sharp_points(plate.corners, self.shapes.points), plate.section.thickness
        angle = 2 * np.pi * np.arange(AROUND) / AROUND
        circle = thickness / 2 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        around = (sharp[:, None] + circle).reshape(-1, 2)
        off = np.hypot(*(mesh.points[:, None] - sharp).transpose(2, 0, 1)).min(axis=1) > thickness / 2
        field = StretchField(self, np.concatenate([mesh.points[off], around[self.shapes.outline.inside(around)]]))
        states = zip(*self.states(moments(self.drives, self.end)), strict=True)
        return Extremes(*np.max([field.extremes(b, g) for b, g in states], axis=0).tolist())


class Extremes(NamedTuple):
    """The largest of some points and times."""

    deflection: float  # m
    slope: float
    strain: float  # the largest principal strain, at the top or the bottom face


class StretchField:
    """A plate that stretches at points (n, 2) [m].

    Its state at a time is b, the heights of actuators and corrections (N + n,), and g, the in-plane motions (M,), in m.
    """

    def __init__(self, stretch: Stretch, xy: FloatArray) -> None:
        shapes, self._plate = stretch.shapes, stretch.model.large.plate
        self._value, gradient, hessian = shapes.evaluate(xy)
        self._gradient, self._hessian = (np.ascontiguousarray(np.moveaxis(rows, 1, -1)) for rows in (gradient, hessian))
        self._in_plane = shapes.in_plane_gradients(xy)

    def strain(self, slope: FloatArray, b: FloatArray, g: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The strain of the mid-plane under slopes (n, 2), and what bending adds at the top face, (n, 2, 2) each."""
        stretched = self._in_plane @ g
        middle = (stretched + stretched.transpose(0, 2, 1) + slope[:, :, None] * slope[:, None]) / 2
        return middle, -self._plate.section.thickness / 2 * (self._hessian @ b)

    def extremes(self, b: FloatArray, g: FloatArray) -> Extremes:
        """The largest deflection, slope and strain of the points."""
        slope = self._gradient @ b
        middle, bending = self.strain(slope, b, g)
        strain = max(_largest_principal(middle + sign * bending) for sign in (-1, 1))
        return Extremes(float(np.abs(self._value @ b).max()), float(np.linalg.norm(slope, axis=1).max()), strain)


def _largest_principal(tensors: FloatArray) -> float:
    """The largest eigenvalue, by size, of symmetric tensors (n, 2, 2)."""
    middle = (tensors[:, 0, 0] + tensors[:, 1, 1]) / 2
    radius = np.hypot((tensors[:, 0, 0] - tensors[:, 1, 1]) / 2, tensors[:, 0, 1])
    return float((np.abs(middle) + radius).max())
