"""Trajectory: what the integrator found, for people."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicHermiteSpline

FloatArray = NDArray[np.float64]


class State(enum.IntEnum):
    """How the part is in contact."""

    STICK = 0
    SLIP = 1


class EventKind(enum.IntEnum):
    """What happens to the part at one moment."""

    SLIPS = 0
    STOPS = 1
    REVERSES = 2
    DETACHES = 3
    LEAVES_PLATE = 4
    OVERLOADS = 5


class Outcome(enum.StrEnum):
    """How a run ended; `sentence` says it in full."""

    STUCK = "stuck"
    MOVING = "moving"
    DETACHED = "detached"
    LEFT_PLATE = "left the plate"
    OVERLOADED = "overloaded"
    WORK_LIMIT = "work limit"

    @property
    def sentence(self) -> str:
        return _SENTENCES[self]


_SENTENCES = {
    Outcome.STUCK: "The part rests on the surface at the end of the run.",
    Outcome.MOVING: "The part is still sliding at the end of the run.",
    Outcome.DETACHED: "The surface pulled away faster than adhesion could follow: the part came off.",
    Outcome.LEFT_PLATE: "The part slid over the rim of the plate.",
    Outcome.OVERLOADED: "The surface pressed the part harder than the contact model covers.",
    Outcome.WORK_LIMIT: "The integrator stopped at its limit of work before the end of the run.",
}


@dataclass(frozen=True)
class Event:
    """One moment of a trajectory."""

    kind: EventKind
    time: float  # s
    position: tuple[float, float]  # m
    load: float  # N, net normal force


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The path of a part: a row at every event and every step of the integrator.

    The last row is at the run's duration, or where the run ended. A row's state holds from it to the next.
    """

    time: FloatArray  # (n,) s
    position: FloatArray  # (n, 2) m
    velocity: FloatArray  # (n, 2) m/s
    normal_force: FloatArray  # (n,) N
    friction_force: FloatArray  # (n,) N, its magnitude
    state: NDArray[np.int64]  # (n,) State
    events: list[Event] = field(repr=False)
    outcome: Outcome
    evaluations: int  # of the surface

    @property
    def distance(self) -> float:
        """How far the part ended from where it began [m]."""
        return float(np.hypot(*(self.position[-1] - self.position[0])))

    def time_in(self, state: State) -> float:
        """How long the part was in a state [s]."""
        return float(np.diff(self.time)[self.state[:-1] == state].sum())

    def at(self, times: ArrayLike) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
        """Position (k, 2) [m], velocity (k, 2) [m/s] and row (k,) at times (k,) within the run [s].

        Between rows positions follow cubics that meet the rows' positions and velocities: good to about 1e-8 m in a
        usual run, less than the rows themselves.
        """
        times = np.clip(np.asarray(times, dtype=float), self.time[0], self.time[-1])
        row = np.clip(np.searchsorted(self.time, times, side="right") - 1, 0, len(self.time) - 1)
        if len(self.time) == 1:
            return self.position[row], self.velocity[row], row
        curve = CubicHermiteSpline(self.time, self.position, self.velocity)
        return curve(times), curve(times, 1), row
