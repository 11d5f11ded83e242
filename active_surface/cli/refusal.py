"""Refusal: what is wrong with the input of a command, as text or as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import click

from coupling import near, printable, why

if TYPE_CHECKING:
    from coupling.case import Case

_SIZES = "its numbers are too far apart, too large or too small to compute with"
BEYOND = {
    "MemoryError": "it needs more memory than there is",
    "RecursionError": "something in it is nested too deeply",
    **dict.fromkeys(("ArithmeticError", "LinAlgError", "MatrixRankWarning"), _SIZES),
}
"""What errors of numbers and machines mean, by the names of their classes; they have no words for users."""
KINDS = {
    "study": "a study; write active-surface sweep",
    "aim": "an aim; write active-surface aim",
    "case": "a case; write active-surface run",
}
"""What files are, and the command that takes them."""
TABLES = {"study": "study", "axes": "study", "aim": "aim", "plate": "case"}
"""The kind of file that has a table; a study or an aim may have those of a case."""


class Mistake(NamedTuple):
    """One mistake: where it is, as far as it has a file or line, and in which input; what is wrong with that."""

    file: str | None
    line: int | None
    field: str
    message: str


class Refusal(click.ClickException):
    """Ends a command with exit code 2 and every mistake in its input."""

    exit_code = 2

    def __init__(self, message: str, mistakes: Sequence[Mistake], as_json: bool) -> None:
        super().__init__(message)
        self.mistakes, self.as_json = mistakes, as_json

    def show(self, file: IO[Any] | None = None) -> None:
        """Print them on the error stream, or on the output as the JSON that is waited for there."""
        if self.as_json:
            figures = {"mistakes": [mistake._asdict() for mistake in self.mistakes]}
            click.echo(printable(json.dumps(figures, indent=2, ensure_ascii=False)), file)
        else:
            click.echo(printable(self.message), file, err=True)


@contextmanager
def refusing() -> Iterator[None]:
    """Refuse the input of the current command where its work raises an error."""
    try:
        yield
    except BrokenPipeError:  # of a reader that has had enough, as `head` has
        raise
    except (ValueError, OSError, RuntimeError, ArithmeticError, MemoryError) as error:
        context = click.get_current_context()
        words: dict[str, str] = {}
        for param in context.command.params:
            if isinstance(param, click.Option):
                words |= dict.fromkeys((param.name or "", param.opts[0].lstrip("-")), param.opts[0])
            else:
                words[param.name or ""] = param.human_readable_name
                words.setdefault("path", param.human_readable_name)  # as readers of files call it
        raise refusal_of(error, context.command_path, bool(context.params.get("as_json", context.obj)), words) from None


def refusal_of(error: Exception, command: str, as_json: bool, words: Mapping[str, str]) -> Refusal:
    """What is wrong with the input where work for a command raised an error.

    words: how the command calls its inputs, by their names.
    """
    file = getattr(error, "file", None)
    if file is not None:  # of a CaseError, which knows its lines
        problems = getattr(error, "problems", ())
        mistakes = [Mistake(file, problem.line, problem.field, problem.message) for problem in problems]
        return Refusal(str(error), mistakes, as_json)
    names = [one.__name__ for one in type(error).__mro__]
    beyond = next((text for name, text in BEYOND.items() if name in names), "")
    if beyond or not isinstance(error, ValueError):  # no mistake, but something in the way
        text = beyond or str(error)
        if isinstance(error, OSError) and error.strerror:
            text = ": ".join([*([str(error.filename)] if error.filename else []), why(error)])
        return Refusal(f"{command}: {text}", [Mistake(None, None, "", text)], as_json)
    mistakes = [_mistake(text, words) for text in re.split(r"\n|; (?=Inputs? )", str(error))]
    lines = [f"  {f'{mistake.field} {mistake.message}'.lstrip()}" for mistake in mistakes]
    head = f"{command}: {len(mistakes)} mistake{'s' * (len(mistakes) != 1)}"
    return Refusal("\n".join([head, *lines]), mistakes, as_json)


def _mistake(text: str, words: Mapping[str, str]) -> Mistake:
    """What is wrong, and with which input of the command where the text names one of a function."""
    found = re.fullmatch(r"Input (\S+) (?:of [a-z]\w* )?(?!of )(.*)", text, re.DOTALL)
    if found is None:
        return Mistake(None, None, "", text)
    return Mistake(None, None, words.get(found[1], found[1]), found[2])


def kind_of(file: Path, otherwise: str = "case") -> str:
    """Which of the KINDS of files it is, as far as its tables show it; CaseError where it has none."""
    from coupling.case import parse

    tables = parse(file).tables
    found = {TABLES[table] for table in tables if table in TABLES}
    meant = {TABLES[table] for one in tables if (table := near(one, TABLES))}
    return next((kind for kind in KINDS if kind in (found or meant)), otherwise)


def check_kind(file: Path, *expected: str) -> None:
    """Refuse a file of another of the KINDS, in which nearly all would be a mistake."""
    kind = kind_of(file, expected[0])
    if kind not in expected:
        what = " or ".join(KINDS[one].partition(";")[0] for one in expected)
        raise ValueError(f"Input path must be {what}; got {file}, {KINDS[kind]} {file}")


def read(file: Path, may_move: bool = False) -> Case:
    """The case in a file; may_move: as for `read_case`."""
    from coupling.case import read_case

    check_kind(file, "case")
    return read_case(file, may_move)


def read_all(file: Path) -> list[Case]:
    """The cases of the parts in a file."""
    from coupling.case import read_parts

    check_kind(file, "case")
    return read_parts(file)
