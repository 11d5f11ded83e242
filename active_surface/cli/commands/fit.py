"""The command `fit`."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import click

from active_surface.cli import options
from active_surface.cli.group import main, read, refusing
from active_surface.cli.values import amount_of

if TYPE_CHECKING:
    from coupling.case import Case
    from fem_plate import InfluenceFit, MeasuredInfluence

Answer = TypeVar("Answer")
MAX_RESIDUAL = 0.1  # of the largest value: more is left by what is no influence function of the plate
SAME_PITCH = 0.01  # by how much pitches may differ


@main.command()
@click.argument("influence", type=click.Path(path_type=Path))
@click.argument("case", type=click.Path(path_type=Path))
@click.option("--pixel", metavar="D", help='Distance of pixels, such as "2 um" [that in the file].')
@click.option("--actuator", type=click.IntRange(min=0), metavar="N", help="Whose function an image is [the middle].")
@click.option("--stiffness", metavar="K", help='Keep this stiffness, such as "250 N/m", and fit only the tension.')
@click.option("--tension", metavar="T", help='Keep this tension, such as "40 N/m", and fit only the stiffness.')
@options.quiet
@options.as_json
def fit(
    influence: Path,
    case: Path,
    pixel: str | None,
    actuator: int | None,
    stiffness: str | None,
    tension: str | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Fit the actuators' stiffness and the plate's tension to measured influence functions.

    INFLUENCE is a FITS file in the layout of PROPER, COMPASS or SPECULA, or an image of one function with its actuator
    in the middle pixel. CASE has the plate and the places of its actuators.
    """
    parsed = read(case)
    from coupling import StageBar, silent

    step = refusing(amount_of, pixel, "m", "2 um", "--pixel")
    kept = refusing(amount_of, stiffness, "N/m", "250 N/m", "--stiffness")
    pull = refusing(amount_of, tension, "N/m", "40 N/m", "--tension")
    refusing(_check, parsed, kept, pull)
    from fem_plate import read_influence

    measured = refusing(_in_words, read_influence, influence, step)
    with nullcontext(silent) if quiet else StageBar(1) as bar, bar("Fitting the plate"):
        found = refusing(_in_words, _fitted, measured, parsed, actuator, kept, pull)
    figures = vars(found) | {"layout": measured.layout}
    options.tell(figures, _lines(found, measured), quiet, as_json, _warnings(found, measured, parsed))


def _in_words(work: Callable[..., Answer], *arguments: object) -> Answer:
    """work(*arguments), whose ValueError names inputs of this command in place of those of functions."""
    try:
        return work(*arguments)
    except ValueError as error:
        text = re.sub(r"(?<=of )(read|fit)_influence", "fit", str(error))
        raise ValueError(re.sub(r"Input (path|measured) of fit", "Input influence of fit", text)) from None


def _check(case: Case, stiffness: float | None, tension: float | None) -> None:
    if not case.actuators:
        raise ValueError("Input case of fit must have a plate on actuators; got a platform")
    if stiffness is not None and stiffness <= 0:
        raise ValueError(f"Input stiffness of fit must be greater than 0; got {stiffness:g} N/m")
    if stiffness is not None and tension is not None:
        raise ValueError("Input tension of fit must not be given with --stiffness; nothing is left to fit")


def _fitted(
    measured: MeasuredInfluence, case: Case, actuator: int | None, stiffness: float | None, tension: float | None
) -> InfluenceFit:
    from typing import cast

    from coupling.case import PlateCase
    from coupling.scene import build_plate
    from fem_plate import fit_influence

    of = cast(PlateCase, case.plate)
    plate = build_plate(of).as_meshed(tension)
    fitted = [name for name, kept in (("stiffness", stiffness), ("tension", tension)) if kept is None]
    stated = [actuator.stiffness for actuator in case.actuators if actuator.stiffness]
    begin = stiffness or (sum(stated) / len(stated) if stated else None)
    points = [actuator.position for actuator in case.actuators]
    return fit_influence(measured, plate, points, begin, fitted, actuator)


def _lines(found: InfluenceFit, measured: MeasuredInfluence) -> list[tuple[str, str]]:
    rows = [("functions", f"{found.functions} of layout {measured.layout}, {found.pixels} values on the plate")]
    for name in ("stiffness", "tension"):
        value, error = getattr(found, name), getattr(found, f"{name}_error")
        rows.append((name, f"{value:.6g} N/m" + (", kept" if error is None else f" +- {error:.2g} N/m")))
    if found.correlation is not None:
        rows.append(("correlation", f"{found.correlation:.2f} of both errors"))
    if not measured.scaled:
        rows.append(("gain", f"{found.gain:.6g}, as the functions have a unit of their own"))
    rows.append(("residual", f"{found.residual:.2e} of the largest value, root mean square"))
    return rows


def _warnings(found: InfluenceFit, measured: MeasuredInfluence, case: Case) -> list[str]:
    from scipy.spatial.distance import pdist

    from common import quantity_text

    warned = []
    if found.residual > MAX_RESIDUAL:
        warned.append(
            f"the functions are not those of this plate: the best fit leaves {found.residual:.0%} of the largest value"
        )
    pitch = float(pdist([actuator.position for actuator in case.actuators]).min(initial=math.inf))
    if measured.pitch is not None and math.isfinite(pitch) and abs(measured.pitch / pitch - 1) > SAME_PITCH:
        own, other = quantity_text(measured.pitch, "m"), quantity_text(pitch, "m")
        warned.append(f"the file is of actuators {own} apart (C2CDX_M), the nearest of the case are {other} apart")
    if found.rigid:
        warned.append("the actuators cannot be told from rigid ones: the stiffness is a lower bound")
    for name in ("stiffness", "tension"):
        error = getattr(found, f"{name}_error")
        if error is not None and not error < abs(getattr(found, name)):
            warned.append(f"the {name} is not determined: its uncertainty is as large as itself")
    return warned
