"""Portrait: what pictures show of a run, whether it has just ended or is read from its files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from common import unit_for
from coupling.case import Case
from coupling.display import most_deflected, moving_heights
from coupling.drives import travel
from coupling.margins import LOSSES, MarginCurves, Margins
from coupling.pictures.plate import Relief, relief_of
from particle import AnyDrive, Event, EventKind, Rows, Samples, SegmentDrive

if TYPE_CHECKING:
    from coupling.display import DisplaySurface
    from coupling.result import Result
    from coupling.scene import Scene

FloatArray = NDArray[np.float64]

SAMPLES, MAX_SAMPLES = 4000, 100_000
PER_CYCLE = 24  # samples, of the fastest drive
MAX_DRIVES = 3  # drawn; of more, those that the margins name, or the one nearest to the start
BATCH = 64  # times whose deflections are computed together


@dataclass(frozen=True, eq=False)
class Portrait:
    """A run as pictures show it."""

    name: str
    sentence: str  # how it ended
    origin: str  # what positions are counted from
    rows: Rows  # where states change, among others
    samples: Samples  # as many as make smooth lines
    events: Sequence[Event]
    box: FloatArray  # (2, 2) m, around the surface as drawn
    relief: Relief | None  # of the plate at the moment; None: there is a platform
    moment: float  # s
    base: Sequence[AnyDrive]  # of a platform, along x and y; none: the surface stays in its plane
    drives: Mapping[str, AnyDrive]  # by name, whose heights are drawn
    margins: MarginCurves
    by_pull_off: bool  # whether the distance from coming off is over the pull-off force, not the weight
    decisive: float  # s, when it was lost, first slipped or came nearest to slipping
    cycles: Sequence[float]  # s, of all drives that move; none: the motion was measured
    complete: bool = True  # whether the files hold the run to its end

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
        return f" on {self.origin}" if self.base else ""

    @property
    def most(self) -> str:
        """Why the surface is drawn at that moment."""
        return "when it is deflected most" + ("" if self.complete else " of the steps that were written")


def portrait_of(result: Result) -> Portrait:
    """The portrait of a run that has just ended."""
    case, scene, trajectory, surface = result.case, result.scene, result.trajectory, result.ground
    margins, moment = result.summary.margins, deflected_most(scene, surface, result.frames)
    end, drives = float(trajectory.time[-1]), [*scene.lifts, *scene.base]
    cycles = end * max(drive.frequency for drive in drives if travel(drive) > 0 or drive is drives[0])
    samples = int(np.clip(PER_CYCLE * cycles, SAMPLES, MAX_SAMPLES))
    return Portrait(
        case.name,
        trajectory.sentence,
        scene.origin,
        trajectory,
        trajectory.at(np.linspace(0, end, samples)),
        trajectory.events,
        np.stack([surface.points.min(axis=0), surface.points.max(axis=0)]),
        _relief(scene, surface, moment),
        moment,
        scene.base,
        chosen_drives(case, scene.lifts, margins),
        result.margin_curves,
        margins.by_pull_off,
        decisive_moment(trajectory.events, margins),
        () if scene.fits else cycles_of(drives),
    )


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
    moving = [k for k, drive in enumerate(lifts) if case.actuators[k].force is None and travel(drive) > 0]
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


def _relief(scene: Scene, surface: DisplaySurface, moment: float) -> Relief | None:
    if scene.shapes is None:
        return None
    return relief_of(scene.moving_shapes, surface, moving_heights(scene, np.array([moment]))[0])


def deflected_most(scene: Scene, surface: DisplaySurface, times: FloatArray) -> float:
    """The first of times (k,) [s] at which the surface is deflected the most."""
    heights = moving_heights(scene, times)
    batches = (heights[start : start + BATCH] for start in range(0, len(times), BATCH))
    mean_squares = [np.square(surface.deflection(batch)).mean(axis=1) for batch in batches]
    return float(times[most_deflected(np.concatenate(mean_squares))])
