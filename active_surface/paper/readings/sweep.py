"""Sweep: every reading in every model."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter, process_time
from typing import Final, NamedTuple

from active_surface.paper.models import CLOSED, PAPER, PLATE, Ground
from active_surface.paper.readings.kept import keep, kept_rows
from active_surface.paper.readings.reading import READINGS, RIM, Reading, SweepSize, benches_of
from active_surface.paper.readings.single import Shares, of_one
from active_surface.paper.readings.two import of_two
from coupling import Progress, silent

USUAL: Final = SweepSize(READINGS, starts=8, step=20.0, frequencies=18, across=14)


class Row(NamedTuple):
    """What becomes of all statements by one reading."""

    reading: Reading
    shares: dict[str, Shares]  # by model
    thresholds: dict[str, float]  # Hz, of figure 18
    seconds: float
    processor: float  # s, of all threads


class Sweep(NamedTuple):
    """All rows."""

    size: SweepSize
    rows: list[Row]

    @property
    def seconds(self) -> float:
        """How long it took in all, also before it was stopped."""
        return sum(row.seconds for row in self.rows)

    @property
    def processor(self) -> float:
        """The processor time [s] of that."""
        return sum(row.processor for row in self.rows)


def row_of(reading: Reading, size: SweepSize, grounds: dict[str, dict[tuple[str, str], Ground]]) -> Row:
    """One reading in all models; the plate differs from closed forms only where there are two actuators."""
    begun, worked, benches = perf_counter(), process_time(), benches_of(reading, grounds)
    shares: dict[str, Shares] = {}
    levels = {}
    for model in (PAPER, CLOSED):
        single, levels[model] = of_one(benches, RIM, model, size)
        shares[model] = single | of_two(benches, model, size)
    shares[PAPER] |= {name: shares[CLOSED][name] for name in ("5", "6", "5, 6 (range)")}
    shares[PLATE] = of_two(benches, PLATE, size)
    return Row(reading, shares, levels, perf_counter() - begun, process_time() - worked)


def sweep_readings(size: SweepSize = USUAL, kept: Path | None = None, progress: Progress = silent) -> Sweep:
    """All readings of a sweep.

    kept: a file of lines, one a reading, that is gone on with if it is of the same sweep.
    """
    done = {(reading := Reading(*one.pop("reading"))): Row(reading, **one) for one in kept_rows(kept, size)}
    grounds: dict[str, dict[tuple[str, str], Ground]] = {}
    with progress("Sweeping readings of the paper") as tell:
        for k, reading in enumerate(size.readings):
            if reading not in done:
                done[reading] = row_of(reading, size, grounds)
                keep(kept, size, done[reading])
            tell(k + 1, len(size.readings))
    return Sweep(size, [done[reading] for reading in size.readings])
