"""The command `feasibility`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing
from active_surface.cli.values import frequency_of

STAGES = 3  # of a plate that only bends


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option("--lowest", metavar="F", help='Lowest frequency of the fastest drive, such as "100 Hz".')
@click.option("--highest", metavar="F", help="Highest frequency of the fastest drive.")
@click.option("--across", default=120, show_default=True, help="Places along the plate's longer side.")
@options.folder
@options.quiet
@options.as_json
def feasibility(
    case: Path,
    lowest: str | None,
    highest: str | None,
    across: int,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Show where the array of CASE moves its part without losing it.

    Writes a map of the plate, and the area where slip starts while the part stays attached over the drives' frequency:
    its largest value and its time integral. All drives keep their ratios.
    """
    parsed = read(case)
    from active_surface.studies.feasibility import feasibility as find
    from active_surface.studies.feasibility import lines, warnings
    from coupling import StageBar, answers_drives, silent
    from coupling.results import check_folder

    ends = [refusing(frequency_of, text, name) for text, name in ((lowest, "--lowest"), (highest, "--highest"))]
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(silent) if quiet else StageBar(STAGES + answers_drives(parsed)) as bar:
        result = refusing(find, parsed, *ends, across, bar)
        files = refusing(result.write, folder)
    figures = result.figures()
    warned = warnings(figures)
    summary = figures | {"warnings": warned, "files": list(map(str, files))}
    options.tell(summary, lines(figures), quiet, as_json, warned, files)
