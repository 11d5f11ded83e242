"""The command `response`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing
from active_surface.cli.values import frequency_of, place_of

STAGES = 2


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option(
    "--point",
    "points",
    multiple=True,
    metavar="X,Y",
    help='Point of the plate, such as "100 um, 50 um"; again for more [the part\'s start].',
)
@click.option("--lowest", metavar="F", help='Lowest frequency, such as "1 kHz" [1/20 of the first resonance].')
@click.option("--highest", metavar="F", help="Highest frequency [five times the first resonance].")
@options.folder
@options.quiet
@options.as_json
def response(
    case: Path,
    points: tuple[str, ...],
    lowest: str | None,
    highest: str | None,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Show how far points of the plate of CASE follow its actuators, over frequency.

    Writes amplitude and phase of each point for each actuator, with resonances marked, as NAME.response.nc and
    NAME.response.png.
    """
    parsed = read(case, True)
    from active_surface.studies.response import response as find
    from coupling import StageBar, silent
    from coupling.results import check_folder

    ends = [refusing(frequency_of, text, name) for text, name in ((lowest, "--lowest"), (highest, "--highest"))]
    places = [refusing(place_of, text, "--point") for text in points] or None
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(silent) if quiet else StageBar(STAGES) as bar:
        found = refusing(find, parsed, places, None, *ends, bar)
        files = refusing(found.write, folder)
    figures = found.figures() | {"files": list(map(str, files))}
    options.tell(figures, found.lines(), quiet, as_json, (), files)
