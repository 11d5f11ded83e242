"""Formulas: an expression followed by a unit, "0.05 * (row + column) ms", or one that is true or false, "row > 2"."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from coupling.case.values.expression import KEYWORDS, NAMES, Expression, parse, split, unreadable
from coupling.case.values.units import Quantity, quoted

FORMULA: Final = "an expression and its unit"
CONDITION: Final = "an expression that is true or false"
EXAMPLE: Final = '"hypot(x, y) > 100e-6"'  # of a condition


@dataclass(frozen=True)
class Formula:
    """An expression, its unit, and how much in SI units one of that is; `text` is both as written."""

    text: str
    expression: Expression
    unit: str
    scale: float

    def value(self, names: Mapping[str, float]) -> float:
        """The value in SI units where the names have these values; ValueError, saying why, when there is none."""
        value = self.expression.evaluate(names)
        if isinstance(value, bool):
            raise ValueError("is a comparison and not a number")
        if not math.isfinite(value * self.scale):
            raise ValueError("is not finite")
        return value * self.scale

    def text_of(self, value: float) -> str:
        """A value in SI units as text in this unit."""
        return f"{value / self.scale:g} {self.unit}"


@dataclass(frozen=True)
class Condition:
    """An expression that is true or false; `text` is that as written."""

    text: str
    expression: Expression

    def holds(self, names: Mapping[str, float]) -> bool:
        """Whether it is true where the names have these values; ValueError, saying why, when it is neither."""
        value = self.expression.evaluate(names)
        if not isinstance(value, bool):
            raise ValueError("is a number and not a comparison")
        return value


@dataclass(frozen=True)
class Amount(Quantity):
    """Marks a quantity that is the same for every actuator of a lattice, a float, or a `Formula`."""

    @property
    def expected(self) -> str:
        """What a value must be, in words: a length such as "150 um" or "2 * (row + column) um"."""
        return f'{super().expected} or "2 * (row + column) {self._unit}"'

    @property
    def _unit(self) -> str:
        return self.example.split()[-1]

    def parse(self, text: str) -> float | Formula:  # type: ignore[override]
        """The quantity or formula that a text states; ValueError unless it is one, of this dimension."""
        words, rest = _words(text, FORMULA)
        digits = words[-1:] and words[-1][0] in "0123456789."
        try:
            if not words or (digits and len(words) == 1) or (digits and len(words) == 2 and words[0] in ("+", "-")):
                return super().parse(text)
            expression = _parsed(text, words, FORMULA)
            return Formula(text, expression, rest, self.value_of(text, "1", rest))
        except ValueError:
            reason = unreadable(rest) if rest else ""
            if not reason and re.search(rf"\b({'|'.join((*KEYWORDS, *NAMES))})\b", rest):
                example = f"(5 if row > 2 else 3) {self._unit}"
                reason = f"the unit must come once, at the end, as in {quoted(example)}"
            if not reason:
                raise
            raise _refusal(text, reason, FORMULA) from None

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "examples": [self.example]}


@dataclass(frozen=True)
class Choice:
    """Marks a `Condition`."""

    expected = f"{CONDITION}, such as {EXAMPLE}"

    def validate(self, value: object) -> Condition:
        """The condition that a text states; ValueError unless it is one."""
        if isinstance(value, Condition):
            return value
        if not isinstance(value, str) or not value.strip():
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        words, rest = _words(value, CONDITION)
        if rest:
            no_unit = f'"{rest}" is too much; it has no unit, x and y are in metres, as in {EXAMPLE}'
            raise _refusal(value, unreadable(rest) or no_unit, CONDITION)
        return Condition(value, _parsed(value, words, CONDITION))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.validate)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string"}


def unit_of(text: str) -> str:
    """The unit that a quantity or formula ends with."""
    return split(text)[1]


def _words(text: str, expected: str) -> tuple[list[str], str]:
    try:
        return split(text)
    except ValueError as error:
        raise _refusal(text, str(error), expected) from None


def _parsed(text: str, words: list[str], expected: str) -> Expression:
    try:
        return parse(words)
    except ValueError as error:
        raise _refusal(text, str(error), expected) from None


def _refusal(text: str, reason: str, expected: str) -> ValueError:
    return ValueError(f"must be {expected}; got {quoted(text)}: {reason}")
