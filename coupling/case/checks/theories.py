"""Checking: whether a plate's theory goes with the actuators and the run."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, Final

from coupling.case.actuators import ENDLESS, ActuatorCase, LatticeCase
from coupling.case.checks.parts import Parts
from coupling.case.mistakes import Location, Mistake
from coupling.case.plates import INERTIA, VON_KARMAN, PlateCase
from coupling.case.table import right_value
from coupling.case.tables import RunCase

MAX_STRETCHING: Final = 200
"""Actuators of a plate that stretches."""
MAX_VIBRATING: Final = 250
"""Actuators of a plate with inertia."""
MAX_PRESSED: Final = 250
"""Actuators of a plate under pressure."""
MAX_GENERAL: Final = 250
"""Actuators of a plate on a foundation, or of a wafer under a tension."""
STEADY: Final = 'start = "steady"'
MAX_CYCLES: Final = 1000  # of one drive in the common period
ROUNDING: Final = 1e-11  # of a period, as of one that is written with twelve digits


def check_theory(parts: Parts, count: int) -> Iterator[Mistake]:
    """Yield what a plate with so many actuators does not go with."""
    plate, run = parts.tables["plate"], parts.tables.get("run")
    if right_value(PlateCase, "theory", plate, parts.context) == "von-karman":
        yield from _stretching(right_value(RunCase, "scheme", run, parts.context), count)
        if tension := right_value(PlateCase, "tension", plate, parts.context):
            yield (
                ("plate", "tension"),
                f"must be 0 with {VON_KARMAN}, whose mid-plane has no stress at rest; got {tension:g} N/m",
            )
    yield from _pressure(plate, parts.context, count)
    yield from _foundation(plate, parts.context, count)
    inertia = right_value(PlateCase, "inertia", plate, parts.context, False)
    if inertia and count > MAX_VIBRATING:
        yield (
            ("plate", "inertia"),
            f"must be false with more than {MAX_VIBRATING} actuators, as their modes are those of one whole plate; got "
            f"{count}; a piece of the array with {MAX_VIBRATING} can vibrate",
        )
    if right_value(RunCase, "start", run, parts.context) == "steady":
        if inertia is False:
            yield ("run", "start"), f"must not be given without {INERTIA} in [plate]; only then do vibrations build up"
        yield from _ending(parts)
        if inertia and right_value(PlateCase, "theory", plate, parts.context) == "von-karman":
            yield from _aperiodic(parts)
        damping = right_value(PlateCase, "damping", plate, parts.context)
        undamped = min(ratio for _, ratio in damping) == 0 if isinstance(damping, tuple) else damping == 0
        if inertia and undamped and right_value(PlateCase, "theory", plate, parts.context) == "von-karman":
            yield (
                ("plate", "damping"),
                f"must be a positive ratio such as 0.02 with {VON_KARMAN} and {STEADY}, as the steady state is what is "
                "left when all ringing has decayed",
            )


def _pressure(plate: Any, context: Any, count: int) -> Iterator[Mistake]:
    """Yield that a plate's theory, or so many actuators, leave no room for its pressure."""
    pressure = right_value(PlateCase, "pressure", plate, context, 0.0)
    if not pressure:
        return
    if right_value(PlateCase, "theory", plate, context) == "von-karman":
        yield (
            ("plate", "pressure"),
            f"must be 0 with {VON_KARMAN}, whose reduced model knows strokes and forces of actuators only; got "
            f"{pressure:g} Pa; leave out pressure or theory",
        )
    if count > MAX_PRESSED:
        yield (
            ("plate", "pressure"),
            f"must be 0 with more than {MAX_PRESSED} actuators, as their shapes are found on patches and a pressure "
            f"bends the whole plate; got {pressure:g} Pa and {count}; a piece of the array with {MAX_PRESSED} can bear "
            "one",
        )


