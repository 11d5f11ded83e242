"""Result files of a run: two VTKHDF files on one time axis, and a picture."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, amplitude
from coupling.drawn_plate import drawn_plate
from coupling.pictures import draw_run
from coupling.rim import onto_plate
from coupling.summary import Summary, stroke_heights
from coupling.vtkhdf import part_file, plate_file
from fem_plate import InfluenceShapes
from meshes import PlateMesh
from particle import AnyDrive, Trajectory

FloatArray = NDArray[np.float64]

FRAMES_PER_CYCLE = 20
FRAMES = (100, 1000)  # least and most without a wish in the case
UNITS = {
    "time": "s",
    "points": "m",
    "deflection": "m",
    "velocity": "m/s",
    "normal_force": "N",
    "friction_force": "N",
    "state": "0: stuck, 1: slipping",
}


def write_results(
    case: Case,
    mesh: PlateMesh,
    shapes: InfluenceShapes,
    drives: Sequence[AnyDrive],
    trajectory: Trajectory,
    summary: Summary,
    folder: Path,
) -> tuple[Path, ...]:
    """Writes NAME.plate.vtkhdf, NAME.part.vtkhdf and NAME.png into the folder, made if need be; returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    times = frame_times(case, drives, float(trajectory.time[-1]))
    points, triangles = drawn_plate(mesh, shapes.points)
    value = shapes.evaluate(points)[0]
    heights = stroke_heights(drives, times)
    metadata = {
        "case": case.source or case.model_dump_json(),
        "summary": json.dumps(summary.as_dict()),
        "units": json.dumps(UNITS),
        "versions": json.dumps({name: version(name) for name in ("active-surface", "numpy", "scipy", "numba")}),
    }
    samples = trajectory.at(times)
    place = onto_plate(shapes.outline, samples.position)
    with (
        plate_file(folder, case.name, points, triangles, metadata) as plate,
        part_file(folder, case.name, metadata) as part,
    ):
        for k, time in enumerate(times.tolist()):
            plate.append(time, deflection=value @ heights[k])
            part.append(
                time,
                (*place[k], samples.height[k]),
                velocity=(*samples.velocity[k], 0.0),
                state=samples.state[k],
                normal_force=samples.normal_force[k],
                friction_force=samples.friction_force[k],
            )
    picture = folder / f"{case.name}.png"
    all_up = value @ [amplitude(actuator) for actuator in case.actuators]
    draw_run(case, shapes, trajectory, (points, triangles, all_up), picture)
    return folder / f"{case.name}.plate.vtkhdf", folder / f"{case.name}.part.vtkhdf", picture


def check_folder(folder: Path) -> None:
    """Raises ValueError unless the folder can be made and written to: better before the work than after it."""
    made = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    if not made.is_dir():
        raise ValueError(f"Input output must be a folder; got {folder}, but {made} is a file")
    if not os.access(made, os.W_OK):
        raise ValueError(f"Input output must be a folder that can be written to; got {folder}, but {made} refuses it")


def frame_times(case: Case, drives: Sequence[AnyDrive], end: float) -> FloatArray:
    """The times of the result files' steps, from 0 to the run's end."""
    if case.run.frames:
        return np.linspace(0, end, case.run.frames)
    fastest = max(drive.frequency for drive in drives)
    count = math.ceil(end * fastest * FRAMES_PER_CYCLE) + 1
    return np.linspace(0, end, min(max(count, FRAMES[0]), FRAMES[1]))
