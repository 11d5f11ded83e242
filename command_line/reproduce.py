"""The command `reproduce`."""

from __future__ import annotations

import json
from pathlib import Path

import click

from command_line.group import DEFAULT_OUTPUT, main, refusing


@main.command()
@click.argument("figures", nargs=-1, metavar="[FIGURE]...")
@click.option("--full", is_flag=True, help="Many more starts, and finer steps: takes long.")
@click.option(
    "--output", "-o", type=click.Path(path_type=Path, file_okay=False), help="Folder for the results [results]."
)
@click.option("--quiet", "-q", is_flag=True, help="Print no table.")
@click.option("--json", "as_json", is_flag=True, help="Print the verdicts as JSON.")
def reproduce(figures: tuple[str, ...], full: bool, output: Path | None, quiet: bool, as_json: bool) -> None:
    """Reproduce figures of the paper, such as fig17, or all.

    Each in three models: the paper's scheme on its closed-form surface, our equations on that surface, and our
    equations on a plate of finite elements. Writes a picture and the data of each; of all a page as well.
    """
    from coupling.progress import StageBar
    from coupling.results import check_folder
    from paper.catalogue import modules_of
    from paper.parameters import FULL, QUICK
    from paper.reproduction import reproduce as run
    from paper.reproduction import rounded

    modules = refusing(modules_of, figures)
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with StageBar(len(modules)) as bar:
        done = refusing(lambda: run(figures, folder, FULL if full else QUICK, progress=bar))
    if as_json:
        said = {"verdicts": [verdict.as_dict() for verdict in done.verdicts], "seconds": done.seconds}
        click.echo(json.dumps(rounded(said | {"files": [str(file) for file in done.files]}), indent=2))
    elif not quiet:
        for verdict in done.verdicts:
            click.echo(f"figure {verdict.figure}: {verdict.verdict}")
            click.echo(f"  {'the paper':<10}{verdict.statement}")
            for model, answer in verdict.answers.items():
                click.echo(f"  {model:<10}{answer.text}")
        for file in done.files:
            click.echo(f"{'wrote':<12}{file}")
        click.echo(f"{'time':<12}{done.seconds:.0f} s")
