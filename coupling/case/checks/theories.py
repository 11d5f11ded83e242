"""Check that a plate's theory and the drives of a case go with the run."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any, Final

from coupling.case.actuators import ENDLESS, ActuatorCase
from coupling.case.plates import INERTIA, VON_KARMAN, PlateCase
from coupling.case.table import Location, Mistake, Table
from coupling.case.tables import RunCase

MAX_STRETCHING: Final = 200
"""Actuators of a plate that stretches."""
MAX_VIBRATING: Final = 250
"""Actuators of a plate with inertia, under a pressure, on a foundation, or of a wafer under a tension."""
STEADY: Final = 'start = "steady"'
MAX_PERIODS: Final = 1000  # of one drive in the common period
MAX_CYCLES: Final = 100_000  # of one drive: a part that slips all the while takes minutes and up to 3 GB
MAX_TOGETHER: Final = 10_000_000  # of all drives
ROUNDING: Final = 4 * sys.float_info.epsilon


def check_theory(plate: PlateCase, run: RunCase, made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield what a plate does not go with; alone: how many actuators are not of the lattice."""
    stretches, count = plate.theory == "von-karman", len(made)
    if stretches:
        if run.scheme == "paper":
            moves = "whose mid-plane also moves in its plane"
            yield ("run", "scheme"), f'must be "events" or "fixed" with {VON_KARMAN}, {moves}; got "paper"'
        for key, unit in (("tension", "N/m"), ("pressure", "Pa"), ("foundation", "N/m^3")):
            if value := getattr(plate, key):
                yield ("plate", key), f"must be 0 with {VON_KARMAN}; got {value:g} {unit}; leave out one of the two"
    general = [
        ("theory", '"linear"', stretches, MAX_STRETCHING),
        ("inertia", "false", plate.inertia, MAX_VIBRATING),
        ("pressure", "0", plate.pressure, MAX_VIBRATING),
        ("foundation", "0", plate.foundation, MAX_VIBRATING),
        ("tension", "0 with a wafer", plate.wafer and plate.tension, MAX_VIBRATING),
    ]
    for key, instead, has, most in general:
        if has and count > most:
            piece = f"as it needs one model of the whole plate; got {count}; use a piece of the array"
            yield ("plate", key), f"must be {instead} with more than {most} actuators, {piece}"
    if run.start != "steady":
        return
    if not plate.inertia:
        yield ("run", "start"), f"must not be given without {INERTIA} in [plate]; only then do vibrations build up"
    yield from _endless(made, alone)
    if plate.inertia and stretches:
        yield from _periodic(made, alone)
        damping = plate.damping
        if (damping if isinstance(damping, float) else min(ratio for _, ratio in damping)) == 0:
            rings = "as the steady state is what is left when all ringing has decayed"
            yield ("plate", "damping"), f"must be a positive ratio with {VON_KARMAN} and {STEADY}, {rings}"


def common_period(one: float | None, other: float) -> float:
    """The shortest whole multiple of both periods [s], to rounding; inf: there is none of up to MAX_PERIODS of each."""
    if one is None:
        return other
    ratio = Fraction(one / other).limit_denominator(MAX_PERIODS)
    cycles = float(ratio.numerator), float(ratio.denominator)
    if min(cycles) < 1 or max(cycles) > MAX_PERIODS:
        return math.inf
    shared = cycles[1] * one
    return shared if abs(shared - cycles[0] * other) <= ROUNDING * shared else math.inf


def _location(k: int, alone: int, key: str) -> Location:
    return ("actuators", k, key) if k < alone else ("lattice", key)


def _periodic(made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield the first drive with which those before it have no common period."""
    period: float | None = None
    for k, one in enumerate(made):
        if one.frequency is None or one.stroke == 0 or one.force == 0:
            continue
        own = 1 / one.frequency + (2 * one.dwell if one.cycle == "up-down" else 0.0)
        if math.isinf(shared := common_period(period, own)):
            got = f"got a period of {own * 1e3:.15g} ms, and {(period or 0.0) * 1e3:.15g} ms before"
            must = f"must have a common period with the drives before it, with {VON_KARMAN} and {STEADY}"
            yield _location(k, alone, "frequency"), f"{must}; {got}; use frequencies in a ratio of small whole numbers"
            return
        period = shared


def _endless(made: Sequence[ActuatorCase], alone: int) -> Iterator[Mistake]:
    """Yield the drives that end, or grow, and so have no steady state; of a lattice its first."""
    why = f"with {STEADY} in [run], which takes a drive without end"
    for k, one in enumerate(made[: alone + 1]):
        if one.cycle == "up":
            yield _location(k, alone, "cycle"), f'must not be "up" {why}'
        if one.cycles is not None:
            yield _location(k, alone, "cycles"), f"must not be given {why}"
        if (one.table or one.segments) and one.repeats != ENDLESS:
            yield _location(k, alone, "repeats"), f'must be "{ENDLESS}" {why}'
        if one.ramp > 0:
            yield _location(k, alone, "ramp"), f"must not be given {why}"


def cycles_fault(plate: Table, actuators: Iterable[Any], duration: float) -> str:
    """What is wrong with a duration [s] in which drives make more strokes than can be followed; "": nothing."""
    motion = getattr(plate, "motion", None)
    axes = [drive for _, drive in motion if drive is not None] if isinstance(motion, Table) else []
    counts = [_cycles(drive, duration) for drive in (*actuators, *axes)]
    for count, most, of in (
        (max(counts, default=0.0), MAX_CYCLES, "each drive"),
        (sum(counts), MAX_TOGETHER, "all drives together"),
    ):
        if count > most:
            return f"must have at most {most} cycles, or points, of {of}; got {count:.3g} in {duration:g} s"
    return ""


def _cycles(drive: Any, duration: float) -> float:
    """How many cycles, or points, a drive runs through in a time [s]."""
    if drive.table:
        return _in_passes([(drive.table[-1][0], len(drive.table))], drive.repeats, duration)
    if drive.segments:
        pieces = [(s.cycles * (1 / s.frequency if s.frequency else s.dwell), s.cycles) for s in drive.segments]
        return _in_passes(pieces, drive.repeats, duration)
    if drive.cycle == "up":
        return 0.0
    return min(duration * drive.frequency, math.inf if drive.cycles is None else drive.cycles)


def _in_passes(pieces: list[tuple[float, int]], repeats: Any, duration: float) -> float:
    """How many cycles there are in a time [s] of pieces, each some time with some cycles, that are repeated."""
    total = sum(time for time, _ in pieces)
    passes = min(math.inf if repeats == ENDLESS else repeats, duration / total if total > 0 else 1.0)
    left = (passes - passes // 1) * total
    count = passes // 1 * sum(cycles for _, cycles in pieces)
    for time, cycles in pieces:
        count += cycles * min(1.0, left / time) if time > 0 else 0.0
        left = max(0.0, left - time)
    return count
