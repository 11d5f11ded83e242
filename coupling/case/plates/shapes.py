"""The plates of a case by their shape: one model for each, and one for a mesh file."""

from __future__ import annotations

import errno
import math
import os
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, GetCoreSchemaHandler, StrictInt, StrictStr, field_validator
from pydantic_core import CoreSchema, core_schema

from coupling.case.plates.plate import PlateCase
from coupling.case.table import Contradictions
from coupling.case.values import Angle, FileBeside, Point, PositiveLength, length_text, quoted

if TYPE_CHECKING:
    from meshes import PlateMesh

CELLS_OF_A_DISC = 64 * math.pi
"""Without a cell size a plate has as many cells as a disc with 8 from centre to rim."""
MAX_SLENDER = 1000.0  # times as long as wide
MAX_CELLS = 25_000  # of a size that is given: halved for an estimate of the error, they fill some GB
COARSER = 2.0  # times: the cells that refinement of a stretching plate begins with


class ShapeCase(PlateCase):
    """A plate given by a few lengths in m, around the origin."""

    cell_size: PositiveLength | None = Field(default=None, gt=0, examples=["50 um"])
    """The size of the mesh's cells, at most half of the smallest width; without it the mesh is refined as it needs."""

    @property
    @abstractmethod
    def measures(self) -> tuple[float, float]:
        """The smallest width [m] and the area [m^2]."""

    @property
    def cell_size_given(self) -> bool:
        return self.cell_size is not None

    def build_mesh(self) -> PlateMesh:
        width, area = self.measures
        times = 1.0 if self.theory == "linear" else COARSER
        return self.mesh_of(self.cell_size or min(width / 4, times * math.sqrt(area / CELLS_OF_A_DISC)))

    @cached_property
    def coarse_mesh(self) -> PlateMesh:
        width, area = self.measures
        if not area <= MAX_SLENDER * width**2:
            times = f"it is {area / width**2:.4g} times as long as wide" if width > 0 else "it has no width"
            raise ValueError(f"must be of a plate at most {MAX_SLENDER:g} times as long as wide; {times}")
        return self.mesh_of(width / 2)

    @property
    def min_cell_size(self) -> float:
        """The smallest size [m] that its cells may have."""
        return math.sqrt(self.measures[1] / (MAX_CELLS * math.sqrt(0.1875)))

    def mesh_of(self, cell_size: float) -> PlateMesh:
        """The mesh with cells of a size [m]."""
        import meshes  # Here, because reading a case is to be quick.

        own = [key for key in type(self).model_fields if key not in ShapeCase.model_fields and key != "shape"]
        return getattr(meshes, self.shape)(*(getattr(self, key) for key in own), cell_size)  # type: ignore[attr-defined]


class DiscCase(ShapeCase):
    """A disc."""

    shape: Literal["disc"]
    """A disc around the origin; its boundary is rim."""
    radius: PositiveLength = Field(gt=0, examples=["300 um"])
    """From the centre to the rim."""

    @property
    def measures(self) -> tuple[float, float]:
        return 2 * self.radius, math.pi * self.radius**2


class RectangleCase(ShapeCase):
    """A rectangle."""

    shape: Literal["rectangle"]
    """A rectangle around the origin; its boundaries are left, right, bottom and top."""
    width: PositiveLength = Field(gt=0, examples=["600 um"])
    """Along x."""
    height: PositiveLength = Field(gt=0, examples=["400 um"])
    """Along y."""

    @property
    def measures(self) -> tuple[float, float]:
        return min(self.width, self.height), self.width * self.height


