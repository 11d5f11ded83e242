"""The command `reproduce`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, refusing


@main.command()
@click.argument("figures", nargs=-1, metavar="[FIGURE]...")
@click.option("--full", is_flag=True, help="Many more starts, and finer steps: takes long.")
@options.folder
@options.quiet
@options.as_json
def reproduce(figures: tuple[str, ...], full: bool, output: Path | None, quiet: bool, as_json: bool) -> None:
    """Reproduce figures of the paper, such as fig17, or all.

    Each in three models: the paper's scheme on its closed-form surface, our equations on that surface, and our
    equations on a plate of finite elements. Writes a picture and the data of each; of all a page as well.
    """
    from active_surface.paper import FULL, QUICK, figures_of, rounded
    from active_surface.paper import reproduce as run
    from coupling import StageBar, silent
    from coupling.results import check_folder

    groups = refusing(figures_of, figures)
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with nullcontext(silent) if quiet else StageBar(len(groups)) as bar:
        done = refusing(lambda: run(figures, folder, FULL if full else QUICK, progress=bar))
    verdicts = [verdict.as_dict() for verdict in done.verdicts]
    summary = {"verdicts": verdicts, "seconds": done.seconds, "files": list(map(str, done.files))}
    lines: list[tuple[str, str]] = []
    for verdict in done.verdicts:
        lines += [(f"figure {verdict.figure}: {verdict.verdict}", ""), ("  the paper", f"  {verdict.statement}")]
        lines += [(f"  {model}", f"  {answer.text}") for model, answer in verdict.answers.items()]
        lines.append(("", ""))
    lines.append(("time", f"{done.seconds:.0f} s"))
    options.tell(rounded(summary), lines, quiet, as_json, files=done.files)
