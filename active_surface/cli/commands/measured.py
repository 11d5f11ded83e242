"""The commands `influence`, `fit` and `identify`, which compare with measurements or prepare to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast

import click

from active_surface.cli.command import Answer, argument, command, option
from active_surface.cli.options import NOT_NEGATIVE, RESULTS, Output, Overwrite, Threads, amount_of, numbers_of, stages
from active_surface.cli.refusal import read

if TYPE_CHECKING:
    from coupling.case import Case, PlateCase
    from fem_plate import InfluenceFit, MeasuredInfluence

ARRAYS = "npz"
MAX_RESIDUAL = 0.1  # of the largest value: more is left by what is no influence function of the plate
SAME_PITCH = 0.01  # by how much pitches may differ
IDENTIFYING = 3  # stages


@command
def influence(
    case: Path,
    layout: Annotated[
        Literal["proper", "compass", "specula", "npz"],
        option("FITS for PROPER, FALCO and HCIPy; for COMPASS; for SPECULA; or numpy's arrays.", "-l"),
    ],
    pixels: Annotated[int, option("Along the longer side.", type=click.IntRange(min=2), show_default=True)] = 101,
    dead: Annotated[str | None, option("Actuators that stand still: their functions are 0.", "N,N...")] = None,
    passive: Annotated[str | None, option("Dead actuators that follow the plate and hold nothing.", "N,N...")] = None,
    actuator: Annotated[int | None, option("Whose function, for proper [the middle].", "N", type=NOT_NEGATIVE)] = None,
    output: Output = RESULTS,
) -> Answer:
    """Write the influence functions of the plate of CASE, for programs of adaptive optics.

    Writes NAME.LAYOUT.fits, or NAME.influence.npz. Stiffness and tension are those of CASE.
    """
    parsed = read(case)
    still, following = numbers_of(dead, "--dead"), numbers_of(passive, "--passive")
    _check(parsed, layout, {"--dead": still, "--passive": following}, actuator)
    from common import count
    from coupling.scene import actuator_stiffness, build_plate
    from fem_plate import save_influence

    with stages(1) as bar, bar("Solving the plate"):
        stiffness = actuator_stiffness(parsed)
        stiffness[following] = 0.0
        plate = build_plate(cast("PlateCase", parsed.plate))
        shapes = plate.influence([one.position for one in parsed.actuators], stiffness)
        output.mkdir(parents=True, exist_ok=True)
        file = output / f"{parsed.name}.{'influence.npz' if layout == ARRAYS else f'{layout}.fits'}"
        fits: Any = {} if layout == ARRAYS else {"layout": layout, "dead": still + following, "actuator": actuator}
        save_influence(file, shapes, pixels, **fits)
    figures = {"layout": layout, "actuators": len(parsed.actuators), "dead": still, "passive": following}
    of = count(1 if layout == "proper" else len(parsed.actuators), "actuator")
    lines = [("functions", f"of {of}, layout {layout}")]
    if still or following:
        lines.append(("dead", f"standing still {still or 'none'}; following passively {following or 'none'}"))
    return Answer(figures, lines, files=[file])


def _check(case: Case, layout: str, dead: dict[str, list[int]], actuator: int | None) -> None:
    """Raise ValueError with all that the options of `influence` have wrong."""
    count = len(case.actuators)
    mistakes = []
    if not count:
        mistakes.append("Input case of influence must have a plate on actuators; got a platform")
    for name, rows in dead.items():
        if wrong := [row for row in rows if row >= count > 0]:
            mistakes.append(f"{name} must be actuators from 0 to {count - 1}; got {', '.join(map(str, wrong))}")
        if rows and layout == ARRAYS:
            mistakes.append(f"{name} must not be given with --layout {ARRAYS}")
    if both := set.intersection(*map(set, dead.values())):
        mistakes.append(f"--passive must not be given for actuators that stand still; got {min(both)} in both")
    if actuator is not None and layout != "proper":
        mistakes.append(f"--actuator must not be given with --layout {layout}, which has all")
    elif actuator is not None and (actuator >= count > 0 or any(actuator in rows for rows in dead.values())):
        mistakes.append(f"--actuator must be one from 0 to {count - 1} that is not dead; got {actuator}")
    if layout == "proper" and count == 1:
        mistakes.append("--layout must not be proper with one actuator, as its pixels are counted in pitches")
    if mistakes:
        raise ValueError("\n".join(mistakes))


@command
def fit(
    measured: Annotated[Path, argument(metavar="INFLUENCE")],
    case: Path,
    pixel: Annotated[str | None, option('Distance of pixels, such as "2 um" [that in the file].', "D")] = None,
    actuator: Annotated[int | None, option("Whose function an image is [the middle].", "N", type=NOT_NEGATIVE)] = None,
    stiffness: Annotated[
        str | None, option('Keep this stiffness, such as "250 N/m", and fit only the tension.', "K")
    ] = None,
    tension: Annotated[
        str | None, option('Keep this tension, such as "40 N/m", and fit only the stiffness.', "T")
    ] = None,
) -> Answer:
    """Fit the actuators' stiffness and the plate's tension to measured influence functions.

    INFLUENCE is a FITS file in the layout of PROPER, COMPASS or SPECULA, or an image of one function with its actuator
    in the middle pixel. CASE has the plate and the places of its actuators.
    """
    parsed = read(case)
    step = amount_of(pixel, "m", "--pixel", "2 um")
    kept = {
        "stiffness": amount_of(stiffness, "N/m", "--stiffness", "250 N/m"),
        "tension": amount_of(tension, "N/m", "--tension", "40 N/m"),
    }
    if not parsed.actuators:
        raise ValueError("Input case of fit must have a plate on actuators; got a platform")
    if kept["stiffness"] is not None and kept["stiffness"] <= 0:
        raise ValueError(f"--stiffness must be greater than 0; got {kept['stiffness']:g} N/m")
    if None not in kept.values():
        raise ValueError("--tension must not be given with --stiffness; nothing is left to fit")
    from coupling.scene import build_plate
    from fem_plate import fit_influence, read_influence

    functions = read_influence(measured, step)
    with stages(1) as bar, bar("Fitting the plate"):
        plate = build_plate(cast("PlateCase", parsed.plate)).as_meshed(kept["tension"])
        stated = [one.stiffness for one in parsed.actuators if one.stiffness]
        begin = kept["stiffness"] or (sum(stated) / len(stated) if stated else None)
        points = [one.position for one in parsed.actuators]
        fitted = [name for name, value in kept.items() if value is None]
        found = fit_influence(functions, plate, points, begin, fitted, actuator)
    figures = vars(found) | {"layout": functions.layout}
    return Answer(figures, _fit_lines(found, functions), _fit_warnings(found, functions, parsed))


def _fit_lines(found: InfluenceFit, measured: MeasuredInfluence) -> list[tuple[str, str]]:
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


def _fit_warnings(found: InfluenceFit, measured: MeasuredInfluence, case: Case) -> list[str]:
    from scipy.spatial.distance import pdist

    from common import quantity_text

    warnings = []
    if found.residual > MAX_RESIDUAL:
        warnings.append(
            f"the functions are not those of this plate: the best fit leaves {found.residual:.0%} of the largest value"
        )
    pitch = float(pdist([actuator.position for actuator in case.actuators]).min(initial=math.inf))
    if measured.pitch is not None and math.isfinite(pitch) and abs(measured.pitch / pitch - 1) > SAME_PITCH:
        own, other = quantity_text(measured.pitch, "m"), quantity_text(pitch, "m")
        warnings.append(f"the file is of actuators {own} apart (C2CDX_M), the nearest of the case are {other} apart")
    if found.rigid:
        warnings.append("the actuators cannot be distinguished from rigid ones: the stiffness is a lower bound")
    for name in ("stiffness", "tension"):
        error = getattr(found, f"{name}_error")
        if error is not None and not error < abs(getattr(found, name)):
            warnings.append(f"the {name} is not determined: its uncertainty is as large as itself")
    return warnings


@command
def identify(
    case: tuple[Path, ...],
    track: Annotated[
        tuple[Path, ...],
        option("CSV file of time, x, y and heading, with units: one for each CASE, or several of one.", "FILE ..."),
    ],
    free: Annotated[tuple[str, ...], option("Fields to find: part.squeeze ...", "FIELD ...")] = (),
    own: Annotated[tuple[str, ...], option("Fields that each track has for itself.", "FIELD ...")] = (),
    bounds: Annotated[tuple[str, ...], option("Of a field [a tenth and ten times the case's].", "FIELD=LOW,HIGH")] = (),
    noise: Annotated[
        str | None, option("Deviations of place and heading [by the radius of gyration].", "LENGTH,ANGLE")
    ] = None,
    absolute: Annotated[bool, option("Make distances small, not their squares: for tracks with outliers.")] = False,
    seed: Annotated[int, option("Of the search's starts.", type=NOT_NEGATIVE, show_default=True)] = 0,
    overwrite: Overwrite = False,
    threads: Threads = None,
    output: Output = RESULTS,
) -> Answer:
    """Find the fields of each CASE with which paths are closest to measured tracks.

    Fields are those of [part] and [friction]. Each gets a 95 % interval, and a warning where tracks do not determine
    it. Writes NAME_identified.toml with the fields for each case, and NAME_identified.png.
    """
    cases = [read(file) for file in case]
    from active_surface.identification import case_names, free_files, parameters_of, read_track
    from active_surface.identification import identify as find

    deviations = None if noise is None else _noise(noise)
    tracks, ends = [read_track(file, deviations) for file in track], _bounds(bounds)
    parameters_of(cases, tracks, free, own, ends)  # mistakes come before results that are in the way
    free_files(output, case_names(cases, len(track), bool(own)), overwrite)
    with stages(IDENTIFYING) as bar:
        found = find(cases, tracks, free, ends, own, "absolute" if absolute else "squares", seed, threads, bar)
    found = found.written(output, True)
    return Answer(found.figures(), found.lines(), found.warnings(), found.files)


def _noise(text: str) -> tuple[float, float]:
    """The deviations [m, rad] in a text such as 0.5 um,0.2 deg."""
    length, _, angle = text.partition(",")
    return amount_of(length, "m", "--noise", "0.5 um") or 0.0, amount_of(angle, "rad", "--noise", "0.2 deg") or 0.0


def _bounds(texts: Sequence[str]) -> dict[str, list[str]]:
    """The bounds in texts such as part.squeeze=1 nN,10 nN."""
    bounds = {}
    for text in texts:
        field, _, ends = text.partition("=")
        bounds[field.strip()] = values = [end.strip() for end in ends.split(",")]
        if len(values) != 2:
            raise ValueError(f'--bounds must be like "part.squeeze=1 nN,10 nN"; got "{text}"')
    return bounds
