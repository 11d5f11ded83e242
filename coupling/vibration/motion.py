"""The modes of a plate over time: how they ring under the drives of its actuators."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coupling.stretch import Schedule, breakpoints, schedule_of
from coupling.vibration.oscillators import Course, Oscillators, at_times, follow, lay_edges, lay_pieces
from coupling.vibration.steady import steady_state
from particle import AnyDrive
from particle.drives import QuinticDrive, drive_table, quintic_drives

FloatArray = NDArray[np.float64]

MAX_CHANGE = 1e-10  # of the largest acceleration: what all later passes still change
MIN_LOSS = 1e-2  # of a mode's ringing, in a pass: without damping nothing more than rounding may change
MAX_PIECES = 20_000_000  # of all modes: about 2 GB
MAX_EDGES = 500  # of intervals in which the largest acceleration is sought


@dataclass(frozen=True, eq=False)
class ModalMotion:
    """n modes under drives, from 0 to an end."""

    oscillators: Oscillators
    course: Course
    loop: int  # the interval with which a pass begins that repeats without end; -1: there is none
    drives: Sequence[AnyDrive]  # distinct, one a column of participation

    def evaluate(self, times: FloatArray) -> FloatArray:
        """Values [m], velocities and accelerations (3, k, n) at times (k,) [s], up to the end."""
        edges = self.course.edges
        if self.loop >= 0:
            begin, end = edges[self.loop], edges[-1]
            times = np.where(times < end, times, begin + np.mod(times - begin, end - begin))
        intervals = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
        return at_times(self.oscillators, self.course, intervals, np.ascontiguousarray(times))

    def chosen(self, rows: NDArray[np.bool_]) -> ModalMotion:
        """That of some of the modes (n,)."""
        o, c = self.oscillators, self.course
        oscillators = Oscillators(o.omega[rows], o.damping[rows], np.ascontiguousarray(o.participation[rows]))
        course = Course(c.edges, np.ascontiguousarray(c.forced[:, rows]), np.ascontiguousarray(c.ringing[:, rows]))
        return ModalMotion(oscillators, course, self.loop, self.drives)

    def largest_acceleration(self) -> float:
        """The modes' largest acceleration [m/s^2], where intervals begin and between; 0 without modes."""
        edges = self.course.edges[:MAX_EDGES]
        times = (edges[:-1, None] + np.diff(edges)[:, None] * np.linspace(0.0, 1.0, 8, endpoint=False)).ravel()
        return float(np.abs(self.evaluate(times)[2]).max(initial=0.0))

    def modal_drives(self, allowed: float, beside: AnyDrive | None = None) -> list[QuinticDrive]:
        """A drive for each mode [m]; allowed: m/s^2, what their accelerations may be off by.

        beside: a drive whose breakpoints serve where they can.
        Raises ValueError when that takes too many pieces.
        """
        marks = np.zeros(0) if beside is None else self._marks(beside)
        begins, intervals = lay_edges(self.oscillators, self.course, allowed, marks)
        n = len(self.oscillators.omega)
        if len(begins) * n > MAX_PIECES:
            raise ValueError(
                f"The plate's ringing takes {len(begins)} pieces in time for each of {n} modes, more than {MAX_PIECES} "
                "in all; raise plate.damping, reduce run.duration, or give drives frequencies with a common period"
            )
        rows = lay_pieces(self.oscillators, self.course, begins, intervals)
        edges = np.append(self.course.edges[intervals] + begins, self.course.edges[-1])
        loop = None if self.loop < 0 else int(np.searchsorted(intervals, self.loop))
        swing = math.pi / float(self.oscillators.omega.max())
        return quintic_drives(
            edges,
            rows,
            loop,
            min(swing, *(drive.stroke_time for drive in self.drives)),
            max(drive.frequency for drive in self.drives),
            np.zeros(len(rows)),
        )

    def _marks(self, beside: AnyDrive) -> FloatArray:
        """The breakpoints [s] of another drive; in the loop those of its own repetition."""
        edges, table = self.course.edges, drive_table([beside])
        if self.loop < 0:
            return breakpoints(table, 0.0, edges[-1])
        begin, period = edges[self.loop], edges[-1] - edges[self.loop]
        settled = beside.delay + beside.segments().lead_time
        later = max(0, math.ceil((settled - begin) / period)) * period
        in_loop = breakpoints(table, begin + later, edges[-1] + later) - later
        return np.concatenate([breakpoints(table, 0.0, begin), in_loop])


