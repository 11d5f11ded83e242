"""The commands `aim` and `plan`, which find drives."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import click

from active_surface.cli.command import Answer, command, option
from active_surface.cli.ctrl_c import INTERRUPTED
from active_surface.cli.options import POSITIVE, RESULTS, Output, Overwrite, Threads, amount_of, counted
from active_surface.cli.refusal import check_kind

if TYPE_CHECKING:
    from active_surface.steering import Aimed, Planned
    from coupling import ProgressCallback

QUANTILE = click.FloatRange(min=0, max=1, min_open=True)
SHARE = click.FloatRange(min=0, max=1, min_open=True, max_open=True)
MISSED = 1  # the exit code where a target is not reached
Groups = Annotated[
    Literal["each", "columns", "rows", "all"] | None, option("Which actuators move alike [each by itself].")
]
Bounds = Annotated[str | None, option('Bounds of the frequency, such as "1 kHz:6 kHz".', "LOW:HIGH")]


@command
def aim(
    case: Path,
    output: Output = RESULTS,
    threads: Threads = None,
    overwrite: Overwrite = False,
    target: Annotated[
        str | None, option('Where the part is to go: um, or with units as "0.1 mm,50 um".', "X,Y")
    ] = None,
    by: Annotated[str | None, option("The same from where the part starts.", "X,Y")] = None,
    heading: Annotated[
        str | None, option('The heading of its footprint there: deg, or with its unit as "0.5 rad".', "ANGLE")
    ] = None,
    robust: Annotated[
        float | None, option("Make this quantile of the distances small, such as 0.9.", "Q", type=QUANTILE)
    ] = None,
    cvar: Annotated[
        float | None, option("Make their mean beyond this quantile small, such as 0.9.", "Q", type=SHARE)
    ] = None,
    groups: Groups = None,
    frequency: Bounds = None,
) -> Answer:
    """Find the drives that bring the part of CASE to a target.

    CASE is a case file, or a file with a table [aim] that names one and says what may be varied. Ctrl-C ends the search
    with the best drives so far. The exit code is 1 where the target is missed.
    """
    from active_surface.steering import aim as find
    from active_surface.steering import read_heading, read_place, read_task

    place = None if target is None else read_place(target, "--target")
    step = None if by is None else read_place(by, "--by")
    angle = None if heading is None else read_heading(heading, "--heading")
    if robust is not None and cvar is not None:
        raise ValueError("--cvar must not be given with --robust, whose place it takes")
    check_kind(case, "aim", "case")
    task = read_task(case, place, robust, cvar, angle, step, groups=groups, frequency=_bounds(frequency))
    return _searched(lambda tell: _aimed(find(task, output, threads, tell, overwrite)))


@command
def plan(
    case: Path,
    output: Output = RESULTS,
    threads: Threads = None,
    overwrite: Overwrite = False,
    *,
    through: Annotated[tuple[str, ...], option("Where it is to go, in this order.", "X,Y ...")] = (),
    by: Annotated[tuple[str, ...], option("The same in steps, the first from the start.", "X,Y ...")] = (),
    measured: Annotated[Path | None, option("Where the part was after each leg.", "FILE")] = None,
    attempts: Annotated[int | None, option("Legs to a way-point, with --measured [3].", "N", type=POSITIVE)] = None,
    groups: Groups = None,
    frequency: Bounds = None,
) -> Answer:
    """Find the drives that carry the part of CASE over way-points.

    CASE is as for `aim`, and its duration the time for each leg. Ctrl-C ends the search with the legs so far. The exit
    code is 1 where a way-point is missed. With --measured only the next leg is aimed, from where the part was measured
    last; its drives are written as a case of their own.
    """
    from active_surface.steering import (
        ATTEMPTS,
        next_leg,
        progress_of,
        read_measured,
        read_place,
        read_route,
        report,
    )
    from active_surface.steering import aim as find
    from active_surface.steering import plan as find_all

    places, steps = [read_place(text, "--through") for text in through], [read_place(text, "--by") for text in by]
    check_kind(case, "aim", "case")
    route = read_route(case, places, steps, groups=groups, frequency=_bounds(frequency))
    if measured is not None:
        ends = read_measured(measured)
        task = next_leg(route, ends, attempts or ATTEMPTS)
        if task is not None:
            return _searched(lambda tell: _aimed(find(task, output, threads, tell, overwrite)))
        complete, figures, lines = report.ended(route, progress_of(route, ends, attempts or ATTEMPTS))
        return Answer(figures, lines, code=0 if complete else MISSED)
    if attempts is not None:
        raise ValueError("--attempts must not be given without --measured")
    return _searched(lambda tell: _planned(find_all(route, output, threads, tell, overwrite)))


def _searched(search: Callable[[ProgressCallback], Answer]) -> Answer:
    """What a search found, with a bar over its paths; or why nothing moves the part."""
    from active_surface.steering import Unmoved

    try:
        with counted("paths") as tell:
            return search(tell)
    except Unmoved as error:
        return Answer({"reached": False, "failure": str(error)}, [("missed", f"{error}.")], code=MISSED)


def _aimed(result: Aimed) -> Answer:
    from active_surface.steering import report

    code = INTERRUPTED if result.interrupted else 0 if result.reached else MISSED
    return Answer(report.figures(result), report.lines(result), code=code)


def _planned(result: Planned) -> Answer:
    from active_surface.steering import report

    code = INTERRUPTED if result.interrupted else 0 if result.complete else MISSED
    return Answer(report.plan_figures(result), report.plan_lines(result), code=code)


def _bounds(text: str | None) -> tuple[float, float] | None:
    """The bounds [Hz] that an option gives; None: it is not given."""
    if text is None:
        return None
    ends = [amount_of(part, "Hz", "--frequency", "1 kHz") or 0.0 for part in text.split(":")]
    if len(ends) != 2 or not 0 < ends[0] <= ends[1]:
        raise ValueError(f'--frequency must be two frequencies, the lower first, such as "1 kHz:6 kHz"; got "{text}"')
    return ends[0], ends[1]
