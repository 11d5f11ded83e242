"""The command `active-surface`. Heavy imports wait until a command needs them."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import click

if TYPE_CHECKING:
    from coupling.case import Case

Answer = TypeVar("Answer")

DEFAULT_OUTPUT = Path("results")
STAGES = 5
INTERRUPTED = 130  # 128 and the number of the signal


class _Command(click.Group):
    """A command that ends with the exit code of an interrupted one on Ctrl-C."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            click.echo("interrupted", err=True)
            sys.exit(INTERRUPTED)


@click.group(cls=_Command, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="active-surface")
def main() -> None:
    """Simulate microparts on active surfaces: thin plates pushed from below by point actuators."""


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
    read = _read(case)
    from coupling import report
    from coupling.progress import StageBar
    from coupling.results import check_folder
    from coupling.run import run_case

    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    with StageBar(STAGES) as bar:
        result = refusing(run_case, read, folder, bar, csv, save_surface)
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
    read = _read(case)
    from coupling.run import build_friction

    refusing(lambda: build_friction(read).law)
    count = len(read.actuators)
    what = f"{count} actuator{'s' * (count != 1)}" if count else "a platform"
    click.echo(f"{case}: fine; {what}, {read.run.duration * 1e3:g} ms")


@main.command()
@click.option(
    "--json", "file", type=click.Path(path_type=Path, dir_okay=False), help="Also write every figure to FILE."
)
def verify(file: Path | None) -> None:
    """Check the plate against theory.

    Solves equation (2) and an off-centre layout on three meshes; exits with 1 when an error on the finest mesh or an
    observed order misses its bound.
    """
    from coupling import verification
    from coupling.results import check_folder

    if file is not None:
        refusing(check_folder, file.parent)
    checks = verification.verify()
    for done in checks:
        click.echo(f"{done.name}: {'passed' if done.passed else 'FAILED'}")
        click.echo(
            f"  {'unknowns':<10}" + "".join(f"{n:>11}" for n in done.unknowns) + f"{'order':>9}{'bound, order':>16}"
        )
        for k, name in enumerate(verification.QUANTITIES):
            order = done.orders[name]
            said = "rounding" if order is None else f"{order:.2f}"
            bounds = f"{verification.ERROR_BOUNDS[k]:.0e}, {verification.ORDER_BOUNDS[k]:g}"
            click.echo(f"  {name:<10}" + "".join(f"{e:>11.2e}" for e in done.errors[name]) + f"{said:>9}{bounds:>16}")
        for failure in done.failures:
            click.secho(f"  {failure}", fg="red")
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        partial = file.with_name(file.name + ".partial")
        partial.write_text(json.dumps([done.as_dict() for done in checks], indent=2) + "\n")
        partial.replace(file)
    sys.exit(0 if all(done.passed for done in checks) else 1)


def _read(path: Path) -> Case:
    from coupling.case import read_case

    return refusing(read_case, path)


def refusing(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments), with a refused input said in one message and exit code 2."""
    try:
        return work(*arguments)
    except (ValueError, OSError, RuntimeError) as error:
        _refuse(str(error))


def _refuse(message: str) -> NoReturn:
    click.echo(message, err=True)
    sys.exit(2)
