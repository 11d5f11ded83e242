"""Refusal: what is wrong with the input of a command, as text or as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from typing import IO, Any, NamedTuple

import click


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
            click.echo(json.dumps(told, indent=2, ensure_ascii=False), file)
        else:
            click.echo(self.message, file, err=True)


def refusal_of(error: Exception, command: str, as_json: bool) -> Refusal:
    """What is wrong with the input where work for a command raised an error."""
    file = getattr(error, "file", None)
    if file is not None:  # of a CaseError, which knows its lines
        problems: Iterable[Any] = getattr(error, "problems", ())
        mistakes = [Mistake(file, problem.line, problem.field, problem.message) for problem in problems]
        return Refusal(str(error), mistakes, as_json)
    if not isinstance(error, ValueError):  # no mistake, but something in the way
        said = str(error)
        if isinstance(error, OSError) and error.strerror:
            said = ": ".join([*([str(error.filename)] if error.filename else []), error.strerror.lower()])
        return Refusal(f"{command}: {said}", [Mistake(None, None, "", said)], as_json)
    return refusal(command, [("", said) for said in re.split(r"\n|; (?=Inputs? )", str(error))], as_json)


def refusal(command: str, mistakes: Iterable[tuple[str, str]], as_json: bool) -> Refusal:
    """A refusal for inputs of a command: their names, and what is wrong with each."""
    told = [Mistake(None, None, *mistake) for mistake in mistakes]
    lines = [f"  {f'{mistake.field} {mistake.message}'.lstrip()}" for mistake in told]
    head = f"{command}: {len(told)} mistake{'s' * (len(told) != 1)}"
    return Refusal("\n".join([head, *lines]), told, as_json)
