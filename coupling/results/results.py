"""Result files of a run: two VTKHDF files on one time axis, on request the trajectory and the moving surface."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from coupling.display import DisplaySurface, moving_heights, onto_surface
from coupling.environment import versions
from coupling.files import check_room
from coupling.margins import MarginCurves, event_actuators
from coupling.part import build_friction
from coupling.progress import ProgressCallback, no_progress
from coupling.result import Result
from coupling.results.case_record import CaseRecord
from coupling.results.csv_file import ROUGH, VECTORS, check_csv, is_trajectory, write_csv
from coupling.results.vtkhdf import part_file, plate_file
from coupling.surface import check_surface, is_surface, write_surface
from particle import KogutEtsion, Samples, Trajectory

FloatArray = NDArray[np.float64]

PART_STEP = 500  # bytes of a step of the part
AT_ONCE = 64  # time steps whose deflections are computed and written together
UNITS = {
    "time": "s",
    "deflection": "m",
    "velocity": "m/s",
    "curvature": "1/m, the Laplacian of the deflection, positive where the plate is bent like a bowl; at an actuator, "
    "where it has no bound, that at a millionth of the plate's half length from it",
    "drive": "m (N where a force drives) at actuators, 0 elsewhere",
    "membrane_force": "N/m, xx, xy and yy, positive where it pulls; of a plate that stretches",
    "strain": "1, xx, xy and yy, of the top face of a plate that stretches; within half a thickness of an actuator, "
    "that at this distance",
    "normal_force": "N",
    "friction_force": "N",
    "contact": "m, in space, where the part touches the surface",
    "centre": "m, in space, of the part's centre of mass",
    "normal": "of the surface, along which the part stands",
    "friction": "N, on the part",
    "separation": "of a rough contact, over its roughness",
    "contact_load": "N, by which the asperities of a rough contact are pressed",
    "adhesion": "N, of a rough contact",
    "heading": "rad, counter-clockwise, of a part with a face",
    "spin": "rad/s",
    "pressure_margin": "1, least pressure under the face over the mean",
    "state": "0: stuck, 1: slipping, 2: flying",
}


@dataclass(frozen=True)
class Output:
    """What of a run is written, and where."""

    folder: Path
    csv: bool = False  # whether there is NAME.csv, the trajectory
    surface: bool = False  # whether there is NAME.surface.h5, the moving surface
    forces: bool = False  # whether the part's file and the CSV have the parts of the contact's force
    picture: bool = True  # whether there is NAME.png

    def check(self, name: str) -> None:
        """Raise ValueError where NAME.csv or NAME.surface.h5 would replace something else."""
        if self.csv:
            check_csv(self.folder / f"{name}.csv")
        if self.surface:
            check_surface(self.folder / f"{name}.surface.h5")


def write_results(
    result: Result, record: CaseRecord, output: Output, tell: ProgressCallback = no_progress
) -> tuple[list[Path], list[Path]]:
    """Write NAME.plate.vtkhdf and NAME.part.vtkhdf, and what else is wanted but a picture; return the paths of both.

    The folder is made if need be. What a run of an older case left there goes.

    record: of the case, taken before the work: later its files may be others.
    tell: gets how many time steps are written, and of how many.
    """
    case, scene, trajectory, folder = result.case, result.scene, result.trajectory, output.folder
    folder.mkdir(parents=True, exist_ok=True)
    times, ground, friction = result.frames, result.ground, build_friction(case)
    heights, speeds = moving_heights(scene, times), moving_heights(scene, times, 1)
    metadata: dict[str, str | int] = {
        "run": uuid4().hex,  # the same in both files, which so find each other
        "case": case.source or record.text,
        "summary": json.dumps(result.summary.as_dict()),
        "units": json.dumps(UNITS | {"points": f"m, counted from {scene.origin}"}),
        "versions": json.dumps(versions()),
        "actuators": len(case.actuators),
    }
    samples = trajectory.at(times)
    rough = friction if isinstance(friction, KogutEtsion) else None
    of_part: dict[str, NDArray[Any]] = {
        "velocity": np.column_stack([samples.velocity, samples.vertical_velocity]),
        "state": samples.state,
        "normal_force": samples.normal_force,
        "friction_force": samples.friction_force,
        **(_contact_fields(trajectory, times, rough) if output.forces else {}),
    }
    position = np.column_stack([onto_surface(scene, samples.position), samples.height])
    if (face := case.part.face) is not None and samples.heading is not None:
        of_part |= {name: getattr(samples, name) for name in ("heading", "spin", "pressure_margin")}
        position = _with_corners(position, face.outline(position[:, :2], samples.heading), trajectory, times)
        of_part = {name: np.repeat(values[:, None], position.shape[1], axis=1) for name, values in of_part.items()}
    arrays = _arrays(record, trajectory, result.margin_curves, event_actuators(scene, result.loads))
    step = _fields(ground, heights[:1], speeds[:1], len(scene.lifts), times[:1])
    step_size = sum(values.nbytes for values in step.values()) + PART_STEP * position[0].size // 3
    check_room(folder, len(times) * step_size + sum(values.nbytes for values in arrays["rows"].values()))
    with (
        plate_file(folder, case.name, ground.points, ground.triangles, metadata) as plate,
        part_file(folder, case.name, metadata, position[0].size // 3 - 1) as part,
    ):
        for group, members in arrays.items():
            part.add_arrays(group, members)
        for first in range(0, len(times), AT_ONCE):
            tell(first, len(times))
            some = slice(first, first + AT_ONCE)
            plate.append(times[some], **_fields(ground, heights[some], speeds[some], len(scene.lifts), times[some]))
            part.append(times[some], position[some], **{name: values[some] for name, values in of_part.items()})
    _clear(folder, case.name)
    further = []
    if output.csv:
        further.append(write_csv(trajectory, folder / f"{case.name}.csv", times, output.forces, rough))
    if output.surface:
        further.append(write_surface(scene.surface, folder / f"{case.name}.surface.h5"))
    return [folder / f"{case.name}.plate.vtkhdf", folder / f"{case.name}.part.vtkhdf"], further


def _with_corners(middle: FloatArray, corners: FloatArray, trajectory: Trajectory, times: FloatArray) -> FloatArray:
    """The middle (k, 3) and the corners (k, p, 2) [m] of a face, all on the plane on which it stands: (k, 1 + p, 3)."""
    normal = trajectory.contact_at(times).normal
    away = corners - middle[:, None, :2]
    rise = -(away @ normal[:, :2, None])[..., 0] / normal[:, 2:]
    points = np.concatenate([away, np.nan_to_num(rise)[..., None]], axis=2) + middle[:, None]
    return np.concatenate([middle[:, None], points], axis=1)


def _contact_fields(trajectory: Trajectory, times: FloatArray, friction: KogutEtsion | None) -> dict[str, FloatArray]:
    """The fields of the contact at times (k,): vectors (k, 3), and for a rough contact numbers (k,), 0 in flight."""
    contact = trajectory.contact_at(times, friction)
    return {name: np.nan_to_num(getattr(contact, name)) for name in (*VECTORS, *(ROUGH if friction else ()))}


def _fields(
    ground: DisplaySurface, heights: FloatArray, speeds: FloatArray, actuators: int, times: FloatArray
) -> dict[str, NDArray[np.float32]]:
    """The fields (k, n) of the surface as drawn under heights [m] and speeds [m/s] (k, K) of its drives."""
    single = np.float32
    fields = {
        "deflection": ground.deflection(heights).astype(single),
        "velocity": ground.deflection(speeds).astype(single),
    }
    if ground.curvature is not None:
        fields["curvature"] = ground.curvature(heights).astype(single)
        fields["drive"] = np.zeros_like(fields["curvature"])
        fields["drive"][:, :actuators] = heights[:, :actuators]  # the actuators are the first of the points
    if ground.stretching is not None:
        fields |= {name: values.astype(single) for name, values in ground.stretching.fields(times).items()}
    return fields


def _arrays(
    record: CaseRecord, trajectory: Trajectory, margins: MarginCurves, actuators: NDArray[np.int64]
) -> dict[str, dict[str, NDArray]]:
    """What the part's file holds beside its steps, by groups: the case and its files, rows, events, margins.

    actuators: those that count most at each event.
    """
    events = {
        "kind": np.array([event.kind for event in trajectory.events], np.int64),
        "actuator": actuators,
        "position": np.array([event.position for event in trajectory.events], float).reshape(-1, 2),
    }
    if trajectory.heading is not None:
        events["heading"] = np.array([event.heading for event in trajectory.events], float)
    for key in ("time", "speed", "load"):
        events[key] = np.array([getattr(event, key) for event in trajectory.events], float)
    return {
        "case": {"json": np.frombuffer(record.text.encode(), np.uint8)},
        "files": {name: np.frombuffer(content, np.uint8) for name, content in record.files.items()},
        "rows": {key: rows for key in Samples._fields if (rows := getattr(trajectory, key)) is not None},
        "events": events,
        "margins": margins._asdict(),
    }


def _clear(folder: Path, name: str) -> None:
    """Removes what a run of an older case left beside the two files: its picture, trajectory and surface."""
    (folder / f"{name}.png").unlink(missing_ok=True)
    for path, is_ours in ((folder / f"{name}.csv", is_trajectory), (folder / f"{name}.surface.h5", is_surface)):
        if path.is_file() and is_ours(path):
            path.unlink()
