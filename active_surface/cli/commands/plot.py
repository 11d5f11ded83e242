"""The command `plot`."""

from __future__ import annotations

from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing

PARTIAL = "The files were not written to the end: the surface is drawn from the steps that they have."


@main.command()
@click.argument("result", type=click.Path(path_type=Path), metavar="RESULT|SWEEP")
@options.output_folder("the result's", "pictures")
@click.option(
    "--format",
    "formats",
    type=click.Choice(["pdf", "svg", "png"]),
    multiple=True,
    default=["pdf"],
    help="Kind of the files; may be given several times [pdf].",
)
@click.option("--width", type=float, default=85.0, metavar="MM", help="Width of each picture in mm [85].")
@click.option("--x", metavar="AXIS", help="Of a sweep: the axis that is drawn along x [one of the two longest].")
@click.option("--y", metavar="AXIS", help="Of a sweep: the axis that is drawn along y.")
@click.option("--value", metavar="COLUMN", help="Of a sweep: the only column that is drawn [distance and outcome].")
@options.quiet
@options.as_json
def plot(
    result: Path,
    output: Path | None,
    formats: tuple[str, ...],
    width: float,
    x: str | None,
    y: str | None,
    value: str | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Draw a run or a sweep for print.

    RESULT is either file of a run, or FOLDER/NAME; SWEEP is the netCDF file of a sweep. Each picture has a file of its
    own, as wide as is asked for, with text as text; the captions are printed.
    """
    from active_surface.views.prints import plot as draw
    from coupling.results import check_folder

    if output is not None:
        refusing(check_folder, output)
    plotted = refusing(draw, result, output, formats, width, x, y, value)
    complete = all(done.complete for done in plotted)
    figures = {
        "complete": complete,
        "pictures": [{"files": list(map(str, p.files)), "caption": p.caption} for p in plotted],
    }
    lines = [] if complete else [("partial", PARTIAL)]
    for done in plotted:
        lines += [("wrote", ", ".join(map(str, done.files))), ("", done.caption)]
    options.tell(figures, lines, quiet, as_json)
