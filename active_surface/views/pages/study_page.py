"""The page of a sweep: its map, and the path of the cell that is chosen."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from active_surface.studies import Engine, Study, Sweep, lines
from active_surface.studies.pictures import Findings, Selection
from active_surface.views.pages.page_file import notes_of, rows_of, write_page
from active_surface.views.pages.study_data import study_data
from active_surface.views.pages.sweep_paths import Paths, find_paths, spread, usual_count
from common import joined
from coupling import ProgressCallback, no_progress, report

if TYPE_CHECKING:
    import xarray

PROGRAMS = "plan.js", "study_map.js", "study.js"


def write_study_page(
    study: Study, dataset: xarray.Dataset, path: Path, paths: int | None = None, tell: ProgressCallback = no_progress
) -> Path:
    """Writes the page of a sweep to an HTML file, as a whole or not at all; returns its path.

    paths: how many paths to find for it; None: as many as take about a minute, at most 2 500. `tell` gets how many are
    found, and of how many.
    """
    selection = Selection.of(Findings.of(study.name, dataset, study.threshold))
    engine = Engine(study)
    numbers, ends = selection.numbers[..., 0], selection.end[..., 0, :]
    chosen = spread(numbers.shape, usual_count(engine) if paths is None else paths)
    followed = find_paths(engine, numbers[chosen], ends[chosen], tell)
    starts = np.stack([dataset[f"start_{c}"].values.ravel()[numbers] for c in "xy"], axis=-1)
    sweep = Sweep(study, dataset)
    fixed = ", ".join(f"{name} = {text}" for name, text in selection.fixed.items())
    title = f"A sweep of {joined([axis.name for axis in study.points.axes])}"
    texts = {
        "name": escape(study.name),
        "title": escape(title),
        "sentence": escape(f"Base case: {report.device(study.case)}. {_sentence(study, selection, followed)}"),
        "warnings": notes_of([*sweep.warnings, *_warnings(followed)]),
        "rows": rows_of([*lines(sweep), *([("shown at", fixed)] if fixed else [])]),
        "study": escape(study.source),
        "case": escape(study.case.source or study.case.model_dump_json(indent=2)),
    }
    data = study_data(study, selection, starts, followed)
    return write_page(path, f"{study.name}: {title}", "study.html", texts, data, PROGRAMS)


def _sentence(study: Study, selection: Selection, followed: Paths) -> str:
    """What there is to be seen."""
    repeats = study.points.repeats
    sentence = f"{selection.numbers[..., 0].size} points" + (f", each with {repeats} starts" if repeats > 1 else "")
    known = int(np.isfinite(selection.mean_distance).sum())
    if not followed.lines:
        return f"{sentence}. A click on a point shows where its path starts and ends." if known else f"{sentence}."
    if len(followed.lines) == known:
        return f"{sentence}. A click on a point shows its path."
    some = f"{len(followed.lines)}, of {known}, in this page"
    return f"{sentence}. A click on a point shows its path, if it is one of the {some}."


def _warnings(followed: Paths) -> list[str]:
    """What is to be known of the paths."""
    if not followed.strangers:
        return []
    which = f"{followed.strangers} of the {len(followed.lines)} paths, found once more for this page,"
    return [f"{which} end elsewhere than in the sweep: other versions made it, or the paths are chaotic."]
