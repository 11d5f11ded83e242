"""Expressions of an actuator's place in a lattice, such as 0.05 * (row + column), which can do no harm."""

from __future__ import annotations

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

from simpleeval import SimpleEval

from coupling.case.values.units import quoted
from coupling.suggestion import near

PLACES: Final = ("row", "column", "rows", "columns")
NAMES: Final = (*PLACES, "x", "y", "pi")
TIMES: Final = ("t", "time")
ANY: Final = 20  # arguments, of functions that take any number
_OF_ONE: Final = ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "floor")
FUNCTIONS: Final[dict[str, tuple[Callable[..., float], int, int]]] = {
    **{name: (getattr(math, name), 1, 1) for name in _OF_ONE},
    "atan2": (math.atan2, 2, 2),
    "log": (math.log, 1, 2),
    "abs": (abs, 1, 1),
    "min": (min, 2, ANY),
    "max": (max, 2, ANY),
    "hypot": (math.hypot, 2, ANY),
}
"""Each with the least and the most arguments that it takes."""

LONGEST: Final = 500  # characters
_TOO_DEEP: Final = "it is nested too deeply; fewer brackets and signs are needed"
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
class Expression:
    """An expression without a mistake in it; made by `parse`."""

    source: str

    def evaluate(self, names: Mapping[str, float]) -> float | bool:
        """The value where the NAMES have these values; ValueError, saying why, when there is none."""
        self._evaluator.names = names
        try:
            value = self._evaluator.eval(self.source, self._tree)
            return value if isinstance(value, bool) else float(value)
        except ZeroDivisionError:
            raise ValueError("divides by zero") from None
        except OverflowError:
            raise ValueError("is too large") from None
        except RecursionError:
            raise ValueError("is nested too deeply") from None
        except ValueError:  # What `math` says differs between versions of Python.
            raise ValueError("has no real value") from None

    @cached_property
    def names(self) -> frozenset[str]:
        """The NAMES that it uses."""
        return frozenset(node.id for node in ast.walk(self._tree) if isinstance(node, ast.Name)) & {*NAMES}

    @cached_property
    def _tree(self) -> ast.AST:
        return _tree(self.source)

    @cached_property
    def _evaluator(self) -> SimpleEval:
        functions = {name: function for name, (function, *_) in FUNCTIONS.items()}
        evaluator = SimpleEval(OPERATORS, functions, {})
        evaluator.nodes = {node: evaluator.nodes[node] for node in NODES}
        return evaluator


def parse(words: list[str]) -> Expression:
    """The expression of words as from `split`; ValueError, which says what is wrong with it and what would be right."""
    source = " ".join(words)
    try:
        mistake = _mistake(_tree(source))
    except (RecursionError, MemoryError):
        mistake = _TOO_DEEP
    except (SyntaxError, ValueError) as error:
        lacks = "an else is missing, as in 5 if row > 2 else 3"
        other = "a number, name, operator or bracket is missing"
        mistake = f"the expression is not complete; {lacks if words.count('if') > words.count('else') else other}"
        if "nested" in str(error):  # brackets, which Python counts
            mistake = _TOO_DEEP
    if mistake:
        raise ValueError(mistake)
    return Expression(source)


def split(text: str) -> tuple[list[str], str]:
    """The words of the expression that a text begins with, and the rest: all from where no operator joins two words.

    ValueError when the text is too long.
    """
    if len(text) > LONGEST:
        raise ValueError(f"it is longer than {LONGEST} characters, the most that an expression may have")
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


def unreadable(rest: str) -> str:
    """Why what follows an expression is no word of its own, such as a unit; "" if it may be one."""
    if not rest[0].isalnum() and rest[0] not in "(.":
        return f"{quoted(rest[0])} means nothing{'; a power is written **' if rest[0] == '^' else ' in an expression'}"
    word = re.match(r"\w*", rest)
    if rest[0] in "(." or (word and word[0] in (*NAMES[:-1], *FUNCTIONS)):
        return f'an operator such as * is missing before "{rest}"'
    return ""


def _tree(source: str) -> ast.AST:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(source, mode="eval").body


def _mistake(tree: ast.AST) -> str:
    """What an expression has that it must not; "" if nothing."""
    called = {id(node.func) for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            name = node.func.id
            if name not in FUNCTIONS:
                known = name in NAMES
                return f"{name} is no function" if known else f"there is no function {name}; {_hint(name, FUNCTIONS)}"
            _, least, most = FUNCTIONS[name]
            if not least <= len(node.args) <= most or node.keywords:
                some = f"{least}" if least == most else f"{least} or more" if most == ANY else f"{least} or {most}"
                return f"{name} takes {some} number{'s' * (most > 1)}; it has {len(node.args)}"
        elif isinstance(node, ast.Name) and id(node) not in called and node.id not in NAMES:
            if node.id in FUNCTIONS:
                return f"{node.id} is a function, written {node.id}(...)"
            if node.id in TIMES:
                return f"there is no {node.id}: an expression is constant in time, one value for each actuator"
            return f"there is no {node.id}; {_hint(node.id, NAMES)}"
        elif not isinstance(node, _PARTS) or (isinstance(node, ast.Constant) and type(node.value) not in (int, float)):
            return "it must have numbers, names, operators and functions only"
    return ""


def _hint(name: str, known: Collection[str]) -> str:
    meant = near(name, known)
    return f"did you mean {meant}?" if meant else f"there are {', '.join(known)}"
