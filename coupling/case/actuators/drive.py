"""The actuators of a case: where each one is, and how it is driven over time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import accumulate
from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import AfterValidator, Field, PlainValidator, StrictFloat, StrictInt, WithJsonSchema, WrapValidator

from coupling.case.table import Contradictions, Table
from coupling.case.values import (
    Angle,
    Expected,
    Force,
    Frequency,
    Length,
    Listed,
    Point,
    PositiveForce,
    PositiveLength,
    Stiffness,
    Time,
    expected_of,
    length_text,
    quoted,
)

ENDLESS: Final = "endless"
MAX_PASSES: Final = 1_000_000_000
MAX_CYCLES: Final = 1_000_000  # of segments
"""Cycles, or repeats, of a drive."""
MIN_SPACING: Final = 1e-12  # of points of a table, over its whole time
SHORTEST_RAMP, LONGEST_RAMP = 0.01, 1000
_SLACK: Final = 1 + 1e-9  # for limits that are met exactly
_ROUNDING: Final = 1e-9  # of a cycle, or of the fastest velocity in it
_RAMP: Final = f"0, or a number of cycles from {SHORTEST_RAMP} to {LONGEST_RAMP}"
_REPEATS: Final = f'a whole number from 1 to {MAX_PASSES}, or "{ENDLESS}"'
_POINTS: Final = 'two or more points, each a time and a height, such as [["0 ms", "0 um"], ["1 ms", "50 um"]]'
_ANGLES: Final = 'two or more points, each a time and an angle, such as [["0 ms", "0 deg"], ["1 ms", "5 deg"]]'


def _repeats(value: object) -> object:
    if value == ENDLESS or (isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MAX_PASSES):
        return value
    raise ValueError(f"must be {_REPEATS}; got {quoted(value)}")


def _ramp(value: float) -> float:
    if value == 0 or SHORTEST_RAMP <= value <= LONGEST_RAMP:
        return value
    raise ValueError(f"must be {_RAMP}; got {quoted(value)}")


def _points(value: Any, handler: Any) -> object:
    """Points in time, whose times increase from 0."""
    points = handler(value)
    times = [time for time, _ in points]
    if times[0] != 0:
        raise ValueError(f"must begin at the time 0; got {quoted(value[0][0])}; a delay is a key of its own")
    closest = MIN_SPACING * max(times)
    for k in range(1, len(times)):
        if times[k] - times[k - 1] <= closest:
            raise ValueError(f"must have increasing times; got {quoted(value[k][0])} after {quoted(value[k - 1][0])}")
    return points


class Pairs(Listed):
    """Marks a tuple of pairs."""

    def validate(self, value: object) -> object:
        """Return a list or tuple of so many pairs; ValueError for all else."""
        pairs: Any = super().validate(value)
        if not all(isinstance(one, (list, tuple)) and len(one) == 2 for one in pairs):
            raise ValueError(f"must be {self.expected}; got {quoted(value)}")
        return pairs  # type: ignore[no-any-return]


Cycle = Literal["up-down", "up", "sine", "cosine"]
Ramp = Annotated[StrictFloat, AfterValidator(_ramp), Expected(_RAMP)]
Points = Annotated[tuple[tuple[Time, Length], ...], WrapValidator(_points), Pairs(_POINTS, 2)]
Angles = Annotated[tuple[tuple[Time, Angle], ...], WrapValidator(_points), Pairs(_ANGLES, 2)]
_PASSES: Final = {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MAX_PASSES}, {"const": ENDLESS}]}
Repeats = Annotated[int | Literal["endless"], PlainValidator(_repeats), Expected(_REPEATS), WithJsonSchema(_PASSES)]


class SegmentCase(Table):
    """A part of a schedule, in m, Hz and s; with cycle = "hold" it has only a `dwell`."""

    in_template: ClassVar[tuple[str, ...]] = ("stroke", "frequency")

    stroke: Length | None = Field(default=None, examples=["50 um"])
    """How far it goes from where it is; negative: the other way. Not with "hold"."""
    frequency: Frequency | None = None
    """A stroke takes half of one over this, with "up" all of it. Not with "hold"."""
    cycle: Literal["up-down", "up", "hold"] = "up-down"
    """Up and down again, up to stay, or a wait of one dwell."""
    cycles: StrictInt = Field(default=1, ge=1, le=MAX_CYCLES)
    """How often; several of "up" climb on."""
    dwell: Time = Field(default=0.0, ge=0)
    """The rest after each stroke; with "hold" how long it waits."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        if given.get("cycle") != "hold":
            for key in (key for key in ("stroke", "frequency") if key not in given):
                yield key, f"is missing; it must be {expected_of(cls.model_fields[key])}"
            return
        for key in ("stroke", "frequency", "cycles"):
            if key in given:
                yield key, 'must not be given with cycle = "hold", which only waits for the time dwell'
        if "dwell" not in given:
            yield "dwell", 'is missing; with cycle = "hold" it must be the time to wait, such as "1 ms"'
        elif given["dwell"] == 0:
            yield "dwell", 'must be greater than 0 with cycle = "hold"; got 0 s'


