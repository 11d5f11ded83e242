"""What a case may have for a plate: one of the plates, or a platform."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import ConfigDict, Discriminator, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema

from coupling.case.plates.plate import PlateCase
from coupling.case.plates.platform import PlatformCase
from coupling.case.plates.shapes import (
    AnnulusCase,
    DiscCase,
    EllipseCase,
    MeshCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
    ShapeCase,
)
from coupling.case.values import adapter

if TYPE_CHECKING:
    from meshes import PlateMesh


class _Shape:
    expected = (
        '"disc", "rectangle", "annulus", "ellipse", "polygon" or "platform", or have mesh = "file.msh" in its place'
    )


class ShapelessCase(PlateCase):
    """A plate whose shape is missing or unknown: it fails on that, and on what is wrong with the rest."""

    model_config = ConfigDict(extra="ignore")

    shape: Annotated[Literal["disc", "rectangle", "annulus", "ellipse", "polygon", "platform"], _Shape()]
    """Which of these it is."""

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"not": {}}  # no plate is right that is one of these

    def build_mesh(self) -> PlateMesh:
        raise AssertionError("a plate with a known shape is one of the other models")


PLATFORM: Final = 'shape = "platform"'
REGULAR: Final = 'shape = "polygon" and a radius'
PLATES: dict[str, type[PlateCase | PlatformCase]] = {
    'shape = "disc"': DiscCase,
    'shape = "rectangle"': RectangleCase,
    'shape = "annulus"': AnnulusCase,
    'shape = "ellipse"': EllipseCase,
    'shape = "polygon"': PolygonCase,
    REGULAR: RegularPolygonCase,
    PLATFORM: PlatformCase,
    "a mesh": MeshCase,
    "no shape": ShapelessCase,
}
"""The models by what messages call them."""


def kind(plate: Any) -> str:
    """Which of PLATES a plate is, given as a table or as a model."""
    keys = plate if isinstance(plate, dict) else getattr(plate, "__dict__", {})
    named = f'shape = "{keys.get("shape")}"'
    if (
        named == 'shape = "polygon"'
        and "corners" not in keys
        and ("radius" in keys or isinstance(keys.get("sides"), int))
    ):
        return REGULAR
    if named in PLATES:
        return named
    return "a mesh" if "mesh" in keys and "shape" not in keys else "no shape"


AnyPlate = Annotated[
    Annotated[DiscCase, Tag('shape = "disc"')]
    | Annotated[RectangleCase, Tag('shape = "rectangle"')]
    | Annotated[AnnulusCase, Tag('shape = "annulus"')]
    | Annotated[EllipseCase, Tag('shape = "ellipse"')]
    | Annotated[PolygonCase, Tag('shape = "polygon"')]
    | Annotated[RegularPolygonCase, Tag(REGULAR)]
    | Annotated[PlatformCase, Tag(PLATFORM)]
    | Annotated[MeshCase, Tag("a mesh")]
    | Annotated[ShapelessCase, Tag("no shape")],
    Discriminator(kind),
]


def outline_of(plate: Any, wrong_keys: Collection[Any], context: Any) -> PlateCase | None:
    """The plate as far as its outline goes, or None where that is wrong or there is a platform.

    plate: a model, or a table of which `wrong_keys` are not valid.
    """
    if not isinstance(plate, dict):
        return plate if isinstance(plate, PlateCase) else None
    model = PLATES[kind(plate)]
    own = model.model_fields.keys() - ShapeCase.model_fields.keys()
    if not issubclass(model, PlateCase) or not own.isdisjoint(wrong_keys):
        return None
    return model.model_construct(
        **{key: adapter(model, key).validate_python(plate[key], context=context) for key in own & plate.keys()}
    )
