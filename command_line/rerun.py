"""The command `rerun`."""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from command_line import options
from command_line.group import main, refusing
from command_line.run import STAGES

if TYPE_CHECKING:
    from coupling.rerun import Rerun

OUTPUT = Path("rerun")


@main.command()
@click.argument("result", type=click.Path(path_type=Path))
@click.option(
    "--output",
    "-o",
    type=click.Path(path_type=Path, file_okay=False),
    default=OUTPUT,
    help="Folder for the new results [rerun].",
)
@options.quiet
@options.as_json
def rerun(result: Path, output: Path, quiet: bool, as_json: bool) -> None:
    """Run the case that RESULT keeps again, and compare.

    RESULT is either file of a run, or FOLDER/NAME. Exits with 1 when the part ends elsewhere.
    """
    from coupling.progress import StageBar, silent
    from coupling.rerun import rerun
    from coupling.results import check_folder
    from coupling.saved import read_run

    saved = refusing(read_run, result)
    refusing(check_folder, output)
    with nullcontext(silent) if quiet else StageBar(STAGES) as bar:
        done = refusing(rerun, saved, output, bar)
    if as_json:
        said = {"same_end": done.same_end, "moved": done.moved, "versions": done.changed, "complete": saved.complete}
        click.echo(json.dumps(said | {"files": [str(file) for file in done.result.files]}, indent=2))
    elif not quiet:
        _tell(done)
    sys.exit(0 if done.same_end else 1)


def _tell(done: Rerun) -> None:
    if not done.saved.complete:
        click.echo(f"{'partial':<12}The files were not written to the end; the case and the end point are in them.")
    x, y = (1e6 * place for place in done.result.summary.end_position)
    same = "the same, bit for bit" if done.same_end else f"{done.moved * 1e6:.3g} um from that of the result"
    click.echo(f"{'end':<12}({x:.4f}, {y:.4f}) um at {done.result.summary.end_time * 1e3:.4f} ms: {same}")
    told = [f"{name} {now} in place of {then}" for name, (then, now) in done.changed.items()]
    click.echo(f"{'versions':<12}{'; '.join(told) or 'the same'}")
    for file in done.result.files:
        click.echo(f"{'wrote':<12}{file}")
