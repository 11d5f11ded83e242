"""The command `active-surface` with `aim`. Heavy imports wait until a command needs them."""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path

import click

from coupling.cli import DEFAULT_OUTPUT, INTERRUPTED, main, refusing
from studies import cli as _sweep  # noqa: F401  # which adds its command

QUANTILE = click.FloatRange(min=0, max=1, min_open=True)


@main.command()
@click.argument("file", type=click.Path(path_type=Path), metavar="CASE")
@click.option("--target", metavar="X,Y", help='Where the part is to go: um, or with units as "0.1 mm,50 um".')
@click.option("--robust", type=QUANTILE, metavar="Q", help="Make this quantile of the distances small, such as 0.9.")
@click.option(
    "--output", "-o", type=click.Path(path_type=Path, file_okay=False), help="Folder for the results [results]."
)
@click.option("--threads", "-t", type=click.IntRange(min=1), help="Paths found at a time [one on each processor].")
@click.option("--quiet", "-q", is_flag=True, help="Print no summary, show no progress.")
@click.option("--json", "as_json", is_flag=True, help="Print the summary as JSON.")
def aim(
    file: Path,
    target: str | None,
    robust: float | None,
    output: Path | None,
    threads: int | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Find the drives that bring the part of CASE to a target.

    CASE is a case file, or a file with a table [aim] that names one and says what may be varied. Ctrl-C ends the search
    with the best drives so far.
    """
    from coupling.progress import CountBar, untold
    from coupling.results import check_folder
    from steering import report
    from steering.aiming import aim as find
    from steering.places import read_place
    from steering.read import read_task

    place = None if target is None else refusing(read_place, target, "--target")
    task = refusing(read_task, file, place, robust)
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(untold) if quiet else CountBar("paths") as tell:
        found = refusing(find, task, folder, threads, tell)
    if as_json:
        click.echo(json.dumps(report.figures(found), indent=2))
    elif not quiet:
        for label, text in report.lines(found):
            click.echo(f"{label:<12}{text}")
    if found.interrupted:
        sys.exit(INTERRUPTED)
