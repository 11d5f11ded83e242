"""The command `verify`."""

from __future__ import annotations

import json
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from active_surface.cli import options
from active_surface.cli.group import main, refusing

if TYPE_CHECKING:
    from fem_plate import Check


@main.command()
@options.quiet
@click.option(
    "--json", "file", type=click.Path(path_type=Path, dir_okay=False), help="Also write every figure to FILE."
)
def verify(quiet: bool, file: Path | None) -> None:
    """Check the plate against theory.

    Solves equation (2) and an off-centre layout on three meshes; exits with 1 when an error on the finest mesh or an
    observed order misses its bound.
    """
    from coupling import StageBar, silent, whole_file
    from coupling.results import check_folder
    from fem_plate import verification

    if file is not None:
        refusing(check_folder, file.parent)
    with nullcontext(silent) if quiet else StageBar(1) as bar, bar("Checking the plate"):
        checks = verification.verify()
    if not quiet:
        for done in checks:
            _tell(done)
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(file) as partial:
            partial.write_text(json.dumps([done.as_dict() for done in checks], indent=2) + "\n")
    sys.exit(0 if all(done.passed for done in checks) else 1)


def _tell(done: Check) -> None:
    from fem_plate import verification

    click.echo(f"{done.name}: {'passed' if done.passed else 'FAILED'}")
    click.echo(f"  {'unknowns':<10}" + "".join(f"{n:>11}" for n in done.unknowns) + f"{'order':>9}{'bound, order':>16}")
    for k, name in enumerate(verification.QUANTITIES):
        order = done.orders[name]
        said = "rounding" if order is None else f"{order:.2f}"
        bounds = f"{verification.ERROR_BOUNDS[k]:.0e}, {verification.ORDER_BOUNDS[k]:g}"
        click.echo(f"  {name:<10}" + "".join(f"{e:>11.2e}" for e in done.errors[name]) + f"{said:>9}{bounds:>16}")
    for failure in done.failures:
        click.secho(f"  {failure}", fg="red")
