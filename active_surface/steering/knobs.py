"""Knobs: the numbers of a drive that a search varies, and the case with their values."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.parameter import Parameter
from active_surface.steering.settings import Settings
from coupling.case import ActuatorCase, Case, find_field, groups_of

SLOWEST, FASTEST = 0.2, 2.0  # of an actuator's own frequency
LATEST = 2.0  # of its own delay
FEW_CYCLES = 1, 3  # over more of them the end point is less smooth
AT_BOUND = 1e-3  # of a knob's range: a value so near to its bound stands at it
KEYS = ("frequency", "stroke", "delay", "cycles")
SHARED = ("frequency", "cycles")  # by all in a search that has them together
DIGITS = {"frequency": 6, "stroke": 12, "delay": 12}  # decimals in SI units, as many as a file shows


class Knob(Parameter):
    """A number of one or more actuators' drives between two bounds; cycles are whole, and vary below `high` + 1."""

    @property
    def actuators(self) -> tuple[int, ...]:
        """The numbers of the actuators that have it."""
        return tuple(int(location[1]) for location in self.field.locations)

    @property
    def key(self) -> str:
        """The key of the number in the actuator's table."""
        return str(self.field.locations[0][2])

    @property
    def smooth(self) -> bool:
        """Whether the end point changes smoothly with it."""
        return self.field.kind == "number"


class Stop(NamedTuple):
    """A knob that stands at a bound."""

    knob: Knob
    highest: bool  # else at the lowest

    @property
    def bound(self) -> float:
        """Its value in SI units."""
        return self.knob.high if self.highest else self.knob.low


class Knobs:
    """All knobs of the actuators that take part, in groups that move alike.

    The others are at rest; with `around` each by itself varies about the drives of the case, which must end, and all
    others keep theirs. With `together` all have one frequency and one number of cycles.
    """

    def __init__(
        self,
        case: Case,
        settings: Settings,
        movers: tuple[int, ...],
        around: bool = False,
        wide: bool = False,
        together: bool = False,
    ) -> None:
        """wide: without bounds of cycles in the settings, an actuator may have as many as in the case."""
        self.still = tuple(one if around or k in movers else at_rest(one) for k, one in enumerate(case.actuators))
        self.case, self.around = case, around
        lines = groups_of(case, "each" if around else settings.groups).values()
        self.groups = [group for line in lines if (group := tuple(k for k in line if k in movers))]
        self._fixed: dict[int, dict[str, float]] = {k: {} for k in movers}
        self.knobs: list[Knob] = []
        bounds = {
            k: _bounds(case.actuators[k], settings, case.run.duration, wide or around or together) for k in movers
        }
        apart = [key for key in KEYS if not (together and key in SHARED)]
        for group, keys in [(movers, SHARED)] * together + [(group, apart) for group in self.groups]:
            for key in keys:
                low, high = _common(key, [bounds[k][key] for k in group])
                if low < high:
                    self.knobs.append(_knob(case, group, key, low, high))
                else:
                    self._fixed |= {k: self._fixed[k] | {key: low} for k in group}

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """The smallest and the largest value of each."""
        return [(knob.low, knob.high + (not knob.smooth)) for knob in self.knobs]

    @property
    def smooth(self) -> IntArray:
        """The indices of the smooth knobs."""
        return np.array([k for k, knob in enumerate(self.knobs) if knob.smooth], dtype=np.int64)

    @property
    def own(self) -> FloatArray | None:
        """The values (n,) that the case has; None where one lies beyond its bounds."""
        ended = own_drives(self.case)
        for k, fixed in self._fixed.items():
            if any(getattr(ended[k], key) != value for key, value in fixed.items()):
                return None
        values = [float(getattr(ended[knob.actuators[0]], knob.key) or 0.0) for knob in self.knobs]
        inside = all(knob.low <= value <= knob.high for knob, value in zip(self.knobs, values, strict=True))
        return np.array(values) if inside else None

    def actuators(self, values: FloatArray) -> tuple[ActuatorCase, ...]:
        """All actuators with these values (n,) of the knobs; drives end within the case's duration where they can."""
        tables = {k: dict(fixed) for k, fixed in self._fixed.items()}
        for knob, value in zip(self.knobs, values.tolist(), strict=True):
            value = round(value, DIGITS[knob.key]) if knob.smooth else min(math.floor(value), knob.high)
            for k in knob.actuators:
                tables[k][knob.key] = value
        actuators = list(self.still)
        for k, keys in tables.items():
            fit = _fitting(keys["frequency"], actuators[k].dwell, self.case.run.duration - keys["delay"])
            keys["cycles"] = int(max(1, min(keys["cycles"], fit)))
            actuators[k] = actuators[k].model_copy(update=keys)
        return tuple(actuators)

    def stops(self, values: FloatArray) -> tuple[Stop, ...]:
        """Which knobs stand at a bound with these values (n,) that keeps them from moving more or otherwise."""
        ends = []
        for knob, value in zip(self.knobs, values.tolist(), strict=True):
            value, room = value if knob.smooth else math.floor(value), AT_BOUND * (knob.high - knob.low)
            if knob.high > 0 and value >= knob.high - room:
                ends.append(Stop(knob, True))
            elif value <= knob.low + room and (knob.key == "frequency" or (knob.key == "stroke" and knob.low < 0)):
                ends.append(Stop(knob, False))
        return tuple(ends)


