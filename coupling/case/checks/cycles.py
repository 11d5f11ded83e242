"""Checking: how many strokes all drives make in a run, which take time each."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

from coupling.case.actuators import ENDLESS, ActuatorCase
from coupling.case.checks.parts import Parts
from coupling.case.mistakes import Mistake
from coupling.case.plates import AxisCase
from coupling.case.table import Table, right_value
from coupling.case.tables import RunCase

MAX_CYCLES: Final = 100_000  # of one drive: a part that slips all the while takes minutes and up to 3 GB
MAX_TOGETHER: Final = 10_000_000  # of all drives


def check_cycles(parts: Parts, lattice: Iterable[ActuatorCase]) -> Iterator[Mistake]:
    """Yield that drives make more strokes in a run than can be followed; lattice: its actuators."""
    duration = right_value(RunCase, "duration", parts.tables.get("run"), parts.context)
    if not isinstance(duration, float):
        return
    drives = [ActuatorCase.values_of(one, parts.context) for one, _ in parts.items("actuators") if _is_table(one)]
    drives += [dict(one) for one in lattice]
    plate = parts.tables.get("plate")
    motion = plate.get("motion") if isinstance(plate, Mapping) else getattr(plate, "motion", None)
    axes = motion.values() if isinstance(motion, Mapping) else vars(motion).values() if _is_table(motion) else ()
    drives += [AxisCase.values_of(one, parts.context) for one in axes if _is_table(one)]
    if wrong := _too_many(drives, duration):
        yield ("run", "duration"), wrong


def cycles_fault(plate: Table, actuators: Iterable[Table], duration: float) -> str:
    """That the drives of a case make more strokes in a time [s] than can be followed, or nothing."""
    motion = getattr(plate, "motion", None)
    axes = vars(motion).values() if _is_table(motion) else ()
    wrong = _too_many([vars(one) for one in (*actuators, *axes) if _is_table(one)], duration)
    return f"run.duration {wrong}" if wrong else ""


def _too_many(drives: Iterable[Mapping[str, Any]], duration: float) -> str:
    counts = [_cycles(drive, duration) for drive in drives]
    for count, most, of in (
        (max(counts, default=0.0), MAX_CYCLES, "each drive"),
        (sum(counts), MAX_TOGETHER, "all drives together"),
    ):
        if count > most:
            return f"must hold at most {most} cycles, or points, of {of}; got {count:.3g} in {duration:g} s"
    return ""


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping) or hasattr(value, "model_fields_set")


def _cycles(drive: Mapping[str, Any], duration: float) -> float:
    """How many cycles, or points, a drive runs through in a time [s]; 0 where it is wrong."""
    table, segments, frequency = drive["table"], drive["segments"], drive["frequency"]
    if isinstance(table, tuple) and table:
        return _in_passes([(table[-1][0], len(table))], drive["repeats"], duration)
    if isinstance(segments, tuple) and segments:
        pieces = [(one.cycles * (1 / one.frequency if one.frequency else one.dwell), one.cycles) for one in segments]
        return _in_passes(pieces, drive["repeats"], duration)
    if not isinstance(frequency, float) or drive["cycle"] == "up":
        return 0.0
    cycles = drive["cycles"]
    return min(duration * frequency, cycles if isinstance(cycles, int) else math.inf)


def _in_passes(pieces: list[tuple[float, int]], repeats: Any, duration: float) -> float:
    """How many cycles there are in a time [s] of pieces, each some time with some cycles, that are repeated."""
    total = sum(time for time, _ in pieces)
    most = repeats if isinstance(repeats, int) else math.inf if repeats == ENDLESS else 0
    passes = min(most, duration / total if total > 0 else 1.0)
    left = (passes - passes // 1) * total
    count = passes // 1 * sum(cycles for _, cycles in pieces)
    for time, cycles in pieces:
        count += cycles * min(1.0, left / time) if time > 0 else 0.0
        left = max(0.0, left - time)
    return count
