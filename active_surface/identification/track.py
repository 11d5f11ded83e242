"""Track: measured positions, and headings, of a part over time."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from coupling.case import AXES, Quantity, read_columns, unreadable
from particle import Trajectory

LENGTH: Final = Quantity("m", "150 um")
QUANTITIES: Final = {"time": Quantity("s", "50 ms"), "x": LENGTH, "y": LENGTH, "heading": Quantity("rad", "30 deg")}
HEADER: Final = "time [ms], x [um], y [um]"


@dataclass(frozen=True, eq=False)
class Track:
    """Where a part was at k times, as its case counts places: on the plate, or from the platform.

    Parameters
    ----------
    time : (k,) array
        Times of the run, increasing, s.
    position : (k, 2) array
        Places, m; nan where x or y was not measured.
    heading : (k,) array, optional
        Headings of a part with a footprint, rad, up to whole turns; nan where it was not measured.
    noise : (float, float), optional
        Standard deviations of x or y, m, and heading, rad, whose ratio makes headings lengths beside places; by default
        the radius of gyration of the part's face does.
    name : str, optional
        Its file, for messages.

    Raises
    ------
    ValueError
        The arrays are no track.
    """

    time: FloatArray
    position: FloatArray
    heading: FloatArray | None = None
    noise: tuple[float, float] | None = None
    name: str = ""

    def __post_init__(self) -> None:
        time, position = np.asarray(self.time, dtype=float), np.asarray(self.position, dtype=float)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "position", position)
        if time.ndim != 1 or not len(time):
            raise ValueError(f"Input time of Track must have shape (k,); got {time.shape}")
        if not (np.isfinite(time).all() and time[0] >= 0 and (np.diff(time) > 0).all()):
            raise ValueError("Input time of Track must be finite, 0 or later, and increase")
        if position.shape != (len(time), 2):
            raise ValueError(f"Input position of Track must have shape ({len(time)}, 2); got {position.shape}")
        if np.isinf(position).any() or np.isnan(position).all():
            raise ValueError("Input position of Track must have finite numbers, nan where a place was not measured")
        if self.heading is not None:
            heading = np.asarray(self.heading, dtype=float)
            object.__setattr__(self, "heading", heading)
            if heading.shape != time.shape or np.isinf(heading).any() or np.isnan(heading).all():
                wanted = f"have shape ({len(time)},) and finite numbers, nan where it was not measured"
                raise ValueError(f"Input heading of Track must {wanted}; got shape {heading.shape}")
        if self.noise is not None:
            both = np.shape(self.noise) == (2,) and all(np.isfinite(one) and one > 0 for one in self.noise)
            if self.heading is None or not both:
                wanted = "two positive deviations, in m and rad, beside headings"
                raise ValueError(f"Input noise of Track must be {wanted}; got {self.noise}")

    @property
    def measured(self) -> BoolArray:
        """Which places, and headings, were measured (k, 2), with headings (k, 3)."""
        columns = [self.position] if self.heading is None else [self.position, self.heading]
        return np.asarray(np.isfinite(np.column_stack(columns)))

    def lever(self, gyration: float) -> float:
        """The length [m] that stands for a heading of 1 rad: a radius of gyration [m], or as the noise says."""
        return gyration if self.noise is None else self.noise[0] / self.noise[1]

    def away(self, path: Trajectory, gyration: float) -> FloatArray:
        """Path minus track (k, 2) [m], with headings (k, 3), as lengths and within half a turn; nan where not measured.

        gyration: of the part's face, m.
        """
        found = path.at(self.time)
        away = np.asarray(found.position - self.position)
        if self.heading is None or found.heading is None:
            return away
        turn = found.heading - self.heading
        return np.column_stack([away, self.lever(gyration) * (turn - 2 * np.pi * np.round(turn / (2 * np.pi)))])


def read_track(path: str | os.PathLike[str], noise: tuple[float, float] | None = None) -> Track:
    """The track in a CSV file whose header names time, x, y and heading with their units; x or y may be left out.

    Parameters
    ----------
    path : path
        The file.
    noise : (float, float), optional
        Of the track.

    Returns
    -------
    track : Track
        Its rows, in SI units.

    Raises
    ------
    ValueError
        The file cannot be read; names every mistake with its line.

    Warns
    -----
    UserWarning
        Rows have no position, as those of frames in which the tracker lost the part, and are left out.
    """
    file = Path(path)
    try:
        read = read_columns(file, QUANTITIES, (["time"], AXES[:2]), HEADER)
    except (OSError, ValueError) as error:
        raise ValueError(f"Input track of identify {unreadable(str(file), error)}") from None
    times, mistakes = read.columns.get("time", ()), list(read.mistakes)
    if not mistakes and not times:
        mistakes = ["must have rows below its header; got none"]
    elif not mistakes and times[0] < 0:
        mistakes = [f"line {read.lines[0]} must have a time of 0 or later; got {times[0]:g} s"]
    elif not mistakes and (still := np.flatnonzero(np.diff(times) <= 0)).size:
        k = int(still[0]) + 1
        mistakes = [f"line {read.lines[k]} must have a later time than the row before; got {times[k]:g} s"]
    if mistakes:
        raise ValueError("\n".join(f"Input track of identify in {file.name}: {mistake}" for mistake in mistakes))
    if read.lost:
        warnings.warn(f"{file.name}: {read.lost} rows without a position are left out", stacklevel=2)
    missing = (np.nan,) * len(times)
    places = np.array([read.columns.get(axis, missing) for axis in AXES[:2]]).T
    heading = read.columns.get("heading")
    return Track(np.array(times), places, None if heading is None else np.array(heading), noise, os.fspath(path))
