"""Formulas of an actuator's place in a lattice: "0.05 * (row + column) ms", or one that is true or false, "row > 2".

They are evaluated by simpleeval, with no more than the names, operators and functions below, so they can do no harm.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, Final

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler, WithJsonSchema
from pydantic_core import CoreSchema, core_schema
from simpleeval import InvalidExpression, SimpleEval

from coupling.case.values.units import DIMENSIONS, Expected, Quantity, quoted
from coupling.suggestion import near

NAMES: Final = ("row", "column", "rows", "columns", "x", "y", "pi")
_OF_ONE: Final = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "floor")
FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    **{name: getattr(math, name) for name in (*_OF_ONE, "atan2", "log", "hypot")},
    **{"abs": abs, "min": min, "max": max},
}
_LONGEST: Final = 500  # characters
_OPERATORS: Final[dict[type[ast.AST], Callable[..., Any]]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: math.pow,  # of floats, so that a huge power is refused at once
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_NODES: Final = (
    *(ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp),
    *(ast.Call, ast.Name, ast.Constant),
)
_KEYWORDS: Final = ("if", "else", "and", "or", "not")
_WORD: Final = re.compile(
    r"\s*(?:(?P<number>(?:[0-9][0-9_]*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[^\W\d]\w*)|(?P<sign>\*\*|//|[<>=!]=|[-+*/%(),<>]))"
)


@dataclass(frozen=True)
class Expression:
    """An expression of the NAMES, `text` as it was written; ValueError where it is none."""

    text: str
    source: str

    def __post_init__(self) -> None:
        try:
            if len(self.source) > _LONGEST:
                raise ValueError(f"it is longer than {_LONGEST} characters")
            for node in ast.walk(self._tree):
                if isinstance(node, ast.Name) and node.id not in (*NAMES, *FUNCTIONS):
                    raise ValueError(f"there is no {_unknown(node.id)}")
        except (RecursionError, MemoryError):
            raise ValueError("it is nested too deeply") from None
        except SyntaxError:
            raise ValueError("the expression is incomplete, or has an unknown sign") from None

    def evaluate(self, names: Mapping[str, float], rule: str, is_condition: bool = False) -> Any:
        """The value where the NAMES have these values; ValueError says what it must be, `rule`, and why it is not."""
        self._evaluator.names, reason = names, ""
        try:
            value = self._evaluator.eval(self.source, self._tree)
            if is_condition and not isinstance(value, bool):
                reason = "is a number and not a comparison"
            elif not is_condition and isinstance(value, bool):
                reason = "is a comparison and not a number"
            elif not math.isfinite(float(value)):
                reason = "is not finite"
        except ZeroDivisionError:
            reason = "divides by zero"
        except OverflowError:
            reason = "is too large"
        except RecursionError:
            reason = "is nested too deeply"
        except (InvalidExpression, TypeError):
            reason = "has a function with the wrong number of arguments, or something that is not a number"
        except ValueError:  # What `math` says differs between versions of Python.
            reason = "has no real value"
        if reason:
            raise ValueError(f"must be {rule} for each actuator; {quoted(self.text)} {reason}")
        return value

    @cached_property
    def _tree(self) -> ast.AST:
        return ast.parse(self.source, mode="eval").body

    @cached_property
    def _evaluator(self) -> SimpleEval:
        evaluator = SimpleEval(_OPERATORS, FUNCTIONS, {})
        evaluator.nodes = {node: evaluator.nodes[node] for node in _NODES}
        return evaluator


def _unknown(name: str) -> str:
    if name in ("t", "time"):
        return f"{name}: an expression is constant in time, one value for each actuator"
    meant = near(name, known := (*NAMES, *FUNCTIONS))
    return f"{name}; " + (f"did you mean {meant}?" if meant else f"there are {', '.join(known)}")


def split(text: str) -> tuple[str, str]:
    """The expression that a text begins with, and the rest: all from where no operator joins two words."""
    words: list[str] = []
    place, ended, called = 0, False, False
    while match := _WORD.match(text, place):
        word = match[match.lastgroup or 0]
        begins = match.lastgroup == "number" or (match.lastgroup == "name" and word not in _KEYWORDS) or word == "("
        if ended and begins and not (word == "(" and called):
            break
        ended = (begins and word != "(") or word == ")"
        called = match.lastgroup == "name" and ended
        words.append(word)
        place = match.end()
    return " ".join(words), text[place:].strip()


def unit_of(text: str) -> str:
    """The unit that a quantity or formula ends with."""
    return split(text)[1]


@dataclass(frozen=True)
class Formula(Expression):
    """An expression with a unit, for a quantity."""

    unit: str
    scale: float  # of the unit in SI
    amount: Amount

    def value(self, names: Mapping[str, float]) -> float:
        """The value in SI units where the names have these values; ValueError, saying why, when there is none."""
        value = float(self.evaluate(names, DIMENSIONS[self.amount.unit]))
        return self.amount.in_range(f"{value:g} {self.unit}", value * self.scale)


@dataclass(frozen=True)
class Condition(Expression):
    """An expression that is true or false."""

    def value(self, names: Mapping[str, float]) -> bool:
        """Whether it is true where the names have these values; ValueError, saying why, when it is neither."""
        return bool(self.evaluate(names, "true or false", is_condition=True))

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(condition)  # a PlainValidator would load its source


@dataclass(frozen=True)
class Amount(Quantity):
    """Marks a quantity that is the same for every actuator of a lattice, a float, or a `Formula`.

    from_0: whether it must not be negative.
    """

    from_0: bool = False

    @property
    def expected(self) -> str:
        """What a value must be, in words: a length such as "150 um" or "2 * (row + column) um"."""
        return f'{super().expected} or "2 * (row + column) {self.example.split()[-1]}"'

    def parse(self, text: str) -> float | Formula:  # type: ignore[override]
        """The quantity or formula that a text states; ValueError unless it is one, of this dimension."""
        source, unit = split(text)
        if re.fullmatch(r"[+-]?\s*[\d._eE+-]*", source):
            return super().parse(text)
        try:
            return Formula(text, source, unit, self.value_of(text, "1", unit), self)
        except ValueError as error:
            reason = str(error).partition(f"got {quoted(text)}")[2] or f": {error}"
            rule = "an expression with one unit, at its end"
            raise ValueError(f"must be {rule}; got {quoted(text)}{reason}") from None

    def in_range(self, text: object, value: float) -> float:
        """As of a quantity, and not negative where it must not be."""
        if self.from_0 and value < 0:
            raise ValueError(f"must be at least 0; got {quoted(text)}")
        return super().in_range(text, value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(
            lambda value, info: value if isinstance(value, Formula) else self.validate(value, info)
        )

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "string", "examples": [self.example]}


_CHOICE: Final = 'an expression that is true or false, such as "hypot(x, y) > 100e-6"'


def condition(value: object) -> Condition:
    """The condition that a text states; ValueError unless it is one."""
    if isinstance(value, Condition):
        return value
    try:
        source, rest = split(value) if isinstance(value, str) else ("", "")
        if rest:
            raise ValueError(f'"{rest}" is too much: a condition has no unit, and x and y are in metres')
        return Condition(str(value), source)
    except ValueError as error:
        raise ValueError(f"must be {_CHOICE}; got {quoted(value)}: {error}") from None


Where = Annotated[Condition, Expected(_CHOICE), WithJsonSchema({"type": "string"})]
