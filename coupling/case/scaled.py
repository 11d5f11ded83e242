"""Scaled: a case with other frequencies, strokes or friction, in proportion to its own."""

from __future__ import annotations

from typing import Any, Final, TypeVar

from coupling.case.actuators import ActuatorCase, DriveCase, SegmentCase, amplitude
from coupling.case.case import Case
from coupling.case.friction import ConstantCase, CoulombCase, FrictionCase, KogutEtsionCase, TableCase
from coupling.case.plates import MotionCase, PlatformCase

Drive = TypeVar("Drive", DriveCase, ActuatorCase, SegmentCase)
INDICES: Final = 3.0, 3.5, 4.0, 4.5, 4.9128  # of plasticity: the last is that of the paper's surfaces


def scaled_case(case: Case, frequency: float, stroke: float, shortly: bool = False) -> Case:
    """The case with all frequencies times one factor and all strokes, heights and forces times another.

    Delays, dwells and the times of tables and segments shrink as cycles do. Duration and all else stay, and so does a
    platform whose motion is measured.
    shortly: round what changes to 12 digits, so that a file has 0.009 uN and not 0.009000000000000001 uN.
    """
    if frequency == 1 and stroke == 1:
        return case

    def rate(value: float) -> float:
        return final(value * frequency)

    def time(value: float) -> float:
        return final(value / frequency)

    def height(value: float) -> float:
        return final(value * stroke)

    def scaled(drive: Drive) -> Drive:
        scales = {"frequency": rate, "delay": time, "dwell": time, "stroke": height, "force": height}
        given = {key: value for key in scales if (value := getattr(drive, key, None)) is not None}
        update: dict[str, Any] = {key: scales[key](value) for key, value in given.items()}
        if table := getattr(drive, "table", None):
            update["table"] = tuple((time(moment), height(top)) for moment, top in table)
        if segments := getattr(drive, "segments", None):
            update["segments"] = tuple(map(scaled, segments))
        return drive.model_copy(update=update)

    final = rounded if shortly else float
    if isinstance(case.plate, PlatformCase):
        if not isinstance(case.plate.motion, MotionCase):
            return case
        axes = {axis: drive for axis, drive in case.plate.motion if drive is not None}
        motion = case.plate.motion.model_copy(update={axis: scaled(drive) for axis, drive in axes.items()})
        return case.model_copy(update={"plate": case.plate.model_copy(update={"motion": motion})})
    return case.model_copy(update={"actuators": tuple(map(scaled, case.actuators))})


def ramped_case(case: Case, ramp: float) -> Case | None:
    """The case with forces that grow over so many cycles where they begin at once; None: there is none that may.

    A force that has been running all the time begins at once only where the plate has mass and was at rest.
    """
    assert not isinstance(case.plate, PlatformCase)
    wakes = case.plate.inertia and case.run.start == "rest"
    actuators = tuple(
        one.model_copy(update={"ramp": ramp}) if (wakes or one.delay > 0) and _may_grow(one, ramp) else one
        for one in case.actuators
    )
    return None if actuators == case.actuators else case.model_copy(update={"actuators": actuators})


def _may_grow(actuator: ActuatorCase, ramp: float) -> bool:
    room = actuator.cycles is None or 2 * ramp <= actuator.cycles
    return actuator.force is not None and actuator.cycle in ("sine", "cosine") and actuator.ramp == 0 and room


def rounded(value: float) -> float:
    """A value to 12 digits."""
    return float(f"{value:.12g}")


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
    """Larger plasticity indices of Kogut and Etsion's law: less friction, the same adhesion; () for other laws."""
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
    update: dict[str, Any] = {key: rounded(factor * value) for key, value in scales.items()}
    if isinstance(friction, TableCase):
        update["limits"] = tuple(rounded(factor * limit) for limit in friction.limits or ())
    return friction.model_copy(update=update)
