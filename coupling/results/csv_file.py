"""A trajectory as a CSV file: a header of names and units, and a row for each time."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from coupling.files import whole_file
from particle import ContactSamples, KogutEtsion, Samples, State, Trajectory

COLUMNS = (
    *("time [s]", "x [m]", "y [m]", "z [m]", "vx [m/s]", "vy [m/s]", "state"),
    *("normal force [N]", "friction force [N]"),
)
HEADER = ",".join(COLUMNS)
VECTORS = {"contact": "m", "centre": "m", "normal": "1", "friction": "N"}
CONTACT_COLUMNS = tuple(f"{name} {axis} [{unit}]" for name, unit in VECTORS.items() for axis in "xyz")
ROUGH_COLUMNS = ("separation [roughness]", "contact load [N]", "adhesion [N]")


def write_csv(
    trajectory: Trajectory,
    path: str | os.PathLike[str],
    times: ArrayLike | None = None,
    forces: bool = False,
    friction: KogutEtsion | None = None,
) -> Path:
    """Write a trajectory at given times and its events, or at all its rows, as CSV.

    Each time comes once, at an event with the values from then on. Reading the numbers gives the same floats. The
    state is stick, slip or flight.

    Parameters
    ----------
    trajectory : Trajectory
        The path.
    path : path
        The file.
    times : array (k,), optional
        Times, s; those before its start or after its end count as these.
    forces : bool
        Also write where contact and centre of mass are in space, the surface's normal and the friction as vectors.
    friction : KogutEtsion, optional
        The law of the run: with `forces`, also its separation, contact load and adhesion; empty in flight.

    Returns
    -------
    path : path
        The file.

    Raises
    ------
    ValueError
        A time is not finite, or the file holds something else.
    OSError
        The file cannot be written.
    """
    path = Path(path)
    check_csv(path)
    at = trajectory.time if times is None else np.asarray(times, dtype=float).ravel()
    if not np.isfinite(at).all():
        raise ValueError(f"Input times of write_csv must be finite times in s; got {at[~np.isfinite(at)][0]}")
    at = np.concatenate([at, [event.time for event in trajectory.events]])
    at = np.unique(np.clip(at, trajectory.time[0], trajectory.time[-1]))
    header, rows = HEADER, csv_rows(trajectory.at(at))
    if forces:
        contact = trajectory.contact_at(at, friction)
        header = ",".join([HEADER, *CONTACT_COLUMNS, *(ROUGH_COLUMNS if friction else ())])
        rows = (f"{row},{more}" for row, more in zip(rows, _contact_rows(contact, friction is not None), strict=True))
    with whole_file(path) as partial:
        partial.write_text("\n".join([header, *rows, ""]), encoding="utf-8")
    return path


def check_csv(path: Path) -> None:
    """Raises ValueError when there is a file at `path` that is no trajectory, such as a measured motion."""
    if path.is_file() and not is_trajectory(path):
        raise ValueError(f"Input path of write_csv must be free or a trajectory; got {path}, which is neither")


def is_trajectory(path: Path) -> bool:
    """Whether `write_csv` wrote a file."""
    with path.open(encoding="utf-8", errors="replace") as file:
        header = file.readline().rstrip("\n")
    return header == HEADER or header.startswith(f"{HEADER},{CONTACT_COLUMNS[0]},")


def csv_rows(samples: Samples) -> Iterator[str]:
    """Yield the lines of a file for samples, without its header."""
    columns = (samples.time, *samples.position.T, samples.height, *samples.velocity.T)
    words = [State(state).name.lower() for state in samples.state.tolist()]
    forces = (samples.normal_force, samples.friction_force)
    for *numbers, word, normal, friction in zip(
        *(column.tolist() for column in columns), words, *(force.tolist() for force in forces), strict=True
    ):
        yield ",".join([*map(repr, numbers), word, repr(normal), repr(friction)])


def _contact_rows(contact: ContactSamples, rough: bool) -> Iterator[str]:
    columns = [getattr(contact, name) for name in VECTORS]
    if rough:
        columns += [contact.separation, contact.contact_load, contact.adhesion]
    for numbers in np.column_stack(columns).tolist():
        yield ",".join("" if math.isnan(number) else repr(number) for number in numbers)
