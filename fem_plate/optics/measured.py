"""Influence functions read from FITS files, our own or measured ones."""

from __future__ import annotations

import io
import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fem_plate.types import FloatArray, IntArray

OURS = "active-surface"


@dataclass(frozen=True, eq=False)
class MeasuredInfluence:
    """M influence functions at P pixels; made by `read_influence`.

    Attributes
    ----------
    layout : str
        "proper", "compass", "specula", or "image": one function around the actuator in its middle pixel.
    offsets : (P, 2) array
        Pixels [m], from the middle of the plate's box, or of one function ("proper", "image") from its actuator.
    values : (M, P) array
        The functions; NaN where they are not known.
    actuators : (M,) array of int or None
        Whose functions they are; None: the file does not say.
    scaled : bool
        Whether values are metres of surface per metre of stroke, and not in a unit of their own.
    shape : tuple of int
        Pixels along y and along x.
    pitch : float or None
        Distance of actuators that the file states [m]; only "proper" does.
    """

    layout: str
    offsets: FloatArray
    values: FloatArray
    actuators: IntArray | None
    scaled: bool
    shape: tuple[int, int]
    pitch: float | None = None

    @property
    def alone(self) -> bool:
        """Whether it is one function around its actuator."""
        return self.layout in ("proper", "image")


def read_influence(path: str | os.PathLike[str], pixel: float | None = None) -> MeasuredInfluence:
    """Read influence functions from a FITS file in the layout of PROPER, COMPASS or SPECULA, or from a plain image.

    The functions of dead actuators, which are 0, are left out.

    Parameters
    ----------
    path : path-like
        The file.
    pixel : float, optional
        Distance of pixels [m], in place of the file's own; needed where it has none.

    Returns
    -------
    measured : MeasuredInfluence

    Raises
    ------
    ValueError
        The file is no FITS file of these kinds, or the distance of pixels is not known or not positive.
    OSError
        The file cannot be read.
    """
    fits = fits_package()

    if pixel is not None and not (np.isfinite(pixel) and pixel > 0):
        raise ValueError(f"Input pixel of read_influence must be greater than 0; got {pixel!r}")
    raw = Path(path).read_bytes()  # whose errors name the file
    if not raw.startswith(b"SIMPLE  ="):
        raise ValueError(f"Input path of read_influence must be a FITS file; got {path}, which is none")
    try:
        with warnings.catch_warnings(), fits.open(io.BytesIO(raw)) as hdus:
            warnings.simplefilter("ignore")  # headers that are not quite standard, as that of PROPER's own file
            warnings.filterwarnings("error", message="File may have been truncated")
            names = {hdu.name: hdu for hdu in hdus}
            header, of_array = hdus[0].header, [hdu for hdu in hdus if hdu.data is not None and hdu.is_image]
            if {"I1_J1", "INFLU"} <= names.keys():
                return _compass(names, header, pixel, path)
            if {"INFLUENCE_FUNCTION", "MASK_INF_FUNC"} <= names.keys():
                return _specula(names, header, pixel, path)
            return _image(of_array, header, pixel, path)
    except (OSError, TypeError, KeyError, IndexError, UserWarning, ValueError) as error:
        if isinstance(error, ValueError) and str(error).startswith("Input "):
            raise
        lack = f"lacks the key {error}" if isinstance(error, KeyError) else "is cut off or damaged"
        raise ValueError(f"Input path of read_influence must be a whole FITS file; {path} {lack}") from None


def _step(header: Any, key: str, pixel: float | None, path: object) -> float:
    step = header.get(key) if pixel is None else pixel
    if step is None:
        raise ValueError(f"Input pixel of read_influence must be given, as {path} has no key {key}")
    if not (isinstance(step, int | float) and step > 0):
        raise ValueError(f"Input path of read_influence must have a distance of pixels {key} > 0; got {step!r}")
    return float(step)


def _grid(x: FloatArray, y: FloatArray) -> FloatArray:
    """Points (P, 2), row by row of y."""
    return np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)


