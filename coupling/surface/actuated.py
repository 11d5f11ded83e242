"""Moving surfaces of more shapes than actuators, whose drives determine all others; such as that of a pressed plate."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from coupling.surface.motion import surface_motion
from fem_plate import InfluenceShapes, MovingShapes
from fem_plate.elements import PlateFunctions
from particle import AnyDrive, SurfaceMotion
from particle.drives import ORDER, QuinticDrive, Segments


@dataclass(frozen=True, eq=False, repr=False)
class ActuatedSurface(SurfaceMotion):
    """A moving surface with more drives than actuators, whose drives determine all others.

    kept: drives of the last shapes that go up and down, which stay what they are, such as that of a constant pressure.
    """

    kept: tuple[AnyDrive, ...] = ()

    @classmethod
    def of(cls, surface: SurfaceMotion, **more: Any) -> Self:
        """A surface with what a kind of surface knows beyond it."""
        known = [one.name for one in fields(ActuatedSurface) if hasattr(surface, one.name)]
        return cls(**{name: getattr(surface, name) for name in known} | more)

    def driven_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives of its actuators, sharing its cells; raises as `SurfaceMotion` does."""
        if wrong := self.drive_faults({"drives": drives}):
            raise ValueError("; ".join(wrong))
        return self.moved_by(drives)

    def moved_by(self, drives: Sequence[AnyDrive], in_plane_drives: Sequence[AnyDrive] = ()) -> SurfaceMotion:
        """The same surface with other drives of all shapes but those that stay what they are."""
        return super().driven_by([*drives, *self.kept], in_plane_drives)

    def scaled(self, factor: float, stroke: float = 1.0) -> SurfaceMotion:
        """As `SurfaceMotion.scaled`; the drives that stay what they are keep their heights."""
        surface = super().scaled(factor, stroke)
        if not self.kept:
            return surface
        table, end = surface.drives, self.shape_count
        rows = slice(table.first[end - len(self.kept)], table.first[end])
        coefficients = table.coefficients.copy()
        coefficients[rows] = self.drives.coefficients[rows]
        return replace(surface, drives=table._replace(coefficients=coefficients))

    def drive_faults(
        self, given: Mapping[str, Sequence[AnyDrive]], in_plane: Mapping[str, Sequence[AnyDrive]] | None = None
    ) -> list[str]:
        if in_plane is not None:
            return super().drive_faults(given, in_plane)
        count = len(self.sources)
        return [
            f"Input {name} must be one an actuator, {count}; got {len(row)}"
            for name, row in given.items()
            if len(row) != count
        ]


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
        highest = float(np.abs(functions.values(functions.space.samples)).max())
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
