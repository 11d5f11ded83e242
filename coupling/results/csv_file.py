"""A trajectory as a CSV file: a header of names and units, and a row for each time."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupling.files import whole_file
from particle import KogutEtsion, Samples, State, Trajectory

HEADER = "time [s],x [m],y [m],z [m],vx [m/s],vy [m/s],state,normal force [N],friction force [N]"
FACE = {"heading": "heading [rad]", "spin": "spin [rad/s]", "pressure_margin": "pressure margin"}
FILM = {"gap": "gap [m]", "air_force": "air force [N]"}
VECTORS = {"contact": "m", "centre": "m", "normal": "1", "friction": "N"}
ROUGH = {"separation": "separation [roughness]", "contact_load": "contact load [N]", "adhesion": "adhesion [N]"}


def write_csv(
    trajectory: Trajectory,
    path: str | os.PathLike[str],
    times: ArrayLike | None = None,
    forces: bool = False,
    friction: KogutEtsion | None = None,
) -> Path:
    """Write a trajectory at given times and its events, or at all its rows, as CSV.

    Each time comes once, at an event with the values from then on. Reading the numbers gives the same floats. The
    state is stick, slip or flight. A part with a face adds its heading, spin and pressure margin, one on a film
    of air the mean gap and the film's force.

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
    columns = columns_of(trajectory.at(at))
    if forces:
        contact = trajectory.contact_at(at, friction)
        for name, unit in VECTORS.items():
            x_y_z = zip("xyz", getattr(contact, name).T, strict=True)
            columns |= {f"{name} {axis} [{unit}]": values for axis, values in x_y_z}
        columns |= {label: getattr(contact, name) for name, label in ROUGH.items() if friction is not None}
    return write_columns(columns, path)


def columns_of(samples: Samples) -> dict[str, NDArray[Any]]:
    """The columns (k,) of a file for samples, by their names."""
    words = np.array([State(state).name.lower() for state in samples.state.tolist()])
    columns = (samples.time, *samples.position.T, samples.height, *samples.velocity.T, words)
    forces = samples.normal_force, samples.friction_force
    face = {label: values for name, label in (FACE | FILM).items() if (values := getattr(samples, name)) is not None}
    return dict(zip(HEADER.split(","), (*columns, *forces), strict=True)) | face


def write_columns(columns: Mapping[str, NDArray[Any]], path: Path) -> Path:
    """Write columns (k,) of numbers, empty where they are nan, or words as a CSV file; return its path."""
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    lines = (",".join("" if value != value else str(value) for value in row) for row in rows)
    with whole_file(path) as partial:
        partial.write_text("\n".join([",".join(columns), *lines, ""]), encoding="utf-8")
    return path


def check_csv(path: Path) -> None:
    """Raises ValueError when there is a file at `path` that is no trajectory, such as a measured motion."""
    if path.is_file() and not is_trajectory(path):
        raise ValueError(f"Input path of write_csv must be free or a trajectory; got {path}, which is neither")


def is_trajectory(path: Path) -> bool:
    """Whether `write_csv` wrote a file."""
    with path.open(encoding="utf-8", errors="replace") as file:
        header = file.readline().rstrip("\n")
    further = ("contact x [m],", *(",".join(names.values()) for names in (FACE, FILM)))
    return header == HEADER or header.startswith(tuple(f"{HEADER},{names}" for names in further))