def modal_motion(oscillators: Oscillators, drives: Sequence[AnyDrive], end: float, steady: bool = False) -> ModalMotion:
    """How modes move under distinct drives, up to an end [s].

    steady: they begin in the steady state of drives that repeat without end; else the plate begins at rest.
    Raises ValueError when a mode without damping resonates.
    """
    if steady:
        state, before = steady_state(oscillators, drives)
    else:
        state, before = np.zeros((len(oscillators.omega), 2)), np.zeros((len(drives), 2))
        before[:, 0] = [drive.evaluate(0.0)[0] for drive in drives]
    schedule = schedule_of(drives, end)
    table = drive_table(drives)
    if schedule.loop < 0:
        course = _room(np.append(schedule.edges, end) if schedule.edges[-1] < end else schedule.edges, oscillators)
        follow(oscillators, table, course, before, state)
        return ModalMotion(oscillators, course, -1, drives)
    return _in_passes(oscillators, drives, schedule, end, before, state)


def _in_passes(
    oscillators: Oscillators,
    drives: Sequence[AnyDrive],
    schedule: Schedule,
    end: float,
    before: FloatArray,
    state: FloatArray,
) -> ModalMotion:
    """The motion until it repeats with the drives, or until its end [s]."""
    table, cycle = drive_table(drives), schedule.edges[schedule.loop :]
    parts = []
    if schedule.loop > 0:
        parts.append(_room(schedule.edges[: schedule.loop + 1], oscillators))
        follow(oscillators, table, parts[0], before, state)
    period, passes = cycle[-1] - cycle[0], 0
    while True:
        course, begun = _room(cycle + passes * period, oscillators), state.copy()
        follow(oscillators, table, course, before, state)
        parts.append(course)
        passes += 1
        if _settled(oscillators, course, begun, state):
            loop = sum(len(part.forced) for part in parts[:-1])
            break
        if course.edges[-1] >= end:
            loop = -1
            break
    edges = np.concatenate([parts[0].edges[:1], *(part.edges[1:] for part in parts)])
    forced, ringing = (np.concatenate([part[k] for part in parts]) for k in (1, 2))
    return ModalMotion(oscillators, Course(edges, forced, ringing), loop, drives)


def _room(edges: FloatArray, oscillators: Oscillators) -> Course:
    count, n = len(edges) - 1, len(oscillators.omega)
    return Course(np.ascontiguousarray(edges), np.zeros((count, n, 4)), np.zeros((count, n, 2)))


def _settled(oscillators: Oscillators, course: Course, begun: FloatArray, state: FloatArray) -> bool:
    """Whether a pass ends as it began, as will all later ones together."""
    omega, length = oscillators.omega, np.diff(course.edges)
    change = omega**2 * np.abs(state[:, 0] - begun[:, 0]) + omega * np.abs(state[:, 1] - begun[:, 1])
    lost = -np.expm1(-oscillators.damping * omega * (course.edges[-1] - course.edges[0]))
    intervals = np.repeat(np.arange(len(length)), 4)
    times = course.edges[:-1, None] + length[:, None] * np.linspace(0.0, 1.0, 4, endpoint=False)
    acceleration = at_times(oscillators, course, intervals, times.ravel())[2]
    return bool((change / np.maximum(lost, MIN_LOSS)).max() <= MAX_CHANGE * np.abs(acceleration).max())
