"""Trajectory: what the integrator found, for people."""

from __future__ import annotations

import enum
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.modes import EventKind, Mode

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

MIN_ENERGY = 1e-6


class State(enum.IntEnum):
    """How the part is in contact."""

    STICK = 0  # at rest on the surface
    SLIP = 1  # sliding
    FLIGHT = 2  # off the surface


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
        """What happened, in one sentence."""
        return _SENTENCES[self]


_SENTENCES = {
    Outcome.STUCK: "The part rests on the surface at the end of the run.",
    Outcome.MOVING: "The part is still on the move at the end of the run.",
    Outcome.DETACHED: "The surface pulled away faster than adhesion could follow: the part came off.",
    Outcome.LEFT_PLATE: "The part went over the rim of the plate.",
    Outcome.OVERLOADED: "The load on the part is more than the contact model covers.",
    Outcome.WORK_LIMIT: "The integrator stopped at its limit of work before the end of the run.",
}


_FOR_GOOD = "The part is at rest, and the drives do not move it again."
_IN_FLIGHT = "The part is in flight at the end of the run."
_FOR_NOW = "The part is at rest at the end of the run; the drives move it again later."


@dataclass(frozen=True)
class Event:
    """One moment of a trajectory."""

    kind: EventKind
    time: float  # s
    position: tuple[float, float]  # m
    speed: float  # m/s, in the plane; at a landing that after it
    load: float  # N, net normal force


class Samples(NamedTuple):
    """The part at k moments."""

    time: FloatArray  # (k,) s
    position: FloatArray  # (k, 2) m
    velocity: FloatArray  # (k, 2) m/s
    vertical_velocity: FloatArray  # (k,) m/s
    height: FloatArray  # (k,) m, that of the surface under it unless it flies
    normal_force: FloatArray  # (k,) N, net, of the contact
    friction_force: FloatArray  # (k,) N, its magnitude
    state: NDArray[np.int64]  # (k,) State


class RoughContact(Protocol):
    """What `KogutEtsion` knows of the parts of its normal force."""

    @property
    def pull_off(self) -> float: ...

    @property
    def largest_load(self) -> float: ...

    def separation(self, net_load: ArrayLike) -> FloatArray: ...

    def forces(self, separation: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]: ...


class ContactSamples(NamedTuple):
    """Contact and centre of mass of a part in space at k moments, and the forces on it."""

    time: FloatArray  # (k,) s
    contact: FloatArray  # (k, 3) m, where it touches the surface; in flight the place that would touch
    centre: FloatArray  # (k, 3) m, its centre of mass
    normal: FloatArray  # (k, 3) the surface's normal, along which it stands: its attitude
    normal_force: FloatArray  # (k,) N, net, along the normal
    friction: FloatArray  # (k, 3) N, on the part
    pull: FloatArray  # (k,) m/s^2, along the surface, without friction; 0 in flight
    point_pull: FloatArray  # (k,) m/s^2, the same on a point of the mid-plane
    added_pull: FloatArray  # (k,) m/s^2, the difference, which the heights of contact and centre of mass make
    separation: FloatArray  # (k,) over the roughness, of a rough contact; nan in flight and without its law
    contact_load: FloatArray  # (k,) N, pressing its asperities; nan likewise
    adhesion: FloatArray  # (k,) N, holding against it; contact_load - adhesion is the normal force; nan likewise


