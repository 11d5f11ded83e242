"""Quantities with units: text such as "150 um" becomes a float in SI units.

Each alias at the end of this module (`Length`, `Time`, ...) is a float to a type checker. As the type of a pydantic
field it also accepts text with a unit of the right dimension. A bare number is taken as SI, or is an error where the
validation context is `UNITS_REQUIRED`, as it is for a case file.
"""

from __future__ import annotations

import difflib
import json
import math
import re
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

if TYPE_CHECKING:
    import pint

UNITS_REQUIRED: Final = {"units_required": True}
"""The validation context in which a bare number is not accepted as a quantity."""

DIMENSIONS: Final = {
    "m": "a length", "m^2": "an area", "m^3": "a volume", "rad": "an angle",
    "s": "a time", "Hz": "a frequency", "rad/s": "an angular velocity", "m/s": "a velocity", "m/s^2": "an acceleration",
    "kg": "a mass", "kg/m^3": "a density", "N": "a force", "Pa": "a pressure",
    "J": "an energy", "J/m^2": "an energy per area", "N/m": "a stiffness",
    "W": "a power", "K": "a temperature", "1": "a plain number",
}  # fmt: skip
"""SI units, and what a quantity in each is called in a message."""

_USUAL_UNITS: Final = [
    *("m", "cm", "mm", "um", "nm", "m^2", "mm^2", "um^2", "nm^2", "m^3", "meter", "micrometer", "nanometer", "micron"),
    *("s", "ms", "us", "s^2", "second", "Hz", "kHz", "MHz", "hertz", "kg", "g", "mg", "ug", "ng", "gram"),
    *(
        "metre",
        "micrometre",
        "nanometre",
        "millisecond",
        "microsecond",
        "kilohertz",
        "milligram",
        "microgram",
        "nanogram",
    ),
    *("N", "mN", "uN", "nN", "newton", "Pa", "kPa", "MPa", "GPa", "pascal", "J", "mJ", "uJ", "nJ", "joule"),
]

# Other characters are refused here because pint skips them: it would read "1,5 mm" as 15 mm, and a typographic minus
# sign as nothing at all.
_NUMBER_AND_UNIT: Final = re.compile(
    r"(?P<number>[+-]?(?:(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?|(?:nan|inf)\b))"
    r"[ \t]*(?P<unit>[\w \t.*/^()+⁻·⋅°%-]*)"
)

# The same for JSON schemas, as far as it goes without a list of all units.
WRITTEN: Final = r"^\s*[+-]?\.?[0-9][0-9_.]*([eE][+-]?[0-9]+)?\s*([^0-9_.,;\s]|[0-9]+/).*$"
POSITIVE: Final = WRITTEN.replace("[+-]?", "[+]?", 1)

_COUNTS: Final = {2: "two", 3: "three"}
_NONSENSE: Final = ", which is not a number and a unit"
_NO_UNIT: Final = ", which has no unit"
_NOT_FINITE: Final = ", which is not finite"


@dataclass(frozen=True)
class Quantity:
    """Marks a float as a quantity in the SI unit `unit`, a key of `DIMENSIONS`; `example` shows how to write one."""

    unit: str
    example: str

    @property
    def wanted(self) -> str:
        """What a value must be, in words: a length such as "150 um"."""
        return f'{DIMENSIONS[self.unit]} such as "{self.example}"'

    def parse(self, text: str) -> float:
        """Return the quantity that `text` states, in `unit`; ValueError unless it is a finite one of this dimension."""
        match = _NUMBER_AND_UNIT.fullmatch(text.strip())
        if match is None:
            raise self.refusal(text, "; write decimals with a point" if "," in text else _NONSENSE)
        return self.convert(text, match["number"], match["unit"])

    def convert(self, text: str, number: str, unit: str) -> float:
        """Return so many of a unit, in `unit`; ValueError, which shows the text, as from `parse`."""
        import pint  # Here, because loading pint takes longer than the rest of the package.

        if not unit:
            raise self.refusal(text, _NO_UNIT)
        try:
            fits = self._fits(unit)
            value = float(_registry().Quantity(Decimal(number), unit).m_as(self.unit)) if fits else math.nan
        except pint.UndefinedUnitError as error:
            raise self.refusal(text, self._unknown_unit(number, unit, error)) from None
        except Exception:  # On nonsense pint raises anything from AssertionError to TokenError.
            raise self.refusal(text, _NONSENSE) from None
        if not fits:
            raise self.refusal(text, f", {_dimension(unit)}")
        if not math.isfinite(value):
            raise self.refusal(text, _NOT_FINITE)
        return value

    def validate(self, value: object, info: ValidationInfo) -> float:
        """Return a number as it is and text in `unit`; ValueError for what is neither, or lacks a unit it needs."""
        if isinstance(value, str):
            return self.parse(value)
        if isinstance(value, bool) or not isinstance(value, Real):
            raise self.refusal(value)
        if info.context and info.context.get("units_required"):
            raise self.refusal(value, _NO_UNIT)
        if not math.isfinite(value):
            raise self.refusal(value, _NOT_FINITE)
        return float(value)

    def _fits(self, unit: str) -> bool:
        return _root(unit) == _root(self.unit)

    def _unknown_unit(self, number: str, unit: str, error: pint.UndefinedUnitError) -> str:
        name = error.unit_names if isinstance(error.unit_names, str) else next(iter(error.unit_names))
        same = [usual for usual in _USUAL_UNITS if usual.lower() == name.lower()]
        for usual in same + difflib.get_close_matches(name, _USUAL_UNITS):
            near = unit.replace(name, usual)
            with suppress(Exception):  # There may be a second unknown unit in it.
                if self._fits(near):
                    return f', but there is no unit "{name}"; did you mean "{number} {near}"?'
        return f', but there is no unit "{name}"'

    def refusal(self, value: object, reason: str = "") -> ValueError:
        """The error that says what a value must be, and that this one is not."""
        return ValueError(f"must be {self.wanted}; got {shown(value)}{reason}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_before_validator_function(self.validate, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "pattern": WRITTEN, "examples": [self.example]}


@dataclass(frozen=True)
class Pair:
    """Marks a tuple as the x and y of a point or vector; `name` is what the two are, `example` one of them."""

    name: str
    example: str

    @property
    def wanted(self) -> str:
        """What a value must be, in words: two lengths, x and y, such as ["100 um", "100 um"]."""
        return f"two {self.name}, x and y, such as {shown([self.example, self.example])}"

    def validate(self, value: object) -> object:
        """Return `value`; ValueError unless it is a list or tuple of two."""
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise ValueError(f"must be {self.wanted}; got {shown(value)}")
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.validate, handler(source))


