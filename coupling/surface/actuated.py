"""ActuatedSurface: a moving surface of more shapes than actuators, whose drives determine all others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Self

from particle import AnyDrive, SurfaceMotion


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
