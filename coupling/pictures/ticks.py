"""Axes of pictures whose numbers are in a unit with a prefix."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from common import STEPS, Unit

MAX_TICKS = 6


def plain_ticks(axes: Axes) -> None:
    """Set a few ticks, labelled with plain numbers: without an offset or a power of ten."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(MAX_TICKS, steps=STEPS))
        formatter = ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
        axis.set_major_formatter(formatter)


def map_axes(axes: Axes, unit: Unit, where: str = "") -> None:
    """Give axes of places equal scales and plain ticks, and label them with a unit; where: such as " on the plate"."""
    axes.set_aspect("equal")
    plain_ticks(axes)
    axes.set_xlabel(f"x{where} [{unit.name}]")
    axes.set_ylabel(f"y{where} [{unit.name}]")
