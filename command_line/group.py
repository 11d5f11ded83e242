"""The group that commands join, and what they have in common. Heavy imports wait until a command needs them."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import click

if TYPE_CHECKING:
    from coupling.case import Case

Answer = TypeVar("Answer")

DEFAULT_OUTPUT = Path("results")
INTERRUPTED = 130  # 128 and the number of the signal


class _Command(click.Group):
    """A command that ends with the exit code of an interrupted one on Ctrl-C."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            sys.exit(INTERRUPTED)


@click.group(cls=_Command, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="active-surface")
def main() -> None:
    """Simulate microparts on active surfaces: thin plates pushed from below by point actuators."""


def read(path: Path) -> Case:
    from coupling.case import read_case

    return refusing(read_case, path)


def refusing(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments), with a refused input said in one message and exit code 2."""
    try:
        return work(*arguments)
    except (ValueError, OSError, RuntimeError) as error:
        _refuse(str(error))


def _refuse(message: str) -> NoReturn:
    click.echo(message, err=True)
    sys.exit(2)
