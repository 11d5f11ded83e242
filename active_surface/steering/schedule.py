"""Schedule: the drives of legs one after the other, as segments of each actuator."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from active_surface.steering.knobs import at_rest
from coupling import build_drive
from coupling.case import ActuatorCase, Case, SegmentCase

SHORTEST = 1e-9  # s: shorter waits are left out
DIGITS = 12  # decimals of times in s, as many as a file shows


class Leg(NamedTuple):
    """The drives of one leg."""

    start: float  # s
    actuators: tuple[ActuatorCase, ...]
    movers: tuple[int, ...]  # the numbers of those that move


def lasting(actuators: Sequence[ActuatorCase], movers: Sequence[int]) -> float:
    """The time [s] from the start of a leg to when the last of its drives has ended."""
    return max((_end(actuators[k]) for k in movers), default=0.0)


def scheduled(case: Case, legs: Sequence[Leg], duration: float) -> Case:
    """The case of a duration [s] in which the drives of legs follow each other."""
    actuators = tuple(_over_time(k, actuator, legs) for k, actuator in enumerate(case.actuators))
    run = case.run.model_copy(update={"duration": duration})
    return case.model_copy(update={"actuators": actuators, "run": run, "source": None})


def _over_time(k: int, actuator: ActuatorCase, legs: Sequence[Leg]) -> ActuatorCase:
    """Actuator k in all legs: waits and cycles, or at rest."""
    segments: list[SegmentCase] = []
    now = 0.0
    for leg in legs:
        if k in leg.movers:
            own = leg.actuators[k]
            wait = round(leg.start + own.delay - now, DIGITS)
            if wait > SHORTEST:
                segments.append(SegmentCase(cycle="hold", dwell=wait))
            cycles = own.cycles or 1
            segments.append(SegmentCase(stroke=own.stroke, frequency=own.frequency, cycles=cycles, dwell=own.dwell))
            now = leg.start + _end(own)
    if not segments:
        return at_rest(actuator)
    unset = dict.fromkeys(("stroke", "force", "frequency", "table", "cycles"))
    same = {"cycle": "up-down", "dwell": 0.0, "repeats": 1, "delay": 0.0, "phase": 0.0, "ramp": 0.0}
    return actuator.model_copy(update=unset | same | {"segments": tuple(segments)})


def _end(actuator: ActuatorCase) -> float:
    """When a drive with a number of cycles ends [s]."""
    return actuator.delay + build_drive(actuator).segments().duration
