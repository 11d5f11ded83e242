"""The command `active-surface`, with all its commands."""

from __future__ import annotations

import atexit
import gc
import os
import sys
import warnings
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

import click

from active_surface.cli import ctrl_c
from active_surface.cli.command import from_libraries
from active_surface.cli.commands import COMMANDS
from active_surface.cli.refusal import KINDS, Mistake, Refusal, kind_of, refusal_of, refusing
from coupling import printable

GARBAGE = 500_000  # objects between collections: none while what a short command needs is loaded


class Group(click.Group):
    """The commands: errors as JSON where that is waited for, and the exit code of Ctrl-C."""

    def main(self, args: Sequence[str] | None = None, *more: Any, **extra: Any) -> Any:
        if args is not None:  # of a program that goes on
            return super().main(args, *more, **extra)
        ctrl_c.watch()
        warnings.showwarning = _show
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

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        ctx.obj = "--json" in args
        if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
            ctx.color = False
        return super().parse_args(ctx, args)

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        with refusing():
            if args[0] not in self.commands and Path(args[0]).exists() and not ctx.resilient_parsing:
                raise ValueError(f"{args[0]} is {KINDS[kind_of(Path(args[0]))]} {args[0]}")
        return super().resolve_command(ctx, args)

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except click.UsageError as error:
            if not ctx.obj:
                raise
            message = error.format_message()
            raise Refusal(message, [Mistake(None, None, "", message)], True) from None
        except KeyboardInterrupt as error:
            ctrl_c.end(*error.args)
        except SystemError as error:  # raised where compiled code goes on after a KeyboardInterrupt
            if not isinstance(error.__cause__, KeyboardInterrupt):
                raise
            ctrl_c.end()


def _show(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a library's warning as the commands print theirs, without the line of code."""
    from_libraries.append(str(message))
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


@click.group(cls=Group, commands=COMMANDS, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="active-surface")
def main() -> None:
    """Simulate microparts on active surfaces: thin plates pushed from below by point actuators."""
