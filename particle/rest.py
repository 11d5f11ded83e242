"""A part that stays at one place: how near it is to slipping and to coming off."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

import numpy as np

from particle.body import Body, BodyMemory, Face, new_body_memory, rest_margins, rest_responses
from particle.drives import next_breakpoint
from particle.events import Part, rest_loads
from particle.friction import Contact, friction_limits
from particle.simulation import Micropart, face_of, part_record
from particle.surface import SurfaceMotion
from particle.types import FloatArray

PER_STROKE: Final = 48  # moments in the shortest stroke
MAX_BREAKPOINTS, MAX_MOMENTS = 20_000, 400_000
BLOCK: Final = 4096  # moments at a time
TOLERANCE: Final = 1e-8  # for which points a face's surface is averaged over
CANDIDATES, POINTS, ROUNDS = 8, 17, 7  # a bracket shrinks by 8 in a round
ROUNDING: Final = 1e-9  # of the largest value: as large, up to rounding


class Extreme(NamedTuple):
    """The largest or the smallest value of a signal."""

    value: float
    time: float  # s


@dataclass(frozen=True, eq=False)
class PartAtRest:
    """A part that stays at one place of a moving surface for a while; made by `part_at_rest`."""

    surface: SurfaceMotion
    pose: tuple[float, float, float]  # m, m, rad
    part: Part = field(repr=False)
    times: FloatArray = field(repr=False)  # (n,) s, where to look for extremes first
    face: Face | None = field(default=None, repr=False)

    def scaled(self, factor: float, stroke: float = 1.0) -> PartAtRest:
        """The same under drives `factor` times as fast over `stroke` times their heights (`SurfaceMotion.scaled`)."""
        return replace(self, surface=self.surface.scaled(factor, stroke), times=self.times / factor)

    def slip(self) -> Extreme:
        """The largest force that holds the part over the largest that friction gives: from 1 on it slips."""
        return largest(lambda times: self._signals(times)[0], self.times)

    def contact_margin(self) -> Extreme:
        """The smallest distance from the end of contact, over about the part's weight: below 0 it comes off or tips.

        inf: the law bears any load.
        """
        value, time = largest(lambda times: -self._signals(times)[1], self.times)
        return Extreme(-value, time)

    def _signals(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What holds the part over what friction gives (n,), and the margin of contact (n,), at times (n,) [s]."""
        if self.face is not None:
            memory = self.memory(np.array([self.pose[:2]]), float(times[0]))
            found = rest_margins(self.surface.record, self.part, self.face, memory, *self.pose, times)
            return found[:, 0], found[:, 1]
        loads, pulls = np.empty(len(times)), np.empty(len(times))
        for k in range(0, len(times), BLOCK):
            own = times[k : k + BLOCK]
            points = self.surface.samples(np.broadcast_to(self.pose[:2], (len(own), 2)).copy(), own)
            loads[k : k + BLOCK], pulls[k : k + BLOCK] = rest_loads(points, self.part)
        law, unit = self.part.law, self.part.mass * abs(self.part.gravity) + self.part.squeeze or self.part.mass
        margins = np.full(len(times), np.inf)
        if math.isfinite(law.pull_off):
            margins = (loads + law.pull_off) / unit
        if math.isfinite(law.largest_load):
            margins = np.minimum(margins, (law.largest_load - loads) / unit)
        return pull_ratios(self.part, loads, self.part.mass * pulls), margins

    def responses(self, places: FloatArray, times: FloatArray) -> FloatArray:
        """What a part with a face must bear at other places (n, 2) [m], at times (k,) [s]; (k, n, 12).

        In numbers of `particle.body.rest_responses`, by factors of all the drives' frequencies.
        """
        assert self.face is not None
        memory = self.memory(places, float(times[0]))
        return rest_responses(self.surface.record, self.part, self.face, memory, places, self.pose[2], times)

    def memory(self, places: FloatArray, time: float) -> BodyMemory:
        """Scratch memory for the face, once the cells are built that it lies on at places (n, 2) [m]."""
        assert self.face is not None
        cosine, sine = math.cos(self.pose[2]), math.sin(self.pose[2])
        under = self.face.places @ np.array([[cosine, sine], [-sine, cosine]])
        points = (places[:, None] + under).reshape(-1, 2)
        self.surface.samples(points, np.full(len(points), time))
        return new_body_memory(self.surface.record, self.face, np.zeros(1, dtype=np.int64))


