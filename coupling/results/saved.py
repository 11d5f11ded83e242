"""Saved run: what the result files of a run hold, read back."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from common import DEADLY, check_hdf5, survives
from coupling.case import Case
from coupling.margins import LOSSES, MarginCurves
from coupling.parts import Overlap
from coupling.results.case_record import CaseRecord, case_of
from coupling.results.opening import (
    ENDINGS,
    EXPECTED,
    KINDS,
    PARTIAL,
    SUFFIX,
    check_numbers,
    checked_cells,
    checked_count,
    described,
    meant,
    opened,
    readable,
    split,
)
from coupling.summary import summary_of
from particle import Event, EventKind, Outcome, Samples, State, dataset_of, table_of

if TYPE_CHECKING:
    import pandas
    import xarray

FloatArray = NDArray[np.float64]

TIMES = "VTKHDF/Steps/Values"
EVENT_KIND, EVENT_NUMBERS, EVENT_PLACE = "kind", ("time", "speed", "load"), "position"
OF_PART = ("velocity", "state", "normal_force", "friction_force")
OPTIONAL = ("heading", "pressure_margin", "air_force")  # of a face, and of a film
LOST = tuple(outcome.value for outcome in (Outcome.DETACHED, Outcome.LEFT_PLATE, Outcome.OVERLOADED, Outcome.TIPPED))


@dataclass(frozen=True, eq=False)
class SavedRun:
    """A run as its two files hold it, finished or as far as it was written; the k steps are those that both have.

    Of many parts it is that of one, over the surface of all.
    """

    name: str  # of the files
    complete: bool  # whether they were written to the end of the run
    summary: dict[str, Any] = field(repr=False)
    versions: dict[str, str] = field(repr=False)
    units: dict[str, str] = field(repr=False)
    time: FloatArray = field(repr=False)  # (k,) s
    points: FloatArray = field(repr=False)  # (n, 2) m, of the plate at rest, the N actuators first
    triangles: NDArray[np.int64] = field(repr=False)  # (m, 3)
    actuators: FloatArray = field(repr=False)  # (N, 2) m
    position: FloatArray = field(repr=False)  # (k, 3) m, of the part
    velocity: FloatArray = field(repr=False)  # (k, 3) m/s
    state: NDArray[np.int64] = field(repr=False)  # (k,) 0 stuck, 1 slipping, 2 flying
    normal_force: FloatArray = field(repr=False)  # (k,) N
    friction_force: FloatArray = field(repr=False)  # (k,) N
    heading: FloatArray | None = field(repr=False)  # (k,) rad, of a part with a face, as is the next one
    pressure_margin: FloatArray | None = field(repr=False)  # (k,) the least pressure over the mean
    air_force: FloatArray | None = field(repr=False)  # (k,) N, of a film
    events: list[Event] = field(repr=False)
    rows: Samples = field(repr=False)  # all that the integrator found
    margins: MarginCurves = field(repr=False)  # over time
    event_actuators: NDArray[np.int64] = field(repr=False)  # (e,) that count most for slips and detachments; -1: none
    plate_fields: tuple[str, ...]
    plate_path: Path = field(repr=False)
    part_path: Path = field(repr=False)
    overlaps: tuple[Overlap, ...] = field(default=(), repr=False)  # of many parts, all first ones

    @cached_property
    def case(self) -> Case:
        """The case that was run, to the last bit; the files that it reads are in a temporary folder.

        Raises ValueError when the file holds no valid case.
        """
        with opened(self.part_path) as file, readable(self.part_path, self.part_path, "whose case is damaged"):
            ours = file["active_surface"]
            files = {name: data[()].tobytes() for name, data in ours["files"].items()}
            text, source = ours["case"]["json"][()].tobytes().decode(), ours.attrs["case"]
            return case_of(CaseRecord(text, files), self.name, None if source == text else source)

    def to_xarray(self) -> xarray.Dataset:
        """All rows and events of the run as labelled arrays with units, as `Trajectory.to_xarray` gives them."""
        return dataset_of(self.rows, self.events, **self._ending)

    def to_dataframe(self) -> pandas.DataFrame:
        """All rows of the run as a table, as `Trajectory.to_dataframe` gives them."""
        return table_of(self.rows, **self._ending)

    @property
    def loss(self) -> Event | None:
        """The event with which the part was lost at the end of the run; None: it was not."""
        last = self.events[-1] if self.events else None
        return last if last and last.kind in LOSSES and self.summary["outcome"] in LOST else None

    @property
    def _ending(self) -> dict[str, str]:
        return {key: str(self.summary[key]) for key in ("outcome", "sentence")}

    def plate_field(self, name: str, steps: int | slice | Sequence[int] | NDArray[np.int64] = slice(None)) -> NDArray:
        """A field of the plate at stored steps.

        Parameters
        ----------
        name : str
            Name of the field.
        steps : int or slice
            The steps.

        Returns
        -------
        values : array (k', n) or, of a vector, (k', n, 3)
            Values at the points; at a single step without the first axis.

        Raises
        ------
        ValueError
            The file lacks the field or has it damaged.
        IndexError
            The file lacks the step.
        """
        if name not in self.plate_fields:
            known = ", ".join(self.plate_fields)
            raise ValueError(f"Input name of plate_field must be one of {known}; got {name!r}")
        rows = np.arange(len(self.time))[steps]
        n = len(self.points)
        with (
            opened(self.plate_path) as file,
            readable(self.plate_path, self.part_path, f"whose field {name} is damaged"),
        ):
            data = file[f"VTKHDF/PointData/{name}"]
            if len(data) < len(self.time) * n:
                raise ValueError(f"it lacks some of {len(self.time)} steps")
            values = np.empty((rows.size, n, *data.shape[1:]), data.dtype)
            for row, step in zip(values, np.atleast_1d(rows).tolist(), strict=True):
                row[...] = data[step * n : (step + 1) * n]
            if not np.isfinite(values).all():
                raise ValueError(f"{name} has a number that is not finite")
        return values.reshape(*rows.shape, *values.shape[1:])


def read_run(path: str | os.PathLike[str]) -> SavedRun:
    """Read a run back from its files.

    Parameters
    ----------
    path : path
        Either of the two files, finished or partial, or FOLDER/NAME without the endings; of one of many parts
        FOLDER/NAME.PART.

    Returns
    -------
    run : SavedRun
        The run.

    Raises
    ------
    ValueError
        There is no such file, or it is no result of a run, is damaged, or has no other beside it.
    """
    paths = _pair(Path(path))
    with opened(paths["plate"]) as plate, opened(paths["part"]) as part:
        steps = {}
        for file, kind in ((plate, "plate"), (part, "part")):
            with readable(paths[kind], paths["part"]):
                steps[kind] = checked_count("NSteps", file["VTKHDF/Steps"].attrs["NSteps"])
        fewest = min(steps, key=steps.__getitem__)
        if steps[fewest] == 0:
            raise ValueError(f"{EXPECTED}; got {paths[fewest]}, to which no step was written")
        with readable(paths["plate"], paths["part"]):
            surface = _surface(plate)
        with readable(paths["part"], paths["part"]):
            run = _read(part, surface, paths, steps[fewest])
            _check(run, steps[fewest])
            return run


def read_runs(path: str | os.PathLike[str]) -> list[SavedRun]:
    """The runs of all parts, by their file or FOLDER/NAME, or the one that `read_run` reads; raises likewise."""
    (name, kind, _), path = split(Path(path)), Path(path)
    plates = [path.with_name(f"{name}{part}.plate{SUFFIX}") for part in ("", PARTIAL)] if kind is None else [path]
    plate = next((file for file in plates if kind != "part" and file.is_file()), None)
    parts = [] if plate is None else part_names(plate)
    return [read_run(path.with_name(part)) for part in parts] if parts not in ([], [name]) else [read_run(path)]


def part_names(plate: Path) -> list[str]:
    """The names of the parts' files of a run, by its plate's file; raises ValueError where that is none."""
    _run(plate, "plate")
    with opened(plate) as file, readable(plate, plate):
        name, parts = split(plate)[0], json.loads(file["active_surface"].attrs.get("parts", "[]"))
        if wrong := [part for part in parts if not re.fullmatch(r"[\w-]+", part)]:
            raise ValueError(f"it has a part with the name {wrong[0]!r}")
        return [f"{name}.{part}" for part in parts] or [name]


def _surface(plate: h5py.File) -> dict[str, Any]:
    """What the plate's file holds beside its steps; raises ValueError where that does not fit together."""
    points, corners = (np.asarray(plate[f"VTKHDF/{name}"][()]) for name in ("Points", "Connectivity"))
    triangles = checked_cells(points, corners)
    found = json.loads(plate["active_surface"].attrs["summary"]).get("overlaps", ())
    overlaps = tuple(Overlap(tuple(one["parts"]), float(one["time"])) for one in found)
    fields = tuple(plate["VTKHDF/PointData"])
    return {"points": points[:, :2], "triangles": triangles, "plate_fields": fields, "overlaps": overlaps}


