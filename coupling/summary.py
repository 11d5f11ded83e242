"""Summary: a run in numbers, including those that tell where it leaves the model; `report` says them in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter, ValidationError

from coupling.air import AirFigures, air_figures
from coupling.borders import Thresholds, thresholds_of
from coupling.case import Case
from coupling.display import frame_times
from coupling.drives import fastest, first_jump
from coupling.margins import Margins, PathLoads, margins_of
from coupling.measured import MotionFit
from coupling.plate_figures import PlateFigures, plate_figures
from coupling.scene import PlateScene, Scene
from particle import EventKind, State, Trajectory
from particle.friction import Contact

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Summary:
    """A run in numbers."""

    outcome: str
    sentence: str
    origin: str  # what positions are counted from
    end_time: float  # s
    duration: float  # s, asked for
    at_rest_since: float | None  # s; None: it does not rest at the end
    end_position: tuple[float, float]  # m
    end_heading: float | None  # rad, counter-clockwise, whole turns counted; None: a point, as for the next three
    turned: float | None  # rad, from start to end
    least_pressure: float | None  # under the part over the mean, adhesion included: 0 where an edge lifts; None: no law
    pressure: str | None  # how it presses: "linear", "uniform" or "local" over the face
    distance: float  # m, from start to end
    path_length: float  # m
    time_stuck: float  # s
    time_slipping: float  # s
    time_flying: float  # s
    slips: int
    flights: int  # that it went on with after it had come off
    landings: int
    evaluations: int
    scheme: str
    gravity: float | tuple[float, float, float]  # m/s^2
    squeeze: float  # N
    motion_fits: tuple[MotionFit, ...]  # of a measured motion
    noise_pull: float | None  # that its noise alone gives a part at rest, over the friction limit; None: not measured
    load_unbounded: bool  # whether the friction law has no pull-off, whatever the load
    drive_error: float  # of the drives' pieces, relative to the stroke
    drive_jump: float | None  # s, the first jump of a drive's velocity on the way; None: there is none
    contact_error: float  # relative, of the tabulated friction limit, measured
    energy_balance: float  # the largest gap in the energy ledger over the largest of its entries
    path_error: float  # m, end point against a run at a hundredth of the tolerance
    same_events: bool  # whether that run has the same kinds of events in the same order
    path_resolution: float  # m, the tolerance of one step
    margins: Margins
    thresholds: Thresholds | None  # of a part that hardly moved or was lost, where a factor scales its drives
    air: AirFigures | None  # under the part; None: it has no size
    frames_per_cycle: float | None  # steps in files to a cycle of the fastest drive; None: measured, or nothing moves

    def as_dict(self) -> dict[str, Any]:
        """The figures by name; those of a plate are None where there is none."""
        return dict.fromkeys(field.name for field in fields(PlateFigures)) | asdict(self)


@dataclass(frozen=True)
class PlateSummary(PlateFigures, Summary):
    """A run on a plate in numbers."""


def summary_of(figures: Mapping[str, Any]) -> Summary:
    """The summary whose `as_dict`, written as JSON and read again, gave these figures.

    Raises ValueError where one is missing or has another form.
    """
    try:
        return _reader(figures["plate_unknowns"] is not None).validate_python(figures)
    except (KeyError, ValidationError) as error:
        wrong = ["plate_unknowns"] if isinstance(error, KeyError) else [str(one["loc"][0]) for one in error.errors()]
        text = f"the summary has no valid {', '.join(dict.fromkeys(wrong))}, as that of another version may"
        raise ValueError(text) from None


@cache
def _reader(of_plate: bool) -> TypeAdapter[Summary]:
    return TypeAdapter(PlateSummary if of_plate else Summary)


def summarise(case: Case, scene: Scene, loads: PathLoads, tighter: Trajectory, friction: Contact) -> Summary:
    """The run's summary; `tighter` is the same run at a hundredth of the tolerance, or with half the time step."""
    trajectory = loads.trajectory
    same = [e.kind for e in trajectory.events] == [e.kind for e in tighter.events]
    moved = float(np.hypot(*(trajectory.position[-1] - tighter.position[-1])))
    drives = [*scene.lifts, *scene.base]
    landings = sum(event.kind is EventKind.LANDS for event in trajectory.events)
    summary = Summary(
        outcome=trajectory.outcome.value,
        sentence=trajectory.sentence,
        origin=scene.origin,
        end_time=float(trajectory.time[-1]),
        duration=case.run.duration,
        at_rest_since=trajectory.at_rest_since,
        end_position=(float(trajectory.position[-1, 0]), float(trajectory.position[-1, 1])),
        **_face(trajectory, friction),
        pressure=None if case.part.face is None else "local" if case.part.local_contact else case.part.pressure,
        distance=trajectory.distance,
        path_length=trajectory.path_length,
        time_stuck=trajectory.time_in(State.STICK),
        time_slipping=trajectory.time_in(State.SLIP),
        time_flying=trajectory.time_in(State.FLIGHT),
        slips=sum(event.kind is EventKind.SLIPS for event in trajectory.events),
        flights=landings + int(trajectory.state[-1] == State.FLIGHT),
        landings=landings,
        evaluations=int(trajectory.evaluations),
        scheme=case.run.scheme,
        gravity=case.run.gravity,
        squeeze=case.part.squeeze,
        motion_fits=scene.fits,
        noise_pull=_noise_pull(case, scene, friction),
        load_unbounded=math.isinf(friction.pull_off),
        drive_error=max((drive.error for drive in drives), default=0.0),
        drive_jump=first_jump(drives, float(trajectory.time[-1])),
        contact_error=friction.table_error,
        energy_balance=trajectory.energy.balance,
        path_error=moved,
        same_events=same,
        path_resolution=case.run.tolerance * scene.surface.size,
        margins=margins_of(scene, loads),
        thresholds=thresholds_of(case, scene, trajectory, friction),
        air=air_figures(case, scene, trajectory, friction),
        frames_per_cycle=None if scene.fits else _frames_per_cycle(case, scene, float(trajectory.time[-1])),
    )
    if isinstance(scene, PlateScene):
        return PlateSummary(**vars(summary), **vars(plate_figures(case, scene, trajectory, friction)))
    return summary