def part_at_rest(
    surface: SurfaceMotion,
    part: Micropart | Body,
    friction: Contact,
    window: float,
    gravity: float | Sequence[float] = 9.80665,
    tips: bool = True,
) -> PartAtRest:
    """A part that stays at its start for a window [s] from the drives' start.

    tips: whether the contact of a part with a face ends where an edge lifts.
    """
    x, y = part.position
    pose = x, y, part.heading if isinstance(part, Body) else 0.0
    record, moments = part_record(surface, part, friction, gravity), sample_times(surface, 0.0, window)
    return PartAtRest(surface, pose, record, moments, face_of(part, TOLERANCE, tips))


def pull_ratios(part: Part, loads: FloatArray, demands: FloatArray) -> FloatArray:
    """The forces (n,) [N] that hold a part at rest over the largest that friction gives under loads (n,) [N].

    Where the contact has ended friction gives nothing; no demand then counts as 0.
    """
    law = part.law
    held = (loads >= -law.pull_off) & (loads <= law.largest_load)
    limits = law.static_ratio * friction_limits(law, np.where(held, loads, 0.0)) * held
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(demands > 0, demands / limits, 0.0)


def sample_times(surface: SurfaceMotion, begin: float, end: float, per_stroke: int = PER_STROKE) -> FloatArray:
    """Times (n,) from `begin` to `end` [s], so many in its shortest stroke, the drives' breakpoints among them."""
    stroke_time = float(surface.stroke_times.min(initial=end - begin)) or 1.0
    count = int(np.clip(math.ceil(per_stroke * (end - begin) / stroke_time), per_stroke, MAX_MOMENTS))
    breakpoints = [begin]
    while len(breakpoints) < MAX_BREAKPOINTS and breakpoints[-1] < end:
        breakpoints.append(min(next_breakpoint(surface.drives, breakpoints[-1]), end))
    return np.union1d(np.linspace(begin, end, count + 1), breakpoints)


def largest(signal: Callable[[FloatArray], FloatArray], times: FloatArray, values: FloatArray | None = None) -> Extreme:
    """The largest value of a signal, smooth except for breakpoints, and when first; times (n,) [s] bracket its maxima.

    values: (n,) of the signal at these, where they are known.
    """
    values = signal(times) if values is None else values
    before, after = np.append(-np.inf, values[:-1]), np.append(values[1:], -np.inf)
    peaks = np.flatnonzero((values >= before) & (values >= after))
    top = values[peaks].max()
    if not math.isfinite(top):
        return Extreme(float(top), float(times[peaks[values[peaks] == top][0]]))
    nearly = np.minimum(values[peaks], top - ROUNDING * abs(top))  # of equal ones the first
    peaks = peaks[np.argsort(-nearly, kind="stable")[:CANDIDATES]]
    best, at = values[peaks], times[peaks]
    low, high = times[np.maximum(peaks - 1, 0)], times[np.minimum(peaks + 1, len(times) - 1)]
    rows = np.arange(len(peaks))
    for _ in range(ROUNDS):
        grid = np.linspace(low, high, POINTS, axis=1)  # (candidates, POINTS)
        order = np.argsort(grid, axis=None, kind="stable")
        found = np.empty(grid.shape)
        found.flat[order] = signal(grid.ravel()[order])
        place = found.argmax(axis=1)
        more = found[rows, place] > best
        best, at = np.where(more, found[rows, place], best), np.where(more, grid[rows, place], at)
        low, high = grid[rows, np.maximum(place - 1, 0)], grid[rows, np.minimum(place + 1, POINTS - 1)]
    top = best.max()
    equal = np.flatnonzero(best >= (top - ROUNDING * abs(top) if math.isfinite(top) else top))
    first = equal[np.argmin(at[equal])]
    return Extreme(float(best[first]), float(at[first]))
