"""Marks of pydantic fields that are quantities, and the types of such fields.

Each alias at the end (`Length`, `Time`, ...) is a float to a type checker. As the type of a pydantic field it also
accepts text with a unit of the right dimension. A number without a unit is taken as SI, or refused where the
validation context is `UNITS_REQUIRED`, as it is for files.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, StrictStr, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from coupling.case.values.units import Quantity, quoted

AXES: Final = ("x", "y", "z")
_COUNTS: Final = {2: "two", 3: "three"}


@dataclass(frozen=True)
class Pair:
    """Marks a tuple as the x and y of a point or vector; `name` is what the two are, `example` one of them."""

    name: str
    example: str

    @property
    def expected(self) -> str:
        """What a value must be, in words: two lengths, x and y, such as ["100 um", "100 um"]."""
        return f"two {self.name}, x and y, such as {quoted([self.example, self.example])}"

    def validate(self, value: object) -> object:
        """Return `value`; ValueError unless it is a list or tuple of two."""
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            both = _both(value)
            instead = f"; write {quoted(both)}" if both else ""
            raise ValueError(f"must be {self.expected}; got {quoted(value)}{instead}")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.validate, handler(source))


def _both(value: object) -> list[object] | None:
    """The two that are meant by a table of x and y, or by one text; None: it is no such thing."""
    if isinstance(value, dict) and {*value} == {"x", "y"}:
        return [value["x"], value["y"]]
    if isinstance(value, str) and re.fullmatch(r"[+-]?0+(\.0*)?\s*[^\W\d][^,;]*", value.strip()):
        return [value, value]
    parts = re.split(r"[,;]\s*", value.strip("()[] \t")) if isinstance(value, str) else []
    return [*parts] if len(parts) == 2 and all(map(re.compile(r".*\d\s*[^\W\d].*").fullmatch, parts)) else None


@dataclass(frozen=True)
class Directed:
    """Marks a quantity that is one number, or one along each of some axes."""

    quantity: Quantity
    axes: str = "xyz"

    @property
    def expected(self) -> str:
        """What a value must be, in words: an acceleration such as "9.8 m/s^2", or three, along x, y and z."""
        along = f"{', '.join(self.axes[:-1])} and {self.axes[-1]}"
        return f"{self.quantity.expected}, or {_COUNTS[len(self.axes)]}, along {along}"

    def validate(self, value: object, info: ValidationInfo) -> object:
        """Return the value in SI units; ValueError for what is neither one nor one an axis, or wrong by itself."""
        if not isinstance(value, (list, tuple)):
            return self.quantity.validate(value, info)
        if len(value) != len(self.axes):
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        parts, wrong = [], []
        for name, part in zip(self.axes, value, strict=True):
            try:
                parts.append(self.quantity.validate(part, info))
            except ValueError as error:
                wrong.append(f"its {name} {error}")
        if wrong:
            raise ValueError("is wrong: " + "; ".join(wrong))
        return tuple(parts)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        one, count = self.quantity.__get_pydantic_json_schema__(schema, handler), len(self.axes)
        return {"anyOf": [one, {"type": "array", "items": one, "minItems": count, "maxItems": count}]}


@dataclass(frozen=True)
class _Beside:
    """Marks the name of a file that lies beside the one that names it; it becomes a path."""

    def validate(self, name: str, info: ValidationInfo) -> str:
        return str(Path((info.context or {}).get("folder", ""), name))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_after_validator_function(self.validate, handler(source))


Length = Annotated[float, Quantity("m", "150 um")]
Area = Annotated[float, Quantity("m^2", "1e4 um^2")]
Time = Annotated[float, Quantity("s", "50 ms")]
Angle = Annotated[float, Quantity("rad", "90 deg")]
Frequency = Annotated[float, Quantity("Hz", "300 Hz", positive=True)]
Speed = Annotated[float, Quantity("m/s", "0.1 m/s")]
Acceleration = Annotated[float, Quantity("m/s^2", "9.80665 m/s^2")]
Gravity = Annotated[float | tuple[float, float, float], Directed(Quantity("m/s^2", "9.80665 m/s^2"))]
Mass = Annotated[float, Quantity("kg", "2e-9 kg", positive=True)]
Density = Annotated[float, Quantity("kg/m^3", "2330 kg/m^3", positive=True)]
Force = Annotated[float, Quantity("N", "2 uN")]
Stiffness = Annotated[float, Quantity("N/m", "1e4 N/m", positive=True)]
Tension = Annotated[float, Quantity("N/m", "50 N/m", "a force per length")]
Foundation = Annotated[float, Quantity("N/m^3", "1e10 N/m^3")]
Pressure = Annotated[float, Quantity("Pa", "169 GPa")]
LoadPressure = Annotated[float, Quantity("Pa", "100 Pa")]
SurfaceEnergy = Annotated[float, Quantity("J/m^2", "1 J/m^2", positive=True)]
PositiveLength = Annotated[float, Quantity("m", "150 um", positive=True)]
PositiveArea = Annotated[float, Quantity("m^2", "1e4 um^2", positive=True)]
PositiveTime = Annotated[float, Quantity("s", "50 ms", positive=True)]
PositiveForce = Annotated[float, Quantity("N", "2 uN", positive=True)]
PositivePressure = Annotated[float, Quantity("Pa", "169 GPa", positive=True)]
Point = Annotated[tuple[Length, Length], Pair("lengths", "100 um")]
Velocity = Annotated[tuple[Speed, Speed], Pair("velocities", "0 m/s")]
FileBeside = Annotated[StrictStr, _Beside()]