class DriveCase(Table):
    """A drive over time, in m, Hz and s: a `stroke` with a `frequency`, a `table`, or `segments`, a schedule."""

    in_template: ClassVar[tuple[str, ...]] = ("stroke", "frequency")
    owner: ClassVar[str] = "an actuator"
    height: ClassVar[str] = 'a length such as "150 um"'

    stroke: Length | None = Field(default=None, examples=["50 um"])
    """How far it rises; 0: it keeps the plate at 0; negative: down."""
    frequency: Frequency | None = None
    """One cycle takes one over this, and the dwells."""
    cycle: Cycle = "up-down"
    """Up in the first half and down in the second; up once, to stay; or sines."""
    cycles: StrictInt | None = Field(default=None, ge=1, le=MAX_PASSES, examples=[5])
    """How many cycles there are, after which it rests where it began; without it they do not end."""
    dwell: Time = Field(default=0.0, ge=0)
    """The rest after each stroke, up and down."""
    phase: Angle = Field(default=0.0, examples=["90 deg"])
    """Where in its cycle it begins; a whole cycle, dwells included, has 360 deg. Not with "up"."""
    ramp: Ramp = Field(default=0.0, examples=[3])
    """Cycles over which a "sine" or "cosine" grows from rest, and decays over the last of its cycles."""
    table: Points | None = Field(default=None, examples=[[["0 ms", "0 um"], ["1 ms", "50 um"], ["3 ms", "20 um"]]])
    """Instead of a stroke: where it is at given times, with a smooth stroke from each to the next."""
    segments: tuple[SegmentCase, ...] | None = None
    """Instead of a stroke: a schedule, one table after the other."""
    repeats: Repeats = 1
    """How often a table or schedule comes."""
    delay: Time = Field(default=0.0, ge=0)
    """The rest before all this."""

    def jump(self, duration: float) -> tuple[str, float] | None:
        """The key with which its velocity jumps in a run of a duration [s], and when [s]; None: it does not.

        It does so where its `delay` or its `cycles` end, if it moves at its phase and has no ramp.
        """
        if not self.frequency or self.ramp or self.cycle == "up" or not amplitude(self):
            return None
        period, turn = 1 / self.frequency + 2 * self.dwell, self.phase % (2 * math.pi)
        if self.cycle == "up-down":
            moves = _ROUNDING < turn / (2 * math.pi) * period % (period / 2) * self.frequency < 0.5 - _ROUNDING
        else:
            moves = abs(math.cos(turn) if self.cycle == "sine" else math.sin(turn)) > _ROUNDING
        times = {"delay": self.delay, "cycles": self.delay + (self.cycles or 0) * period}
        return next(((key, at) for key, at in times.items() if moves and 0 < at < duration * (1 - _ROUNDING)), None)

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        drivers = [key for key in _NAMED if key in given]
        for key in drivers[1:]:
            *others, last = (one for one in _NAMED if one in cls.model_fields)
            only = f"{cls.owner} is driven by one of {', '.join(others)} and {last}"
            yield key, f"must not be given with {_NAMED[drivers[0]]}; {only}"
        if not drivers:
            other = 'a force such as "1 mN", ' * ("force" in cls.model_fields) + "a table or segments instead"
            yield "stroke", f"is missing; it must be {cls.height}, or use {other}"
        if drivers and drivers[0] in ("table", "segments"):
            yield from cls._beside_times(drivers[0], given)
        else:
            yield from cls._of_cycles(given)
        if "force" in given and "stiffness" in given:
            yield "stiffness", "must not be given with a force, which is the same whatever the stiffness"
        if "force" in given and "max_stroke" in given:
            yield "max_stroke", "must not be given with a force, which has no stroke; max_force limits it"

    @classmethod
    def _of_cycles(cls, given: Mapping[str, Any]) -> Contradictions:
        """What does not go with a stroke or force that comes again and again."""
        if "frequency" not in given:
            yield "frequency", 'is missing; it must be a frequency such as "300 Hz"'
        cycle, cycles, ramp = given.get("cycle", "up-down"), given.get("cycles"), given.get("ramp", 0.0)
        for key, (others, why) in _OF_OTHER_CYCLES.items():
            if key in given and cycle in others:
                yield key, f'must not be given with cycle = "{cycle}"; {why}'
        if cycle in ("sine", "cosine") and cycles is not None and 2 * ramp > cycles:
            why = f"half of cycles, {cycles / 2:g}: the wave grows over the first cycles and decays over the last"
            yield "ramp", f"must be at most {why}; got {ramp:g}"
        if "repeats" in given:
            yield "repeats", "must not be given without a table or segments; cycles counts those of a stroke"

    @classmethod
    def _beside_times(cls, driver: str, given: Mapping[str, Any]) -> Contradictions:
        """What does not go with a table or segments, which say themselves what happens when."""
        why = "whose points have their own times" if driver == "table" else "which have their own"
        for key in ("frequency", "cycle", "cycles", "dwell", "phase", "ramp"):
            if key in given:
                yield key, f"must not be given with {_NAMED[driver]}, {why}"
        if given.get("segments") == ():
            yield "segments", "must be at least one table; got none"
        if (count := sum(one.cycles for one in given.get("segments", ()))) > MAX_CYCLES:
            yield "segments", f"must have at most {MAX_CYCLES} cycles together; got {count}"
        heights = _heights(given[driver])
        if given.get("repeats", 1) != 1 and abs(heights[-1] - heights[0]) > 1e-12 * max(map(abs, heights)):
            ends = "whose last height is not its first" if driver == "table" else "which do not end at height 0"
            yield "repeats", f"must not be given with {_NAMED[driver]} {ends}"


