"""Count the strokes that all drives make in a run, which take time each."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, Final

from coupling.case.actuators import ENDLESS
from coupling.case.table import Table

MAX_CYCLES: Final = 100_000  # of one drive: a part that slips all the while takes minutes and up to 3 GB
MAX_TOGETHER: Final = 10_000_000  # of all drives


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
