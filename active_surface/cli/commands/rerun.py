"""The command `rerun`."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing

if TYPE_CHECKING:
    from coupling import Rerun

OUTPUT = Path("rerun")


@main.command()
@click.argument("result", type=click.Path(path_type=Path))
@options.output_folder("rerun", "new results", OUTPUT)
@options.quiet
@options.as_json
def rerun(result: Path, output: Path, quiet: bool, as_json: bool) -> None:
    """Run the case that RESULT keeps again, and compare.

    RESULT is either file of a run, or FOLDER/NAME. Exits with 1 when the part ends elsewhere.
    """
    from coupling import StageBar, rerun, silent, stage_count
    from coupling.results import check_folder, read_run

    saved = refusing(read_run, result)
    refusing(check_folder, output)
    case = refusing(lambda: saved.case)
    with nullcontext(silent) if quiet else StageBar(stage_count(case)) as bar:
        done = refusing(rerun, saved, output, bar)
    figures = {"same_end": done.same_end, "moved": done.moved, "versions": done.changed, "complete": saved.complete}
    files = [str(file) for file in done.result.files]
    options.tell(figures | {"files": files}, _lines(done), quiet, as_json, files=done.result.files)
    sys.exit(0 if done.same_end else 1)


def _lines(done: Rerun) -> list[tuple[str, str]]:
    x, y = (1e6 * place for place in done.result.summary.end_position)
    same = "the same, bit for bit" if done.same_end else f"{done.moved * 1e6:.3g} um from that of the result"
    changed = [f"{name} {now} in place of {then}" for name, (then, now) in done.changed.items()]
    partial = [("partial", "The files lack the last steps; the case and the end point are complete.")]
    return [
        *([] if done.saved.complete else partial),
        ("end", f"({x:.4f}, {y:.4f}) um at {done.result.summary.end_time * 1e3:.4f} ms: {same}"),
        ("versions", "; ".join(changed) or "the same"),
    ]