class Pushing(Table):
    """What an actuator has beside its drive, and what it can bear."""

    force: Force | None = Field(default=None, examples=["1 mN"])
    """Instead of a stroke: it floats and pushes with this force; negative: it pulls."""
    stiffness: Stiffness | None = None
    """The stiffness of a spring between actuator and plate; without it there is none. Not with a force."""
    max_stroke: PositiveLength | None = Field(default=None, examples=["150 um"])
    """The largest height, up or down, that it can reach. Not with a force."""
    max_force: PositiveForce | None = Field(default=None, examples=["100 mN"])
    """The largest force, up or down, that it can bear."""


class _Place(Table):
    position: Point = Field(examples=[["0 um", "0 um"]])
    """Where it stands, inside the rim."""


class ActuatorCase(DriveCase, Pushing, _Place):
    """A point actuator, in m, N/m and N, and what drives it: a drive, or a `force` instead of its stroke."""

    @classmethod
    def contradictions(cls, given: Mapping[str, Any]) -> Contradictions:
        yield from super().contradictions(given)
        yield from limit_faults(given)


_OF_OTHER_CYCLES: Final = {
    "cycles": (("up",), "it counts periodic cycles"),
    "dwell": (("up", "sine", "cosine"), 'it is the rest after each stroke of "up-down"'),
    "phase": (("up",), "it is where in a periodic cycle the drive begins"),
    "ramp": (("up-down", "up"), 'only a "sine" and a "cosine" grow'),
}
"""The cycles that keys do not go with, and why."""
_NAMED: Final = {"stroke": "a stroke", "force": "a force", "table": "a table", "segments": "segments"}


def _heights(motion: Sequence[Any]) -> list[float]:
    """The heights [m] at the points of a table or after the segments of a schedule."""
    if motion and isinstance(motion[0], tuple):
        return [height for _, height in motion]
    return list(accumulate((s.cycles * (s.stroke or 0.0) if s.cycle == "up" else 0.0 for s in motion), initial=0.0))


def amplitude(drive: Any) -> float:
    """The stroke [m] of a drive, its force [N], or the height [m] furthest from 0 that it goes to."""
    return _farthest(drive.table, drive.segments, drive.stroke) or getattr(drive, "force", None) or 0.0


def _farthest(table: Any, segments: Any, stroke: float | None) -> float:
    """The height [m] furthest from 0 of a table, a schedule or a stroke."""
    if table:
        return max(_heights(table), key=abs)
    if segments:
        before = _heights(segments)
        tops = [height + (s.stroke or 0.0) for height, s in zip(before, segments, strict=False)]
        return max(before + tops, key=abs)
    return stroke or 0.0


def limit_faults(given: Mapping[str, Any]) -> Contradictions:
    """Yield each key of an actuator's drive that asks for more than max_stroke or max_force, and why.

    given: valid values by their keys, None for what is not given.
    """
    motions = {key: given.get(key) for key in ("table", "segments", "stroke")}
    limit, force, largest = given.get("max_stroke"), given.get("force"), given.get("max_force")
    key = next((key for key, motion in motions.items() if motion is not None), "")
    if limit is not None and key and abs(farthest := _farthest(*motions.values())) > _SLACK * limit:
        must = "must be" if key == "stroke" else "must have heights of"
        yield key, f"{must} at most max_stroke, {length_text(limit)}, up or down; got {length_text(farthest)}"
    if largest is not None and force is not None and abs(force) > _SLACK * largest:
        yield "force", f"must be at most max_force, {largest:g} N, up or down; got {force:g} N"
