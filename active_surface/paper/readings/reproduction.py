"""reproduce readings: the sweep, its page and its data."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Any, Final, NamedTuple

from active_surface.paper.models import CLOSED, PAPER
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.cases import STATEMENTS, best_row, met
from active_surface.paper.readings.contact import variants_of
from active_surface.paper.readings.page import page_of_readings
from active_surface.paper.readings.reading import INDEX, Reading, SweepSize
from active_surface.paper.readings.sweep import USUAL, Sweep, sweep_readings
from active_surface.paper.reproduction import FOLDER, replace_file, written_as_json
from coupling import Progress, silent

PAGE, DATA, KEPT = "paper-readings.md", "readings.json", "readings.partial.jsonl"
FIGURES: Final = Reading(PARAMETERS.radius, PARAMETERS.gravity, INDEX)  # the reading of docs/paper.md
TITLE: Final = "The paper's statements over its readings"


class Readings(NamedTuple):
    """What was found, and where it was written."""

    sweep: Sweep
    files: tuple[Path, ...]
    seconds: float

    @property
    def summary(self) -> dict[str, Any]:
        """For JSON."""
        best = best_row(self.sweep)
        held = {model: met(best, model) for model in (PAPER, CLOSED)}
        return {"best_reading": best.reading._asdict(), "hold": held, "seconds": self.seconds}

    @property
    def lines(self) -> list[tuple[str, str]]:
        """In words."""
        best = best_row(self.sweep)
        return [
            ("best", best.reading.name),
            ("  paper", f"{len(met(best, PAPER))} of {len(STATEMENTS)} statements hold"),
            ("  closed", f"{len(met(best, CLOSED))} of {len(STATEMENTS)} statements hold"),
        ]


def reproduce_readings(output: Path, size: SweepSize = USUAL, progress: Progress = silent) -> Readings:
    """Sweeps all readings and writes the page and the data; what is done is kept until all is."""
    begun, kept = perf_counter(), output / FOLDER / KEPT
    sweep = sweep_readings(size, kept, progress)
    page, data = output / PAGE, output / FOLDER / DATA
    variants = variants_of(FIGURES, size, progress)
    replace_file(page, page_of_readings(sweep, variants))
    rows = [row._asdict() | {"reading": row.reading._asdict()} for row in sweep.rows]
    replace_file(
        data,
        written_as_json(
            {
                "title": TITLE,
                "size": sweep.size._asdict() | {"readings": len(rows)},
                "rows": rows,
                "variants": [one._asdict() for one in variants],
            }
        ),
    )
    kept.unlink(missing_ok=True)
    return Readings(sweep, (page, data), perf_counter() - begun)
