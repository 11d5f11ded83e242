"""Result files of a run: two VTKHDF files on one time axis, a picture, and on request a CSV file."""

from __future__ import annotations

import json
from pathlib import Path
from uuid import uuid4
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case
from coupling.display import (
    DisplaySurface,
    display_surface,
    frame_times,
    most_deflected,
    moving_heights,
    onto_surface,
)
from coupling.environment import versions
from coupling.files import check_room
from coupling.margins import MarginCurves, event_actuators, margin_curves
from coupling.part import build_friction
from coupling.progress import ProgressCallback, no_progress
from coupling.results.case_record import CaseRecord
from coupling.results.csv_file import is_trajectory, write_csv
from coupling.results.vtkhdf import part_file, plate_file
from coupling.scene import Scene
from coupling.summary import Summary
from coupling.surface import is_surface
from particle import KogutEtsion, Samples, Trajectory
from particle.friction import Contact

FloatArray = NDArray[np.float64]

PART_STEP, ROOM = 500, 2_000_000  # bytes of a step of the part, and of what does not grow with the run
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
    "state": "0: stuck, 1: slipping, 2: flying",
}


def write_results(
    case: Case,
    record: CaseRecord,
    scene: Scene,
    trajectory: Trajectory,
    summary: Summary,
    folder: Path,
    csv: bool = False,
    tell: ProgressCallback = no_progress,
    friction: Contact | None = None,
    with_picture: bool = True,
) -> tuple[Path, ...]:
    """Writes NAME.plate.vtkhdf, NAME.part.vtkhdf and NAME.png into the folder, made if need be; returns their paths.

    A picture that cannot be drawn is left out, with a RuntimeWarning.

    record: of the case, taken before the work: later its files may be others.  csv: whether to write NAME.csv as well.
    tell: gets how many time steps are written, and of how many.  friction: the contact's forces go to the part's file
    and the CSV, too.  with_picture: whether the picture is wanted.
    """
    folder.mkdir(parents=True, exist_ok=True)
    times = frame_times(case, scene, float(trajectory.time[-1]))
    ground = display_surface(scene, trajectory)
    heights, speeds = moving_heights(scene, times), moving_heights(scene, times, 1)
    metadata: dict[str, str | int] = {
        "run": uuid4().hex,  # the same in both files, which so find each other
        "case": case.source or record.text,
        "summary": json.dumps(summary.as_dict()),
        "units": json.dumps(UNITS | {"points": f"m, counted from {scene.origin}"}),
        "versions": json.dumps(versions()),
        "actuators": len(case.actuators),
    }
    samples = trajectory.at(times)
    position = np.column_stack([onto_surface(scene, samples.position), samples.height])
    velocity = np.column_stack([samples.velocity, samples.vertical_velocity])
    rough = friction if isinstance(friction, KogutEtsion) else None
    forces = {} if friction is None else _contact_fields(trajectory, times, rough)
    law = build_friction(case)
    curves = margin_curves(case, scene.surface, trajectory, law)
    by = event_actuators(case, scene, trajectory, law)
    check_room(
        folder, _needed(_fields(ground, heights[:1], speeds[:1], len(scene.lifts), times[:1]), times, trajectory)
    )
    spread: list[FloatArray] = []
    with (
        plate_file(folder, case.name, ground.points, ground.triangles, metadata) as plate,
        part_file(folder, case.name, metadata) as part,
    ):
        for group, arrays in _arrays(record, trajectory, curves, by).items():
            part.add_arrays(group, arrays)
        for first in range(0, len(times), AT_ONCE):
            tell(first, len(times))
            some = slice(first, first + AT_ONCE)
            fields = _fields(ground, heights[some], speeds[some], len(scene.lifts), times[some])
            spread.append(np.square(fields["deflection"], dtype=np.float64).mean(axis=1))
            plate.append(times[some], **fields)
            part.append(
                times[some],
                position[some],
                velocity=velocity[some],
                state=samples.state[some],
                normal_force=samples.normal_force[some],
                friction_force=samples.friction_force[some],
                **{name: values[some] for name, values in forces.items()},
            )
    picture = folder / f"{case.name}.png"
    files = [folder / f"{case.name}.plate.vtkhdf", folder / f"{case.name}.part.vtkhdf"]
    _clear(folder, case.name)
    if with_picture:
        try:
            from coupling.pictures import draw_run  # here, because it loads matplotlib

            moment = float(times[most_deflected(np.concatenate(spread))])
            draw_run(case, scene, trajectory, ground, moment, picture, summary.margins, curves)
            files.append(picture)
        except Exception as error:  # the run is finished, whatever becomes of its picture
            warn(f"{picture} could not be drawn: {error}", RuntimeWarning, stacklevel=2)
    if csv:
        files.append(write_csv(trajectory, folder / f"{case.name}.csv", times, friction is not None, rough))
    return tuple(files)


def _needed(fields: dict[str, NDArray[np.float32]], times: FloatArray, trajectory: Trajectory) -> int:
    """How many bytes the files take at most; fields: of one time step."""
    rows = sum(np.asarray(getattr(trajectory, key)).nbytes for key in Samples._fields)
    return len(times) * (sum(values.nbytes for values in fields.values()) + PART_STEP) + rows + ROOM


def _contact_fields(trajectory: Trajectory, times: FloatArray, friction: KogutEtsion | None) -> dict[str, FloatArray]:
    """The fields of the contact at times (k,): vectors (k, 3), and for a rough contact numbers (k,), 0 in flight."""
    contact = trajectory.contact_at(times, friction)
    names = ["contact", "centre", "normal", "friction"]
    names += ["separation", "contact_load", "adhesion"] if friction else []
    return {name: np.nan_to_num(getattr(contact, name)) for name in names}


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
    for key in ("time", "speed", "load"):
        events[key] = np.array([getattr(event, key) for event in trajectory.events], float)
    return {
        "case": {"json": np.frombuffer(record.text.encode(), np.uint8)},
        "files": {name: np.frombuffer(content, np.uint8) for name, content in record.files.items()},
        "rows": {key: getattr(trajectory, key) for key in Samples._fields},
        "events": events,
        "margins": margins._asdict(),
    }


def _clear(folder: Path, name: str) -> None:
    """Removes what a run of an older case left beside the two files: its picture, trajectory and surface."""
    (folder / f"{name}.png").unlink(missing_ok=True)
    for path, is_ours in ((folder / f"{name}.csv", is_trajectory), (folder / f"{name}.surface.h5", is_surface)):
        if path.is_file() and is_ours(path):
            path.unlink()
