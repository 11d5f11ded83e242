"""Portrait: what pictures show of a run, whether it has just ended or is read from its files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common import unit_for
from coupling.case import Case, PlateCase
from coupling.display import most_deflected, moving_heights, onto_plate
from coupling.drives import travel
from coupling.margins import LOSSES, MarginCurves, Margins
from coupling.pictures.plate import PlateView, Relief
from coupling.progress import silent
from coupling.result import Result
from coupling.results import SavedRun
from coupling.scene import Scene, lifts_of, platform_scene
from coupling.summary import Summary, summary_of
from particle import AnyDrive, Event, EventKind, Samples, SegmentDrive, Trajectory

FloatArray = NDArray[np.float64]

SAMPLES, MAX_SAMPLES = 1500, 100_000
PER_CYCLE = 24  # samples, of the fastest drive
MAX_DRIVES = 3  # drawn; of more, those that the margins name, or the one nearest to the start
BATCH = 64  # times whose deflections are computed or read together
JUMP = ("vertical_velocity", "normal_force", "friction_force")  # with velocities, where the state changes
BETWEEN = 4  # pieces of a line from one moment to the next


@dataclass(frozen=True, eq=False)
class Portrait:
    """A run as pictures show it."""

    name: str
    case: Case
    summary: Summary
    sentence: str  # how it ended
    rows: Samples | Trajectory  # where states change, among others
    samples: Samples  # as many as make smooth lines
    events: Sequence[Event]
    margins: MarginCurves
    box: FloatArray  # (2, 2) m, around the surface as drawn
    plate: PlateView | None  # at the moment; None: there is a platform
    moment: float  # s
    lifts: Sequence[AnyDrive]  # of the actuators or the platform
    base: Sequence[AnyDrive]  # of a platform, along x and y, and its turn; none: the surface stays in its plane
    complete: bool = True  # whether the files hold the run to its end

    @cached_property
    def drives(self) -> Mapping[str, AnyDrive]:
        """Those whose heights are drawn, by name."""
        return chosen_drives(self.case, self.lifts, self.summary.margins)

    @cached_property
    def cycles(self) -> list[float]:
        """The times [s] of one cycle of the drives that move, the shortest first; none: the motion was measured."""
        return [] if self.summary.motion_fits else cycles_of([*self.lifts, *self.base])

    @property
    def decisive(self) -> float:
        """When it was lost, first slipped or came nearest to slipping [s]."""
        return decisive_moment(self.events, self.summary.margins)

    @property
    def when(self) -> str:
        """The moment, with its unit."""
        unit = unit_for(self.samples.time[-1], "s")
        return f"{self.moment * unit.per_si:.4g} {unit.name}"

    @property
    def why(self) -> str:
        """What happens at the decisive moment."""
        kinds = {event.kind for event in self.events}
        if kinds.intersection(LOSSES):
            return "when it is lost"
        return "when it first slips" if EventKind.SLIPS in kinds else "when it is nearest to slipping"

    @property
    def where(self) -> str:
        """What positions are counted from, where it is not the plate."""
        return f" on {self.summary.origin}" if self.base else ""

    @property
    def most(self) -> str:
        """Why the surface is drawn at that moment."""
        return "when it is deflected most" + ("" if self.complete else " of the steps that were written")


def portrait_of(run: Result | SavedRun) -> Portrait:
    """The portrait of a run that has just ended, or is read from its files."""
    return _of_saved(run) if isinstance(run, SavedRun) else _of_result(run)


def _of_result(result: Result) -> Portrait:
    scene, trajectory, surface = result.scene, result.trajectory, result.ground
    moment, end = deflected_most(scene, surface.deflection, result.frames), float(trajectory.time[-1])
    drives = [*scene.lifts, *scene.base]
    cycles = end * max(drive.frequency for drive in dict.fromkeys(drives) if travel(drive) > 0 or drive is drives[0])
    count = int(np.clip(PER_CYCLE * cycles, SAMPLES, MAX_SAMPLES))
    samples = trajectory.at(even_times(trajectory.time, count, trajectory.events))
    plate = None
    if scene.shapes is not None:
        shapes, heights = scene.moving_shapes, moving_heights(scene, np.array([moment]))

        def exact(points: FloatArray) -> FloatArray:
            return shapes.values(onto_plate(shapes.outline, points), heights.T)[:, 0]

        relief = Relief(surface.points, surface.triangles, surface.deflection(heights)[0], exact)
        plate = PlateView(shapes.outline, shapes.points, relief)
    return Portrait(
        result.case.name,
        result.case,
        result.summary,
        trajectory.sentence,
        trajectory,
        samples,
        trajectory.events,
        result.margin_curves,
        _box(surface.points),
        plate,
        moment,
        scene.lifts,
        scene.base,
    )


def _of_saved(run: SavedRun) -> Portrait:
    case, plate = run.case, None
    every = range(0, len(run.time), BATCH)
    fields = (run.plate_field("deflection", slice(start, start + BATCH)).astype(float) for start in every)
    step = most_deflected(np.concatenate([np.square(w).mean(axis=1) for w in fields]))
    if isinstance(case.plate, PlateCase):
        relief = Relief(run.points, run.triangles, run.plate_field("deflection", step).astype(float))
        plate = PlateView(case.plate.coarse_mesh.outline, run.actuators, relief)
        lifts: Sequence[AnyDrive] = lifts_of(case)
        base: Sequence[AnyDrive] = ()
    else:
        scene = platform_scene(case.plate, silent)
        lifts, base = scene.lifts, scene.base
    return Portrait(
        run.name,
        case,
        summary_of(run.summary),
        run.summary["sentence"],
        run.rows,
        samples_of(run),
        run.events,
        run.margins,
        _box(run.points),
        plate,
        float(run.time[step]),
        lifts,
        base,
        run.complete,
    )


def even_times(rows: FloatArray, count: int, events: Sequence[Event]) -> FloatArray:
    """About so many even times [s] and those of events; at a row nearby, of rows (n,) [s], as these cost nothing."""
    even = np.linspace(rows[0], rows[-1], count)
    after = np.searchsorted(rows, even)
    before = np.maximum(after - 1, 0)
    nearest = rows[np.where(rows[after] - even < even - rows[before], after, before)]
    near = np.abs(nearest - even) < (even[1] - even[0]) / 2
    return np.union1d(np.where(near, nearest, even), [event.time for event in events])


def _box(points: FloatArray) -> FloatArray:
    return np.stack([points.min(axis=0), points.max(axis=0)])


def samples_of(run: SavedRun) -> Samples:
    """All that the files know of the part, with cubics for the places in between."""
    from scipy.interpolate import CubicHermiteSpline  # here, because the run itself does without it

    steps = Samples(
        run.time,
        run.position[:, :2],
        run.velocity[:, :2],
        run.velocity[:, 2],
        run.position[:, 2],
        run.normal_force,
        run.friction_force,
        run.state,
    )
    _, chosen = np.unique(np.concatenate([run.rows.time, steps.time]), return_index=True)
    pairs: Any = ((ours, theirs) for ours, theirs in zip(run.rows, steps, strict=True) if theirs is not None)
    known = Samples(*(np.concatenate(pair)[chosen] for pair in pairs))
    places = np.arange((len(known.time) - 1) * BETWEEN + 1) / BETWEEN
    before = places.astype(np.int64)
    time = np.interp(places, np.arange(len(known.time)), known.time)
    line = CubicHermiteSpline(known.time, known.position, known.velocity) if len(known.time) > 1 else None
    changes = np.append(known.state[1:] != known.state[:-1], False)[before]
    last = changes & (places % 1 == (BETWEEN - 1) / BETWEEN)
    time[last] = np.nextafter(known.time[before[last] + 1], -np.inf)  # what jumps does so at once

    def between(values: FloatArray) -> FloatArray:
        """Values (k,) at the times in between; before the state changes they stay."""
        column = np.interp(time, known.time, values)
        return np.where(changes, values[before], column)

    columns = {
        "velocity": np.stack([between(values) for values in known.velocity.T], axis=1),
        "height": np.interp(time, known.time, known.height),
        **{name: between(getattr(known, name)) for name in JUMP},
    }
    return Samples(time, line(time) if line else known.position, state=known.state[before], **columns)


def cycles_of(drives: Sequence[AnyDrive]) -> list[float]:
    """The times [s] of one cycle of the drives that move, each once, the shortest first."""
    found = set()
    for drive in dict.fromkeys(drives):
        if travel(drive) > 0:
            pieces = drive.segments()
            repeats = pieces.repeats > 1 and not isinstance(drive, SegmentDrive)  # whose pass has many cycles
            found.add(pieces.span if repeats else 1 / drive.frequency)
    return sorted(found)


def chosen_drives(case: Case, lifts: Sequence[AnyDrive], margins: Margins) -> dict[str, AnyDrive]:
    """The drives whose heights are drawn, by name: all of a few, of many those whose margins count."""
    if not case.actuators:
        return {"platform": lifts[0]}
    moves = {drive: travel(drive) > 0 for drive in dict.fromkeys(lifts)}  # many of a lattice are equal
    moving = [k for k, drive in enumerate(lifts) if case.actuators[k].force is None and moves[drive]]
    if len(moving) > MAX_DRIVES:
        named = {one.actuator for one in (margins.slip, margins.contact) if one is not None} & set(moving)
        places = np.array([case.actuators[k].position for k in moving]) - case.part.position
        moving = sorted(k for k in named if k is not None) or [moving[int(np.argmin(np.hypot(*places.T)))]]
    return {f"actuator {k}": lifts[k] for k in moving}


def decisive_moment(events: Sequence[Event], margins: Margins) -> float:
    """When the part was lost; else when it first slipped; else when it came nearest to that [s]."""
    lost = [event.time for event in events if event.kind in LOSSES]
    slips = [event.time for event in events if event.kind is EventKind.SLIPS]
    nearest = [one.time for one in (margins.slip, margins.contact) if one is not None]
    return float((lost[-1:] or slips[:1] or nearest[:1] or [0.0])[0])


def deflected_most(scene: Scene, deflection: Callable[[FloatArray], FloatArray], times: FloatArray) -> float:
    """The first of times (k,) [s] at which the surface is deflected the most."""
    heights = moving_heights(scene, times)
    batches = (heights[start : start + BATCH] for start in range(0, len(times), BATCH))
    mean_squares = [np.square(deflection(batch)).mean(axis=1) for batch in batches]
    return float(times[most_deflected(np.concatenate(mean_squares))])
