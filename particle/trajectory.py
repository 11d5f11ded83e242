"""Trajectory: what the integrator found, with its ledger of energy, for people."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from common import draw, notebook_html
from particle.modes import Outcome, State
from particle.samples import (
    ContactSamples,
    Event,
    RoughContact,
    Samples,
    contact_samples_of,
    dataset_of,
    samples_of,
    table_of,
)
from particle.types import FloatArray, IntArray

if TYPE_CHECKING:
    import pandas
    import xarray

    from common import Axes, Figure


MIN_ENERGY = 1e-6
_FOR_GOOD = "The part is at rest, and the drives do not move it again."
_IN_FLIGHT = "The part is in flight at the end of the run."
_FOR_NOW = "The part rests between slips at the end of the run."


@dataclass(frozen=True, eq=False)
class Energy:
    """The energy ledger at the rows of a trajectory: kinetic + potential grow by work - dissipated."""

    kinetic: FloatArray = field(repr=False)  # (n,) J, seen by one at rest
    potential: FloatArray = field(repr=False)  # (n,) J, of gravity
    work: FloatArray = field(repr=False)  # (n,) J, of the moving surface and what squeezes on the part since the start
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


@dataclass(frozen=True, eq=False)
class FilmEnergy:
    """The energy ledger of a film of air at the rows of a trajectory: what it stores grows by work - heat.

    It is that of Galerkin's equations, quadratic in p/p_a - 1, and so a check of the numerics.
    """

    stored: FloatArray = field(repr=False)  # (n,) J, p_a/2 int h (p/p_a - 1)^2 dA
    work: FloatArray = field(repr=False)  # (n,) J, -int (p - p_a) (1 + (p/p_a - 1)/2) h_t dA dt since the start
    heat: FloatArray = field(repr=False)  # (n,) J, what the air lost by its flow since the start

    @property
    def balance(self) -> float:
        """The largest gap in the ledger, relative to the largest of its entries."""
        gap = self.stored - self.stored[0] - (self.work - self.heat)
        largest = max(float(np.abs(entry).max()) for entry in (self.stored, self.work, self.heat))
        return float(np.abs(gap).max()) / largest if largest > 0 else 0.0


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
    state: IntArray  # (n,) State
    events: list[Event]
    outcome: Outcome
    evaluations: int  # of the surface
    energy: Energy
    sampler: Callable[[FloatArray], NDArray[Any]]  # rows at ascending times
    contact: Callable[[NDArray[Any]], NDArray[Any]]  # rows of `ContactState` at rows
    heading: FloatArray | None = None  # (n,) rad, of a part with a face, as are these
    spin: FloatArray | None = None  # (n,) rad/s
    pressure_margin: FloatArray | None = None  # (n,) the least pressure over the mean; below 0 an edge lifts
    gap: FloatArray | None = None  # (n,) m, the mean under a part on a film of air, as are these
    air_force: FloatArray | None = None  # (n,) N, of the film, a share of the normal force
    film_energy: FilmEnergy | None = field(default=None, repr=False)
    future: Callable[[], bool | None] | None = None  # of a part that rests at the end
    _last: list[NDArray[Any]] = field(default_factory=list, init=False, repr=False)  # times, and the rows there

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
        times : float or array (k,)
            Times, s.

        Returns
        -------
        samples : Samples
            The part at these times.

        Raises
        ------
        ValueError
            A time is no number.
        """
        return samples_of(self._rows_at(times), self.heading is not None, self.gap is not None)

    def contact_at(self, times: ArrayLike, friction: RoughContact | None = None) -> ContactSamples:
        """Contact and centre of mass in space at times, and the forces on the part there.

        Parameters
        ----------
        times : float or array (k,)
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
            A time is no number.
        """
        rows = self._rows_at(times)
        return contact_samples_of(rows, self.contact(rows), friction)

    def to_xarray(self, times: ArrayLike | None = None) -> xarray.Dataset:
        """The path as labelled arrays.

        Parameters
        ----------
        times : float or array (k,), optional
            Times, s; by default those of all rows. Each comes once, at an event with the values from then on.

        Returns
        -------
        dataset : xarray.Dataset
            Over `time`: x, y, z, vx, vy, vz, normal_force, friction_force and state; over `event`: event_time,
            event_kind, event_x, event_y, event_speed and event_load; of a part with a face also heading, spin and
            pressure_margin, of one on a film of air gap and air_force. All have their units as attributes.

        Raises
        ------
        ValueError
            A time is no number.
        """
        return dataset_of(self._samples(times), self.events, outcome=self.outcome.value, sentence=self.sentence)

    def to_dataframe(self, times: ArrayLike | None = None) -> pandas.DataFrame:
        """The path as a table with a row for each time, its index; units are in `attrs["units"]`.

        Parameters
        ----------
        times : float or array (k,), optional
            Times, s, as of `to_xarray`.

        Returns
        -------
        table : pandas.DataFrame
            x, y, z, vx, vy, vz, normal_force, friction_force, state in words, and what a face has besides.

        Raises
        ------
        ValueError
            A time is no number.
        """
        return table_of(self._samples(times), outcome=self.outcome.value, sentence=self.sentence)

    def _samples(self, times: ArrayLike | None) -> Samples:
        """Samples at ascending times, by default all rows."""
        if times is not None:
            return self.at(np.sort(_seconds(times)))
        return Samples(*(getattr(self, name) for name in Samples._fields))

    def _rows_at(self, times: ArrayLike) -> NDArray[Any]:
        """The rows (k,) at times (k,) [s] in any order."""
        at = _seconds(times)
        last = tuple(self._last)
        if last and np.array_equal(last[0], at):
            return last[1].copy()
        within = np.clip(at, self.time[0], self.time[-1])
        order = np.argsort(within, kind="stable")
        ordered = self.sampler(within[order])
        rows = np.empty_like(ordered)
        rows[order] = ordered
        self._last[:] = at.copy(), rows
        return rows.copy()

    def __repr__(self) -> str:
        found = f"{len(self.time)} rows, {len(self.events)} events"
        way = f"{self.distance:.4g} m from the start over a path of {self.path_length:.4g} m"
        return f"Trajectory of {self.time[-1]:.4g} s: {self.outcome}, {way}; {found}"

    def plot(self, axes: Axes | None = None) -> Figure:
        """Draw the path and the speed over time; with axes only the path, into these. Axes are in SI units."""
        return draw(self, axes)

    _repr_html_ = notebook_html


def _seconds(times: ArrayLike) -> FloatArray:
    """Times (k,), of a single one (1,); raises ValueError where one is no number."""
    try:
        at = np.ravel(np.asarray(times, dtype=float))
    except (TypeError, ValueError):  # text, or rows of different lengths
        raise ValueError(f"Input times of Trajectory must be numbers; got {times!r}") from None
    if np.isnan(at).any():
        raise ValueError("Input times of Trajectory must be numbers; got nan")
    return at