def _face(trajectory: Trajectory, friction: Contact) -> dict[str, float | None]:
    """The figures of a part with a face."""
    heading, margin, load = trajectory.heading, trajectory.pressure_margin, trajectory.normal_force
    if heading is None or margin is None:
        return dict.fromkeys(("end_heading", "turned", "least_pressure"))
    ratios = least_pressure(margin, load, trajectory.air_force, friction.pull_off)
    least = float(np.nanmin(ratios)) if np.isfinite(ratios).any() else None
    return {"end_heading": float(heading[-1]), "turned": float(heading[-1] - heading[0]), "least_pressure": least}


def least_pressure(margin: FloatArray, load: FloatArray, air: FloatArray | None, pull_off: float) -> FloatArray:
    """The least pressure on a face over the mean, both with adhesion; nan where nothing presses or all is borne.

    air: what a film bears of the load [N], of which margin and pressure have no share.
    """
    load = load if air is None else load - air
    presses = load + pull_off > 0 if math.isfinite(pull_off) else np.zeros(len(load), dtype=bool)
    return np.divide(margin * load + pull_off, load + pull_off, out=np.full(len(load), np.nan), where=presses)


def _frames_per_cycle(case: Case, scene: Scene, end: float) -> float | None:
    cycles = end * fastest([*scene.lifts, *scene.base])
    return (len(frame_times(case, scene, end)) - 1) / cycles if cycles > 0 else None


def _noise_pull(case: Case, scene: Scene, friction: Contact) -> float | None:
    """The root mean square of the noise's force along the platform over the friction limit under the weight."""
    if not scene.fits:
        return None
    shaken = float(np.hypot.reduce([fit.noise_acceleration for fit in scene.fits if fit.axis != "z"] or [0.0]))
    weight = case.part.mass * float(np.linalg.norm(case.run.gravity)) + case.part.squeeze
    limit = friction.law.static_ratio * float(friction.friction_limit(min(weight, friction.largest_load)))
    return case.part.mass * shaken / limit if limit > 0 else None
