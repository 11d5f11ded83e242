"""Sweep: every reading in every model, kept line by line, so that one that was stopped goes on where it was."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, Final, NamedTuple

from active_surface.paper.models import CLOSED, PAPER, PLATE, Ground
from active_surface.paper.readings.reading import CONSTANT, READINGS, RIM, Reading, SweepSize, benches_of
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


class Sweep(NamedTuple):
    """All rows."""

    size: SweepSize
    rows: list[Row]

    @property
    def seconds(self) -> float:
        """How long it took in all, also before it was stopped."""
        return sum(row.seconds for row in self.rows)


def row_of(reading: Reading, size: SweepSize, grounds: dict[str, dict[tuple[str, str], Ground]]) -> Row:
    """One reading in all models.

    The plate differs from closed forms only where there are two actuators, and the paper's scheme, whose paths take
    twenty times longer, is asked with the rough contact alone, as it has little to lose parts by.
    """
    begun, benches = perf_counter(), benches_of(reading, grounds)
    shares: dict[str, Shares] = {}
    levels = {}
    for model in (CLOSED,) if reading.law == CONSTANT else (PAPER, CLOSED):
        single, levels[model] = of_one(benches, RIM, model, size)
        shares[model] = single | of_two(benches, model, size)
    if PAPER in shares:
        shares[PAPER] |= {name: shares[CLOSED][name] for name in ("5", "6", "5, 6 (range)")}
    shares[PLATE] = of_two(benches, PLATE, size)
    return Row(reading, shares, levels, perf_counter() - begun)


def sweep_readings(size: SweepSize = USUAL, kept: Path | None = None, progress: Progress = silent) -> Sweep:
    """All readings of a sweep.

    kept: a file of lines, one a reading, that is gone on with if it is of the same sweep.
    """
    done = _read(kept, size) if kept else {}
    grounds: dict[str, dict[tuple[str, str], Ground]] = {}
    with progress("Sweeping readings of the paper") as tell:
        for k, reading in enumerate(size.readings):
            if reading not in done:
                done[reading] = row_of(reading, size, grounds)
                if kept:
                    _keep(kept, size, done[reading])
            tell(k + 1, len(size.readings))
    return Sweep(size, [done[reading] for reading in size.readings])


def _keep(path: Path, size: SweepSize, row: Row) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        file.write(json.dumps({"size": list(size[1:])} | row._asdict()) + "\n")


def _read(path: Path, size: SweepSize) -> dict[Reading, Row]:
    """What is kept of the same sweep; a last line that was cut off is passed over."""
    if not path.exists():
        return {}
    rows = [one for line in path.read_text().splitlines() if (one := _parsed(line)) and one["size"] == list(size[1:])]
    readings: Sequence[Reading] = [Reading(*one["reading"]) for one in rows]
    return {
        reading: Row(reading, one["shares"], one["thresholds"], one["seconds"])
        for reading, one in zip(readings, rows, strict=True)
    }


def _parsed(line: str) -> dict[str, Any] | None:
    try:
        return json.loads(line)  # type: ignore[no-any-return]
    except json.JSONDecodeError:
        return None
