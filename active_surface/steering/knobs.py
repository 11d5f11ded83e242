"""Knobs: the numbers of a drive that a search varies, and the case with their values."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.steering.tables import Settings
from coupling.case import ActuatorCase, Case

SLOWEST, FASTEST = 0.2, 2.0  # of an actuator's own frequency
LATEST = 2.0  # of its own delay
DIGITS = {"frequency": 6, "stroke": 12, "delay": 12}  # decimals in SI units, as many as a file shows


class Knob(NamedTuple):
    """A number between two bounds; cycles are whole, and varied as numbers below `high`."""

    actuator: int
    key: str
    low: float
    high: float

    @property
    def smooth(self) -> bool:
        """Whether the end point changes smoothly with it."""
        return self.key != "cycles"


class Knobs:
    """All knobs of the actuators that take part; those that do not are at rest."""

    def __init__(self, case: Case, settings: Settings, movers: tuple[int, ...]) -> None:
        self.still = tuple(actuator if k in movers else at_rest(actuator) for k, actuator in enumerate(case.actuators))
        self.case, self._movers = case, movers
        self._fixed: dict[int, dict[str, float]] = {}
        self.knobs: list[Knob] = []
        for k in movers:
            bounds = _bounds(case.actuators[k], settings, case.run.duration)
            self._fixed[k] = {key: low for key, (low, high) in bounds.items() if low == high}
            self.knobs += [Knob(k, key, low, high) for key, (low, high) in bounds.items() if low < high]

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """The smallest and the largest value of each."""
        return [(knob.low, knob.high + (not knob.smooth)) for knob in self.knobs]

    @property
    def smooth(self) -> IntArray:
        """The indices of the smooth knobs."""
        return np.array([k for k, knob in enumerate(self.knobs) if knob.smooth], dtype=np.int64)

    def actuators(self, values: FloatArray) -> tuple[ActuatorCase, ...]:
        """All actuators with these values (n,) of the knobs; drives end within the case's duration where they can."""
        tables = {k: dict(fixed) for k, fixed in self._fixed.items()}
        for knob, value in zip(self.knobs, values.tolist(), strict=True):
            tables[knob.actuator][knob.key] = (
                round(value, DIGITS[knob.key]) if knob.smooth else min(math.floor(value), knob.high)
            )
        actuators = list(self.still)
        for k, keys in tables.items():
            period = 1 / keys["frequency"] + 2 * actuators[k].dwell
            fit = math.floor((self.case.run.duration - keys["delay"]) / period * (1 + 1e-12))
            keys["cycles"] = int(max(1, min(keys["cycles"], fit)))
            actuators[k] = actuators[k].model_copy(update=keys)
        return tuple(actuators)

    def turned(self, values: FloatArray) -> Case:
        """The case with these values (n,) of the knobs."""
        return self.case.model_copy(update={"actuators": self.actuators(values), "source": None})


def shortest(case: Case, settings: Settings, movers: Iterable[int]) -> float:
    """The time [s] within which each of the actuators that take part can end one cycle."""
    return max(_shortest(case.actuators[k], settings, case.run.duration) for k in movers)


def _shortest(actuator: ActuatorCase, settings: Settings, duration: float) -> float:
    bounds = _bounds(actuator, settings, duration)
    return bounds["delay"][0] + 1 / bounds["frequency"][1] + 2 * actuator.dwell


def _bounds(actuator: ActuatorCase, settings: Settings, duration: float) -> dict[str, tuple[float, float]]:
    own = actuator.frequency or 0.0
    frequency = settings.frequency or (SLOWEST * own, FASTEST * own)
    stroke = actuator.stroke or 0.0
    max_cycles = max(1, math.floor(frequency[1] * duration))
    low, high = settings.cycles
    return {
        "frequency": frequency,
        "stroke": settings.stroke or (min(0.0, stroke), max(0.0, stroke)),
        "delay": settings.delay or (0.0, LATEST * actuator.delay),
        "cycles": (float(min(low, max_cycles)), float(min(high, max_cycles))),
    }


def at_rest(actuator: ActuatorCase) -> ActuatorCase:
    """An actuator held at height 0, or floating without a force."""
    once: dict[str, object] = {"frequency": actuator.frequency or 1.0, "cycle": "up-down", "cycles": 1}
    none = dict.fromkeys(("delay", "dwell", "phase", "ramp"), 0.0)
    without: dict[str, object] = dict.fromkeys(("table", "segments")) | {"repeats": 1} | none
    pushed = {"force": 0.0} if actuator.force is not None else {"stroke": 0.0}
    return actuator.model_copy(update=once | without | pushed)
