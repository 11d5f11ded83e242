"""Refusal: what is wrong with the input of a command, as text or as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import IO, Any, NamedTuple

import click

from coupling import printable, why

_SIZES = "its numbers are too far apart, too large or too small to compute with"
BEYOND = {
    "MemoryError": "it needs more memory than there is",
    "RecursionError": "something in it is nested too deeply",
    **dict.fromkeys(("ArithmeticError", "LinAlgError", "MatrixRankWarning"), _SIZES),
}
"""What errors of numbers and machines mean, by the names of their classes; they have no words for users."""


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
        """Tells them on the error stream, or on the output as the JSON that is waited for there."""
        if self.as_json:
            told = {"mistakes": [mistake._asdict() for mistake in self.mistakes]}
            click.echo(printable(json.dumps(told, indent=2, ensure_ascii=False)), file)
        else:
            click.echo(printable(self.message), file, err=True)


def refusal_of(error: Exception, command: str, as_json: bool, words: Mapping[str, str]) -> Refusal:
    """What is wrong with the input where work for a command raised an error.

    words: how the command calls its inputs, by their names.
    """
    file = getattr(error, "file", None)
    if file is not None:  # of a CaseError, which knows its lines
        problems: Iterable[Any] = getattr(error, "problems", ())
        mistakes = [Mistake(file, problem.line, problem.field, problem.message) for problem in problems]
        return Refusal(str(error), mistakes, as_json)
    beyond = next(
        (words for name, words in BEYOND.items() if name in [one.__name__ for one in type(error).__mro__]), ""
    )
    if beyond or not isinstance(error, ValueError):  # no mistake, but something in the way
        said = beyond or str(error)
        if isinstance(error, OSError) and error.strerror:
            said = ": ".join([*([str(error.filename)] if error.filename else []), why(error)])
        return Refusal(f"{command}: {said}", [Mistake(None, None, "", said)], as_json)
    texts = re.split(r"\n|; (?=Inputs? )", str(error))
    return refusal(command, [_in_words(text, command.split()[-1], words) for text in texts], as_json)


def _in_words(text: str, caller: str, words: Mapping[str, str]) -> tuple[str, str]:
    """The input of the command, and what is wrong with it, where a text names an input of its function, or of none."""
    of_caller = re.fullmatch(rf"Input (\S+) (?:of {re.escape(caller)} |(?!of ))(.*)", text, re.DOTALL)
    return (words.get(of_caller[1], of_caller[1]), of_caller[2]) if of_caller else ("", text)


def refusal(command: str, mistakes: Iterable[tuple[str, str]], as_json: bool) -> Refusal:
    """A refusal for inputs of a command: their names, and what is wrong with each."""
    told = [Mistake(None, None, *mistake) for mistake in mistakes]
    lines = [f"  {f'{mistake.field} {mistake.message}'.lstrip()}" for mistake in told]
    head = f"{command}: {len(told)} mistake{'s' * (len(told) != 1)}"
    return Refusal("\n".join([head, *lines]), told, as_json)
