"""The page of a drift: where parts go from everywhere, for one group of actuators at a time, and where they end."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from active_surface.studies.drifts import LOST, Drift, DriftMap, Fate, shades
from active_surface.views.pages.packed import packed
from active_surface.views.pages.page_file import notes_of, rows_of, write_page
from common import percent, quantity, unit_for
from coupling import report
from meshes import rim_curves

PROGRAMS = "plan.js", "drift.js"


def write_drift_page(found: Drift, path: Path) -> Path:
    """Writes the page of a drift to an HTML file, as a whole or not at all; returns its path."""
    case, first = found.case, found.maps[0]
    unit, fastest = unit_for(first.outline.box, "m"), max(one.speed for one in found.maps)
    title = "Where the drives carry a part"
    texts = {
        "name": escape(case.name),
        "title": escape(title),
        "sentence": escape(f"{report.device(case)}. A click on a place shows where a part from there ends."),
        "warnings": notes_of(found.warnings()),
        "rows": rows_of(found.lines()),
        "case": escape(case.source or case.model_dump_json(indent=2)),
    }
    data = {
        "unit": unit.name,
        "spacing": first.field.spacing * unit.per_si,
        "origin": (first.field.origin * unit.per_si).tolist(),
        "numbers": packed(first.field.numbers.T, "i2"),  # of the places, row by row from below
        "columns": len(first.field.numbers),
        "rim": [packed(curve * unit.per_si, "f4") for curve in rim_curves(first.outline)],
        "actuators": packed(first.places * unit.per_si, "f4"),
        "starts": packed(first.starts * unit.per_si, "f4"),
        "maps": [_map(one, unit.per_si, fastest) for one in found.maps],
    }
    return write_page(path, f"{case.name}: {title}", "drift.html", texts, data, PROGRAMS)


def _map(one: DriftMap, per_si: float, fastest: float) -> dict[str, Any]:
    """A map as the page has it; per_si: the unit of length.  fastest: m/s, the speed of the longest arrows."""
    numbers, colours, fates = one.basins.of_start, shades(one), one.fates
    moves = fates == Fate.MOVES
    ends = {k: f"{percent(end.share)} of all starts end here" for k, end in enumerate(one.basins.ends)}
    words = {-1: "it stays"} | {k: text.replace("from here ", "") for k, (_, text) in LOST.items()} | ends
    return {
        "name": "All actuators" if one.name == "all" else f"{one.name.capitalize()} alone",
        "text": report.with_micro_signs(f"In a period, {quantity(one.period, 's')}{one.later}, {one.text}."),
        "running": list(one.actuators),
        "moving": packed(np.flatnonzero(moves), "u2"),
        "arrows": packed(one.arrows(fastest) * per_si, "f4"),
        "moved": packed(one.moved * per_si, "f4"),
        "ways": [
            report.with_micro_signs(f"{quantity(way, 'm', 3)}, {quantity(way / one.period, 'm/s', 3)}")
            for way in np.hypot(*one.moved[moves].T).tolist()
        ],
        "lost": packed(np.flatnonzero(fates > Fate.MOVES), "u2"),
        "end": packed(numbers, "i2"),
        "colours": [[k, colours[k], words[k]] for k in sorted(set(numbers.tolist()))],
        "reached": packed(one.basins.reached * per_si, "f4"),
    }