def _foundation(plate: Any, context: Any, count: int) -> Iterator[Mistake]:
    """Yield that a plate's theory, or so many actuators, rule out its foundation, or a wafer's tension."""
    foundation, tension, wafer = (
        right_value(PlateCase, key, plate, context, missing)
        for key, missing in (("foundation", 0.0), ("tension", 0.0), ("wafer", None))
    )
    if foundation and right_value(PlateCase, "theory", plate, context) == "von-karman":
        yield ("plate", "foundation"), f"must be 0 with {VON_KARMAN}; got {foundation:g} N/m^3; leave out one of them"
    for key, value, of in (("foundation", foundation, ""), ("tension", wafer and tension, " with a wafer")):
        if value and count > MAX_GENERAL:
            yield (
                ("plate", key),
                f"must be 0{of} with more than {MAX_GENERAL} actuators, as their shapes are found on patches; got "
                f"{value:g} {'N/m^3' if key == 'foundation' else 'N/m'} and {count}; a piece of the array with "
                f"{MAX_GENERAL} can have one",
            )


def _stretching(scheme: str | None, count: int) -> Iterator[Mistake]:
    if count > MAX_STRETCHING:
        yield (
            ("plate", "theory"),
            f'must be "linear" with more than {MAX_STRETCHING} actuators, as a plate that stretches is solved in one '
            f"dense model of all of them; got {count}; a piece of the array with {MAX_STRETCHING} can stretch",
        )
    if scheme == "paper":
        yield (
            ("run", "scheme"),
            f'must be "events" or "fixed" with {VON_KARMAN}, whose mid-plane also moves in its plane; got "paper"',
        )


def common_period(one: float | None, other: float) -> float:
    """The shortest whole multiple of both periods [s], to rounding; inf: there is none of up to MAX_CYCLES of each."""
    if one is None:
        return other
    ratio = Fraction(one / other).limit_denominator(MAX_CYCLES)
    cycles = float(ratio.numerator), float(ratio.denominator)
    if min(cycles) < 1 or max(cycles) > MAX_CYCLES:
        return math.inf
    shared = cycles[1] * one
    return shared if abs(shared - cycles[0] * other) <= ROUNDING * shared else math.inf


def _aperiodic(parts: Parts) -> Iterator[Mistake]:
    """Yield the drive of one frequency with which those before it have no common period."""
    period: float | None = None
    for location, values in _driven(parts):
        frequency, dwell = values["frequency"], values["dwell"]
        still = values["stroke"] == 0 or values["force"] == 0
        if not isinstance(frequency, float) or not isinstance(dwell, float) or still:
            continue
        own = 1 / frequency + (2 * dwell if values["cycle"] == "up-down" else 0.0)
        if math.isinf(shared := common_period(period, own)):
            yield (
                (*location, "frequency"),
                f"must have a common period with the drives before it, with {VON_KARMAN} and {STEADY}; got a period of "
                f"{own * 1e3:.7g} ms, and {(period or 0.0) * 1e3:.7g} ms of those; take frequencies in a ratio of "
                "small whole numbers",
            )
            return
        period = shared


def _driven(parts: Parts) -> list[tuple[Location, Mapping[str, Any]]]:
    """The values of all actuators, and of the lattice as one."""
    driven: list[tuple[Location, Mapping[str, Any]]] = [
        (("actuators", index), ActuatorCase.values_of(value, parts.context))
        for index, (value, _) in enumerate(parts.items("actuators"))
        if isinstance(value, (dict, ActuatorCase))
    ]
    lattice = parts.tables.get("lattice")
    if isinstance(lattice, (dict, LatticeCase)):
        driven.append((("lattice",), LatticeCase.values_of(lattice, parts.context)))
    return driven


def _ending(parts: Parts) -> Iterator[Mistake]:
    """Yield the drives that end, or grow, and so have no steady state."""
    for location, values in _driven(parts):
        if values["cycle"] == "up":
            yield (*location, "cycle"), f'must not be "up" with {STEADY} in [run], which takes a drive without end'
        if isinstance(values["cycles"], int):
            yield (*location, "cycles"), f"must not be given with {STEADY} in [run], which takes a drive without end"
        if any(isinstance(values[key], tuple) for key in ("table", "segments")) and isinstance(values["repeats"], int):
            message = f'must be "{ENDLESS}" with {STEADY} in [run], which takes a drive without end'
            yield (*location, "repeats"), message
        if isinstance(values["ramp"], float) and values["ramp"] > 0:
            yield (*location, "ramp"), f"must not be given with {STEADY} in [run], in which no drive begins"
