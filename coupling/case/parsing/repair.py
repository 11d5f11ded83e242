"""Repair: what is wrong with a text that is not quite TOML, line by line, and the text that is meant."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from typing import Any, Final, NamedTuple

from coupling.case.mistakes import in_double_brackets

MAX_LINES: Final = 200  # that are repaired one by one
MAX_LINE: Final = 2000  # characters of a line that is repaired
MAX_READ: Final = 50_000_000  # characters, in all passes over a text
MAX_DEPTH: Final = 20  # tables and lists inside each other
TOO_DEEP: Final = f"tables or lists are nested more than {MAX_DEPTH} deep"
TOO_LONG: Final = "a number has too many digits"

_CURLY: Final = str.maketrans("“”„‟″‘’‚′", '"""""\'\'\'\'')
_BLANK: Final = str.maketrans("\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}\N{ZERO WIDTH NO-BREAK SPACE}", "   ")
_SYNTAX: Final = {
    "Cannot overwrite a value": "this is given twice",
    r"Illegal character '\n'": "a text lacks its closing quote",
}
_NUMBER: Final = r"[+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY: Final = rf"{_NUMBER}\s*(?:[^\W\d]|[°%])[^,\[\]#\"'=]*?"
_TRUTHS: Final = {"yes": "true", "on": "true", "no": "false", "off": "false", "none": "false"}


class Wrong(NamedTuple):
    """What is wrong with a line."""

    line: int
    field: str  # "" where it is the text itself
    message: str


class _Rule(NamedTuple):
    """How a mistake in a line looks, what to write in place of it, and what to say about that."""

    pattern: re.Pattern[str]
    right: str | Callable[[re.Match[str]], str]
    message: str


def _truth(match: re.Match[str]) -> str:
    word = match[2].lower()
    return match[1] + _TRUTHS.get(word, word)


def _decimal(match: re.Match[str]) -> str:
    return match[1] + match[2] + (f"0{match[3]}" if match[3][0] == "." else f"{match[3]}0")


def _in_quotes(match: re.Match[str]) -> str:
    return f'{match[1]}"{match[2].strip()}"'


_RULES: Final = tuple(
    _Rule(re.compile(pattern), right, message)
    for pattern, right, message in (
        (
            r"(=\s*|[\[,]\s*)(True|TRUE|False|FALSE|[Yy]es|[Nn]o|[Oo]n|[Oo]ff|None)\b(?=\s*(?:[,\]#]|$))",
            _truth,
            "truth values are true and false, in small letters",
        ),
        (rf"(=\s*)({_QUANTITY})(?=\s*(?:#|;|$))", _in_quotes, "a value with a unit needs quotes"),
        (rf"([\[,]\s*)({_QUANTITY})(?=\s*[,\]])", _in_quotes, "a value with a unit needs quotes"),
        (r"(=\s*)([+-]?\d+),(\d+)(?=\s*(?:#|$))", r"\1\2.\3", "decimals are written with a point"),
        (r"([=\[,]\s*)([+-]?)(\.\d+|\d+\.(?=\D|$))", _decimal, "a decimal point needs digits on both sides"),
        (r"^(\s*[A-Za-z_][\w.-]*)\s*(?::=?)(?=\s)(?!\s*=)", r"\1 =", "a key and its value are joined by ="),
        (r"(=\s*)([A-Za-z][\w-]*(?:\.[A-Za-z]\w*)?)(?=\s*(?:#|;|$))", r'\1"\2"', "a text needs quotes"),
        (r"(=\s*)(?:\"([^\"'#]*?)|'([^\"'#]*?))\s*$", r'\1"\2\3"', "a text lacks its closing quote"),
        (r"(\[[^\]#]*\")\s+(?=\"[^\]#]*\])", r"\1, ", "items of a list have commas between them"),
        (r"(\S.*?)\s*;\s*(?=#|$)", r"\1", "a line needs nothing at its end"),
        (r"(\S.*?)\s*(//.*)$", r"\1", "a comment begins with #"),
        (r"(=\s*)\(([^()#]*)\)", r"\1[\2]", "lists are written in square brackets"),
    )
)


_UNLIKE: Final = re.compile(r"""(=\s*)(?:'([^'"#]*)"|"([^'"#]*)')(?=\s*(?:#|$))""")
_QUOTES: Final = _Rule(_UNLIKE, r'\1"\2\3"', "a text ends with the quote that it begins with")


def loads(text: str) -> dict[str, Any]:
    """The tables of a text; raises TOMLDecodeError where it has none, or they are nested too deeply."""
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError:
        raise tomllib.TOMLDecodeError(TOO_DEEP) from None
    except ValueError:  # of an integer, whose digits Python limits
        raise tomllib.TOMLDecodeError(TOO_LONG) from None
    inner: list[Any] = [tables]
    for _ in range(MAX_DEPTH):
        both = [item for item in inner if isinstance(item, (dict, list)) and item]
        if not both:
            return tables
        inner = [one for item in both for one in (item.values() if isinstance(item, dict) else item)]
    raise tomllib.TOMLDecodeError(TOO_DEEP)


def repaired(text: str) -> tuple[str, list[Wrong]]:
    """The text of valid TOML that is meant by one, and what was wrong with it; or the text as far as it could be read.

    The text is valid where `tomllib` reads it, which is for the caller to see.
    """
    text, wrong = _typographic(text)
    for _ in range(min(MAX_LINES, 1 + MAX_READ // max(1, len(text)))):
        try:
            loads(text)
        except tomllib.TOMLDecodeError as error:
            reason, number = _place(str(error), text)
            lines = text.split("\n")
            single = _single_brackets(reason, lines[number - 1], text)
            if single:
                wrong.append(single[1])
                text = single[0]
                continue
            number = next((n for n, one in enumerate(lines, 1) if len(one) <= MAX_LINE and _UNLIKE.search(one)), number)
            rules = (_QUOTES, *_RULES) if len(lines[number - 1]) <= MAX_LINE else ()
            rule = next((rule for rule in rules if rule.pattern.search(lines[number - 1])), None)
            line = rule.pattern.sub(rule.right, lines[number - 1]) if rule else lines[number - 1]
            if rule is None or line == lines[number - 1]:
                wrong.append(Wrong(number, "", f"is not valid TOML: {_readable(reason)}"))
                break
            wrong.append(Wrong(number, "", f"is not valid TOML: {rule.message}; write {line.strip()}"))
            lines[number - 1] = line
            text = "\n".join(lines)
        else:
            break
    return text, wrong


def _typographic(text: str) -> tuple[str, list[Wrong]]:
    """A text with the quotes and blanks of programs, in place of those of word processors."""
    try:
        loads(text)
        return text, []  # where they stand in texts and comments
    except tomllib.TOMLDecodeError:
        plain = text.translate(_CURLY).translate(_BLANK)
    code = [line.partition("#")[0] for line in text.split("\n")]
    lines = [n for n, line in enumerate(code, 1) if line.translate(_CURLY) != line]
    if not lines:
        return plain, []
    more = f", here and in {len(lines) - 1} more line{'s' * (len(lines) > 2)}" if len(lines) > 1 else ""
    character = next(c for c in code[lines[0] - 1] if c.translate(_CURLY) != c)
    straight = character.translate(_CURLY)
    return plain, [Wrong(lines[0], "", f"has the curly quote {character}; write the straight one, {straight}{more}")]


def _place(error: str, text: str) -> tuple[str, int]:
    """The reason and the line of an error of tomllib, which ends with its place, or of `loads`, which has none."""
    reason, _, place = error.rpartition(" (at ")
    if match := re.match(r"line (\d+)", place):
        return reason, int(match[1])
    if error in _CULPRITS:
        return error, _CULPRITS[error](text)
    return reason, text.rstrip().count("\n") + 1


def _deepest(text: str) -> int:
    """The line at which brackets are first nested deeper than MAX_DEPTH, or that with the longest dotted key."""
    depth, line = 0, 1
    for token in re.finditer(r"\"(?:[^\"\\\n]|\\.)*\"|'[^'\n]*'|#[^\n]*|[\[\]{}\n]", text):
        line += token[0] == "\n"
        depth += (token[0] in "[{") - (token[0] in "]}")
        if depth > MAX_DEPTH:
            return line
    keys = [re.match(r"\s*\[*([\w.\s-]*)", one) for one in text.split("\n")]
    return 1 + max(range(len(keys)), key=lambda n: keys[n][1].count(".") if keys[n] else 0)  # type: ignore[index]


def _longest_number(text: str) -> int:
    """The line that has the most digits in a row."""
    return text.count("\n", 0, max(re.finditer(r"[\d_]+", text), key=lambda run: len(run[0])).start()) + 1


_CULPRITS: Final[dict[str, Callable[[str], int]]] = {TOO_DEEP: _deepest, TOO_LONG: _longest_number}
"""The line that an error without a place is about."""


def _single_brackets(reason: str, line: str, text: str) -> tuple[str, Wrong] | None:
    """The text with double brackets where a table comes again that needs them."""
    for name in ("actuators", "actuators.segments", "lattice.segments", "axes"):
        single = rf"^[ \t]*\[[ \t]*{re.escape(name)}[ \t]*\]"
        first = re.search(single, text, re.MULTILINE)
        if first and re.match(rf"\s*\[\[?\s*{re.escape(name)}\s*\]", line):
            number = text.count("\n", 0, first.start()) + 1
            right = re.sub(single, f"[[{name}]]", text, flags=re.MULTILINE)
            return right, Wrong(number, name, f"{in_double_brackets(f'[[{name}]]')}; got [{name}]")
    return None


def _readable(reason: str) -> str:
    return re.sub(r"\('([^']*)',\)", r"[\1]", _SYNTAX.get(reason, reason[:1].lower() + reason[1:]))
