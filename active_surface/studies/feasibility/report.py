"""A feasibility in words: what the command prints."""

from __future__ import annotations

import math
from typing import Any

from active_surface.studies.feasibility.area import TOLERANCE
from common import quantity_text, range_text

STATES = {
    "rest": "stays at rest",
    "moves": "moves and is not lost",
    "lost": "is lost",
}


def lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows (label, text) to print, of `Feasibility.figures`."""
    return [*_map_lines(figures), *(_area_lines(figures) if "window" in figures else [])]


def _map_lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    unit, own, found = figures["stroke_unit"], figures["at_the_case"], figures["map"]
    rows = []
    at = f"{_hertz(figures['frequency'])} and {_stroke(figures['stroke'], unit)}"
    rows.append(("case", f"at {at} the part {STATES[own['state']]}, in {1e3 * figures['duration']:g} ms"))
    if "slips_from" in own:
        rows.append(("", _borders(own, found, unit)))
    room = [
        (lost or found["strokes"][1]) / slips if slips else 0.0
        for slips, lost in zip(found["slips_from"], found["lost_from"], strict=True)
    ]
    best = max(range(len(room)), key=room.__getitem__)
    if figures["nearest"] is None:
        low, high = found["slips_from"][best], found["lost_from"][best] or found["strokes"][1]
        room_there = range_text(low, high, unit)
        at = _hertz(found["frequencies"][best])
        rows.append(("most room", f"at {at}, from {room_there}, a factor of {room[best]:.3g}"))
    else:
        rows += _nearest_lines(figures)
    return rows


def _borders(own: dict[str, Any], found: dict[str, Any], unit: str) -> str:
    """At the case's own frequency: from which strokes on the part slips and is lost."""
    if own["slips_from"] is None:
        return f"at this frequency it stays at rest up to {_stroke(found['strokes'][1], unit)}, the largest looked at"
    text = f"at this frequency it slips from {_stroke(own['slips_from'], unit)}"
    if own["lost_from"] is None:
        return f"{text}, and is not lost up to {_stroke(found['strokes'][1], unit)}, the largest looked at"
    text += f" and is lost from {_stroke(own['lost_from'], unit)}"
    if own["all_lost_from"] is None:
        return f"{text}, but by some larger strokes not"
    if own["all_lost_from"] > 1.011 * own["lost_from"]:
        text += f"; up to {_stroke(own['all_lost_from'], unit)} some strokes keep it"
    return text


def _nearest_lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    near, unit = figures["nearest"], figures["stroke_unit"]
    frequency, stroke = near["frequency"] * figures["frequency"], near["stroke"] * figures["stroke"]
    end = "where a larger one loses it" if near["comes_off"] else "the largest looked at"
    at = f"{_hertz(frequency)} and {_stroke(stroke, unit)}"
    return [
        ("nowhere", "no frequency and stroke looked at moves the part without losing it"),
        ("nearest", f"the pull reaches {near['share']:.3g} of the friction limit at {at}, {end}"),
        ("advice", "`active-surface advise CASE` tries less friction and other starts, too"),
    ]


def _area_lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    rows = [
        (
            "area",
            f"{_area(figures['peak_area'])} at most at {_hertz(figures['frequency'])}, of a part that never comes off",
        ),
        ("integral", f"{_integral(figures['time_integral'])} in {1e3 * figures['window']:g} ms"),
        ("comes off", f"on {_area(figures['area_where_it_comes_off'])} at some moment"),
    ]
    if figures["frequency_of_largest_peak_area"] is None:
        return [*rows, ("frequency", "no frequency looked at moves a part anywhere without losing it")]
    low, high = figures["frequencies"]
    looked_at = f"those looked at, {range_text(low, high, 'Hz', 4)}"
    rows += [
        ("largest", f"{_area(figures['largest_peak_area'])} at {_hertz(figures['frequency_of_largest_peak_area'])}"),
        (
            "",
            f"{_integral(figures['largest_time_integral'])} at "
            f"{_hertz(figures['frequency_of_largest_time_integral'])}, in as many cycles",
        ),
    ]
    for label, between in (("moves", figures["moves_it_from_between"]), ("loses", figures["loses_it_from_between"])):
        rows.append((label, f"{_from(between)} of {looked_at}"))
    return rows


def _from(between: list[float | None] | None) -> str:
    if between is None:
        return "at none"
    before, first = between
    assert first is not None
    if before is None:
        return f"from {_hertz(first)}, the lowest,"
    return f"from between {range_text(before, first, 'Hz', word='and')},"


def warnings(figures: dict[str, Any]) -> list[str]:
    """What the figures leave out, in sentences."""
    texts = []
    if figures["duration"] < figures["whole_duration"]:
        texts.append(
            f"The map is of runs of {1e3 * figures['duration']:.4g} ms, 100 cycles of the case's fastest drive, in "
            f"place of the case's {1e3 * figures['whole_duration']:.4g} ms."
        )
    return texts + (_area_warnings(figures) if "window" in figures else []) + _ragged(figures)


def _area_warnings(figures: dict[str, Any]) -> list[str]:
    part, whole, texts = figures["window"], figures["whole_window"], []
    if part < whole:
        texts.append(
            f"Areas are those of the first {1e3 * part:.4g} ms, of {1e3 * whole:.4g} ms until the drives repeat "
            "themselves or the run ends; the map is of runs. Shorten the run, or give the drives frequencies "
            "with a short common period."
        )
    error = max(figures["areas_change_by"], figures["areas_differ_by_squares"])
    if error > TOLERANCE:
        texts.append(
            f"Areas are good to {100 * error:.2g} %: more moments change them by "
            f"{100 * figures['areas_change_by']:.2g} %, other squares by "
            f"{100 * figures['areas_differ_by_squares']:.2g} %; --across takes more squares."
        )
    return texts


def _ragged(figures: dict[str, Any]) -> list[str]:
    """Where strokes that lose the part and others lie side by side."""
    found = figures["map"]
    rows = [
        (frequency, lost, all_lost)
        for frequency, lost, all_lost in zip(
            found["frequencies"], found["lost_from"], found["all_lost_from"], strict=True
        )
        if lost is not None and (all_lost or math.inf) > 1.011 * lost
    ]
    if not rows:
        return []
    between = range_text(rows[0][0], rows[-1][0], "Hz", 3) if len(rows) > 1 else _hertz(rows[0][0])
    widest = max((all_lost or found["strokes"][1]) / lost for _, lost, all_lost in rows)
    return [
        f"The border of losses is ragged at {len(rows)} of {len(found['frequencies'])} frequencies, {between}: strokes "
        f"that lose the part and others lie side by side, up to a factor of {widest:.3g} apart. The hatched band of "
        "the map is where both were met."
    ]


def _stroke(stroke: float, unit: str) -> str:
    return quantity_text(stroke, unit, 4)


def _hertz(frequency: float) -> str:
    return quantity_text(frequency, "Hz", 4)


def _area(area: float) -> str:
    return f"{1e12 * area:.4g} µm²"


def _integral(integral: float) -> str:
    return f"{1e15 * integral:.4g} µm² ms"