def _read(part: h5py.File, surface: dict[str, Any], paths: dict[str, Path], k: int) -> SavedRun:
    """What both files hold, with their first k steps."""
    ours, fields, points = part["active_surface"], part["VTKHDF/PointData"], surface["points"]
    rows = Samples(**{name: rows[()] for name, rows in ours["rows"].items() if name in Samples._fields})
    numbered = (*EVENT_NUMBERS, "heading") if "heading" in ours["events"] else EVENT_NUMBERS
    columns = (ours["events"][name][()].tolist() for name in (EVENT_KIND, *numbered, EVENT_PLACE))
    texts, time = {key: json.loads(ours.attrs[key]) for key in ("summary", "versions", "units")}, part[TIMES][:k]
    step = checked_count("NumberOfPoints", part["VTKHDF/NumberOfPoints"][0])  # of which the first is the middle
    given: dict[str, Any] = {name: fields[name][: k * step : step] if name in fields else None for name in OPTIONAL}
    end, renamed = summary_of(texts["summary"]).end_time, not any(split(path)[2] for path in paths.values())
    return SavedRun(
        name=split(paths["part"])[0],
        complete=renamed and bool(time[-1] >= end),
        **texts,
        time=time,
        **surface,
        actuators=points[: checked_count("actuators", ours.attrs["actuators"], len(points))],
        position=part["VTKHDF/Points"][: k * step : step],
        **{name: fields[name][: k * step : step] for name in OF_PART},
        **given,
        events=[
            Event(EventKind(kind), position=(place[0], place[1]), **dict(zip(numbered, numbers, strict=True)))
            for kind, *numbers, place in zip(*columns, strict=True)
        ],
        rows=rows,
        event_actuators=ours["events"]["actuator"][()],
        margins=MarginCurves(**{name: ours["margins"][name][()] for name in MarginCurves._fields}),
        plate_path=paths["plate"],
        part_path=paths["part"],
    )


