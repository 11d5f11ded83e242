"""The commands `run` and `check`."""

from __future__ import annotations

import json
from pathlib import Path

import click

from command_line.group import DEFAULT_OUTPUT, main, read, refusing

STAGES = 5


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option(
    "--output", "-o", type=click.Path(path_type=Path, file_okay=False), help="Folder for the results [results]."
)
@click.option("--quiet", "-q", is_flag=True, help="Print no summary.")
@click.option("--json", "as_json", is_flag=True, help="Print the summary as JSON.")
@click.option("--csv", is_flag=True, help="Also write the trajectory to NAME.csv.")
@click.option("--save-surface", is_flag=True, help="Also write the moving surface to NAME.surface.h5.")
def run(case: Path, output: Path | None, quiet: bool, as_json: bool, csv: bool, save_surface: bool) -> None:
    """Run CASE and write its results."""
    wanted = read(case)
    from coupling import report
    from coupling.progress import StageBar
    from coupling.results import check_folder
    from coupling.run import run_case

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with StageBar(STAGES) as bar:
        result = refusing(run_case, wanted, folder, bar, csv, save_surface)
    if as_json:
        said = {"warnings": report.warnings(result.summary), "files": [str(file) for file in result.files]}
        click.echo(json.dumps(result.summary.as_dict() | said, indent=2))
    elif not quiet:
        for label, text in report.lines(result.summary):
            click.echo(f"{label:<12}{text}")
        for warning in report.warnings(result.summary):
            click.secho(f"{'warning':<12}{warning}", fg="yellow")
        for file in result.files:
            click.echo(f"{'wrote':<12}{file}")


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
def check(case: Path) -> None:
    """Report every mistake in CASE."""
    wanted = read(case)
    from coupling.run import build_friction

    refusing(lambda: build_friction(wanted).law)
    count = len(wanted.actuators)
    what = f"{count} actuator{'s' * (count != 1)}" if count else "a platform"
    click.echo(f"{case}: fine; {what}, {wanted.run.duration * 1e3:g} ms")
