"""The page of a sweep: its map, and the path of the cell that is chosen."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from coupling.progress import Tell, untold
from studies.engine import Engine
from studies.report import lines
from studies.run import Sweep
from studies.shown import Shown
from studies.study import Study
from views.page_file import notes_of, rows_of, write_page
from views.study_data import study_data
from views.sweep_paths import find_paths, spread, usual_count

if TYPE_CHECKING:
    import xarray


def write_study_page(
    study: Study, dataset: xarray.Dataset, path: Path, paths: int | None = None, tell: Tell = untold
) -> Path:
    """Writes the page of a sweep to an HTML file, as a whole or not at all; returns its path.

    paths: how many paths to find for it; None: as many as take about a minute, at most 2 500. `tell` gets how many are
    found, and of how many.
    """
    shown = Shown.of(study, dataset)
    engine = Engine(study)
    numbers, ends = shown.numbers[..., 0], shown.end[..., 0, :]
    chosen = spread(numbers.shape, usual_count(engine) if paths is None else paths)
    found = find_paths(engine, numbers[chosen], ends[chosen], tell)
    starts = np.stack([dataset[f"start_{c}"].values.ravel()[numbers] for c in "xy"], axis=-1)
    sweep = Sweep(study, dataset)
    warnings = sweep.warnings
    if found.strangers:
        said = f"{found.strangers} of the {len(found.lines)} paths, found anew for this page, end elsewhere than in the sweep"
        warnings.append(f"{said}: it was made by other versions.")
    fixed = [("shown at", ", ".join(f"{name} = {text}" for name, text in shown.fixed.items()))] if shown.fixed else []
    said = f"{numbers.size} points" + (f", each with {study.points.repeats} starts" if study.points.repeats > 1 else "")
    with_path = np.isin(numbers, list(found.lines))
    known = np.isfinite(ends).all(axis=-1)
    if with_path[known].all():
        has = "A click on a point shows its path."
    else:
        has = f"A click on a point shows its path if this page has it: {len(found.lines)} of {int(known.sum())} are here."
    texts = {
        "name": escape(study.name),
        "sentence": escape(f"{said}. {has}"),
        "warnings": notes_of(warnings),
        "rows": rows_of([*lines(sweep), *fixed]),
        "study": escape(study.source),
        "case": escape(study.case.source or study.case.model_dump_json(indent=2)),
    }
    return write_page(path, study.name, "study.html", texts, study_data(shown, starts, found), ["study.js"])
