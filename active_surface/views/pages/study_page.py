"""The page of a sweep: its map, and the path of the cell that is chosen."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from active_surface.studies import Engine, Study, Sweep, lines
from active_surface.studies.pictures import Findings, Shown
from active_surface.views.pages.page_file import notes_of, rows_of, write_page
from active_surface.views.pages.study_data import study_data
from active_surface.views.pages.sweep_paths import Paths, find_paths, spread, usual_count
from coupling import ProgressCallback, no_progress

if TYPE_CHECKING:
    import xarray

PROGRAMS = "study_map.js", "study_path.js", "study.js"


def write_study_page(
    study: Study, dataset: xarray.Dataset, path: Path, paths: int | None = None, tell: ProgressCallback = no_progress
) -> Path:
    """Writes the page of a sweep to an HTML file, as a whole or not at all; returns its path.

    paths: how many paths to find for it; None: as many as take about a minute, at most 2 500. `tell` gets how many are
    found, and of how many.
    """
    shown = Shown.of(Findings.of(study.name, dataset, study.threshold))
    engine = Engine(study)
    numbers, ends = shown.numbers[..., 0], shown.end[..., 0, :]
    chosen = spread(numbers.shape, usual_count(engine) if paths is None else paths)
    found = find_paths(engine, numbers[chosen], ends[chosen], tell)
    starts = np.stack([dataset[f"start_{c}"].values.ravel()[numbers] for c in "xy"], axis=-1)
    sweep = Sweep(study, dataset)
    fixed = ", ".join(f"{name} = {text}" for name, text in shown.fixed.items())
    texts = {
        "name": escape(study.name),
        "sentence": escape(_sentence(study, shown, found)),
        "warnings": notes_of([*sweep.warnings, *_warnings(found)]),
        "rows": rows_of([*lines(sweep), *([("shown at", fixed)] if fixed else [])]),
        "study": escape(study.source),
        "case": escape(study.case.source or study.case.model_dump_json(indent=2)),
    }
    return write_page(path, study.name, "study.html", texts, study_data(study, shown, starts, found), PROGRAMS)


def _sentence(study: Study, shown: Shown, found: Paths) -> str:
    """What there is to be seen."""
    repeats = study.points.repeats
    said = f"{shown.numbers[..., 0].size} points" + (f", each with {repeats} starts" if repeats > 1 else "")
    known = int(np.isfinite(shown.mean_distance).sum())
    if not found.lines:
        return f"{said}. A click on a point shows where its path starts and ends." if known else f"{said}."
    if len(found.lines) == known:
        return f"{said}. A click on a point shows its path."
    return (
        f"{said}. A click on a point shows its path, if it is one of the {len(found.lines)}, of {known}, in this page."
    )


def _warnings(found: Paths) -> list[str]:
    """What is to be known of the paths."""
    if not found.strangers:
        return []
    which = f"{found.strangers} of the {len(found.lines)} paths, found once more for this page,"
    return [f"{which} end elsewhere than in the sweep: other versions made it, or the paths are chaotic."]
