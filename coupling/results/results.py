"""Result files of a run: two VTKHDF files on one time axis, on request the trajectory and the moving surface."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from glob import escape
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from coupling.display import DisplaySurface, display_surface, frame_times, moving_heights, onto_surface
from coupling.environment import versions
from coupling.files import check_room
from coupling.margins import event_actuators
from coupling.part import build_friction
from coupling.progress import ProgressCallback, no_progress
from coupling.result import Result
from coupling.results.case_record import CaseRecord
from coupling.results.csv_file import ROUGH, VECTORS, check_csv, is_trajectory, write_csv
from coupling.results.saved import part_names
from coupling.results.vtkhdf import NONE, Metadata, part_file, plate_file
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
    "gap": "m, the mean under a part on a film of air",
    "air_force": "N, of the film, a share of the normal force",
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
    name: str,
    results: Mapping[str, tuple[Result, CaseRecord]],
    output: Output,
    tell: ProgressCallback = no_progress,
    of_all: Metadata = NONE,
) -> tuple[list[Path], list[Path]]:
    """Write NAME.plate.vtkhdf, a .part.vtkhdf for each part, and what else is wanted but a picture; return both paths.

    The folder is made if need be. What a run of an older case left there goes.

    results: of parts over one surface by the names of their files, NAME of one part and NAME.PART of many; with the
        records of their cases, taken before the work: later its files may be others.
    tell: gets how many time steps are written, and of how many.  of_all: further attributes of the plate's file.
    """
    folder, (first, record) = output.folder, next(iter(results.values()))
    folder.mkdir(parents=True, exist_ok=True)
    older = _older(folder, name)
    scene, paths = first.scene, [result.trajectory for result, _ in results.values()]
    ends = [float(path.time[-1]) for path in paths]
    times, ground = (
        np.union1d(frame_times(first.case, scene, max(ends)), ends),
        (display_surface(scene, *paths) if scene.shapes is None else first.ground),
    )
    heights, speeds = moving_heights(scene, times), moving_heights(scene, times, 1)
    metadata: Metadata = {
        "run": uuid4().hex,  # the same in all files, which so find each other
        "case": first.case.source or record.text,
        "summary": json.dumps(first.summary.as_dict()),
        "units": json.dumps(UNITS | {"points": f"m, counted from {scene.origin}"}),
        "versions": json.dumps(versions()),
        "actuators": len(first.case.actuators),
    }
    written = {of_part: _part_steps(result, times, output.forces) for of_part, (result, _) in results.items()}
    arrays = {of_part: _arrays(result, record) for of_part, (result, record) in results.items()}
    step = _fields(ground, heights[:1], speeds[:1], len(scene.lifts), times[:1])
    needed = len(times) * sum(values.nbytes for values in step.values())
    for of_part, (position, _) in written.items():
        needed += len(position) * PART_STEP * position[0].size // 3
        needed += sum(values.nbytes for values in arrays[of_part]["rows"].values())
    check_room(folder, needed)
    with ExitStack() as files:
        plate = files.enter_context(plate_file(folder, name, ground.points, ground.triangles, {**metadata, **of_all}))
        parts = {}
        for of_part, (result, _) in results.items():
            own = {**metadata, "summary": json.dumps(result.summary.as_dict())}
            corners = written[of_part][0][0].size // 3 - 1
            parts[of_part] = files.enter_context(part_file(folder, of_part, own, corners))
            for group, members in arrays[of_part].items():
                parts[of_part].add_arrays(group, members)
        for start in range(0, len(times), AT_ONCE):
            tell(start, len(times))
            some = slice(start, start + AT_ONCE)
            plate.append(times[some], **_fields(ground, heights[some], speeds[some], len(scene.lifts), times[some]))
            for of_part, (position, fields) in written.items():
                columns = {key: values[some] for key, values in fields.items()}
                parts[of_part].append(times[some][: len(position[some])], position[some], **columns)
    _clear(folder, {name, *older, *results}, [of_part for of_part in older if of_part not in results])
    further = []
    if output.csv:
        for of_part, (result, _) in results.items():
            path, at = folder / f"{of_part}.csv", times[: len(written[of_part][0])]
            further.append(write_csv(result.trajectory, path, at, output.forces, _rough(result)))
    if output.surface:
        further.append(write_surface(scene.surface, folder / f"{name}.surface.h5"))
    return [folder / f"{name}.plate.vtkhdf", *(folder / f"{of_part}.part.vtkhdf" for of_part in results)], further


def _rough(result: Result) -> KogutEtsion | None:
    """The friction law of a result where that is a rough contact."""
    friction = build_friction(result.case)
    return friction if isinstance(friction, KogutEtsion) else None


def _part_steps(result: Result, times: FloatArray, forces: bool) -> tuple[FloatArray, dict[str, NDArray[Any]]]:
    """Positions (k, 3) or (k, 1 + p, 3) [m] of a part, and its fields, at those of the times [s] that it lasted."""
    trajectory, face = result.trajectory, result.case.part.face
    times = times[times <= trajectory.time[-1]]
    samples = trajectory.at(times)
    fields: dict[str, NDArray[Any]] = {
        "velocity": np.column_stack([samples.velocity, samples.vertical_velocity]),
        "state": samples.state,
        "normal_force": samples.normal_force,
        "friction_force": samples.friction_force,
        **(_contact_fields(trajectory, times, _rough(result)) if forces else {}),
    }
    if samples.gap is not None and samples.air_force is not None:
        fields |= {"gap": samples.gap, "air_force": samples.air_force}
    position = np.column_stack([onto_surface(result.scene, samples.position), samples.height])
    if face is not None and samples.heading is not None:
        fields |= {name: getattr(samples, name) for name in ("heading", "spin", "pressure_margin")}
        position = _with_corners(position, face.outline(position[:, :2], samples.heading), trajectory, times)
        fields = {name: np.repeat(values[:, None], position.shape[1], axis=1) for name, values in fields.items()}
    return position, fields


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


def _arrays(result: Result, record: CaseRecord) -> dict[str, dict[str, NDArray]]:
    """What the part's file holds beside its steps, by groups: the case and its files, rows, events, margins."""
    trajectory = result.trajectory
    events = {
        "kind": np.array([event.kind for event in trajectory.events], np.int64),
        "actuator": event_actuators(result.scene, result.loads),  # those that count most
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
        "margins": result.margin_curves._asdict(),
    }


def _older(folder: Path, name: str) -> list[str]:
    """The names of the parts' files of an older run of many parts of this name."""
    if any(folder.glob(f"{escape(name)}.*.part.vtkhdf")):
        with suppress(ValueError):  # there is none, or what is left of it
            return part_names(folder / f"{name}.plate.vtkhdf")
    return []


def _clear(folder: Path, names: Iterable[str], gone: Iterable[str]) -> None:
    """Removes what a run of an older case left beside its files: pictures, trajectories, surface, and parts."""
    for name in names:
        (folder / f"{name}.png").unlink(missing_ok=True)
        for path, is_ours in ((folder / f"{name}.csv", is_trajectory), (folder / f"{name}.surface.h5", is_surface)):
            if path.is_file() and is_ours(path):
                path.unlink()
    for name in gone:
        (folder / f"{name}.part.vtkhdf").unlink(missing_ok=True)
