"""The plates of a case by their shape: one model for each, and one for a mesh file."""

from __future__ import annotations

import errno
import math
import os
from abc import abstractmethod
from collections.abc import Mapping
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Discriminator, Field, StrictInt, StrictStr, Tag

from coupling.case.plates.plate import PlateCase
from coupling.case.plates.platform import PlatformCase
from coupling.case.table import Contradictions, Table, named
from coupling.case.values import Angle, FileBeside, Listed, Point, PositiveLength, length_text, quoted, tag

if TYPE_CHECKING:
    from meshes import PlateMesh

CELLS_OF_A_DISC = 64 * math.pi
"""Without a cell size a plate has as many cells as a disc with 8 from centre to rim."""
MAX_SLENDER = 1000.0  # times as long as wide
MAX_CELLS = 25_000  # of a size that is given: halved for an estimate of the error, they fill some GB
COARSER = 2.0  # times: the cells that refinement of a stretching plate begins with


class ShapeCase(PlateCase):
    """A plate given by a few lengths in m, around the origin."""

    cell_size: PositiveLength | None = Field(default=None, examples=["50 um"])
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
        times = area / width / width if width else 0.0  # without a width the corners are wrong, which the mesh says
        if times > MAX_SLENDER:
            raise ValueError(f"must be at most {MAX_SLENDER:g} times as long as wide; got {times:.4g} times")
        name, own = self._made_by
        return _kept_mesh(name, cell_size=width / 2 or 1.0, **own)

    @property
    def min_cell_size(self) -> float:
        """The smallest size [m] that its cells may have."""
        return math.sqrt(self.measures[1] / (MAX_CELLS * math.sqrt(0.1875)))

    def mesh_of(self, cell_size: float) -> PlateMesh:
        """The mesh with cells of a size [m]."""
        name, own = self._made_by
        return _mesh(name, cell_size=cell_size, **own)

    @property
    def _made_by(self) -> tuple[str, dict[str, Any]]:
        """The function of `meshes` for it, and the arguments that shape it."""
        own = {key: getattr(self, key) for key in type(self).model_fields if key not in ShapeCase.model_fields}
        return own.pop("shape"), own


def _mesh(name: str, **shape: Any) -> PlateMesh:
    import meshes  # Here, because reading a case is to be quick.

    mesh: PlateMesh = getattr(meshes, name)(**shape)
    return mesh


_kept_mesh = lru_cache(16)(_mesh)
"""The mesh of a shape, kept for plates that differ in other keys only."""


class DiscCase(ShapeCase):
    """A disc."""

    shape: Literal["disc"]
    """A disc around the origin; its boundary is rim."""
    radius: PositiveLength = Field(examples=["300 um"])
    """From the centre to the rim."""

    @property
    def measures(self) -> tuple[float, float]:
        return 2 * self.radius, math.pi * self.radius**2


class RectangleCase(ShapeCase):
    """A rectangle."""

    shape: Literal["rectangle"]
    """A rectangle around the origin; its boundaries are left, right, bottom and top."""
    width: PositiveLength = Field(examples=["600 um"])
    """Along x."""
    height: PositiveLength = Field(examples=["400 um"])
    """Along y."""

    @property
    def measures(self) -> tuple[float, float]:
        return min(self.width, self.height), self.width * self.height


