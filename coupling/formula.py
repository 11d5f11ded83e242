"""Formulas: an expression of an actuator's place in a lattice, followed by a unit: "0.05 * (row + column) ms"."""

from __future__ import annotations

import ast
import difflib
import math
import operator
import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema
from simpleeval import SimpleEval

from coupling.units import Quantity

NAMES: Final = ("row", "column", "rows", "columns", "x", "y", "pi")
ANY: Final = 20  # arguments, of functions that take any number
FUNCTIONS: Final[dict[str, tuple[Callable[..., float], int, int]]] = {
    **{name: (getattr(math, name), 1, 1) for name in ("sqrt", "sin", "cos", "tan", "exp", "floor")},
    "log": (math.log, 1, 2),
    "abs": (abs, 1, 1),
    "min": (min, 2, ANY),
    "max": (max, 2, ANY),
    "hypot": (math.hypot, 2, ANY),
}
"""Each with the least and the most arguments that it takes."""

LONGEST: Final = 500  # characters
KEYWORDS: Final = ("if", "else", "and", "or", "not")
OPERATORS: Final[dict[type[ast.AST], Callable[..., Any]]] = {
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
NODES: Final = (
    *(ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp),
    *(ast.Call, ast.Name, ast.Constant),
)
_PARTS: Final = (*NODES, *OPERATORS, ast.And, ast.Or, ast.Load)

_WORD: Final = re.compile(
    r"\s*(?:(?P<number>(?:[0-9][0-9_]*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[^\W\d]\w*)|(?P<sign>\*\*|//|[<>=!]=|[-+*/%(),<>]))"
)


@dataclass(frozen=True)
class Formula:
    """An expression, and how much in SI units one of its unit is; `text` is both as written."""

    text: str
    expression: str
    scale: float

    def value(self, names: Mapping[str, float]) -> float:
        """The value in SI units where the NAMES have these values; ValueError, saying why, when there is none."""
        self._evaluator.names = names
        try:
            result = self._evaluator.eval(self.expression, self._tree)
            if isinstance(result, bool):
                raise ValueError("is a comparison and not a number")
            value = float(result) * self.scale
        except ZeroDivisionError:
            raise ValueError("divides by zero") from None
        except OverflowError:
            raise ValueError("is too large") from None
        except RecursionError:
            raise ValueError("is nested too deeply") from None
        except ValueError as error:
            # What `math` says differs between versions of Python.
            raise ValueError(str(error) if str(error).startswith("is ") else "has no real value") from None
        if not math.isfinite(value):
            raise ValueError("is not finite")
        return value

    @cached_property
    def _tree(self) -> ast.AST:
        return _parse(self.expression)

    @cached_property
    def _evaluator(self) -> SimpleEval:
        functions = {name: function for name, (function, *_) in FUNCTIONS.items()}
        evaluator = SimpleEval(OPERATORS, functions, {})
        evaluator.nodes = {node: evaluator.nodes[node] for node in NODES}
        return evaluator


@dataclass(frozen=True)
class Amount(Quantity):
    """Marks a quantity that is the same for every actuator of a lattice, a float, or a `Formula`."""

    @property
    def wanted(self) -> str:
        """What a value must be, in words."""
        unit = self.example.split()[-1]
        return f'{super().wanted}, or an expression of row and column with a unit, such as "2 * (row + column) {unit}"'

    def parse(self, text: str) -> float | Formula:  # type: ignore[override]
        """The quantity or formula that a text states; ValueError unless it is one, of this dimension."""
        if len(text) > LONGEST:
            raise self.refusal(text, f", which is longer than {LONGEST} characters")
        words, unit = split(text)
        try:
            return self._parsed(text, words, unit)
        except ValueError:
            if unit and (reason := _misplaced(unit)):
                raise self.refusal(text, f", {reason}") from None
            raise

    def _parsed(self, text: str, words: list[str], unit: str) -> float | Formula:
        digits = words[-1:] and words[-1][0] in "0123456789."
        if not words or (digits and len(words) == 1) or (digits and len(words) == 2 and words[0] in ("+", "-")):
            return super().parse(text)
        expression = " ".join(words)
        try:
            mistake = _mistake(_parse(expression))
        except ValueError as error:
            mistake = str(error)
        if mistake:
            raise self.refusal(text, f", {mistake}")
        return Formula(text, expression, self.convert(text, "1", unit))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.validate)


def split(text: str) -> tuple[list[str], str]:
    """The words of the expression that a text begins with, and the unit: all from where no operator joins two words."""
    words: list[str] = []
    place, ended, called = 0, False, False
    while match := _WORD.match(text, place):
        word = match[match.lastgroup or 0]
        begins = match.lastgroup == "number" or (match.lastgroup == "name" and word not in KEYWORDS) or word == "("
        if ended and begins and not (word == "(" and called):
            break
        ended = (begins and word != "(") or word == ")"
        called = match.lastgroup == "name" and ended
        words.append(word)
        place = match.end()
    return words, text[place:].strip()


def _parse(expression: str) -> ast.AST:
    """The syntax tree; ValueError, saying why, when there is none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(expression, mode="eval").body
    except (RecursionError, MemoryError):
        raise ValueError("which is nested too deeply") from None
    except (SyntaxError, ValueError):
        raise ValueError("whose expression is not complete") from None


def _mistake(tree: ast.AST) -> str:
    """What an expression has that it must not; "" if nothing."""
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            if node.func.id not in FUNCTIONS:
                return f"but there is no function {node.func.id}; {_hint(node.func.id, FUNCTIONS)}"
            _, least, most = FUNCTIONS[node.func.id]
            if not least <= len(node.args) <= most or node.keywords:
                some = f"{least}" if least == most else f"{least} or more" if most == ANY else f"{least} or {most}"
                return f"but {node.func.id} takes {some} number{'s' * (most > 1)}; it has {len(node.args)}"
        elif isinstance(node, ast.Name) and id(node) not in called and node.id not in NAMES:
            if node.id in FUNCTIONS:
                return f"but {node.id} is a function, written {node.id}(...)"
            return f"but there is no {node.id}; {_hint(node.id, NAMES)}"
        elif not isinstance(node, _PARTS) or (isinstance(node, ast.Constant) and type(node.value) not in (int, float)):
            return "which has more than numbers, names, operators and functions"
    return ""


def _misplaced(rest: str) -> str:
    """Why what follows an expression is no unit; "" if it may be one."""
    if not rest[0].isalnum() and rest[0] not in "(.":
        return f'in which "{rest[0]}" means nothing{"; a power is written **" * (rest[0] == "^")}'
    if re.search(r"\b(if|else|and|or|not)\b", rest):
        return 'whose unit must come once, at its end, as in "(5 if row > 2 else 3) um"'
    word = re.match(r"\w*", rest)
    if rest[0] in "(." or (word and word[0] in (*NAMES[:-1], *FUNCTIONS)):
        return f'in which an operator such as * is missing before "{rest}"'
    return ""


def _hint(name: str, known: Any) -> str:
    near = difflib.get_close_matches(name.lower(), known, 1)
    return f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
