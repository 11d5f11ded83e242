"""The unit, with its prefix, in which numbers are read most easily; axes are labelled with it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
NOTHING = 1e-12  # SI units: numbers below it are rounding
TICKS, STEPS = 6, (1, 2, 2.5, 5, 10)  # a few ticks, at round numbers


class Unit(NamedTuple):
    """A unit and its numbers."""

    name: str
    per_si: float  # how many of it make up the SI unit


def readable(values: FloatArray, si: str) -> Unit:
    """The largest unit of which the largest of an array of values is at least one; `si` itself where all are 0."""
    extent = float(np.abs(values).max())
    if extent < NOTHING:
        return Unit(si, 1.0)
    size, prefix = next((pair for pair in PREFIXES if extent >= pair[0] * (1 - 1e-9)), PREFIXES[-1])
    return Unit(prefix + si, 1 / size)


def plain_ticks(axes: Axes) -> None:
    """A few ticks, labelled with numbers as they are: without an offset or a power of ten."""
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(TICKS, steps=STEPS))
        formatter = ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
        axis.set_major_formatter(formatter)
