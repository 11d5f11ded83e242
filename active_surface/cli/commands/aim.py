"""The commands `aim` and `plan`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import click

from active_surface.cli import ctrl_c, options
from active_surface.cli.group import DEFAULT_OUTPUT, Spreading, check_kind, main, refusing

if TYPE_CHECKING:
    from active_surface.steering import Route

Result = TypeVar("Result")
QUANTILE = click.FloatRange(min=0, max=1, min_open=True)
SHARE = click.FloatRange(min=0, max=1, min_open=True, max_open=True)
MISSED = 1  # the exit code where a target is not reached


class _Through(Spreading):
    """A command whose option --through takes all the points that follow it."""

    spread: ClassVar = {"--through": lambda text: "," in text and not text.startswith("--") and not Path(text).exists()}


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
@click.option("--cvar", type=SHARE, metavar="Q", help="Make their mean beyond this quantile small, such as 0.9.")
def aim(
    file: Path,
    output: Path | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
    target: str | None,
    robust: float | None,
    cvar: float | None,
) -> None:
    """Find the drives that bring the part of CASE to a target.

    CASE is a case file, or a file with a table [aim] that names one and says what may be varied. Ctrl-C ends the search
    with the best drives so far. The exit code is 1 where the target is missed.
    """
    from active_surface.steering import aim as find
    from active_surface.steering import read_place, read_task, report

    place = None if target is None else refusing(read_place, target, "--target")
    if robust is not None and cvar is not None:
        raise click.BadParameter("must not be given with --robust, whose place it takes", param_hint="--cvar")
    check_kind(file, "aim", "case")
    task = refusing(read_task, file, place, robust, cvar)
    result = _search(find, task, output, threads, overwrite, quiet)
    _print(result.interrupted, report.figures(result), report.lines(result), quiet, as_json)
    sys.exit(0 if result.reached else MISSED)


@main.command(cls=_Through)
@_common
@click.option("--through", multiple=True, required=True, metavar="X,Y ...", help="Where it is to go, in this order.")
@click.option("--measured", type=click.Path(path_type=Path), metavar="FILE", help="Where the part was after each leg.")
@click.option("--attempts", type=click.IntRange(min=1), metavar="N", help="Legs to a way-point, with --measured [3].")
def plan(
    file: Path,
    output: Path | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
    through: tuple[str, ...],
    measured: Path | None,
    attempts: int | None,
) -> None:
    """Find the drives that carry the part of CASE over way-points.

    CASE is as for `aim`, and its duration the time for each leg. Ctrl-C ends the search with the legs so far. The exit
    code is 1 where a way-point is missed. With --measured only the next leg is aimed, from where the part was measured
    last; its drives are written as a case of their own.
    """
    from active_surface.steering import plan as find
    from active_surface.steering import read_place, read_route, report

    places = [refusing(read_place, text, "--through") for text in through]
    check_kind(file, "aim", "case")
    route = refusing(read_route, file, places)
    if measured is not None:
        _next_leg(route, measured, attempts, output, threads, overwrite, quiet, as_json)
        return
    if attempts is not None:
        raise click.BadParameter("must not be given without --measured", param_hint="--attempts")
    result = _search(find, route, output, threads, overwrite, quiet)
    _print(result.interrupted, report.plan_figures(result), report.plan_lines(result), quiet, as_json)
    sys.exit(0 if result.complete else MISSED)


def _next_leg(
    route: Route,
    measured: Path,
    attempts: int | None,
    output: Path | None,
    threads: int | None,
    overwrite: bool,
    quiet: bool,
    as_json: bool,
) -> None:
    """Aim the leg that follows the places in a file."""
    from active_surface.steering import ATTEMPTS, next_leg, progress_of, read_measured, report
    from active_surface.steering import aim as find

    places = refusing(read_measured, measured)
    task = refusing(next_leg, route, places, attempts or ATTEMPTS)
    if task is None:
        complete, figures, lines = report.ended(route, progress_of(route, places, attempts or ATTEMPTS))
        options.tell(figures, lines, quiet, as_json)
        sys.exit(0 if complete else MISSED)
    result = _search(find, task, output, threads, overwrite, quiet)
    _print(result.interrupted, report.figures(result), report.lines(result), quiet, as_json)
    sys.exit(0 if result.reached else MISSED)


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
