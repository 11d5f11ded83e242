"""Summary: a run in numbers, including those that tell where it leaves the model; `report` says them in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from coupling.case import Case
from coupling.drives import first_jump, frame_times
from coupling.measured import MotionFit
from coupling.plate_figures import PlateFigures, StretchError, VibrationFigures, plate_figures
from coupling.scene import PlateScene, Scene
from particle import AnyDrive, EventKind, State, Trajectory
from particle.friction import Contact


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
    drive_error: float  # of the drives' pieces, relative to the stroke
    drive_jump: float | None  # s, the first jump of a drive's velocity on the way; None: there is none
    contact_error: float  # relative, of the tabulated friction limit, measured
    energy_balance: float  # the largest gap in the energy ledger over the largest of its entries
    path_error: float | None  # m, end point against a run at a hundredth of the tolerance; None: other events
    path_resolution: float  # m, the tolerance of one step
    frames_per_cycle: (
        float | None
    )  # steps of the result files to a cycle of the fastest drive; None: measured, or nothing moves

    def as_dict(self) -> dict[str, Any]:
        """The figures by name; those of a plate are None where there is none."""
        return dict.fromkeys(field.name for field in fields(PlateFigures)) | asdict(self)


@dataclass(frozen=True)
class PlateSummary(PlateFigures, Summary):
    """A run on a plate in numbers."""


def summary_of(figures: Mapping[str, Any]) -> Summary:
    """The summary whose `as_dict`, written as JSON and read again, gave these figures.

    Raises ValueError when one is missing.
    """
    if lost := [field.name for field in fields(PlateSummary) if field.name not in figures]:
        raise ValueError(f"the summary lacks {', '.join(lost)}, as that of another version may")
    plain: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in figures.items()
    }
    plain["motion_fits"] = tuple(MotionFit(**fit) for fit in plain["motion_fits"])
    if plain["stretch_error"] is not None:
        plain["stretch_error"] = StretchError(**plain["stretch_error"])
    if plain["vibration"] is not None:
        plain["vibration"] = VibrationFigures(**plain["vibration"])
    kind = Summary if plain["plate_unknowns"] is None else PlateSummary
    return kind(**{field.name: plain[field.name] for field in fields(kind)})


def summarise(case: Case, scene: Scene, trajectory: Trajectory, tighter: Trajectory, friction: Contact) -> Summary:
    """The run's summary; `tighter` is the same run at a hundredth of the tolerance, or with half the time step."""
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
        drive_error=max((drive.error for drive in drives), default=0.0),
        drive_jump=first_jump(drives, float(trajectory.time[-1])),
        contact_error=friction.table_error,
        energy_balance=trajectory.energy.balance,
        path_error=moved if same else None,
        path_resolution=case.run.tolerance * scene.surface.size,
        frames_per_cycle=None if scene.fits else _frames_per_cycle(case, drives, float(trajectory.time[-1])),
    )
    if isinstance(scene, PlateScene):
        return PlateSummary(**vars(summary), **vars(plate_figures(case, scene, trajectory, friction)))
    return summary


def _frames_per_cycle(case: Case, drives: Sequence[AnyDrive], end: float) -> float | None:
    cycles = end * max(drive.frequency for drive in drives)
    return (len(frame_times(case.run.frames, drives, end)) - 1) / cycles if cycles > 0 else None
