"""Quantities with units: text such as "150 um" becomes a float in SI units.

Units of lengths, times, forces and the like with an SI prefix, and those of angles, are read here, to the bit as pint
reads them; all others are left to pint, which takes longer to load than a case takes to read.
"""

from __future__ import annotations

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

from coupling.case.values.dimensions import DIMENSIONS, RANGES, dimension_of, is_unit, registry, root_of, si_of
from coupling.case.values.spelling import MAX_MEANT, MISREAD, MULTIPLES, meant_number, meant_units

if TYPE_CHECKING:
    pass

UNITS_REQUIRED: Final = {"units_required": True}
"""The validation context in which a bare number is not accepted as a quantity."""

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

LONGEST: Final = 200  # characters of a quantity as text
_SMALL, _LARGE = 0.05, 1e6
_SAME_ANYWAY: Final = ("Hz", "kg/m^3")  # units that people leave out because they are SI
_MAY_BE_NONE: Final = ("m", "s", "rad", "m/s", "m/s^2", "N", "N/m")
_NONSENSE: Final = ", which is not a number and a unit"
_NO_UNIT: Final = ", which has no unit"
_NOT_FINITE: Final = ", which is not finite"


@dataclass(frozen=True)
class Quantity:
    """Marks a float as a quantity in the SI unit `unit`, a key of `DIMENSIONS`; `example` shows how to write one.

    name: what it is called, where that is not its unit's name in `DIMENSIONS`.  positive: whether it must not be 0, and
    so not all but 0 either.
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
        if len(text) > LONGEST:
            raise self.refusal(text, f", which is longer than {LONGEST} characters")
        match = _NUMBER_AND_UNIT.fullmatch(text.strip())
        if match is None:
            raise self.refusal(text, self._other_number(text))
        return self.convert(text, match["number"], match["unit"])

    def convert(self, text: str, number: str, unit: str) -> float:
        """Return `number` of a unit, in `self.unit`; raises ValueError as `parse` does, quoting `text`."""
        return self._in_range(text, self.value_of(text, number, unit))

    def value_of(self, text: str, number: str, unit: str) -> float:
        """The same, however large or small that is."""
        if not unit:
            raise self.refusal(text, _NO_UNIT)
        base, exponent = prefixed(unit)
        if base == self.unit:
            value = float(Decimal(number).scaleb(exponent))
        elif unit in _ANGLES and self.unit == "rad":
            value = float(Decimal(number) * _ANGLES[unit])
        elif base in _PREFIXED_BASES.values():
            raise self.refusal(text, f", {DIMENSIONS[base]}{self._meant(text, unit)}")
        elif unit in MISREAD:
            raise self.refusal(text, f', but there is no unit "{unit}"{self._meant(text, unit)}')
        else:
            value = self._convert_by_pint(text, number, unit)
        if not math.isfinite(value):
            raise self.refusal(text, _NOT_FINITE)
        return value

    def _in_range(self, text: object, value: float) -> float:
        """Return a value; ValueError, quoting `text`, where no such quantity can be that large or that small."""
        least, most = RANGES.get(self.unit, (0.0, math.inf))
        no = f"but no {(self.name or DIMENSIONS[self.unit]).split(' ', 1)[1]} may be"
        if abs(value) > most:
            raise self.refusal(text, f", {no} above {most:g} {self.unit}")
        if self.positive and 0 < abs(value) < least:
            raise self.refusal(text, f", {no} below {least:g} {self.unit}")
        return value

    def _convert_by_pint(self, text: str, number: str, unit: str) -> float:
        import pint

        try:
            fits = self._fits(unit)
            value = float(registry().Quantity(Decimal(number), unit).m_as(self.unit)) if fits else math.nan
        except pint.UndefinedUnitError as error:
            names = [error.unit_names] if isinstance(error.unit_names, str) else error.unit_names
            unknown = f', but there is no unit "{next(iter(names))}"'
            meant, other = self._meant(text, unit), self._other_number(text)
            raise self.refusal(text, unknown + meant if meant or other == _NONSENSE else other) from None
        except Exception:  # On nonsense pint raises anything from AssertionError to TokenError.
            raise self.refusal(text, self._meant(text, unit) or self._other_number(text)) from None
        if not fits:
            raise self.refusal(text, f", {dimension_of(unit)}{self._meant(text, unit)}")
        return value

    def validate(self, value: object, info: ValidationInfo) -> float:
        """Return a number as it is and text in `unit`; ValueError for what is neither, or lacks a unit it needs."""
        if isinstance(value, str):
            return self.parse(value)
        if isinstance(value, bool) or not isinstance(value, Real):
            raise self.refusal(value, self._none if value is False else "")
        if info.context and info.context.get("units_required"):
            raise self.refusal(value, _NO_UNIT + (self._none if value == 0 else self._in_si(float(value))))
        if not math.isfinite(value):
            raise self.refusal(value, _NOT_FINITE)
        return self._in_range(value, float(value))

    def _fits(self, unit: str) -> bool:
        """Whether a unit has this dimension; raises anything where there is no such unit."""
        return root_of(unit) == root_of(self.unit)

    def _may_be(self, unit: str) -> bool:
        """The same, and False where there is no such unit, or none that pint can take apart."""
        try:
            return self._fits(unit)
        except Exception:
            return False

    def _meant(self, text: str, unit: str) -> str:
        """The question whether a unit that a text ends with, which is wrong, stands for another; "" for none."""
        head = text.strip().removesuffix(unit).rstrip()
        units = {self.value_of("", "1", meant): meant for meant in meant_units(unit, is_unit, self._may_be)}
        texts = [f"{head} {meant}" for meant in units.values()]
        if not 1 <= len(texts) <= MAX_MEANT:
            return self._converted(head, unit)
        question = f"; did you mean {' or '.join(map(quoted, texts))}"
        compound = len(texts) == 1 and re.search(r"[/^ ]", texts[0].removeprefix(f"{head} "))
        if compound and _NUMBER_AND_UNIT.fullmatch(head):
            value = self.value_of(texts[0], head, texts[0].removeprefix(f"{head} "))
            question += f", which is {value:.6g} {self.unit}" if value != float(Decimal(head)) else ""
        return question + "?"

    def _converted(self, head: str, unit: str) -> str:
        """What a number of a unit of another dimension is in this one, where that is beyond doubt."""
        key = (self.unit, si_of(unit) if unit not in MULTIPLES.get(self.unit, {}) else unit)
        match = _NUMBER_AND_UNIT.fullmatch(head)
        if match is None or match["unit"]:
            return ""
        try:
            number = float(match["number"])
        except ValueError:  # as of "0_"
            return ""
        if key == ("Hz", "rad/s"):
            turns = number * float(registry().Quantity(Decimal(1), unit).m_as("rad/s")) / (2 * math.pi)
            return f'; in cycles that is "{turns:.10g} Hz"'
        if key == ("Hz", "s") and number > 0:
            period = Quantity("s", "").value_of("", match["number"], unit)
            return f'; the frequency of that period is "{1 / period:.10g} Hz"'
        if unit in MULTIPLES.get(self.unit, {}):
            each, name = MULTIPLES[self.unit][unit]
            return f'; did you mean "{number * each:.10g} {name}"?'
        return ""

    def _other_number(self, text: str) -> str:
        """Why a text is no number and unit, and which one is meant."""
        comma = re.search(r"\d,\d", text) is not None
        meant = meant_number(text)
        with suppress(ValueError):
            if meant is not None and math.isfinite(self.parse(meant)):
                return (
                    f"; write decimals with a point: {quoted(meant)}" if comma else f"; did you mean {quoted(meant)}?"
                )
        return "; write decimals with a point and thousands without a comma" if comma else _NONSENSE

    @property
    def _none(self) -> str:
        """How none of it is written, as it may be of what has a place, a way or a course."""
        unit = self.example.split()[-1]
        return f'; write "0 {unit}"' if self.unit in _MAY_BE_NONE else ""

    def _in_si(self, value: float) -> str:
        """How a number that seems to be in SI units is written: one that is very small or large."""
        size = abs(value)
        if self.unit == "rad" and 2 * math.pi < size < math.inf:
            return f'; in degrees it is "{value:.10g} deg"'
        seems = size >= 1 if self.unit in _SAME_ANYWAY else 0 < size <= _SMALL or size >= _LARGE
        return f'; in SI units it is "{value:.10g} {self.unit}"' if seems and math.isfinite(value) else ""

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


def number_and_unit(text: str) -> tuple[str, str]:
    """The number and the unit of a quantity as text; raises ValueError where it is none."""
    match = _NUMBER_AND_UNIT.fullmatch(text.strip())
    if match is None:
        raise ValueError(f"{quoted(text)} is not a number and a unit")
    return match["number"], match["unit"].strip()


def length_text(length: float, unit: str = "um") -> str:
    """Return a length in m as text in a unit of length."""
    return f"{length / Quantity('m', '150 um').value_of('', '1', unit):g} {unit}"


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