def _made(
    layout: str, offsets: FloatArray, values: FloatArray, header: Any, shape: tuple[int, int]
) -> MeasuredInfluence:
    alive = np.flatnonzero(np.nan_to_num(values).any(axis=1))
    scaled = header.get("CREATOR") == OURS and header.get("BUNIT") == "m/m"
    return MeasuredInfluence(layout, offsets, values[alive], alive, scaled, shape)


def _compass(names: dict[str, Any], header: Any, pixel: float | None, path: object) -> MeasuredInfluence:
    step = _step(header, "PIXSIZE", pixel, path)
    first, stamps = np.asarray(names["I1_J1"].data, int), np.asarray(names["INFLU"].data, float)
    if stamps.ndim != 3 or stamps.shape[0] != stamps.shape[1] or first.shape != (2, stamps.shape[2]):
        got = f"INFLU {stamps.shape} and I1_J1 {first.shape}"
        raise ValueError(
            f"Input path of read_influence must have INFLU (s, s, N) and I1_J1 (2, N); got {got} in {path}"
        )
    size, count = stamps.shape[1:]
    low = first.min(axis=1)
    nx, ny = (first.max(axis=1) - low + size).tolist()
    values = np.full((count, ny, nx), np.nan)
    for number, (i, j) in enumerate((first.T - low).tolist()):
        values[number, j : j + size, i : i + size] = stamps[:, :, number].T
    x, y = (step * (low[k] + np.arange(n) - header[f"{'XY'[k]}CENTER"]) for k, n in enumerate((nx, ny)))
    return _made("compass", _grid(x, y), values.reshape(count, -1), header, (ny, nx))


def _specula(names: dict[str, Any], header: Any, pixel: float | None, path: object) -> MeasuredInfluence:
    step = _step(header, "PIXSIZE", pixel, path)
    functions, mask = (np.asarray(names[name].data) for name in ("INFLUENCE_FUNCTION", "MASK_INF_FUNC"))
    on = mask > 0
    if functions.ndim != 2 or mask.ndim != 2 or len(functions) != on.sum():
        got = f"{functions.shape} for {int(on.sum())} pixels"
        raise ValueError(
            f"Input path of read_influence must have INFLUENCE_FUNCTION (pixels in mask, N); got {got} in {path}"
        )
    ny, nx = on.shape
    x, y = (step * (np.arange(n) - (n - 1) / 2) for n in (nx, ny))
    return _made("specula", _grid(x, y)[on.ravel()], functions.T.astype(float), header, (ny, nx))


def _image(arrays: list[Any], header: Any, pixel: float | None, path: object) -> MeasuredInfluence:
    if not arrays:
        raise ValueError(f"Input path of read_influence must have an image; got {path}, which has none")
    header = header if "P2PDX_M" in header else arrays[0].header
    image = np.squeeze(np.asarray(arrays[0].data, float))
    if image.ndim != 2 or min(image.shape) < 3 or not all(n % 2 for n in image.shape):
        got = f"{image.shape} in {path}"
        raise ValueError(
            "Input path of read_influence must have one image with an odd number of pixels along each side, the "
            f"actuator in the middle one; got {got}"
        )
    step = _step(header, "P2PDX_M", pixel, path)
    ny, nx = image.shape
    x, y = (step * (np.arange(n) - n // 2) for n in (nx, ny))
    own = header.get("ACTUATOR")
    actuators = np.array([own]) if header.get("CREATOR") == OURS and own is not None else None
    if "P2PDX_M" not in header:
        return MeasuredInfluence("image", _grid(x, y), image.reshape(1, -1), actuators, False, (ny, nx))
    pitch = header.get("C2CDX_M")
    pitch = float(pitch) * step / header["P2PDX_M"] if isinstance(pitch, int | float) and pitch > 0 else None
    return MeasuredInfluence("proper", _grid(x, y), image.reshape(1, -1), actuators, False, (ny, nx), pitch)


def fits_package() -> Any:
    """astropy's module of FITS; ValueError, which says how to get it, where it is not installed."""
    try:
        from astropy.io import fits  # here, as it takes a while
    except ImportError:
        how = "pip install 'active-surface[optics]'"
        raise ValueError(f"FITS files of influence functions need astropy, which comes with {how}") from None
    return fits