@dataclass(frozen=True, eq=False)
class Energy:
    """The energy ledger at the rows of a trajectory: kinetic + potential grow by work - dissipated."""

    kinetic: FloatArray = field(repr=False)  # (n,) J, seen by one at rest
    potential: FloatArray = field(repr=False)  # (n,) J, of gravity
    work: FloatArray = field(
        repr=False
    )  # (n,) J, done on the part by the moving surface (and what squeezes) since the start
    dissipated: FloatArray = field(repr=False)  # (n,) J, by friction and impacts since the start
    scale: float  # J, that of a part thrown across the surface in a stroke; a millionth of it counts as nothing

    @property
    def balance(self) -> float:
        """The largest gap in the ledger, relative to the largest of its entries: the path's own check."""
        total = self.kinetic + self.potential
        gap = total - total[0] - (self.work - self.dissipated)
        entries = (self.kinetic, self.potential - self.potential[0], self.work, self.dissipated)
        largest = max(float(np.abs(entry).max()) for entry in entries)
        return float(np.abs(gap).max()) / max(largest, MIN_ENERGY * self.scale)


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory:
    """The path of a part: a row at every event and every step of the integrator.

    The last row is at the run's duration, or where the run ended. A row's state holds from it to the next.
    """

    time: FloatArray  # (n,) s
    position: FloatArray  # (n, 2) m
    velocity: FloatArray  # (n, 2) m/s
    vertical_velocity: FloatArray  # (n,) m/s
    height: FloatArray  # (n,) m, that of the surface under it unless it flies
    normal_force: FloatArray  # (n,) N, net, of the contact
    friction_force: FloatArray  # (n,) N, its magnitude
    state: NDArray[np.int64]  # (n,) State
    events: list[Event]
    outcome: Outcome
    evaluations: int  # of the surface
    energy: Energy
    sampler: Callable[[FloatArray], NDArray[Any]]  # rows at ascending times
    contact: Callable[[NDArray[Any]], NDArray[Any]]  # rows of `ContactState` at rows
    future: Callable[[], bool | None] | None = None  # of a part that rests at the end

    @cached_property
    def stays(self) -> bool | None:
        """Whether a part that rests at the end does so for good; None: not known, or it does not rest."""
        return None if self.future is None else self.future()

    @property
    def sentence(self) -> str:
        """How the run ended."""
        if self.outcome is Outcome.STUCK and self.stays is not None:
            return _FOR_GOOD if self.stays else _FOR_NOW
        if self.outcome is Outcome.MOVING and self.state[-1] == State.FLIGHT:
            return _IN_FLIGHT
        return self.outcome.sentence

    @property
    def distance(self) -> float:
        """How far the part ended from where it began [m]."""
        return float(np.hypot(*(self.position[-1] - self.position[0])))

    @property
    def path_length(self) -> float:
        """How long the way is that it went in the plane [m]."""
        return float(np.hypot(*np.diff(self.position, axis=0).T).sum())

    @property
    def at_rest_since(self) -> float | None:
        """Since when the part has rested [s]; None: it does not rest at the end."""
        if self.outcome is not Outcome.STUCK:
            return None
        moving = np.flatnonzero(self.state != State.STICK)
        return float(self.time[moving[-1] + 1] if len(moving) else self.time[0])

    def time_in(self, state: State) -> float:
        """How long the part was in a state [s]."""
        return float(np.diff(self.time)[self.state[:-1] == state].sum())

    def at(self, times: ArrayLike) -> Samples:
        """The part at times; those before the start or after the end count as these.

        Scheme `"events"` integrates to each time from the row before it, so samples are as good as rows. Schemes with
        fixed steps take the cubic through the places and velocities of the rows around it.

        Parameters
        ----------
        times : array (k,)
            Times, s.

        Returns
        -------
        samples : Samples
            The part at these times.

        Raises
        ------
        ValueError
            A time is nan.
        """
        return samples_of(self._rows_at(times, "at"))

    def contact_at(self, times: ArrayLike, friction: RoughContact | None = None) -> ContactSamples:
        """Contact and centre of mass in space at times, and the forces on the part there.

        Parameters
        ----------
        times : array (k,)
            Times, s; those before the start or after the end count as these.
        friction : KogutEtsion, optional
            The law of the run, for the parts of the normal force.

        Returns
        -------
        samples : ContactSamples
            Places and forces at these times.

        Raises
        ------
        ValueError
            A time is nan.
        """
        rows = self._rows_at(times, "contact_at")
        states = self.contact(rows)
        vectors = (
            np.column_stack([states[head + axis] for axis in "xyz"]) for head in ("", "centre_", "normal_", "friction_")
        )
        place, centre, normal, force = vectors
        load = rows["load"]
        parts = np.full((3, len(load)), np.nan)
        touching = rows["mode"] != Mode.FLYING
        if friction is not None and touching.any():
            # The end of contact is located just beyond it, where the law has no separation.
            separation = friction.separation(np.clip(load[touching], -friction.pull_off, friction.largest_load))
            parts[:, touching] = separation, *friction.forces(separation)[:2]
        pulls = (states[name] for name in ("pull", "point_pull", "added_pull"))
        return ContactSamples(rows["time"], place, centre, normal, load, force, *pulls, *parts)

    def _rows_at(self, times: ArrayLike, caller: str) -> NDArray[Any]:
        """The rows (k,) at times (k,) [s] in any order."""
        at = np.asarray(times, dtype=float)
        if np.isnan(at).any():
            raise ValueError(f"Input times of {caller} must be numbers; got nan")
        within = np.clip(at, self.time[0], self.time[-1])
        order = np.argsort(within, kind="stable")
        ordered = self.sampler(within[order])
        rows = np.empty_like(ordered)
        rows[order] = ordered
        return rows

    def __repr__(self) -> str:
        found = f"{len(self.time)} rows, {len(self.events)} events"
        way = f"{self.distance:.4g} m from the start over a path of {self.path_length:.4g} m"
        return f"Trajectory of {self.time[-1]:.4g} s: {self.outcome}, {way}; {found}"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the path and the speed over time; with axes only the path, into these. Axes are in SI units."""
        from meshes import plotted
        from particle.pictures import plot, plot_path  # here, because matplotlib is loaded for pictures only

        return plot(self) if axes is None else plotted(lambda axes: plot_path(self, axes), axes)

    def _repr_html_(self) -> str:
        from meshes import notebook_html

        return notebook_html(self)


def samples_of(rows: NDArray[Any]) -> Samples:
    """The rows (k,) of a record, for people."""
    mode = rows["mode"]
    return Samples(
        time=rows["time"],
        position=np.column_stack([rows["x"], rows["y"]]),
        velocity=np.column_stack([rows["v_x"], rows["v_y"]]),
        vertical_velocity=rows["v_z"],
        height=rows["z"],
        normal_force=rows["load"],
        friction_force=rows["friction"],
        state=np.where(mode == Mode.MANIFOLD, State.SLIP, mode),
    )


def energy_of(rows: NDArray[Any], scale: float) -> Energy:
    """The energy ledger of a record's rows (n,); scale: J, as in `Energy`."""
    return Energy(rows["kinetic"], rows["potential"], rows["work"], rows["dissipated"], scale)
