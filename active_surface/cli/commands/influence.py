"""The command `influence`."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from active_surface.cli import options
from active_surface.cli.group import DEFAULT_OUTPUT, main, read, refusing
from active_surface.cli.values import numbers_of

if TYPE_CHECKING:
    from coupling.case import Case

ARRAYS = "npz"


@main.command()
@click.argument("case", type=click.Path(path_type=Path))
@click.option(
    "--layout",
    "-l",
    type=click.Choice(["proper", "compass", "specula", ARRAYS]),
    required=True,
    help="FITS for PROPER, FALCO and HCIPy; for COMPASS; for SPECULA; or numpy's arrays.",
)
@click.option("--pixels", type=click.IntRange(min=2), default=101, show_default=True, help="Along the longer side.")
@click.option("--dead", metavar="N,N...", help="Actuators that stand still: their functions are 0.")
@click.option("--passive", metavar="N,N...", help="Dead actuators that follow the plate and hold nothing.")
@click.option("--actuator", type=click.IntRange(min=0), metavar="N", help="Whose function, for proper [the middle].")
@options.folder
@options.quiet
@options.as_json
def influence(
    case: Path,
    layout: str,
    pixels: int,
    dead: str | None,
    passive: str | None,
    actuator: int | None,
    output: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Write the influence functions of the plate of CASE, for programs of adaptive optics.

    Writes NAME.LAYOUT.fits, or NAME.influence.npz. Stiffness and tension are those of CASE.
    """
    parsed = read(case)
    from coupling import StageBar, silent
    from coupling.results import check_folder

    still, following = refusing(numbers_of, dead, "--dead"), refusing(numbers_of, passive, "--passive")
    folder = output or DEFAULT_OUTPUT
    refusing(check_folder, folder)
    refusing(_check, parsed, layout, {"--dead": still, "--passive": following}, actuator)
    with nullcontext(silent) if quiet else StageBar(1) as bar, bar("Solving the plate"):
        file = refusing(_write, parsed, folder, layout, pixels, still, following, actuator)
    figures = {"layout": layout, "actuators": len(parsed.actuators), "dead": still, "passive": following}
    count = 1 if layout == "proper" else len(parsed.actuators)
    rows = [("functions", f"of {count} actuator{'s' * (count != 1)}, layout {layout}")]
    if still or following:
        rows.append(("dead", f"standing still {still or 'none'}; following passively {following or 'none'}"))
    options.tell(figures | {"files": [str(file)]}, rows, quiet, as_json, (), [file])


def _check(case: Case, layout: str, dead: dict[str, list[int]], actuator: int | None) -> None:
    count = len(case.actuators)
    mistakes = []
    if not count:
        mistakes.append("Input case of influence must have a plate on actuators; got a platform")
    for option, rows in dead.items():
        if wrong := [row for row in rows if row >= count > 0]:
            mistakes.append(f"{option} must be actuators from 0 to {count - 1}; got {', '.join(map(str, wrong))}")
        if rows and layout == ARRAYS:
            mistakes.append(f"{option} must not be given with --layout {ARRAYS}")
    if both := set.intersection(*map(set, dead.values())):
        mistakes.append(f"--passive must not be given for actuators that stand still; got {sorted(both)[0]} in both")
    if actuator is not None and layout != "proper":
        mistakes.append(f"--actuator must not be given with --layout {layout}, which has all")
    elif actuator is not None and (actuator >= count > 0 or any(actuator in rows for rows in dead.values())):
        mistakes.append(f"--actuator must be one from 0 to {count - 1} that is not dead; got {actuator}")
    if layout == "proper" and count == 1:
        mistakes.append("--layout must not be proper with one actuator, as its pixels are counted in pitches")
    if mistakes:
        raise ValueError("\n".join(mistakes))


def _write(
    case: Case, folder: Path, layout: str, pixels: int, still: list[int], passive: list[int], actuator: int | None
) -> Path:
    from typing import Any, cast

    from coupling.case import PlateCase
    from coupling.scene import actuator_stiffness, build_plate
    from fem_plate import save_influence

    stiffness = actuator_stiffness(case)
    stiffness[passive] = 0.0
    plate = build_plate(cast(PlateCase, case.plate))
    shapes = plate.influence([actuator.position for actuator in case.actuators], stiffness)
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{case.name}.{'influence.npz' if layout == ARRAYS else f'{layout}.fits'}"
    fits: Any = {} if layout == ARRAYS else {"layout": layout, "dead": still + passive, "actuator": actuator}
    save_influence(file, shapes, pixels, **fits)
    return file