@dataclass(frozen=True)
class Directed:
    """Marks a quantity that is one number, or one along each of some axes."""

    quantity: Quantity
    axes: str = "xyz"

    @property
    def wanted(self) -> str:
        """What a value must be, in words: an acceleration such as "9.8 m/s^2", or three, along x, y and z."""
        along = f"{', '.join(self.axes[:-1])} and {self.axes[-1]}"
        return f"{self.quantity.wanted}, or {_COUNTS[len(self.axes)]}, along {along}"

    def validate(self, value: object, info: ValidationInfo) -> object:
        """Return the value in SI units; ValueError for what is neither one nor one an axis, or wrong by itself."""
        if not isinstance(value, (list, tuple)):
            return self.quantity.validate(value, info)
        if len(value) != len(self.axes):
            raise ValueError(f"must be {self.wanted}; got {shown(value)}")
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


def shown(value: object) -> str:
    """Return `value` as a case file would write it, or in words if that is long."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, (list, tuple)):
        if any(isinstance(item, dict) for item in value):
            return "a list of tables"
        text = "[" + ", ".join(shown(item) for item in value) + "]"
    elif isinstance(value, (str, bool)):
        text = json.dumps(value, ensure_ascii=False)
    else:
        text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def shown_length(length: float, unit: str = "um") -> str:
    """Return a length in m as text in a unit of length."""
    return f"{length / Quantity('m', '150 um').convert('', '1', unit):g} {unit}"


def written_unit(value: object) -> str:
    """Return the unit of the first length in what a case file has; um where there is none."""
    texts = [part for part in value if isinstance(part, str)] if isinstance(value, (list, tuple)) else [value]
    for text in texts:
        match = _NUMBER_AND_UNIT.fullmatch(text.strip()) if isinstance(text, str) else None
        if match and match["unit"]:
            return match["unit"].strip()
    return "um"


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint

    # Decimals, so that "100 um" gives the float 1e-4 itself and not a neighbour.
    return pint.UnitRegistry(non_int_type=Decimal)


def _root(unit: str) -> pint.Unit:
    # Dimensions do not tell Hz from rad/s, and pint would turn 60 rpm into 6.28 Hz; root units differ.
    return _registry().get_root_units(_registry().parse_units(unit))[1]


def _dimension(unit: str) -> str:
    """Return what a quantity in `unit` is called."""
    root = _root(unit)
    return next((name for si, name in DIMENSIONS.items() if _root(si) == root), f"a quantity in {root:~}")


Length = Annotated[float, Quantity("m", "150 um")]
Area = Annotated[float, Quantity("m^2", "1e4 um^2")]
Time = Annotated[float, Quantity("s", "50 ms")]
Frequency = Annotated[float, Quantity("Hz", "300 Hz")]
Speed = Annotated[float, Quantity("m/s", "0.1 m/s")]
Acceleration = Annotated[float, Quantity("m/s^2", "9.80665 m/s^2")]
Gravity = Annotated[float | tuple[float, float, float], Directed(Quantity("m/s^2", "9.80665 m/s^2"))]
Mass = Annotated[float, Quantity("kg", "2e-9 kg")]
Density = Annotated[float, Quantity("kg/m^3", "2330 kg/m^3")]
Force = Annotated[float, Quantity("N", "2 uN")]
Stiffness = Annotated[float, Quantity("N/m", "1e4 N/m")]
Pressure = Annotated[float, Quantity("Pa", "169 GPa")]
SurfaceEnergy = Annotated[float, Quantity("J/m^2", "1 J/m^2")]
Point = Annotated[tuple[Length, Length], Pair("lengths", "100 um")]
Velocity = Annotated[tuple[Speed, Speed], Pair("velocities", "0 m/s")]
