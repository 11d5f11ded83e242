"""The group that commands join, and what they have in common. Heavy imports wait until a command needs them."""

from __future__ import annotations

import atexit
import copy
import gc
import os
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, TypeVar

import click

from active_surface.cli import ctrl_c, options
from active_surface.cli.refusal import Refusal, refusal, refusal_of
from active_surface.cli.usage import mistakes_in, unknown
from coupling import near, printable

if TYPE_CHECKING:
    from coupling.case import Case

Answer = TypeVar("Answer")

DEFAULT_OUTPUT = Path("results")
JSON = "--json"
GARBAGE = 500_000  # objects between collections: none while what a short command needs is loaded
KINDS = {"study": ("study", "sweep"), "aim": ("aim", "aim"), "case": ("plate", "run")}
"""Kinds of files: the table that only they have, and the command that takes them."""


class Command(click.Command):
    """A command that tells all that is wrong with its words at once."""

    def make_context(
        self, info_name: str | None, args: list[str], parent: click.Context | None = None, **extra: Any
    ) -> click.Context:
        words = list(args)

        def again(params: Sequence[click.Parameter]) -> None:
            other = copy.copy(self)
            other.params = list(params)
            click.Command.make_context(other, info_name, list(words), parent, **extra)

        try:
            return super().make_context(info_name, args, parent, **extra)
        except click.exceptions.NoArgsIsHelpError:
            raise  # which shows the help
        except click.UsageError as error:
            command = " ".join([*([parent.command_path] if parent else []), info_name or ""])
            raise refusal(command, mistakes_in(error, again), JSON in words) from None

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except click.UsageError as error:
            raise refusal(ctx.command_path, mistakes_in(error), bool(ctx.params.get("as_json"))) from None


class Spreading(Command):
    """A command with options that take all the words that follow them, each as long as a test accepts the word."""

    spread: ClassVar[Mapping[str, Callable[[str], bool]]] = {}

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        words, option = [], ""
        for text in args:
            if option and self.spread[option](text):
                words.append(f"{option}={text}")
                continue
            option = next((name for name in self.spread if text == name or text.startswith(f"{name}=")), "")
            if text != option:
                words.append(text)
        return super().parse_args(ctx, words)


