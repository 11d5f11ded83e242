"""Command: a function becomes a command by its signature and its docstring; what it returns is printed."""

from __future__ import annotations

import inspect
import json
import math
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import NoneType
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

import click

from active_surface.cli.refusal import refusing
from coupling import printable

WIDTH = 12  # of labels
NO_ITEM = re.compile(r"-(?![\d.])|.*\.toml$")  # an option or a case: it ends a list of words
USUAL = {
    "quiet": (["--quiet", "-q"], "Print no summary, show no progress."),
    "as_json": (["--json"], "Print the summary, or what is wrong, as JSON."),
}
"""Options of each command that has an Answer: their names and help."""
from_libraries: list[str] = []  # the warnings that Python's `warnings` gave so far, printed already


@dataclass(frozen=True)
class Answer:
    """What a command found: figures for JSON, lines for people, the files that it wrote, and its exit code."""

    figures: Mapping[str, Any]
    lines: Iterable[tuple[str, str]] = ()  # with their labels
    warnings: Iterable[str] | None = None  # None: the command has none
    files: Iterable[Path] | None = None  # None: it writes none, or says so itself
    code: int = 0

    def show(self, quiet: bool, as_json: bool) -> None:
        """Print the lines, warnings and files, or all as JSON."""
        if as_json:
            figures = dict(self.figures)
            if self.warnings is not None or from_libraries:
                figures["warnings"] = [*from_libraries, *(self.warnings or ())]
            if self.files is not None:
                figures["files"] = list(map(str, self.files))
            click.echo(json.dumps(_finite(figures), indent=2, allow_nan=False))
        elif not quiet:
            for label, text in self.lines:
                click.echo(_labelled(label, text))
            for warning in self.warnings or ():
                click.secho(_labelled("warning", warning), fg="yellow")
            for file in self.files or ():
                click.echo(_labelled("wrote", str(file)))


def _labelled(label: str, text: str) -> str:
    return printable(f"{label:<{WIDTH}}{text}")


def _finite(value: Any) -> Any:
    """The same without nan and infinity, which JSON does not have: they become null."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class _Declared(NamedTuple):
    """What an annotation says of a parameter."""

    make: type[click.Parameter]
    names: tuple[str, ...]
    settings: dict[str, Any]


def option(help: str | None, *left: str, **settings: Any) -> _Declared:
    """An option, to annotate a parameter: its help, what stands left of that there, and click's settings.

    left: its names, to which --PARAMETER is added where it has no long one, and its metavar.
    """
    metavar = next((word for word in left if not word.startswith("-")), None)
    names = tuple(word for word in left if word.startswith("-"))
    return _Declared(click.Option, names, settings | {"help": help, "metavar": metavar})


def argument(**settings: Any) -> _Declared:
    """An argument, to annotate a parameter, with click's settings; what is not annotated is one as well."""
    return _Declared(click.Argument, (), settings)


class Command(click.Command):
    """A command in which an option "FILE ..." takes all words that follow it, up to an option or a case."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        lists = {param.opts[0] for param in self.params if str(param.metavar).endswith(" ...")}
        words, name = [], ""
        for text in args:
            if name and not NO_ITEM.match(text):
                words.append(f"{name}={text}")
                continue
            name = next((one for one in lists if text == one or text.startswith(f"{one}=")), "")
            if not name or text != name:
                words.append(text)
        return super().parse_args(ctx, words)


def command(function: Callable[..., Answer | str | None]) -> Command:
    """A command that calls a function: parameters annotated by `option` are options, others arguments.

    Its name, its help and the defaults are those of the function. A bool is a flag, a tuple takes several values and a
    Literal is a choice. A command with an Answer has --quiet and --json as well; a str is printed as it is.
    """

    signature = inspect.signature(function, eval_str=True)
    params = {name: _parameter(parameter) for name, parameter in signature.parameters.items()}
    usual = USUAL if signature.return_annotation is Answer else {}

    def call(**words: Any) -> None:
        given = [words.pop(name) for name in usual]
        with refusing():
            answer = function(**words)
        if isinstance(answer, Answer):
            answer.show(*given)
            if answer.code:
                sys.exit(answer.code)
        elif answer is not None:
            click.echo(answer)

    params |= {name: click.Option([*words, name], is_flag=True, help=text) for name, (words, text) in usual.items()}
    text = inspect.cleandoc(function.__doc__ or "")
    return Command(function.__name__, callback=call, help=text, params=[*params.values()])


def _parameter(parameter: inspect.Parameter) -> click.Parameter:
    """The argument or option that a parameter declares."""
    annotated = get_origin(parameter.annotation) is Annotated
    hint, (make, names, given) = get_args(parameter.annotation) if annotated else (parameter.annotation, argument())
    kind = next((one for one in get_args(hint) if NoneType in get_args(hint) and one is not NoneType), hint)
    settings: dict[str, Any] = {"required": parameter.default is parameter.empty}
    if get_origin(kind) is tuple:
        kind = get_args(kind)[0]
        settings |= {"multiple": True} if make is click.Option else {"nargs": -1}
    if parameter.default not in (parameter.empty, None, ()):
        settings["default"] = parameter.default
    if kind is bool:
        settings["is_flag"] = True
    elif kind is Path:
        settings["type"] = click.Path(path_type=Path)
    else:
        settings["type"] = click.Choice(get_args(kind)) if get_origin(kind) is Literal else kind
    if make is click.Option and not any(name.startswith("--") for name in names):
        names = (f"--{parameter.name.replace('_', '-')}", *names)
    return make([*names, parameter.name], **settings | given)
