"""What a case may have for a plate: the plates of `plate_case`, or a platform."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import ConfigDict, Discriminator, GetJsonSchemaHandler, Tag, ValidationError
from pydantic_core import CoreSchema

from coupling.case.plate import (
    ONE_SUPPORT,
    SUPPORT_OF_EACH,
    AnnulusCase,
    DiscCase,
    EllipseCase,
    MeshCase,
    PlateCase,
    PolygonCase,
    RectangleCase,
    ShapeCase,
)
from coupling.case.platform import BY_DRIVES, FROM_FILE, PlatformCase

if TYPE_CHECKING:
    from meshes import PlateMesh


class _Wanted:
    wanted = (
        '"disc", "rectangle", "annulus", "ellipse", "polygon" or "platform", or have mesh = "file.msh" in its place'
    )


class ShapelessCase(PlateCase):
    """A plate whose shape is missing or unknown: it fails on that, and on what is wrong with the rest."""

    model_config = ConfigDict(extra="ignore")

    shape: Annotated[Literal["disc", "rectangle", "annulus", "ellipse", "polygon", "platform"], _Wanted()]
    """Which of these it is."""

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"not": {}}  # no plate is right that is one of these

    def build_mesh(self) -> PlateMesh:
        raise AssertionError("a plate with a known shape is one of the other models")


PLATFORM: Final = 'shape = "platform"'
PLATES: dict[str, type[PlateCase | PlatformCase]] = {
    'shape = "disc"': DiscCase,
    'shape = "rectangle"': RectangleCase,
    'shape = "annulus"': AnnulusCase,
    'shape = "ellipse"': EllipseCase,
    'shape = "polygon"': PolygonCase,
    PLATFORM: PlatformCase,
    "a mesh": MeshCase,
    "no shape": ShapelessCase,
}
"""The models by what messages call them."""


def kind(plate: Any) -> str:
    """Which of PLATES a plate is, given as a table or as a model."""
    keys = plate if isinstance(plate, dict) else getattr(plate, "__dict__", {})
    named = f'shape = "{keys.get("shape")}"'
    if named in PLATES:
        return named
    return "a mesh" if "mesh" in keys and "shape" not in keys else "no shape"


TAGS: Final = frozenset({*PLATES, ONE_SUPPORT, SUPPORT_OF_EACH, FROM_FILE, BY_DRIVES})
"""What validation puts into the location of a mistake, but is no key of the file."""

AnyPlate = Annotated[
    Annotated[DiscCase, Tag('shape = "disc"')]
    | Annotated[RectangleCase, Tag('shape = "rectangle"')]
    | Annotated[AnnulusCase, Tag('shape = "annulus"')]
    | Annotated[EllipseCase, Tag('shape = "ellipse"')]
    | Annotated[PolygonCase, Tag('shape = "polygon"')]
    | Annotated[PlatformCase, Tag(PLATFORM)]
    | Annotated[MeshCase, Tag("a mesh")]
    | Annotated[ShapelessCase, Tag("no shape")],
    Discriminator(kind),
]

_ANY_MATERIAL = {"youngs_modulus": "1 Pa", "poisson_ratio": 0.3, "thickness": "1 m"}


def outline_of(plate: Any, context: Any) -> PlateCase | None:
    """The plate as far as its outline goes, whatever else is wrong; None where that is wrong too, and of a platform."""
    if not isinstance(plate, dict):
        return plate if isinstance(plate, PlateCase) else None
    model = PLATES[kind(plate)]
    if not issubclass(model, PlateCase):
        return None
    own = {
        key: value for key, value in plate.items() if key in model.model_fields.keys() - ShapeCase.model_fields.keys()
    }
    try:
        return model.model_validate(own | _ANY_MATERIAL, context=context)
    except ValidationError:
        return None
