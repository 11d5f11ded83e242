"""A feasibility in words: what the command prints."""

from __future__ import annotations

from typing import Any

from meshes import quantity_text, range_text


def lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows (label, text) to print, of `Feasibility.figures`."""
    rows = [
        (
            "area",
            f"{_area(figures['peak_area'])} at most at {_hertz(figures['frequency'])}, of a part that never comes off",
        ),
        ("integral", f"{_integral(figures['time_integral'])} in {1e3 * figures['window']:g} ms"),
        ("comes off", f"on {_area(figures['area_where_it_comes_off'])} at some moment"),
    ]
    if figures["frequency_of_largest_peak_area"] is None:
        return [*rows, ("frequency", "no frequency looked at moves the part without losing it")]
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
    part, whole = figures["window"], figures["whole_window"]
    if part >= whole:
        return []
    return [
        f"Only the first {1e3 * part:.4g} ms were looked at, of {1e3 * whole:.4g} ms until the drives repeat "
        "themselves or the run ends; shorten the run, or give the drives frequencies with a short common period."
    ]


def _hertz(frequency: float) -> str:
    return quantity_text(frequency, "Hz", 4)


def _area(area: float) -> str:
    return f"{1e12 * area:.4g} um^2"


def _integral(integral: float) -> str:
    return f"{1e15 * integral:.4g} um^2 ms"