class Group(Command, click.Group):
    """The commands: errors in one style, colours only where they are wanted, and the exit code of Ctrl-C."""

    command_class = Command

    def main(self, args: Sequence[str] | None = None, *more: Any, **extra: Any) -> Any:
        if args is not None:  # of a program that goes on
            return super().main(args, *more, **extra)
        ctrl_c.ends_soon()
        warnings.showwarning = _told
        gc.set_threshold(GARBAGE)
        try:
            return super().main(args, *more, **extra)
        except OSError as error:  # without a file's name of the output or the error stream, as on a full disk
            what = "active-surface" + ("" if error.filename else ": what it prints cannot be written")
            with suppress(OSError):
                refusal_of(error, what, False, {}).show()
            leave(SystemExit(Refusal.exit_code))
        except SystemExit as end:
            leave(end)

    def make_context(self, *arguments: Any, **extra: Any) -> click.Context:
        context = super().make_context(*arguments, **extra)
        if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
            context.color = False
        return context

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        if self.get_command(ctx, args[0]) is None and not ctx.resilient_parsing:
            mistake = _file_alone(args[0]) or unknown(args[0], self.list_commands(ctx), ctx.command_path)
            raise refusal(ctx.command_path, [mistake], JSON in args)
        return super().resolve_command(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            with ctrl_c.heard_again():
                return super().invoke(ctx)
        except KeyboardInterrupt:
            ctrl_c.end()


def _told(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a library's warning as the commands print theirs, without the line of code."""
    options.of_libraries.append(str(message))
    click.echo(printable(f"warning     {message}"), err=True)


def leave(end: SystemExit) -> NoReturn:
    """End the process without taking apart all that it loaded, which takes a tenth of a short command."""
    code = 0 if end.code is None else end.code
    if isinstance(code, int):
        atexit._run_exitfuncs()
        with suppress(OSError, ValueError):  # Python reports what cannot be written
            for stream in (sys.stdout, sys.stderr):
                if stream is not None:  # closed before the start
                    stream.flush()
            os._exit(code)
    raise end  # Python prints what the code is


@click.group(cls=Group, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="active-surface")
def main() -> None:
    """Simulate microparts on active surfaces: thin plates pushed from below by point actuators."""


def read(path: Path, may_move: bool = False) -> Case:
    """The case in a file; may_move: as for `read_case`."""
    from coupling.case import read_case

    check_kind(path, "case")
    return refusing(read_case, path, may_move)


def read_all(paths: Sequence[Path]) -> list[Case]:
    """The cases in files, with the mistakes of all of them in one refusal."""
    cases, refused = [], []
    for path in paths:
        try:
            cases.append(read(path))
        except Refusal as error:
            refused.append(error)
    if refused:
        mistakes = [mistake for error in refused for mistake in error.mistakes]
        raise Refusal("\n".join(error.message for error in refused), mistakes, refused[0].as_json)
    return cases


def check_kind(path: Path, *expected: str) -> None:
    """Refuse a file of another of the KINDS, in which nearly all would be a mistake."""
    kind = kind_of(refusing(parse_file, path))
    if kind and kind not in expected:
        text = f"must be {_a(expected[0])}; got {path}, {_a(kind)}; write active-surface {KINDS[kind][1]} {path}"
        context = click.get_current_context()
        raise refusal(context.command_path, [(_file_argument(context), text)], bool(context.params.get("as_json")))


def parse_file(path: Path) -> dict[str, Any]:
    """The tables of a file, as far as they can be read; raises CaseError where they cannot."""
    from coupling.case import parse

    return parse(path, lenient=True).tables


def kind_of(tables: Mapping[str, Any]) -> str | None:
    """Which of the KINDS of files has these tables; None: it is not clear."""
    of = {table: kind for kind, (table, _) in KINDS.items()} | {"axes": "study"}
    exact = {of[key] for key in tables if key in of}
    meant = {of[table] for key in tables if (table := near(key, of))}
    return next((kind for kind in KINDS if kind in (exact or meant)), None)


def _a(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _file_argument(context: click.Context) -> str:
    """What a command calls its file."""
    arguments = [param for param in context.command.params if isinstance(param, click.Argument)]
    return arguments[0].human_readable_name if arguments else ""


def _file_alone(name: str) -> tuple[str, str] | None:
    """What is missing where a file stands in place of a command; None: it is no file."""
    path = Path(name)
    if not path.exists() and not path.suffix and path.name == name:
        return None
    try:
        kind = kind_of(parse_file(path)) or "case"
    except ValueError as error:  # of a CaseError, which has one reason or several
        reasons = [str(problem.message) for problem in getattr(error, "problems", ())]
        if len(reasons) == 1 and (path.exists() or "did you mean" in reasons[0]):
            return name, f"is no command; it {reasons[0]}"
        kind = "case"
    return (name, f"is {_a(kind)}; write active-surface {KINDS[kind][1]} {name}") if path.exists() else None


def refusing(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments), with a refused input said in one message and exit code 2."""
    try:
        return work(*arguments)
    except (ValueError, OSError, RuntimeError, ArithmeticError, MemoryError) as error:
        context = click.get_current_context()
        words = {"path": _file_argument(context)}  # as readers of files call it
        for param in context.command.params:
            words |= dict.fromkeys((param.name or "", param.opts[0].lstrip("-")), _word(param))
        raise refusal_of(error, context.command_path, bool(context.params.get("as_json")), words) from None


def _word(param: click.Parameter) -> str:
    """What an argument or option is called where the command is typed."""
    return param.opts[0] if isinstance(param, click.Option) else param.human_readable_name