class AnnulusCase(ShapeCase):
    """A disc with a round hole in its middle."""

    shape: Literal["annulus"]
    """A disc with a round hole; its boundaries are inner and outer."""
    inner_radius: PositiveLength = Field(gt=0, examples=["100 um"])
    """The radius of the hole."""
    outer_radius: PositiveLength = Field(gt=0, examples=["300 um"])
    """The radius of the disc."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        inner, outer = given.get("inner_radius"), given.get("outer_radius")
        if isinstance(inner, float) and isinstance(outer, float) and outer <= inner:
            yield "outer_radius", f"must exceed inner_radius, {length_text(inner)}; got {length_text(outer)}"

    @property
    def measures(self) -> tuple[float, float]:
        return self.outer_radius - self.inner_radius, math.pi * (self.outer_radius**2 - self.inner_radius**2)


class EllipseCase(ShapeCase):
    """An ellipse."""

    shape: Literal["ellipse"]
    """An ellipse around the origin; its boundary is rim."""
    semi_axis_x: PositiveLength = Field(gt=0, examples=["300 um"])
    """Half of its axis along x."""
    semi_axis_y: PositiveLength = Field(gt=0, examples=["200 um"])
    """Half of its axis along y."""

    @property
    def measures(self) -> tuple[float, float]:
        return 2 * min(self.semi_axis_x, self.semi_axis_y), math.pi * self.semi_axis_x * self.semi_axis_y


@dataclass(frozen=True)
class _Corners:
    """Marks a tuple as the corners of a polygon."""

    points: ClassVar[str] = 'three points or more, such as [["0 um", "0 um"], ["2 um", "0 um"], ["0 um", "1 um"]]'
    expected: ClassVar[str] = points + ", or have a number of sides and a radius in their place"

    def validate(self, corners: object) -> object:
        if not isinstance(corners, (list, tuple)) or len(corners) < 3:
            raise ValueError(f"must be {self.points}; got {quoted(corners)}")
        return corners

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.validate, handler(source))


class PolygonCase(ShapeCase):
    """A polygon."""

    outlined_by = "corners"

    shape: Literal["polygon"]
    """A polygon, which may turn inwards; its boundary is rim, or by sides."""
    corners: Annotated[tuple[Point, ...], _Corners()] = Field(
        examples=[[["-300 um", "-300 um"], ["300 um", "-300 um"], ["0 um", "300 um"]]]
    )
    """Its corners, three or more, in either sense."""
    sides: tuple[StrictStr, ...] | None = Field(default=None, examples=[["base", "flank", "flank"]])
    """A name for each side, the first from the first corner to the second; sides of one name are one boundary."""

    @field_validator("sides", mode="before")
    @classmethod
    def _names(cls, sides: Any) -> Any:
        if not isinstance(sides, (list, tuple)):
            raise ValueError(f"must be a list of names, one a side; got {quoted(sides)}")
        return sides

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        corners, sides = given.get("corners"), given.get("sides")
        if isinstance(corners, tuple) and isinstance(sides, tuple) and len(sides) != len(corners):
            yield "sides", f"must be {len(corners)} names, one a side; got {quoted(sides)}"

    @property
    def measures(self) -> tuple[float, float]:
        width = min(max(places) - min(places) for places in zip(*self.corners, strict=True))
        ahead = zip(self.corners, self.corners[1:] + self.corners[:1], strict=True)
        return width, abs(sum(x * v - u * y for (x, y), (u, v) in ahead)) / 2

    def mesh_of(self, cell_size: float) -> PlateMesh:
        import meshes

        return meshes.polygon(self.corners, cell_size, self.sides)


class RegularPolygonCase(ShapeCase):
    """A regular polygon."""

    shape: Literal["polygon"]
    """A regular polygon around the origin, by its sides and its radius; its boundary is rim."""
    sides: StrictInt = Field(ge=3, le=1000, examples=[6])
    """How many sides it has."""
    radius: PositiveLength = Field(gt=0, examples=["300 um"])
    """From the centre to a corner."""
    rotation: Angle = Field(default=0.0, examples=["30 deg"])
    """Turns it counter-clockwise; without it a corner lies on the x axis."""

    @property
    def measures(self) -> tuple[float, float]:
        half = math.pi / self.sides
        width = self.radius * math.cos(half) + self.radius * (1.0 if self.sides % 2 else math.cos(half))
        return width, self.sides * self.radius**2 * math.sin(half) * math.cos(half)

    def mesh_of(self, cell_size: float) -> PlateMesh:
        import meshes

        return meshes.regular_polygon(self.sides, self.radius, cell_size, self.rotation)


class MeshCase(PlateCase):
    """A plate read from a mesh file."""

    outlined_by = "mesh"

    mesh: FileBeside = Field(examples=["plate.msh"])
    """A mesh file of gmsh, VTU or XDMF, beside the case file; its boundaries are the physical curves."""
    mesh_unit: PositiveLength = Field(default=1.0, gt=0, examples=["1 um"])
    """What one unit of its coordinates stands for."""

    @cached_property
    def coarse_mesh(self) -> PlateMesh:
        import meshes

        if not os.path.exists(self.mesh):  # told as for other files, with what may be meant
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), self.mesh)
        return meshes.read(self.mesh, self.mesh_unit)

    def build_mesh(self) -> PlateMesh:
        return self.coarse_mesh  # the file is read once, with the case
