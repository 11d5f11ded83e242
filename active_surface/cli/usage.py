"""What is wrong with the words of a command: which of them, what it must be, and what it is."""

from __future__ import annotations

import ast
import copy
import json
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import click

from coupling import alike, near

PATHS = (" is a file", " is a directory", " does not exist", " is not readable", " is not writable")
"""What click says of a path that cannot be used."""
TEXT = r"""'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*\""""
"""A text as Python writes it, in quotes."""
Mistake = tuple[str, str]
"""An argument or option, and what is wrong with it."""


def mistakes_in(
    error: click.UsageError, again: Callable[[Sequence[click.Parameter]], object] | None = None
) -> list[Mistake]:
    """What is wrong with the words of a command that failed on an error.

    again: parses them once more, with other parameters, and raises the next error; None: there is no more to find.
    """
    mistakes = [_mistake(error)]
    while again and error.ctx and (wrong := getattr(error, "param", None)):
        try:
            again([_lenient(param) if param.name == wrong.name else param for param in error.ctx.command.params])
        except click.UsageError as another:
            error = another
            mistakes.append(_mistake(error))
        else:
            break
    return mistakes


def unknown(name: str, known: Iterable[str], owner: str) -> Mistake:
    """That there is no command or option of a name."""
    choices = sorted(known)
    if name.startswith("-"):  # synonyms are of keys and commands
        words = {choice.lstrip("-"): choice for choice in choices}
        meant = words.get(alike(name.lstrip("-"), words) or "")
    else:
        meant = near(name, choices)
    return name, "is not known; " + (f"did you mean {meant}?" if meant else f"{owner} has {', '.join(choices)}")


def _lenient(param: click.Parameter) -> click.Parameter:
    """The same parameter, which takes anything."""
    other = copy.copy(param)
    other.required, other.type, other.callback = False, click.UNPROCESSED, None
    return other


def _mistake(error: click.UsageError) -> Mistake:
    name = error.ctx.command_path if error.ctx else "the command"
    if isinstance(error, click.NoSuchOption):
        params = error.ctx.command.get_params(error.ctx) if error.ctx else []
        return unknown(error.option_name, [word for p in params for word in p.opts if word.startswith("--")], name)
    if isinstance(error, click.BadOptionUsage):
        return error.option_name, "must be followed by its value; got nothing"
    param = getattr(error, "param", None)
    if isinstance(error, click.MissingParameter) and param is not None:
        like = f", as in {_usage(error.ctx)}" if isinstance(param, click.Argument) and error.ctx else ""
        return _named(param), f"is missing; it must be {_expected(param)}{like}"
    if isinstance(error, click.BadParameter) and param is not None:
        return _named(param), f"must be {_expected(param)}; got {_got(error.message)}"
    if isinstance(error, click.BadParameter) and isinstance(error.param_hint, str):
        return error.param_hint, error.message
    extra = re.fullmatch(r"Got unexpected extra arguments? \((.*)\)", error.message)
    if extra and error.ctx:
        return extra[1], f"is one argument too many; the command is {_usage(error.ctx)}"
    return "", error.message


def _usage(context: click.Context) -> str:
    """How a command is written."""
    return " ".join([context.command_path, *context.command.collect_usage_pieces(context)])


def _named(param: click.Parameter) -> str:
    """What a user calls a parameter: --threads, CASE."""
    longest = max(param.opts, key=len)
    return longest if isinstance(param, click.Option) else (param.metavar or str(param.name).upper())


def _got(message: str) -> str:
    """The value that click complains about in a message, and of a path why."""
    match = re.match(rf"(?:\w+ )?({TEXT})(.*)|(\S+)", message)
    assert match
    if match[1] is None:
        return match[3]
    why = next((f", which{end}" for end in PATHS if match[2] == f"{end}."), "")
    return json.dumps(ast.literal_eval(match[1]), ensure_ascii=False) + why


def _expected(param: click.Parameter) -> str:
    """What a value of a parameter must be, in words."""
    kind: Any = param.type
    if isinstance(kind, click.Choice):
        *others, last = (str(choice) for choice in kind.choices)
        return f"{', '.join(others)} or {last}" if others else last
    if isinstance(kind, click.Path):
        return "the name of a folder" if not kind.file_okay else "the name of a file"
    number = {"integer": "a whole number", "float": "a number"}.get(kind.name.split()[0])
    if number is None:
        return param.metavar or "text"
    bounds = []
    if getattr(kind, "min", None) is not None:
        bounds.append(f"{'greater than' if kind.min_open else 'of at least'} {kind.min:g}")
    if getattr(kind, "max", None) is not None:
        bounds.append(f"{'less than' if kind.max_open else 'at most'} {kind.max:g}")
    return " ".join([number, " and ".join(bounds)]).rstrip()
