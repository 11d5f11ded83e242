"""Types of fields that are quantities, and what an annotation says of a field.

Each alias (`Length`, `Time`, ...) is a float to a type checker. As the type of a pydantic field it also accepts text
with a unit of the right dimension. A number without a unit is taken as SI, or refused where the validation context is
`UNITS_REQUIRED`, as it is for files.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final, Literal, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    Discriminator,
    GetCoreSchemaHandler,
    StrictStr,
    Tag,
    ValidationInfo,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from coupling.case.values.units import Expected, Quantity, quoted

AXES: Final = ("x", "y", "z")
TAG: Final = "\ue000"  # a character that no key has


@dataclass(frozen=True)
class Listed:
    """Marks a tuple with what it must be, in words, and with how many items it may have."""

    expected: str
    least: int = 0
    most: float = math.inf

    def validate(self, value: object) -> object:
        """Return a list or tuple with so many items; ValueError for all else."""
        if not isinstance(value, (list, tuple)) or not self.least <= len(value) <= self.most:
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.validate, handler(source))


def tag(name: str) -> str:
    """A name of one of several tables or values that a field may have, which locations of errors are free of."""
    return f"{TAG}{name}"


ONE, LIST = tag("one"), tag("list")
One = TypeVar("One")
Several = TypeVar("Several")
OneOrList = Annotated[
    Annotated[One, Tag(ONE)] | Annotated[Several, Tag(LIST)],
    Discriminator(lambda value: LIST if isinstance(value, (list, tuple)) else ONE),
]
"""One value, or a list of several."""


def _beside(name: str, info: ValidationInfo) -> str:
    """The path of a file that lies beside the one that names it."""
    return str(Path((info.context or {}).get("folder", ""), name))


Length = Annotated[float, Quantity("m", "150 um")]
Time = Annotated[float, Quantity("s", "50 ms")]
Angle = Annotated[float, Quantity("rad", "90 deg")]
AngularVelocity = Annotated[float, Quantity("rad/s", "90 deg/s")]
Frequency = Annotated[float, Quantity("Hz", "300 Hz", positive=True)]
Speed = Annotated[float, Quantity("m/s", "0.1 m/s")]
Acceleration = Annotated[float, Quantity("m/s^2", "9.80665 m/s^2")]
_THREE: Final = 'an acceleration such as "9.80665 m/s^2", or three, along x, y and z'
Three = Annotated[tuple[Acceleration, Acceleration, Acceleration], Listed(_THREE, 3, 3)]
Gravity = Annotated[OneOrList[Acceleration, Three], Expected(_THREE)]
Mass = Annotated[float, Quantity("kg", "2e-9 kg", positive=True)]
Density = Annotated[float, Quantity("kg/m^3", "2330 kg/m^3", positive=True)]
Force = Annotated[float, Quantity("N", "2 uN")]
Stiffness = Annotated[float, Quantity("N/m", "1e4 N/m", positive=True)]
Tension = Annotated[float, Quantity("N/m", "50 N/m", "a force per length")]
Foundation = Annotated[float, Quantity("N/m^3", "1e10 N/m^3")]
Pressure = Annotated[float, Quantity("Pa", "169 GPa")]
LoadPressure = Annotated[float, Quantity("Pa", "100 Pa")]
Temperature = Annotated[float, Quantity("K", "293.15 K", positive=True)]
SurfaceEnergy = Annotated[float, Quantity("J/m^2", "1 J/m^2", positive=True)]
PositiveLength = Annotated[float, Quantity("m", "150 um", positive=True)]
PositiveArea = Annotated[float, Quantity("m^2", "1e4 um^2", positive=True)]
PositiveTime = Annotated[float, Quantity("s", "50 ms", positive=True)]
PositiveForce = Annotated[float, Quantity("N", "2 uN", positive=True)]
PositivePressure = Annotated[float, Quantity("Pa", "169 GPa", positive=True)]
Point = Annotated[tuple[Length, Length], Listed('two lengths, x and y, such as ["100 um", "100 um"]', 2, 2)]
Velocity = Annotated[tuple[Speed, Speed], Listed('two velocities, x and y, such as ["0 m/s", "0 m/s"]', 2, 2)]
FileBeside = Annotated[StrictStr, AfterValidator(_beside)]


def parts_of(annotation: Any, lists: bool = True) -> list[Any]:
    """An annotation and all that it is made of; lists: what is in lists, too."""
    inner = get_args(annotation) if lists or get_origin(annotation) is not tuple else ()
    return [annotation, *(part for one in inner for part in parts_of(one, lists))]


def of_kind(annotation: Any, kind: type) -> Any:
    """The first part of an annotation that is a generic of a kind, such as tuple."""
    return next(part for part in parts_of(annotation) if get_origin(part) is kind)


def marks_of(annotation: Any, lists: bool = True) -> list[Any]:
    """What marks an annotation and its parts."""
    return [mark for part in parts_of(annotation, lists) for mark in getattr(part, "__metadata__", ())]


def quantity_of(annotation: Any, lists: bool = True) -> Quantity | None:
    """What marks a number, or several of one kind, as a quantity; lists: also where it is in a list."""
    return next((mark for mark in marks_of(annotation, lists) if isinstance(mark, Quantity)), None)


def kinds_of_items(annotation: Any, count: int) -> list[Any]:
    """The annotation of each item of a list."""
    types = get_args(of_kind(annotation, tuple))
    return [types[0]] * count if types[-1] is ... else list(types)


def tables_in(annotation: object) -> list[Any]:
    """The tables that an annotation is made of, in its order."""
    return [part for part in parts_of(annotation) if isinstance(part, type) and issubclass(part, BaseModel)]


def names_its_table(field: FieldInfo) -> bool:
    """Whether a field has one choice and so only says which table has it, as the model of a law."""
    return get_origin(field.annotation) is Literal and len(get_args(field.annotation)) == 1


def expected_of(field: FieldInfo) -> str:
    """What a value of a field must be, in words."""
    annotation = field.rebuild_annotation()
    if wanted := next((str(mark.expected) for mark in marks_of(annotation) if hasattr(mark, "expected")), ""):
        return wanted
    kinds = parts_of(annotation)
    choices = next((get_args(kind) for kind in kinds if get_origin(kind) is Literal), ())
    words = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}
    return one_of(choices) if choices else next((word for kind, word in words.items() if kind in kinds), "a value")


def one_of(choices: Iterable[str]) -> str:
    """Choices in quotes, joined by commas and "or"."""
    *others, last = (f'"{choice}"' for choice in choices)
    return f"{', '.join(others)} or {last}" if others else last
