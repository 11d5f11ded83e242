"""Quantities with units: text such as "150 um" becomes a float in SI units.

Units of lengths, times, forces and the like with an SI prefix, and those of angles, are read here, to the bit as pint
reads them; all others are left to pint, which takes longer to load than a case takes to read.
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
from typing import TYPE_CHECKING, Any, Final

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
    *("rad", "deg", "turn", "degree", "radian"),
    *("N", "mN", "uN", "nN", "newton", "Pa", "kPa", "MPa", "GPa", "pascal", "J", "mJ", "uJ", "nJ", "joule"),
]

_PREFIXES: Final = {"": 0, "k": 3, "M": 6, "G": 9, "c": -2, "m": -3, "u": -6, "\u00b5": -6, "\u03bc": -6, "n": -9}
_PREFIXED_BASES: Final = {
    "m": "m", "m^2": "m^2", "m^3": "m^3", "s": "s", "Hz": "Hz", "g": "kg", "N": "N", "Pa": "Pa", "J": "J",
}  # fmt: skip
_PI: Final = Decimal("3.14159265358979323846264338327950288")
_ANGLES: Final = {"deg": _PI / 180, "degree": _PI / 180, "turn": 2 * _PI}
_PREFIXED: Final = re.compile(rf"({'|'.join(_PREFIXES)})(m|s|Hz|g|N|Pa|J)(?:\^([23]))?")

# Other characters are refused here because pint skips them: it would read "1,5 mm" as 15 mm, and a typographic minus
# sign as nothing at all.
_NUMBER_AND_UNIT: Final = re.compile(
    r"(?P<number>[+-]?(?:(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?|(?:nan|inf)\b))"
    r"[ \t]*(?P<unit>[\w \t.*/^()+⁻·⋅°%-]*)"
)

# The same for JSON schemas, as far as it goes without a list of all units.
WRITTEN: Final = r"^\s*[+-]?\.?[0-9][0-9_.]*([eE][+-]?[0-9]+)?\s*([^0-9_.,;\s]|[0-9]+/).*$"
POSITIVE: Final = WRITTEN.replace("[+-]?", "[+]?", 1)

_NONSENSE: Final = ", which is not a number and a unit"
_NO_UNIT: Final = ", which has no unit"
_NOT_FINITE: Final = ", which is not finite"


@dataclass(frozen=True)
class Quantity:
    """Marks a float as a quantity in the SI unit `unit`, a key of `DIMENSIONS`; `example` shows how to write one.

    name: what it is called, where that is not its unit's name in `DIMENSIONS`.
    """

    unit: str
    example: str
    name: str = ""

    @property
    def expected(self) -> str:
        """What a value must be, in words: a length such as "150 um"."""
        return f'{self.name or DIMENSIONS[self.unit]} such as "{self.example}"'

    def parse(self, text: str) -> float:
        """Return the quantity that `text` states, in `unit`; ValueError unless it is a finite one of this dimension."""
        match = _NUMBER_AND_UNIT.fullmatch(text.strip())
        if match is None:
            raise self.refusal(text, "; write decimals with a point" if "," in text else _NONSENSE)
        return self.convert(text, match["number"], match["unit"])

    def convert(self, text: str, number: str, unit: str) -> float:
        """Return `number` of a unit, in `self.unit`; raises ValueError as `parse` does, quoting `text`."""
        if not unit:
            raise self.refusal(text, _NO_UNIT)
        base, exponent = prefixed(unit)
        if base == self.unit:
            value = float(Decimal(number).scaleb(exponent))
        elif unit in _ANGLES and self.unit == "rad":
            value = float(Decimal(number) * _ANGLES[unit])
        elif base in _PREFIXED_BASES.values():
            raise self.refusal(text, f", {DIMENSIONS[base]}")
        else:
            value = self._convert_by_pint(text, number, unit)
        if not math.isfinite(value):
            raise self.refusal(text, _NOT_FINITE)
        return value

    def _convert_by_pint(self, text: str, number: str, unit: str) -> float:
        import pint

        try:
            fits = self._fits(unit)
            value = float(_registry().Quantity(Decimal(number), unit).m_as(self.unit)) if fits else math.nan
        except pint.UndefinedUnitError as error:
            raise self.refusal(text, self._unknown_unit(number, unit, error)) from None
        except Exception:  # On nonsense pint raises anything from AssertionError to TokenError.
            raise self.refusal(text, _NONSENSE) from None
        if not fits:
            raise self.refusal(text, f", {_dimension(unit)}")
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
        return ValueError(f"must be {self.expected}; got {quoted(value)}{reason}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_before_validator_function(self.validate, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "pattern": WRITTEN, "examples": [self.example]}


def quoted(value: object) -> str:
    """Return `value` as a case file would write it, or in words if that is long."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, (list, tuple)):
        if any(isinstance(item, dict) for item in value):
            return "a list of tables"
        text = "[" + ", ".join(quoted(item) for item in value) + "]"
    elif isinstance(value, (str, bool)):
        text = json.dumps(value, ensure_ascii=False)
    else:
        text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def length_text(length: float, unit: str = "um") -> str:
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
def prefixed(unit: str) -> tuple[str, int]:
    """The SI unit that an often used unit is a power of ten of, and that power; "" for any other unit."""
    if unit in DIMENSIONS:
        return unit, 0
    match = _PREFIXED.fullmatch(unit)
    prefix, name, power = match.groups() if match else ("", "", None)
    base = _PREFIXED_BASES.get(name + (f"^{power}" if power else ""), "")
    return base, _PREFIXES[prefix] * int(power or 1) - (3 if base == "kg" else 0)


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