def _knob(case: Case, group: tuple[int, ...], key: str, low: float, high: float) -> Knob:
    """The knob of a group, whose path names all of its actuators."""
    fields = [find_field(case, None, f"actuators.{k}.{key}") for k in group]
    path = f"actuators.{','.join(map(str, group))}.{key}"
    return Knob(replace(fields[0], path=path, locations=tuple(one.locations[0] for one in fields)), low, high)


def _common(key: str, bounds: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Bounds for a group: strokes that each of them may have, and of all else what one of them may."""
    lows, highs = zip(*bounds, strict=True)
    return (max(lows), min(highs)) if key == "stroke" else (min(lows), max(highs))


def is_schedulable(actuator: ActuatorCase) -> bool:
    """Whether segments can state its drive: a stroke that goes up and down, from the start of its cycle."""
    return actuator.stroke is not None and actuator.cycle == "up-down" and not actuator.phase


def own_drives(case: Case) -> tuple[ActuatorCase, ...]:
    """The actuators of a case; endless strokes, up and down, get as many cycles as end within its duration."""
    return tuple(_ended(actuator, case.run.duration) for actuator in case.actuators)


def _ended(actuator: ActuatorCase, duration: float) -> ActuatorCase:
    if not is_schedulable(actuator) or actuator.cycles is not None:
        return actuator
    cycles = _fitting(actuator.frequency or 0.0, actuator.dwell, duration - actuator.delay)
    return actuator.model_copy(update={"cycles": cycles}) if cycles > 0 else actuator


def _fitting(frequency: float, dwell: float, duration: float) -> int:
    """How many whole cycles a duration [s] has room for."""
    return math.floor(duration / (1 / frequency + 2 * dwell) * (1 + 1e-12))


def shortest(case: Case, settings: Settings, movers: Iterable[int]) -> float:
    """The time [s] within which each of the actuators that take part can end one cycle."""
    actuators = [case.actuators[k] for k in movers]
    bounds = [_bounds(actuator, settings, case.run.duration) for actuator in actuators]
    ends = zip(actuators, bounds, strict=True)
    return max(keys["delay"][0] + 1 / keys["frequency"][1] + 2 * actuator.dwell for actuator, keys in ends)


def _bounds(
    actuator: ActuatorCase, settings: Settings, duration: float, wide: bool = False
) -> dict[str, tuple[float, float]]:
    own = actuator.frequency or 0.0
    frequency = settings.frequency or (SLOWEST * own, FASTEST * own)
    stroke = actuator.stroke or 0.0
    max_cycles = max(1, math.floor(frequency[1] * duration))
    largest = max(FEW_CYCLES[1], actuator.cycles or max_cycles) if wide else FEW_CYCLES[1]
    low, high = settings.cycles or (FEW_CYCLES[0], largest)
    return {
        "frequency": frequency,
        "stroke": settings.stroke or (min(0.0, stroke), max(0.0, stroke)),
        "delay": settings.delay or (0.0, LATEST * actuator.delay),
        "cycles": (float(min(low, max_cycles)), float(min(high, max_cycles))),
    }


def at_rest(actuator: ActuatorCase) -> ActuatorCase:
    """An actuator kept at height 0, or floating without a force."""
    once: dict[str, object] = {"frequency": actuator.frequency or 1.0, "cycle": "up-down", "cycles": 1}
    none = dict.fromkeys(("delay", "dwell", "phase", "ramp"), 0.0)
    without: dict[str, object] = dict.fromkeys(("table", "segments")) | {"repeats": 1} | none
    pushed = {"force": 0.0} if actuator.force is not None else {"stroke": 0.0}
    return actuator.model_copy(update=once | without | pushed)
