"""A feasibility in words: what the command prints."""

from __future__ import annotations

from typing import Any


def lines(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows (label, text) to print, of `Feasibility.figures`."""
    rows = [
        (
            "area",
            f"{_area(figures['peak_area'])} at most at {figures['frequency']:g} Hz, of a part that never comes off",
        ),
        ("integral", f"{_integral(figures['time_integral'])} in {1e3 * figures['window']:g} ms"),
        ("comes off", f"on {_area(figures['area_where_it_comes_off'])} at some moment"),
    ]
    if figures["frequency_of_largest_peak_area"] is None:
        return [*rows, ("frequency", "no frequency looked at moves the part without losing it")]
    looked_at = "those looked at, {:.4g} to {:.4g} Hz".format(*figures["frequencies"])
    rows += [
        ("largest", f"{_area(figures['largest_peak_area'])} at {figures['frequency_of_largest_peak_area']:.4g} Hz"),
        (
            "",
            f"{_integral(figures['largest_time_integral'])} at "
            f"{figures['frequency_of_largest_time_integral']:.4g} Hz, in as many cycles",
        ),
    ]
    for label, between in (("moves", figures["moves_it_from_between"]), ("loses", figures["loses_it_from_between"])):
        rows.append((label, f"{_from(between)} of {looked_at}"))
    return rows


def _from(between: list[float | None] | None) -> str:
    if between is None:
        return "at none"
    before, first = between
    return f"from {first:.4g} Hz, the lowest," if before is None else f"from between {before:.3g} and {first:.3g} Hz,"


def warnings(figures: dict[str, Any]) -> list[str]:
    """What the figures leave out, in sentences."""
    part, whole = figures["window"], figures["whole_window"]
    if part >= whole:
        return []
    return [
        f"Only the first {1e3 * part:.4g} ms were looked at, of {1e3 * whole:.4g} ms until the drives repeat "
        "themselves or the run ends; shorten the run, or give the drives frequencies with a short common period."
    ]


def _area(area: float) -> str:
    return f"{1e12 * area:.4g} um^2"


def _integral(integral: float) -> str:
    return f"{1e15 * integral:.4g} um^2 ms"
