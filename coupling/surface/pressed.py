"""Pressed: a plate that a constant pressure deflects as well as its actuators."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from coupling.surface.actuated import ActuatedSurface
from coupling.surface.motion import surface_motion
from fem_plate import InfluenceShapes, MovingShapes
from fem_plate.elements import PlateFunctions
from particle import AnyDrive
from particle.drives import ORDER, QuinticDrive, Segments


@dataclass(frozen=True, eq=False)
class PressureShape:
    """The deflection of a plate under a constant pressure, its actuators' strokes and forces 0.

    functions: one, 1 where it is highest.  drive: its height [m], which stays what it is.
    """

    functions: PlateFunctions
    drive: QuinticDrive

    @staticmethod
    def of(shapes: InfluenceShapes, pressure: float) -> PressureShape:
        """That of a pressure other than 0 [Pa], on the cells of the plate's influence shapes."""
        functions = shapes.under_pressure(pressure)
        highest = float(np.abs(functions.values(functions.space.points)).max())
        return PressureShape(functions.weighted(np.array([1 / highest])), _constant(highest))


@dataclass(frozen=True, eq=False)
class Pressed:
    """A plate under a constant pressure and N drives, without mass.

    shapes: of the actuators, then that of the pressure.
    """

    shapes: MovingShapes
    drives: Sequence[AnyDrive]
    pressure: PressureShape

    @staticmethod
    def under(shapes: InfluenceShapes, drives: Sequence[AnyDrive], pressure: float) -> Pressed:
        """The plate under a pressure other than 0 [Pa]."""
        shape = PressureShape.of(shapes, pressure)
        moving = MovingShapes.beside(shapes, shape.functions, np.append(shapes.own_heights(), 1.0))
        return Pressed(moving, drives, shape)

    def driven_by(self, drives: Sequence[AnyDrive]) -> Pressed:
        """The same plate under other drives."""
        return replace(self, drives=drives)

    @property
    def moving_drives(self) -> list[AnyDrive]:
        """The drive of each shape."""
        return [*self.drives, self.pressure.drive]

    def surface(self, tolerance: float, half_thickness: float) -> ActuatedSurface:
        """The moving surface."""
        surface = surface_motion(self.shapes, self.moving_drives, tolerance, half_thickness)
        return ActuatedSurface.of(surface, kept=(self.pressure.drive,))


def _constant(height: float) -> QuinticDrive:
    """A drive that stays at a height [m]: it has ended before the time 0, and so has no breakpoints."""
    row = np.zeros((1, ORDER))
    row[0, 0] = height
    return QuinticDrive(Segments(np.zeros(1), np.ones(1), row, 1.0), math.inf, 0.0, delay=-1.0)
