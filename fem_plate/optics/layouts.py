"""Influence functions as FITS files that PROPER, FALCO, HCIPy, COMPASS and SPECULA read."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Literal, get_args

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.arrays import PatchedShapes
from fem_plate.influence import InfluenceShapes
from fem_plate.optics.measured import fits_package
from fem_plate.sections import PlateSection, VaryingSection
from fem_plate.types import BoolArray, FloatArray, IntArray

PlateShapes = InfluenceShapes | PatchedShapes

Layout = Literal["proper", "compass", "specula"]
LAYOUTS: Final[tuple[str, ...]] = get_args(Layout)
PER_PITCH = 10  # pixels, of the layout of PROPER, which takes a whole number of them
CHUNK = 64  # shapes evaluated at a time, to bound memory
SMALL = 1e-7  # of the largest value: a stamp of COMPASS leaves out no larger ones


def save_fits(
    path: str | os.PathLike[str],
    shapes: PlateShapes,
    layout: Layout,
    across: int,
    dead: Sequence[int] = (),
    actuator: int | None = None,
) -> None:
    """Write influence functions as a FITS file; `save_influence` says what it holds, and checks its input."""
    fits = fits_package()

    rows = np.arange(len(shapes.points))
    alive = ~np.isin(rows, dead)
    header = _header(shapes, layout)
    if layout == "proper":
        middle = shapes.outline.box.mean(axis=0)
        distance = np.where(alive, np.linalg.norm(shapes.points - middle, axis=1), np.inf)
        hdus = _proper(shapes, int(np.argmin(distance)) if actuator is None else actuator, header)
    else:
        hdus = (_compass if layout == "compass" else _specula)(shapes, across, alive, header)
    table = fits.BinTableHDU.from_columns(
        [
            fits.Column("X", "D", unit="m", array=shapes.points[:, 0]),
            fits.Column("Y", "D", unit="m", array=shapes.points[:, 1]),
            fits.Column("STIFFNESS", "D", unit="N/m", array=shapes.springs),
            fits.Column("PEAK", "D", unit=header["BUNIT"], array=shapes.own_heights()),
            fits.Column("DEAD", "L", array=~alive),
        ],
        name="ACTUATORS",
    )
    path = Path(path)
    partial = path.with_name(f"{path.name}.part")
    try:
        fits.HDUList([*hdus, table]).writeto(partial, overwrite=True)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def pitch_of(points: FloatArray) -> float:
    """The median distance [m] of nearest neighbours among two or more points (N, 2) [m]."""
    return float(np.median(cKDTree(points).query(points, k=2)[0][:, 1]))


def pixels(shapes: PlateShapes, across: int) -> tuple[FloatArray, float]:
    """Centres of pixels (across, across, 2) [m], y before x, over the square around the plate; and their pitch [m]."""
    low, high = shapes.outline.box
    step = float(np.max(high - low)) / across
    x, y = (middle + step * (np.arange(across) - (across - 1) / 2) for middle in (low + high) / 2)
    return np.stack(np.meshgrid(x, y), axis=-1), step


def sampled(shapes: PlateShapes, xy: FloatArray, rows: IntArray) -> tuple[FloatArray, BoolArray]:
    """Some shapes at points (..., 2) [m], (rows, ...), 0 off the plate; and which points are on it."""
    on = shapes.outline.gap(xy.reshape(-1, 2)).reshape(xy.shape[:-1]) >= 0
    values = np.zeros((len(rows), *on.shape))
    for start in range(0, len(rows), CHUNK):
        part = rows[start : start + CHUNK]
        weights = np.zeros((len(shapes.points), len(part)))
        weights[part, np.arange(len(part))] = 1.0
        values[start : start + CHUNK, on] = shapes.values(xy[on], weights).T
    return values, on


def _header(shapes: PlateShapes, layout: str) -> Any:
    """What all layouts state in the primary header."""
    fits = fits_package()

    held = shapes.springs > 0
    header = fits.Header()
    header["CREATOR"] = "active-surface"
    header["LAYOUT"] = (layout, "whose reader this file is for")
    header["BUNIT"] = ("m/m" if held.all() else "m/N" if not held.any() else "m/m, m/N", "surface; m/N: floating")
    section = shapes.plate.section
    header["TENSION"] = (shapes.plate.tension, "[N/m] residual, in the plate's plane")
    if isinstance(section, PlateSection):
        header["YOUNGS"] = (section.youngs_modulus, "[Pa] Young's modulus")
        header["POISSON"] = (section.poisson_ratio, "Poisson's ratio")
    varies = isinstance(section, VaryingSection)
    header["RIGIDITY"] = (
        section.rigidity,
        "[N m] reference, it varies" if varies else "[N m] flexural, mean of directions",
    )
    header["THICKNES"] = (section.thickness, "[m] reference, it varies" if varies else "[m] of the plate")
    foundation = shapes.plate.foundation
    if foundation:
        header["FOUNDATN"] = ("varies" if callable(foundation) else foundation, "[N/m^3] modulus under the plate")
    if shapes.plate.forms:
        header["FORMS"] = (len(shapes.plate.forms), "further terms of the plate's energy")
    return header


def _mask(on: BoolArray) -> Any:
    fits = fits_package()

    return fits.ImageHDU(on.astype(np.uint8), name="MASK")


def _proper(shapes: PlateShapes, actuator: int, header: Any) -> list[Any]:
    """One function around its actuator, in the middle pixel, over its height there; (1, n, n), y before x, n odd."""
    fits = fits_package()

    at, pitch = shapes.points[actuator], pitch_of(shapes.points)
    step = pitch / PER_PITCH
    half = int(np.ceil(np.abs(shapes.outline.box - at).max() / step - 1e-9))
    offset = step * np.arange(-half, half + 1)
    xy = np.stack(np.meshgrid(at[0] + offset, at[1] + offset), axis=-1)
    values, on = sampled(shapes, xy, np.array([actuator]))
    peak = float(shapes.own_heights()[actuator])
    header["BUNIT"] = ("", "surface over its value at the actuator")
    for key in ("P2PDX_M", "P2PDY_M", "P2PD_M"):
        header[key] = (step, "[m] distance of pixels")
    for key in ("C2CDX_M", "C2CDY_M", "C2CD_M"):
        header[key] = (pitch, "[m] distance of actuators")
    for key in ("CX_PIX", "CY_PIX", "CENTERX", "CENTERY"):
        header[key] = (float(half), "pixel of the actuator, the first is 0")
    header["ACTUATOR"] = (actuator, "whose function this is, the first is 0")
    header["PEAK"] = (peak, "m/m, or m/N: surface at the actuator")
    return [fits.PrimaryHDU(values / peak, header), _mask(on)]


def _compass(shapes: PlateShapes, across: int, alive: BoolArray, header: Any) -> list[Any]:
    """Version 1.2: a cube of square stamps [x, y, actuator], the pixels where they begin, and the actuators' places."""
    fits = fits_package()

    xy, step = pixels(shapes, across)
    count = len(shapes.points)
    values, on = sampled(shapes, xy, np.arange(count))
    values[~alive] = 0.0
    places = (shapes.points - xy[0, 0]) / step  # pixels, the first is 0
    middle = np.rint(places).astype(int)
    large = np.abs(values) > SMALL * np.abs(values).max(axis=(1, 2), keepdims=True, initial=np.finfo(float).tiny)
    reach = 1
    for number in np.flatnonzero(alive).tolist():
        y, x = np.nonzero(large[number])
        reach = max(reach, int(np.abs(np.stack([x, y], axis=1) - middle[number]).max()))
    size = min(2 * reach + 1, across)
    first = np.clip(middle - size // 2, 0, across - size)
    stamps = np.zeros((size, size, count))
    for number, (i, j) in enumerate(first.tolist()):
        stamps[:, :, number] = values[number, j : j + size, i : i + size].T
    header["VERSION"] = 1.2
    for axis in "XY":
        header[f"{axis}CENTER"] = ((across - 1) / 2, "[pixel] of the plate's middle, the first is 0")
    header["PIXSIZE"] = (step, "[m] distance of pixels")
    header["PUPM"] = (across * step, "[m] the plate's longer side")
    if count > 1:
        header["PITCHM"] = (pitch_of(shapes.points), "[m] distance of actuators")
    return [
        fits.PrimaryHDU(header=header),
        fits.ImageHDU(first.T.astype(np.int32), name="I1_J1"),
        fits.ImageHDU(stamps, name="INFLU"),
        fits.ImageHDU(np.ascontiguousarray(places.T), name="XPOS_YPOS"),
        _mask(on.T),
    ]


def _specula(shapes: PlateShapes, across: int, alive: BoolArray, header: Any) -> list[Any]:
    """IFunc, version 1: the functions at the mask's pixels (pixels, N), row by row, and the mask, y before x."""
    fits = fits_package()

    xy, step = pixels(shapes, across)
    values, on = sampled(shapes, xy, np.arange(len(shapes.points)))
    values[~alive] = 0.0
    header["VERSION"] = 1
    header["PIXSIZE"] = (step, "[m] distance of pixels")
    return [
        fits.PrimaryHDU(header=header),
        fits.ImageHDU(np.ascontiguousarray(values[:, on].T), name="INFLUENCE_FUNCTION"),
        fits.ImageHDU(on.astype(np.float32), name="MASK_INF_FUNC"),
    ]
