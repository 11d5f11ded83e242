"""The command `feasibility`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing
from active_surface.cli.values import frequency_of, point_of, stroke_of

STAGES = 4  # of a plate that only bends
PICKING = 5  # more of a pick and its run


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option("--lowest", metavar="F", help='Lowest frequency of the fastest drive, such as "100 Hz".')
@click.option("--highest", metavar="F", help="Highest frequency of the fastest drive.")
@click.option("--smallest", metavar="S", help='Smallest stroke of the largest drive, such as "2 um"; of forces in N.')
@click.option("--largest", metavar="S", help="Largest stroke of the largest drive.")
@click.option("--across", default=100, show_default=True, help="Places along the plate's longer side.")
@click.option("--pick", metavar="F,S", help='Write a case that moves: at "2.4 kHz, 12 um", or at the "best" point.')
@click.option("--overwrite", is_flag=True, help="Replace a case that was picked before.")
@options.threads
@options.folder
@options.quiet
@options.as_json
def feasibility(
    case: Path,
    lowest: str | None,
    highest: str | None,
    smallest: str | None,
    largest: str | None,
    across: int,
    pick: str | None,
    overwrite: bool,
    threads: int | None,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Show at which frequencies and strokes, and where, the array of CASE moves its part without losing it.

    Writes a map over frequency and stroke of runs from the case's start, a map of the plate, and the area where slip
    starts while the part stays attached over the drives' frequency. All drives keep their ratios. --pick also writes
    NAME_picked.toml, a case whose run moves the part.
    """
    parsed = read(case)
    from active_surface.studies.feasibility import feasibility as find
    from active_surface.studies.feasibility import lines, warnings
    from active_surface.studies.feasibility import pick as pick_case
    from coupling import StageBar, answers_drives, silent
    from coupling.case import largest_stroke
    from coupling.results import check_folder

    unit = largest_stroke(parsed)[1]
    ends = [refusing(frequency_of, text, name) for text, name in ((lowest, "--lowest"), (highest, "--highest"))]
    strokes = [
        refusing(stroke_of, text, unit, name) for text, name in ((smallest, "--smallest"), (largest, "--largest"))
    ]
    point = None if pick is None else refusing(point_of, pick, unit, "--pick")
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    target = folder / f"{parsed.name}_picked.toml"
    if pick is not None:
        refusing(_check_free, target, overwrite)
    stages = STAGES + answers_drives(parsed) + (PICKING + answers_drives(parsed) if pick is not None else 0)
    with nullcontext(silent) if quiet else StageBar(stages) as bar:
        result = refusing(find, parsed, *ends, across, bar, *strokes, threads)
        files = refusing(result.write, folder, point or None)
        picked = None
        if point is not None:
            picked = refusing(pick_case, result, *(point or (None, None)), threads, bar)
            files = refusing(result.write, folder, (picked.frequency, picked.stroke))
            files = (*files, refusing(picked.write, target))
    figures = result.figures() | {"picked": None if picked is None else picked.figures()}
    warned = warnings(figures)
    rows = lines(figures) + ([] if picked is None else [("picked", picked.text)])
    summary = figures | {"warnings": warned, "files": list(map(str, files))}
    options.tell(summary, rows, quiet, as_json, warned, files)


def _check_free(file: Path, overwrite: bool) -> None:
    if file.exists() and not overwrite:
        raise ValueError(f"Input output must be free of a picked case; got {file}: --overwrite replaces it")
