"""The page of a run: its surface in motion with the part on it, its motion over time, and what is said of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path

from active_surface.views.pages.page_file import part, rows_of, trust_of, write_page
from active_surface.views.pages.run_data import run_data
from active_surface.views.result_file import part_of
from common import unit_for
from coupling import report, summary_of
from coupling.results import SavedRun, name_of
from particle import EventKind

PROGRAMS = "surface.js", "curves.js", "run.js"
MAX_NAMED = 3  # actuators
PARTIAL = "The results are partial, as they were not written to their end: this page shows the steps that were."


def write_run_page(run: SavedRun, path: Path, others: Sequence[SavedRun] = ()) -> Path:
    """Writes the page of a run to an HTML file, as a whole or not at all; returns its path.

    others: over the same surface, whose parts are shown as well.
    """
    summary, device = summary_of(run.summary), report.device(run.case, 1 + len(others))
    name, sentence = run.name, " ".join([summary.sentence, *motion(run)])
    warnings, rows = report.warnings(summary), report.lines(summary, verbose=True)
    if others:
        name, summaries = name_of(run.plate_path), {part_of(one): summary_of(one.summary) for one in (run, *others)}
        warnings = report.warnings_of_parts({part: report.warnings(one) for part, one in summaries.items()})
        warnings = [overlap.sentence for overlap in run.overlaps] + warnings
        rows = report.lines_of_parts(summaries)
        sentence = " ".join(f"{part}: {one.sentence}" for part, one in summaries.items())
        sentence += f" Clock, curves and numbers are those of {part_of(run)}."
    warnings = [*([] if all(one.complete for one in (run, *others)) else [PARTIAL]), *warnings]
    versions = ", ".join(f"{name} {version}" for name, version in run.versions.items())
    texts = {
        "views": part("views.html"),
        "name": escape(name),
        "device": escape(device),
        "sentence": escape(report.with_micro_signs(sentence)),
        "trust": trust_of(report.trust(summary), warnings),
        "rows": rows_of([*rows, ("versions", versions)]),
        "case": escape(run.case.source or run.case.model_dump_json(indent=2)),
    }
    return write_page(path, f"{name}: {device}", "run.html", texts, run_data(run, others), PROGRAMS)


def motion(run: SavedRun) -> list[str]:
    """Sentences on when the part slipped, stopped and was lost, and which actuators did most where it began to slip."""
    unit = unit_for(run.time, "s")
    slips, stops = (
        [k for k, event in enumerate(run.events) if event.kind is kind] for kind in (EventKind.SLIPS, EventKind.STOPS)
    )
    lost = f"is lost at {run.loss.time * unit.per_si:.4g} {unit.name}" if run.loss else ""
    if not slips:
        return [f"It {lost}."] if lost else []
    first, last = (f"{run.events[k].time * unit.per_si:.4g} {unit.name}" for k in (slips[0], [*slips, *stops][-1]))
    times = "once, at" if len(slips) == 1 else f"{len(slips)} times, first at"
    stopped = f", and stops last at {last}" if stops and stops[-1] > slips[-1] else ""
    stopped += f", and {lost}" if lost else ""
    sentences = [f"It begins to slip {times} {first}{stopped}."]
    counts = Counter(actuator for actuator in run.event_actuators[slips].tolist() if actuator >= 0).most_common()
    if len(counts) == 1:
        return [*sentences, f"Actuator {counts[0][0]} {report.PULLS} that makes it slip."]
    if counts:
        (leading, often), *rest = counts
        some = [f"Actuator {leading} {report.PULLS} in {often} of these slips"]
        some += [f"actuator {actuator} in {count}" for actuator, count in rest[: MAX_NAMED - 1]]
        others = f", others in {sum(count for _, count in counts[MAX_NAMED:])}" * (len(counts) > MAX_NAMED)
        sentences.append(f"{', '.join(some)}{others}.")
    return sentences
