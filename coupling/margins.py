"""Margins: how near a part came to slipping while it was stuck, and to coming off while it was in contact."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case
from coupling.drives import stroke_heights
from coupling.part import build_part
from coupling.scene import PlateScene, Scene
from particle import (
    EventKind,
    Extreme,
    State,
    SurfaceMotion,
    Trajectory,
    largest,
    part_record,
    pull_ratios,
    sample_times,
)
from particle.events import Part
from particle.friction import LOCAL, Contact

FloatArray = NDArray[np.float64]

PER_STROKE: Final = 24  # moments in the shortest stroke
LOSSES: Final = (EventKind.DETACHES, EventKind.OVERLOADS, EventKind.LEAVES_PLATE, EventKind.TIPS)  # that end a path
MAX_NAMED: Final = 1000  # events whose actuators are sought
MAX_SHARES: Final = 500_000  # of actuators at places that are found at once: 30 MB
AS_MUCH: Final = 1 - 1e-6  # of the largest share: the first with this much is named, as rounding must not decide


@dataclass(frozen=True)
class Margin:
    """A margin at the moment at which it is smallest."""

    value: float
    time: float  # s
    position: tuple[float, float]  # m
    actuator: int | None  # whose stroke counts most for it, by number; None: a platform, or none counts


@dataclass(frozen=True)
class Margins:
    """How near a part came to slipping and to coming off."""

    slip: Margin | None  # largest pull on it over the friction limit while it was stuck; None: not known, or never so
    contact: Margin | None  # smallest (N + pull-off force) / scale while it touched; None: no pull-off, or on a film
    pull_off: float | None  # N; None: the law has none
    scale: float  # N, the pull-off force or, where that is 0, the part's weight and squeeze
    smallest_load: float  # N, while it touched

    @property
    def by_pull_off(self) -> bool:
        """Whether the scale is the pull-off force."""
        return bool(self.pull_off)


class MarginCurves(NamedTuple):
    """The margins over time; nan where the part is not stuck, or does not touch."""

    time: FloatArray  # (k,) s
    slip: FloatArray  # (k,) pull on the part over the friction limit
    contact: FloatArray  # (k,) (N + pull-off force) / scale; nan also where the law has no pull-off


def margins_of(scene: Scene, path: PathLoads) -> Margins:
    """The margins of a run."""
    trajectory, (ratios, loads, _) = path.trajectory, path.own
    slip = largest(lambda times: _or_least(path.sampled(times)[0]), path.times, _or_least(ratios))
    load = largest(lambda times: _or_least(-path.sampled(times)[1]), path.times, _or_least(-loads))
    if len(path.slips):
        slip = Extreme(1.0, float(path.slips[0]))  # also where a blow makes it slip
    pull_off = math.inf if trajectory.gap is not None else path.part.law.pull_off  # a film bears what pulls beyond
    distance = Extreme((pull_off - load.value) / path.scale, load.time)
    loss = float(path.sampled(np.array([load.time]))[2][0])
    if off := [event.time for event in trajectory.events if event.kind is EventKind.DETACHES]:
        distance = Extreme(0.0, off[0])  # also where a blow throws it off
    return Margins(
        slip=None if slip.value == -np.inf else _margin(scene, path, slip, EventKind.SLIPS),
        contact=None if distance.value == np.inf else _margin(scene, path, distance, EventKind.DETACHES),
        pull_off=None if distance.value == np.inf else path.part.law.pull_off - loss,
        scale=path.scale,
        smallest_load=loss - load.value,
    )


def _or_least(values: FloatArray) -> FloatArray:
    """A signal (k,), -inf where it is nan."""
    return np.where(np.isnan(values), -np.inf, values)


def event_actuators(scene: Scene, path: PathLoads) -> NDArray[np.int64]:
    """The actuator (e,) whose stroke counts most when the part slips or comes off; -1: none, or another event."""
    trajectory, numbers = path.trajectory, np.full(len(path.trajectory.events), -1)
    for kind in (EventKind.SLIPS, EventKind.DETACHES):
        rows = [k for k, event in enumerate(trajectory.events[:MAX_NAMED]) if event.kind is kind]
        places = np.array([trajectory.events[k].position for k in rows]).reshape(-1, 2)
        numbers[rows] = _actuators(scene, path, places, np.array([trajectory.events[k].time for k in rows]), kind)
    return numbers


class PathLoads:
    """The loads on the part along its path; `times` (k,) [s] are the moments at which margins are sampled."""

    def __init__(self, case: Case, surface: SurfaceMotion, trajectory: Trajectory, friction: Contact) -> None:
        self.part: Part = part_record(surface, build_part(case), friction, case.run.gravity)
        self.trajectory = trajectory
        self.times = np.union1d(sample_times(surface, 0.0, float(trajectory.time[-1]), PER_STROKE), trajectory.time)
        self.slips = np.array([event.time for event in trajectory.events if event.kind is EventKind.SLIPS])

    @property
    def scale(self) -> float:
        """What distances from pull-off are over [N]."""
        part, pull_off = self.part, self.part.law.pull_off
        weight = part.mass * abs(part.gravity) + part.squeeze
        return pull_off if 0 < pull_off < np.inf else weight or part.mass

    @cached_property
    def own(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What `sampled` gives at `times`."""
        return self.sampled(self.times)

    @property
    def curves(self) -> MarginCurves:
        """The margins over time."""
        slip, load, _ = self.own
        pull_off = self.part.law.pull_off if self.trajectory.gap is None else np.inf
        contact = (load + pull_off) / self.scale if np.isfinite(pull_off) else np.full(len(load), np.nan)
        return MarginCurves(self.times, slip, contact)

    def sampled(self, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pull over the friction limit, nan unless stuck, and the load [N], nan in flight; at times (k,) [s].

        The load, on a film of air that of the asperities, is as on a flat surface as far above pull-off; the third is
        what to add for the load itself.

        A part that begins to slip counts as stuck at that moment.
        """
        samples = self.trajectory.contact_at(times)
        begins = (samples.state == State.SLIP) & np.isin(times, self.slips)
        stuck = (samples.state == State.STICK) | begins
        air = None if self.trajectory.air_force is None else self.trajectory.at(times).air_force
        own = samples.normal_force if air is None else samples.normal_force - air
        loads = np.where(samples.state == State.FLIGHT, np.nan, own)
        ratios = np.full(len(times), np.nan)
        if self.trajectory.gap is not None and self.part.law.kind == LOCAL:
            return ratios, loads, np.zeros(len(times))  # what friction gives depends on the film's gap
        ratios[stuck] = pull_ratios(self.part, loads[stuck], self.part.mass * samples.pull[stuck])
        return ratios, loads - samples.bend_loss, samples.bend_loss


def _margin(scene: Scene, path: PathLoads, extreme: Extreme, kind: EventKind) -> Margin:
    place = path.trajectory.at([extreme.time]).position
    at = (float(place[0, 0]), float(place[0, 1]))
    actuator = int(_actuators(scene, path, place, np.array([extreme.time]), kind)[0])
    return Margin(extreme.value, extreme.time, at, None if actuator < 0 else actuator)


def _actuators(
    scene: Scene, path: PathLoads, places: FloatArray, times: FloatArray, kind: EventKind
) -> NDArray[np.int64]:
    """The actuators (k,) whose strokes count most for slipping or detaching at places (k, 2) [m] and times (k,) [s].

    What an actuator does is taken from its influence shape, without the plate's inertia and stretching. It lessens the
    load by how it accelerates the place downwards. By how much the pull grows with its stroke is (3.4) in
    docs/motion.md, for small slopes. -1: none of them counts.
    """
    numbers = np.full(len(times), -1)
    if not isinstance(scene, PlateScene):
        return numbers
    on_plate = np.flatnonzero(scene.shapes.outline.gap(places) >= 0)
    at_once = max(1, MAX_SHARES // len(scene.lifts))
    for rows in (on_plate[start : start + at_once] for start in range(0, len(on_plate), at_once)):
        xy, at = places[rows], times[rows]
        value, gradient, _ = scene.shapes.evaluate(xy)  # of each actuator alone, (k, N) and (k, N, 2)
        acceleration = stroke_heights(scene.lifts, at, 2)
        shares = -value * acceleration
        if kind is EventKind.SLIPS:
            state, centre = scene.surface.evaluate_along(xy, at), path.part.centre
            b, slope = (path.part.gravity + state.w_tt)[:, None], state.gradient
            pull = -b * slope + centre * state.gradient_tt
            height = stroke_heights(scene.lifts, at)
            tilts = -b[..., None] * gradient * height[..., None] + centre * gradient * acceleration[..., None]
            each = tilts - (value * acceleration)[..., None] * slope[:, None]
            length = np.hypot(*pull.T)
            shares = (each @ pull[..., None])[..., 0] / np.where(length > 0, length, 1.0)[:, None]
        most = shares.max(axis=1, keepdims=True)
        first = (shares >= AS_MUCH * most).argmax(axis=1)  # of those that symmetry makes equal
        numbers[rows] = np.where(most[:, 0] > 0, first, -1)
    return numbers
