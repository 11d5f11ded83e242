"""The commands `aim` and `plan`."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any, TypeVar

import click

from active_surface.cli import ctrl_c, options
from active_surface.cli.group import DEFAULT_OUTPUT, Command, main, refusing

Result = TypeVar("Result")
QUANTILE = click.FloatRange(min=0, max=1, min_open=True)


class _Through(Command):
    """A command whose option --through takes all the points that follow it."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        spread, through = [], False
        for text in args:
            point = "," in text and not text.startswith("--") and not Path(text).exists()
            if through and point:
                spread.append(f"--through={text}")
            elif text != "--through":
                spread.append(text)
            through = text.startswith("--through") or (through and point)
        return super().parse_args(ctx, spread)


def _common(command: Callable[..., None]) -> Callable[..., None]:
    """The options that both commands have."""
    overwrite = click.option("--overwrite", is_flag=True, help="Replace the results of another search of this name.")
    for option in (options.as_json, options.quiet, overwrite, options.threads, options.folder):
        command = option(command)
    return click.argument("file", type=click.Path(path_type=Path), metavar="CASE")(command)


@main.command()
@_common
@click.option("--target", metavar="X,Y", help='Where the part is to go: um, or with units as "0.1 mm,50 um".')
@click.option("--robust", type=QUANTILE, metavar="Q", help="Make this quantile of the distances small, such as 0.9.")
def aim(
    file: Path,
    output: Path | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
    target: str | None,
    robust: float | None,
) -> None:
    """Find the drives that bring the part of CASE to a target.

    CASE is a case file, or a file with a table [aim] that names one and says what may be varied. Ctrl-C ends the search
    with the best drives so far.
    """
    from active_surface.steering import aim as find
    from active_surface.steering import read_place, read_task, report

    place = None if target is None else refusing(read_place, target, "--target")
    task = refusing(read_task, file, place, robust)
    result = _search(find, task, output, threads, overwrite, quiet)
    _print(result.interrupted, report.figures(result), report.lines(result), quiet, as_json)


@main.command(cls=_Through)
@_common
@click.option("--through", multiple=True, required=True, metavar="X,Y ...", help="Where it is to go, in this order.")
def plan(
    file: Path,
    output: Path | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
    through: tuple[str, ...],
) -> None:
    """Find the drives that carry the part of CASE over way-points.

    CASE is as for `aim`, and its duration the time for each leg. Ctrl-C ends the search with the legs so far.
    """
    from active_surface.steering import plan as find
    from active_surface.steering import read_place, read_route, report

    places = [refusing(read_place, text, "--through") for text in through]
    route = refusing(read_route, file, places)
    result = _search(find, route, output, threads, overwrite, quiet)
    _print(result.interrupted, report.plan_figures(result), report.plan_lines(result), quiet, as_json)


def _search(
    find: Callable[..., Result], task: Any, output: Path | None, threads: int | None, overwrite: bool, quiet: bool
) -> Result:
    """What a search finds, with a bar meanwhile."""
    from coupling import CountBar, no_progress
    from coupling.results import check_folder

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(no_progress) if quiet else CountBar("paths") as tell:
        return refusing(find, task, folder, threads, tell, overwrite)


def _print(
    interrupted: bool, figures: dict[str, Any], lines: list[tuple[str, str]], quiet: bool, as_json: bool
) -> None:
    options.tell(figures, lines, quiet, as_json)
    if interrupted:
        ctrl_c.end(None)
