"""Quantities with units: text such as "150 um" becomes a float in SI units.

Units of lengths, times, forces and the like with an SI prefix, and those of angles, are read here, to the bit as pint
reads them; all others are left to pint, which takes longer to load than a case takes to read.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from coupling.suggestion import near

if TYPE_CHECKING:
    import pint

UNITS_REQUIRED: Final = {"units_required": True}
"""The validation context in which a bare number is not accepted as a quantity."""

DIMENSIONS: Final = {
    "m": "a length", "m^2": "an area", "m^3": "a volume", "rad": "an angle",
    "s": "a time", "Hz": "a frequency", "rad/s": "an angular velocity", "m/s": "a velocity", "m/s^2": "an acceleration",
    "kg": "a mass", "kg/m^3": "a density", "N": "a force", "Pa": "a pressure",
    "J": "an energy", "J/m^2": "an energy per area", "N/m": "a stiffness", "N/m^3": "a stiffness per area",
    "W": "a power", "K": "a temperature", "V": "a voltage", "1": "a plain number",
}  # fmt: skip
"""SI units, and what a quantity in each is called in a message."""

RANGES: Final = {
    "m": (1e-15, 1e3), "m^2": (1e-24, 1e6), "rad": (1e-9, 1e6), "s": (1e-12, 1e6), "Hz": (1e-6, 1e12),
    "m/s": (1e-15, 1e6), "m/s^2": (1e-12, 1e9), "kg": (1e-24, 1e3), "kg/m^3": (1e-3, 1e7), "N": (1e-21, 1e6),
    "Pa": (1e-3, 1e15), "K": (50.0, 2000.0), "J/m^2": (1e-9, 1e3), "N/m": (1e-12, 1e12), "N/m^3": (1e-6, 1e21),
}  # fmt: skip
"""The smallest size of a positive quantity in an SI unit, and the largest of any."""

LONGEST: Final = 200  # characters of a quantity as text
_PREFIXES: Final = {"": 0, "k": 3, "M": 6, "G": 9, "c": -2, "m": -3, "u": -6, "\u00b5": -6, "\u03bc": -6, "n": -9}
_PREFIXED_BASES: Final = {
    "m": "m", "m^2": "m^2", "m^3": "m^3", "s": "s", "Hz": "Hz", "g": "kg", "N": "N", "Pa": "Pa", "J": "J",
}  # fmt: skip
_PREFIXED: Final = re.compile(rf"({'|'.join(_PREFIXES)})(m|s|Hz|g|N|Pa|J)(?:\^([23]))?")
_PI: Final = Decimal("3.14159265358979323846264338327950288")
_ANGLES: Final = {"deg": _PI / 180, "degree": _PI / 180, "turn": 2 * _PI}
_MISREAD: Final = ("Grad", "gr")  # to pint a thousand million radians, and a grain

# Other characters are refused here because pint skips them: it would read "1,5 mm" as 15 mm, and a typographic minus
# sign as nothing at all.
_NUMBER_AND_UNIT: Final = re.compile(
    r"(?P<number>[+-]?(?:(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?|(?:nan|inf)\b))"
    r"[ \t]*(?P<unit>[\w \t.*/^()+⁻·⋅°%-]*)"
)
# The same for JSON schemas, as far as it goes without a list of all units.
_WRITTEN: Final = r"^\s*[+-]?\.?[0-9][0-9_.]*([eE][+-]?[0-9]+)?\s*([^0-9_.,;\s]|[0-9]+/).*$"


class Expected(NamedTuple):
    """Marks a field with what its value must be, in words."""

    expected: str


@dataclass(frozen=True)
class Quantity:
    """Marks a float as a quantity in the SI unit `unit`, a key of `DIMENSIONS`; `example` shows how to write one.

    name: what it is called, where that is not its unit's name in `DIMENSIONS`.  positive: whether it must exceed 0.
    """

    unit: str
    example: str
    name: str = ""
    positive: bool = False

    @property
    def expected(self) -> str:
        """What a value must be, in words: a length such as "150 um"."""
        return f'{self.name or DIMENSIONS[self.unit]} such as "{self.example}"'

    def parse(self, text: str) -> float:
        """Return the quantity that `text` states, in `unit`; ValueError unless it is one of this dimension and size."""
        match = _NUMBER_AND_UNIT.fullmatch(text.strip()) if len(text) <= LONGEST else None
        if match is None:
            comma = "; write decimals with a point" if re.search(r"\d,\d", text) else ""
            raise self.refusal(text, comma or ", which is not a number and a unit")
        return self.convert(text, match["number"], match["unit"])

    def convert(self, text: str, number: str, unit: str) -> float:
        """Return `number` of a unit, in `self.unit`; raises ValueError as `parse` does, quoting `text`."""
        return self.in_range(text, self.value_of(text, number, unit))

    def value_of(self, text: str, number: str, unit: str) -> float:
        """The same, however large or small that is."""
        if not unit:
            raise self.refusal(text, ", which has no unit")
        base, exponent = prefixed(unit)
        if base == self.unit:
            value = float(Decimal(number).scaleb(exponent))
        elif unit in _ANGLES and self.unit == "rad":
            value = float(Decimal(number) * _ANGLES[unit])
        elif base in _PREFIXED_BASES.values():
            raise self.refusal(text, f", {DIMENSIONS[base]}")
        else:
            value = self._by_pint(text, number, unit)
        if not math.isfinite(value):
            raise self.refusal(text, ", which is not finite")
        return value

    def _by_pint(self, text: str, number: str, unit: str) -> float:
        try:
            known = unit not in _MISREAD and _root_of(unit)
        except Exception:  # On nonsense pint raises anything from AssertionError to TokenError.
            known = False
        if not known:
            bases = [name for name, base in _PREFIXED_BASES.items() if base == self.unit]
            meant = near(unit, [prefix + name for prefix in _PREFIXES for name in bases])
            hint = f"; did you mean {meant}?" if meant else ""
            raise self.refusal(text, f', but there is no unit "{unit}"{hint}')
        if known != _root_of(self.unit):
            si = unit if unit in DIMENSIONS else next((si for si in DIMENSIONS if _root_of(si) == known), "")
            wanted = self.name or DIMENSIONS[self.unit]
            raise self.refusal(text, f", {DIMENSIONS[si]}" if si else f", which is not {wanted}")
        return float(_registry().Quantity(Decimal(number), unit).m_as(self.unit))

    def in_range(self, text: object, value: float) -> float:
        """Return a value; ValueError, quoting `text`, where no such quantity can be that large or that small."""
        least, most = RANGES.get(self.unit, (0.0, math.inf))
        no = f"but no {(self.name or DIMENSIONS[self.unit]).split(' ', 1)[1]} may be"
        if abs(value) > most:
            raise self.refusal(text, f", {no} above {most:g} {self.unit}")
        if self.positive and 0 < abs(value) < least:
            raise self.refusal(text, f", {no} below {least:g} {self.unit}")
        if self.positive and value <= 0:
            raise ValueError(f"must be greater than 0; got {quoted(text)}")
        return value

    def validate(self, value: object, info: ValidationInfo) -> float:
        """Return a number as it is and text in `unit`; ValueError for what is neither, or lacks a unit it needs."""
        if isinstance(value, str):
            return self.parse(value)
        if isinstance(value, bool) or not isinstance(value, (float, Real)):  # the first is quicker
            raise self.refusal(value)
        if info.context and info.context.get("units_required"):
            raise self.refusal(value, ", which has no unit")
        try:
            number = float(value)
        except OverflowError:  # an integer
            number = math.inf
        if not math.isfinite(number):
            raise self.refusal(value, ", which is not finite")
        return self.in_range(value, number)

    def refusal(self, value: object, reason: str = "") -> ValueError:
        """The error that says what a value must be, and that this one is not."""
        return ValueError(f"must be {self.expected}; got {quoted(value)}{reason}")

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_before_validator_function(self.validate, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "pattern": _WRITTEN, "examples": [self.example]}


@cache
def _registry() -> pint.UnitRegistry[Any]:
    import pint

    # Decimals, so that "100 um" gives the float 1e-4 itself and not a neighbour.
    return pint.UnitRegistry(non_int_type=Decimal)


def _root_of(unit: str) -> pint.Unit:
    # Dimensions do not tell Hz from rad/s, and pint would turn 60 rpm into 6.28 Hz; root units differ.
    return _registry().get_root_units(_registry().parse_units(unit))[1]


@cache
def prefixed(unit: str) -> tuple[str, int]:
    """The SI unit that an often used unit is a power of ten of, and that power; "" for any other unit."""
    if unit in DIMENSIONS:
        return unit, 0
    match = _PREFIXED.fullmatch(unit)
    prefix, name, power = match.groups() if match else ("", "", None)
    base = _PREFIXED_BASES.get(name + (f"^{power}" if power else ""), "")
    return base, _PREFIXES[prefix] * int(power or 1) - (3 if base == "kg" else 0)


def quoted(value: object) -> str:
    """Return `value` as a case file would write it, or in words if that is long."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, int) and value.bit_length() > 1000:  # Python writes no more than 4300 digits
        return "a whole number of more than 300 digits"
    if isinstance(value, (list, tuple)):
        if any(isinstance(item, dict) for item in value):
            return "a list of tables"
        text = "[" + ", ".join(quoted(item) for item in value) + "]"
    else:
        text = json.dumps(value, ensure_ascii=False) if isinstance(value, (str, bool)) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def length_text(length: float) -> str:
    """Return a length in m as text in micrometres."""
    return f"{length / 1e-6:g} um"
