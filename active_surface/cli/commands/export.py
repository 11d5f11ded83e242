"""The command `export`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing

OUTPUT = Path("export")


@main.command()
@click.argument("result", type=click.Path(path_type=Path))
@click.option(
    "--format",
    "form",
    type=click.Choice(["pvd", "xdmf", "vtkhdf", "csv"]),
    required=True,
    help="pvd: with a VTU file a step; xdmf: with one HDF5 file; vtkhdf: anew, under their final names; csv: the path.",
)
@options.output_folder("export", "files", OUTPUT)
@options.quiet
@options.as_json
def export(result: Path, form: str, output: Path, quiet: bool, as_json: bool) -> None:
    """Write RESULT in another format, for other programs.

    RESULT is either file of a run, or FOLDER/NAME.
    """
    from coupling import StageBar, silent
    from coupling.results import check_folder, export_run, read_run

    saved = refusing(read_run, result)
    refusing(check_folder, output)
    with nullcontext(silent) if quiet else StageBar(1) as bar, bar("Writing the files") as tell:
        files = refusing(export_run, saved, output, form, tell)
    whole = saved.complete or form == "csv"
    has = "the path is whole" if whole else f"these are its first {len(saved.time)} steps"
    figures = {"complete": whole, "steps": len(saved.time), "files": [str(file) for file in files]}
    lines = [] if saved.complete else [("partial", f"The run stopped while it was written: {has}.")]
    options.tell(figures, lines, quiet, as_json, files=files)