def _check(run: SavedRun, k: int) -> None:
    """Raises ValueError where what was read of a part over k steps does not fit together."""
    given = [name for name in OPTIONAL if getattr(run, name) is not None]
    of_each = dict.fromkeys(("time", "state", "normal_force", "friction_force", *given), (k,))
    check_numbers("the part", vars(run), {**of_each, "position": (k, 3), "velocity": (k, 3)})
    for group, one in (("rows", run.rows), ("margins", run.margins)):
        vectors = {name: (len(one.time), 2) for name in ("position", "velocity") if group == "rows"}
        columns = {name: column for name, column in one._asdict().items() if column is not None}  # None: for faces only
        check_numbers(group, columns, {**dict.fromkeys(columns, (len(one.time),)), **vectors})
    check_numbers("events", {"actuator": run.event_actuators}, {"actuator": (len(run.events),)})
    for states in (run.state, run.rows.state):
        if states.dtype.kind not in "iu" or not np.isin(states, list(State)).all():
            raise ValueError("a state is none of the part's")
    if not ((np.diff(run.time) > 0).all() and (np.diff(run.rows.time) >= 0).all()):
        raise ValueError("a time is not later than the one before")


def _pair(path: Path) -> dict[str, Path]:
    """The two files of a run by their kinds: those of one run, finished ones first."""
    name, kind, _ = split(path)
    found: dict[str, list[Path]] = {}
    for one in KINDS:
        both = [path] if one == kind else [path.with_name(f"{name}{part}.{one}{SUFFIX}") for part in ("", PARTIAL)]
        found[one] = [file for file in both if file.is_file()]
    if found["part"] and kind != "plate":  # it may share its plate with other parts
        shared = [path.with_name(f"{name.rpartition('.')[0]}{part}.plate{SUFFIX}") for part in ("", PARTIAL)]
        found["plate"] += [file for file in shared if file.is_file()]
    if missing := [one for one in KINDS if not found[one]]:
        if kind is None and not any(found.values()) and (other := described(path)):
            raise ValueError(f"{EXPECTED}; got {path}, {other}")
        if found["plate"] and (parts := part_names(found["plate"][0])) != [name]:
            one_of = " or ".join(str(path.with_name(part)) for part in parts)
            raise ValueError(f"{EXPECTED} of one part; got {path}, of {len(parts)}: name {one_of}")
        one = kind if kind in missing else missing[0]
        file = path if one == kind else path.with_name(f"{name}.{one}{SUFFIX}")
        beside = meant(path.with_name(name)) if kind in (None, one) else ", the other file of this run"
        raise ValueError(f"{EXPECTED}; got {path}, but there is no {file}{beside}")
    for plate, part in product(*found.values()):
        if _run(plate, "plate") == _run(part, "part"):
            return {"plate": plate, "part": part}
    raise ValueError(f"{EXPECTED}; got {path}, but {found['plate'][0]} and {found['part'][0]} are of different runs")


def name_of(path: Path) -> str:
    """The NAME of a run, from one of its files or from FOLDER/NAME."""
    return split(path)[0]


def is_run(path: Path) -> bool:
    """Whether a path is that of a run's file, or FOLDER/NAME of such files, even of one that is damaged."""
    if split(path)[1] is not None:
        return path.is_file()
    return any(path.with_name(path.name + ending).is_file() for ending in ENDINGS)


def instead(path: Path) -> str:
    """What a path that is no result leads to, and what may be meant."""
    return described(path) or f"which is no file{meant(path)}"


def _run(path: Path, kind: str) -> str:
    if not survives(path):
        raise ValueError(f"{EXPECTED}; got {path}, which is damaged: {DEADLY}")
    with opened(path) as file, readable(path, path):
        check_hdf5(path, "VTKHDF/PointData")
        run, data_type = str(file["active_surface"].attrs["run"]), file["VTKHDF"].attrs["Type"].decode()
    if data_type != KINDS[kind]:
        raise ValueError(f"{EXPECTED}; got {path}, which holds no {kind}, though its name ends in .{kind}{SUFFIX}")
    return run
