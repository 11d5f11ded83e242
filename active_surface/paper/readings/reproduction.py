"""reproduce readings: the sweep, its page and its data."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Any, Final, NamedTuple

from active_surface.paper.models import CLOSED, PAPER
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.readings.builder import ALL, Builder, BuilderSize, see
from active_surface.paper.readings.cases import STATEMENTS, best_row, met
from active_surface.paper.readings.conclusions import summary
from active_surface.paper.readings.page import page_of_readings
from active_surface.paper.readings.picture import NAME, draw_windows
from active_surface.paper.readings.reading import INDEX, Reading, SweepSize
from active_surface.paper.readings.sensitivity import sensitivity_of
from active_surface.paper.readings.sweep import USUAL, Sweep, sweep_readings
from active_surface.paper.reproduction import FOLDER, replace_file, written_as_json
from coupling import Progress, silent

PAGE, DATA, SUMMARY = "paper-readings.md", "readings.json", "builder"
KEPT, KEPT_DEVICES = "readings.partial.jsonl", "devices.partial.jsonl"
FIGURES: Final = Reading(PARAMETERS.radius, PARAMETERS.gravity, INDEX)  # the reading of docs/paper.md
TITLE: Final = "The paper's statements over its readings"


class Readings(NamedTuple):
    """What was found, and where it was written."""

    sweep: Sweep
    builder: Builder
    files: tuple[Path, ...]
    seconds: float

    @property
    def summary(self) -> dict[str, Any]:
        """For JSON."""
        best = best_row(self.sweep)
        held = {model: met(best, model) for model in (PAPER, CLOSED)}
        said = summary(self.builder)
        return {"best_reading": best.reading._asdict(), "hold": held, SUMMARY: said, "seconds": self.seconds}

    @property
    def lines(self) -> list[tuple[str, str]]:
        """In words."""
        best = best_row(self.sweep)
        return [
            ("best", best.reading.name),
            ("  paper", f"{len(met(best, PAPER))} of {len(STATEMENTS)} statements hold"),
            ("  closed", f"{len(met(best, CLOSED))} of {len(STATEMENTS)} statements hold"),
        ]


def reproduce_readings(
    output: Path, size: SweepSize = USUAL, more: BuilderSize = ALL, progress: Progress = silent
) -> Readings:
    """Sweeps all readings and devices, and writes the page and the data; what is done is kept until all is."""
    begun, folder = perf_counter(), output / FOLDER
    sweep = sweep_readings(size, folder / KEPT, progress)
    sensitivity = sensitivity_of(FIGURES, size, progress)
    builder = see(size, more, folder / KEPT_DEVICES, progress)
    page, data, picture = output / PAGE, folder / DATA, folder / NAME
    draw_windows(builder.windows.placing, picture)
    replace_file(page, page_of_readings(sweep, sensitivity, builder))
    rows, devices = (
        [row._asdict() | {name: getattr(row, name)._asdict()} for row in own]  # type: ignore[attr-defined]
        for name, own in (("reading", sweep.rows), ("device", builder.rows))
    )
    whole = {
        "title": TITLE, "size": sweep.size._asdict() | {"readings": len(rows)}, "rows": rows,
        "sensitivity": {name: [one._asdict() for one in own] for name, own in sensitivity._asdict().items()},
        "devices": devices, "plates": [one._asdict() for one in builder.plates], "inertia": builder.inertia._asdict(),
        "losses": [one._asdict() for one in builder.losses],
        "windows": {name: [one._asdict() for one in own] for name, own in builder.windows._asdict().items()},
        SUMMARY: summary(builder),
    }  # fmt: skip
    replace_file(data, written_as_json(whole))
    for name in (KEPT, KEPT_DEVICES):
        (folder / name).unlink(missing_ok=True)
    return Readings(sweep, builder, (page, data, picture), perf_counter() - begun)
