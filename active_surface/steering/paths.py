"""Paths: where a part goes under each of many drives, over one plate with shared cells."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.robustness import Disturbance, disturbed
from active_surface.steering.task import Place, Turn, offset_of
from active_surface.studies import contact_of, start_faults
from coupling import PathTask, build_drives, build_part, follow, one_blas_thread
from coupling.case import ActuatorCase, Case
from particle import Body, Micropart, Outcome, SurfaceMotion, Trajectory
from particle.friction import Contact, ScaledFriction

SETTLING = 1e-3  # s: times its speed, the extra distance of a part that still moves
UNSETTLED = 0.1  # of the surface's size: smallest distance of a part that the drives will move again
LOST = 3.0  # of the surface's size: extra distance of a lost part, beyond all others


class Paths:
    """Computes the paths of a case's part."""

    def __init__(self, case: Case, surface: SurfaceMotion, threads: int | None = None) -> None:
        self.case, self.surface, self._threads = case, surface, threads
        self.count = 0

    def of(self, runs: Sequence[tuple[tuple[ActuatorCase, ...], Disturbance]]) -> list[Trajectory]:
        """The path of each run: its actuators, and how it is disturbed. The same bits as from the case itself."""
        cases = [disturbed(driven(self.case, actuators), way.changes) for actuators, way in runs]
        parts = self._parts(cases, np.array([way.shift for _, way in runs]).reshape(-1, 2))
        laws = [self._contact(case, way.friction) for case, (_, way) in zip(cases, runs, strict=True)]
        tasks = [
            PathTask(self.surface, part, law, self.case.run, build_drives(case))
            for part, law, case in zip(parts, laws, cases, strict=True)
        ]
        with one_blas_thread():
            trajectories = follow(tasks, self._threads)
        self.count += len(trajectories)
        return trajectories

    def _contact(self, case: Case, factor: float) -> Contact:
        contact = contact_of(case)
        if isinstance(contact, str):
            raise ValueError(contact)
        return contact if factor == 1.0 else ScaledFriction(contact, factor)

    def _parts(self, cases: Sequence[Case], shifts: FloatArray) -> list[Micropart | Body]:
        """Parts with starts shifted by (n, 2) [m]; the other way if that is off the plate, not at all if both are."""
        starts = np.repeat(np.array([self.case.part.position]), len(shifts), axis=0)
        left = shifts.any(axis=1)
        for way in (1.0, -1.0):
            moved = starts + way * shifts
            good = left & np.array([not faults for faults in start_faults(self.case, moved)])
            starts[good] = moved[good]
            left &= ~good
        return [build_part(case, (x, y)) for case, (x, y) in zip(cases, starts.tolist(), strict=True)]


def path_of(case: Case, surface: SurfaceMotion) -> Trajectory:
    """The path of a case over a surface."""
    return Paths(case, surface, 1).of([(case.actuators, Disturbance())])[0]


def settled(trajectory: Trajectory) -> bool:
    """Whether the part has come to rest at the end and the drives will not move it again."""
    return trajectory.outcome is Outcome.STUCK and bool(trajectory.stays)


def affordable(case: Case, duration: float, cycles: float, least: int, most: int) -> int:
    """How many paths over a duration [s] have so many cycles in all at the case's highest frequency; within bounds."""
    fastest = max(actuator.frequency or 0.0 for actuator in case.actuators)
    return max(least, min(most, math.floor(cycles / max(duration * fastest, 1.0))))


def driven(case: Case, actuators: tuple[ActuatorCase, ...]) -> Case:
    """A case with other actuators."""
    return case.model_copy(update={"actuators": actuators, "source": None})


def cost(
    trajectory: Trajectory, target: Place, duration: float, size: float, tolerance: float, turn: Turn | None = None
) -> float:
    """The distance [m] of the end from a target [m] and a heading, and more for a part that has not come to rest there.

    size: m, of the surface.  tolerance: m, which only a settled part can reach.
    """
    away = float(np.hypot.reduce(offset_of(trajectory, target, turn)))
    if trajectory.outcome is Outcome.MOVING:
        speed = np.hypot(*trajectory.velocity[-1])
        if turn is not None and trajectory.spin is not None:
            speed = np.hypot(speed, turn.gyration * trajectory.spin[-1])
        away += min(SETTLING * float(speed), size)
    elif trajectory.outcome is not Outcome.STUCK:
        return away + size * (LOST + 1 - float(trajectory.time[-1]) / duration)  # the later it was lost, the better
    minimum = max(UNSETTLED * size, 2 * tolerance)
    return away if away > minimum or settled(trajectory) else minimum
