"""Scaled: a case whose drives run so many times as fast and so many times as high, or with less friction."""

from __future__ import annotations

from typing import Any, Final

from coupling.case.actuators import ActuatorCase, amplitude
from coupling.case.case import Case
from coupling.case.friction import ConstantCase, CoulombCase, FrictionCase, KogutEtsionCase, TableCase

INDICES: Final = 3.0, 3.5, 4.0, 4.5, 4.9128  # of plasticity: the last is that of the paper's surfaces


def scaled_case(case: Case, frequency: float, stroke: float) -> Case:
    """The case with all frequencies times one factor and all strokes, heights and forces times another.

    Delays, dwells and the times of tables and segments shrink as cycles do. Duration and all else stay.
    """
    if frequency == 1 and stroke == 1:
        return case
    actuators = tuple(_scaled(actuator, frequency, stroke) for actuator in case.actuators)
    return case.model_copy(update={"actuators": actuators})


def _scaled(actuator: ActuatorCase, frequency: float, stroke: float) -> ActuatorCase:
    update: dict[str, Any] = {"delay": actuator.delay / frequency, "dwell": actuator.dwell / frequency}
    if actuator.frequency is not None:
        update["frequency"] = actuator.frequency * frequency
    for key in ("stroke", "force"):
        if (value := getattr(actuator, key)) is not None:
            update[key] = value * stroke
    if actuator.table is not None:
        update["table"] = tuple((time / frequency, height * stroke) for time, height in actuator.table)
    if actuator.segments is not None:
        update["segments"] = tuple(
            one.model_copy(
                update={
                    "stroke": None if one.stroke is None else one.stroke * stroke,
                    "frequency": None if one.frequency is None else one.frequency * frequency,
                    "dwell": one.dwell / frequency,
                }
            )
            for one in actuator.segments
        )
    return actuator.model_copy(update=update)


def largest_stroke(case: Case) -> tuple[float, str]:
    """The largest stroke or height [m] of a case's actuators, and "m"; of forces alone the largest [N], and "N"."""
    lengths = [abs(amplitude(one)) for one in case.actuators if one.force is None]
    if max(lengths, default=0.0) > 0:
        return max(lengths), "m"
    return max((abs(amplitude(one)) for one in case.actuators), default=0.0), "N"


def friction_scales(friction: FrictionCase) -> dict[str, float] | None:
    """The keys and values of a law in proportion to which friction is; empty: its lists; None: there are none."""
    if isinstance(friction, KogutEtsionCase):
        return None
    keys = {ConstantCase: ("limit",), CoulombCase: ("coefficient", "static_coefficient")}.get(type(friction), ())
    return {key: value for key in keys if (value := getattr(friction, key)) is not None}


def more_plastic(friction: FrictionCase) -> tuple[float, ...]:
    """Plasticity indices above that of Kogut and Etsion's law, which hold less and adhere alike; else none."""
    if not isinstance(friction, KogutEtsionCase):
        return ()
    return tuple(index for index in INDICES if index > friction.plasticity_index)


def with_index(friction: FrictionCase, index: float) -> KogutEtsionCase:
    """Kogut and Etsion's law with another plasticity index; raises ValueError for another law."""
    if not isinstance(friction, KogutEtsionCase):
        raise ValueError(f"Input friction of with_index must be of Kogut and Etsion; got {friction.model}")
    return friction.model_copy(update={"preset": None, "plasticity_index": index})


def scaled_friction(friction: FrictionCase, factor: float) -> FrictionCase:
    """The law with all its limits times a factor, and its adhesion as it is.

    Raises ValueError for Kogut and Etsion's law, which has no such key.
    """
    scales = friction_scales(friction)
    if scales is None:
        raise ValueError(
            "Input friction of scaled_friction must not be of Kogut and Etsion, whose limits no key scales"
        )
    update: dict[str, Any] = {key: float(f"{factor * value:.12g}") for key, value in scales.items()}
    if isinstance(friction, TableCase):
        update["limits"] = tuple(factor * limit for limit in friction.limits or ())
    return friction.model_copy(update=update)
