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
        ("moves", f"from {figures['lowest_frequency_that_moves_it']:.4g} Hz, of {looked_at}"),
    ]
    loses = figures["lowest_frequency_that_loses_it"]
    return [*rows, ("loses", f"at none of {looked_at}" if loses is None else f"from {loses:.4g} Hz")]


def _area(area: float) -> str:
    return f"{1e12 * area:.4g} um^2"


def _integral(integral: float) -> str:
    return f"{1e15 * integral:.4g} um^2 ms"
