"""The command `example`."""

from __future__ import annotations

from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing

COMMANDS = {
    "case": "active-surface run {}",
    "study": "active-surface sweep {}",
    "aim": "active-surface aim {} --help",
}
"""What to do next with an example."""


@main.command()
@click.argument("name", required=False)
@options.quiet
@options.as_json
def example(name: str | None, quiet: bool, as_json: bool) -> None:
    """Write the example NAME, with the files that it reads, where you are; without NAME list all.

    No file is replaced.
    """
    from active_surface.examples import example_names, kind_of, write_example

    if name is None:
        names = example_names()
        width = max(map(len, names))
        lines = [(f"{one:{width}}", f"  {about}") for one, about in names.items()]
        options.tell({"examples": names}, lines, quiet, as_json)
        return
    name = name.removesuffix(".toml")
    files = refusing(write_example, name, Path())
    command = COMMANDS[kind_of(name)].format(next(iter(files)).as_posix())
    lines = [("wrote" if new else "is there", path.as_posix()) for path, new in files.items()]
    figures = {"files": {path.as_posix(): new for path, new in files.items()}, "next": command}
    options.tell(figures, [*lines, ("next", command)], quiet, as_json)
