"""GivenPlate: what large arrays and large deflection need to know of a plate."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from fem_plate.elements import Fineness, SingularCorner
from fem_plate.types import FloatArray
from fem_plate.varying import Field, Section
from meshes import PlateMesh


class GivenPlate(Protocol):
    """A mesh, a section and supports, as of `fem_plate.Plate`."""

    mesh: PlateMesh
    section: Section
    supports: dict[str, str]
    tolerance: float | None
    tension: float  # N/m
    foundation: float | Field  # N/m^3
    forms: tuple[object, ...]  # of scikit-fem
    corners: list[SingularCorner]
    fineness: Fineness

    @property
    def relative_tension(self) -> float:
        """The tension over the plate's rigidity [1/m^2]."""

    def cells(
        self, points: FloatArray | None = None, halvings: int = 0, corners: Sequence[SingularCorner] = ()
    ) -> PlateMesh:
        """Halved cells, graded towards the plate's corners, further ones, and for actuators at points (N, 2) [m]."""
