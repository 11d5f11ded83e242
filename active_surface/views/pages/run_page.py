"""The page of a run: its surface in motion with the part on it, its motion over time, and what is said of it."""

from __future__ import annotations

from html import escape
from pathlib import Path

from active_surface.views.pages.page_file import notes_of, rows_of, write_page
from active_surface.views.pages.run_data import run_data
from coupling import report, summary_of
from coupling.results import SavedRun

PROGRAMS = "surface.js", "curves.js", "run.js"
PARTIAL = "The results are partial, as they were not written to their end: this page shows the steps that were."


def write_run_page(run: SavedRun, path: Path) -> Path:
    """Writes the page of a run to an HTML file, as a whole or not at all; returns its path."""
    summary = summary_of(run.summary)
    warnings = [*([] if run.complete else [PARTIAL]), *report.warnings(summary)]
    versions = ", ".join(f"{name} {version}" for name, version in run.versions.items())
    texts = {
        "name": escape(run.name),
        "sentence": escape(summary.sentence),
        "warnings": notes_of(warnings),
        "rows": rows_of([*report.lines(summary), ("versions", versions)]),
        "case": escape(run.case.source or run.case.model_dump_json(indent=2)),
    }
    return write_page(path, run.name, "run.html", texts, run_data(run), PROGRAMS)