class AnnulusCase(ShapeCase):
    """A disc with a round hole in its middle."""

    shape: Literal["annulus"]
    """A disc with a round hole; its boundaries are inner and outer."""
    inner_radius: PositiveLength = Field(examples=["100 um"])
    """The radius of the hole."""
    outer_radius: PositiveLength = Field(examples=["300 um"])
    """The radius of the disc."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        inner, outer = given["inner_radius"], given["outer_radius"]
        if outer <= inner:
            yield "outer_radius", f"must exceed inner_radius, {length_text(inner)}; got {length_text(outer)}"

    @property
    def measures(self) -> tuple[float, float]:
        return self.outer_radius - self.inner_radius, math.pi * (self.outer_radius**2 - self.inner_radius**2)


class EllipseCase(ShapeCase):
    """An ellipse."""

    shape: Literal["ellipse"]
    """An ellipse around the origin; its boundary is rim."""
    semi_axis_x: PositiveLength = Field(examples=["300 um"])
    """Half of its axis along x."""
    semi_axis_y: PositiveLength = Field(examples=["200 um"])
    """Half of its axis along y."""

    @property
    def measures(self) -> tuple[float, float]:
        return 2 * min(self.semi_axis_x, self.semi_axis_y), math.pi * self.semi_axis_x * self.semi_axis_y


_POINTS: Final = 'three points or more, such as [["0 um", "0 um"], ["2 um", "0 um"], ["0 um", "1 um"]]'


class PolygonCase(ShapeCase):
    """A polygon."""

    outlined_by = "corners"

    shape: Literal["polygon"]
    """A polygon, which may turn inwards; its boundary is rim, or by sides."""
    corners: Annotated[tuple[Point, ...], Listed(f"{_POINTS}, or use a number of sides and a radius instead", 3)] = (
        Field(examples=[[["-300 um", "-300 um"], ["300 um", "-300 um"], ["0 um", "300 um"]]])
    )
    """Its corners, three or more, in either sense."""
    sides: Annotated[tuple[StrictStr, ...], Listed("a list of names, one a side")] | None = Field(
        default=None, examples=[["base", "flank", "flank"]]
    )
    """A name for each side, the first from the first corner to the second; sides of one name are one boundary."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        corners, sides = given["corners"], given.get("sides")
        if sides is not None and len(sides) != len(corners):
            yield "sides", f"must be {len(corners)} names, one a side; got {quoted(sides)}"

    @property
    def measures(self) -> tuple[float, float]:
        width = min(max(places) - min(places) for places in zip(*self.corners, strict=True))
        ahead = zip(self.corners, self.corners[1:] + self.corners[:1], strict=True)
        return width, abs(sum(x * v - u * y for (x, y), (u, v) in ahead)) / 2

    @property
    def _made_by(self) -> tuple[str, dict[str, Any]]:
        return "polygon", {"corners": self.corners, "names": self.sides}


class RegularPolygonCase(ShapeCase):
    """A regular polygon."""

    shape: Literal["polygon"]
    """A regular polygon around the origin, by its sides and its radius; its boundary is rim."""
    sides: StrictInt = Field(ge=3, le=1000, examples=[6])
    """How many sides it has."""
    radius: PositiveLength = Field(examples=["300 um"])
    """From the centre to a corner."""
    rotation: Angle = Field(default=0.0, examples=["30 deg"])
    """Turns it counter-clockwise; without it a corner lies on the x axis."""

    @property
    def measures(self) -> tuple[float, float]:
        half = math.pi / self.sides
        width = self.radius * math.cos(half) + self.radius * (1.0 if self.sides % 2 else math.cos(half))
        return width, self.sides * self.radius**2 * math.sin(half) * math.cos(half)

    @property
    def _made_by(self) -> tuple[str, dict[str, Any]]:
        return "regular_polygon", super()._made_by[1]


class MeshCase(PlateCase):
    """A plate read from a mesh file."""

    outlined_by = "mesh"

    mesh: FileBeside = Field(examples=["plate.msh"])
    """A mesh file of gmsh, VTU or XDMF, beside the case file; its boundaries are the physical curves."""
    mesh_unit: PositiveLength = Field(default=1.0, examples=["1 um"])
    """What one unit of its coordinates stands for."""

    @cached_property
    def coarse_mesh(self) -> PlateMesh:
        import meshes

        if "\0" in self.mesh:
            raise OSError(errno.EINVAL, "its name has a null character in it", self.mesh)
        os.stat(self.mesh)  # raises FileNotFoundError as for other files, with the name
        return meshes.read(self.mesh, self.mesh_unit)

    def build_mesh(self) -> PlateMesh:
        return self.coarse_mesh  # the file is read once, with the case


PLATFORM: Final = 'shape = "platform"'
_SHAPES: Final = ("disc", "rectangle", "annulus", "ellipse", "polygon", "platform")


def _kind(plate: Any) -> str:
    """The tag of a plate, given as a table or as a model."""
    table = vars(plate) if isinstance(plate, Table) else plate if isinstance(plate, Mapping) else {"shape": "disc"}
    name = table.get("shape", "mesh")
    regular = "corners" not in table and ("radius" in table or isinstance(table.get("sides"), int))
    return tag("regular" if name == "polygon" and regular else name)


AnyPlate = Annotated[
    Annotated[DiscCase, Tag(tag("disc"))]
    | Annotated[RectangleCase, Tag(tag("rectangle"))]
    | Annotated[AnnulusCase, Tag(tag("annulus"))]
    | Annotated[EllipseCase, Tag(tag("ellipse"))]
    | Annotated[PolygonCase, Tag(tag("polygon"))]
    | Annotated[RegularPolygonCase, Tag(tag("regular"))]
    | Annotated[PlatformCase, Tag(tag("platform"))]
    | Annotated[MeshCase, Tag(tag("mesh"))],
    Discriminator(_kind),
    BeforeValidator(named("shape", _SHAPES, "mesh")),
]
"""What a case may have for a plate: one of the plates, or a platform."""
