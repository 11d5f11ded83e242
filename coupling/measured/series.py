"""A series: what was measured along one axis, in units of its own, and the nodes of a motion with kicks."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coupling.measured.smoother import ANYTHING, Nodes, Smoothed, smooth

FloatArray = NDArray[np.float64]

NORMAL_MEDIAN = 0.6745  # of the size of what is normal, over its deviation
DIFFERENCE = 6  # order of the differences that tell noise from motion
ORDER = 5  # of the derivative that a motion has little of
NO_KICKS = np.zeros((0, 2))  # of each its time [steps] and which derivative jumps
LEAST_NOISE = 1e-7  # of the range of the values: less is taken as that


@dataclass(frozen=True)
class Series:
    """Samples of heights, velocities and accelerations, nan where there is none."""

    time: FloatArray  # (n,), in steps, from 0
    value: FloatArray  # (n, 3), in `unit` per step to the power 0, 1, 2
    noise: FloatArray  # (3,) of each, in the same units; that of heights is about 1
    step: float  # s, the median of the steps
    unit: float  # m

    @property
    def scales(self) -> FloatArray:
        """What one of each is in SI units (3,): m, m/s, m/s^2."""
        return self.unit / self.step ** np.arange(3.0)

    @property
    def least_noise(self) -> FloatArray:
        """(3,): less could not be told from rounding."""
        there = np.where(self.measured, self.value, 0.0)
        return LEAST_NOISE * np.ptp(there, axis=0)

    @property
    def measured(self) -> NDArray[np.bool_]:
        """(n, 3)."""
        return np.isfinite(self.value)

    def window(self, first: int, last: int) -> Series:
        """The samples from `first` to before `last`."""
        return replace(self, time=self.time[first:last], value=self.value[first:last])

    def nodes(self, kicks: FloatArray) -> tuple[Nodes, NDArray[np.int64]]:
        """The nodes of a motion with kicks (k, 2), and which of them are the samples (n,)."""
        time = np.union1d(self.time, kicks[:, 0])
        places = np.searchsorted(time, self.time)
        value, weight, kick = np.zeros((len(time), 3)), np.zeros((len(time), 3)), np.zeros((len(time), ORDER))
        value[places] = np.where(self.measured, self.value, 0.0)
        weight[places] = np.where(self.measured, self.noise**-2.0, 0.0)
        kick[np.searchsorted(time, kicks[:, 0]), kicks[:, 1].astype(int)] = ANYTHING
        return Nodes(time, value, weight, kick), places


@dataclass(frozen=True)
class Motion:
    """The smoothest motion near a series, of one roughness and with given kicks."""

    nodes: Nodes
    places: NDArray[np.int64]  # (n,) of the samples among the nodes
    out: Smoothed
    squares: float
    logarithms: float

    @property
    def residuals(self) -> FloatArray:
        """(n, 3) measured less smoothed, 0 where nothing was measured."""
        return np.where(self.nodes.weight > 0, self.nodes.value - self.out.after, 0.0)[self.places]

    @property
    def freedom(self) -> FloatArray:
        """(3,) degrees of freedom that heights, velocities and accelerations take."""
        return self.out.leverage.sum(axis=0)


def smoothed(series: Series, kicks: FloatArray, roughness: float) -> Motion:
    """The motion of a series, in its units."""
    nodes, places = series.nodes(kicks)
    return Motion(nodes, places, *pass_over(series, nodes, roughness))


def pass_over(series: Series, nodes: Nodes, roughness: float) -> tuple[Smoothed, float, float]:
    """What `smooth` makes of nodes of a series, and the two sums that it returns."""
    count = len(nodes.time)
    before, after, leverage = np.zeros((3, count, 3))
    out = Smoothed(before, after, leverage, np.zeros((count, ORDER)), np.zeros((count, ORDER, ORDER)))
    start = np.zeros(ORDER)
    start[0] = series.value[0, 0]
    return out, *smooth(nodes, roughness, start, out)


def series_of(times: FloatArray, columns: Sequence[FloatArray | None]) -> Series:
    """The series of samples at times (n,) [s]: heights, velocities and accelerations (n,) [m, m/s, m/s^2].

    Velocities and accelerations may be None. The noise of each is what its sixth differences show that no smooth
    motion has.
    """
    step = float(np.median(np.diff(times)))
    values = np.stack([np.full(len(times), np.nan) if one is None else one for one in columns], axis=1)
    levels = np.array([0.0 if one is None else _level(one) for one in columns])
    unit = levels[0]
    scales = unit / step ** np.arange(3.0)
    return Series((times - times[0]) / step, values / scales, np.where(levels > 0, levels / scales, 1.0), step, unit)


def noise_of(values: FloatArray) -> float:
    """The noise of values (n,): what their sixth differences show that no smooth motion has; 0 of few."""
    differences = np.diff(values, DIFFERENCE)
    # The median, since jumps are not noise.
    spread = float(np.median(np.abs(differences))) / NORMAL_MEDIAN if len(differences) else 0.0
    return spread / math.sqrt(math.comb(2 * DIFFERENCE, DIFFERENCE))


def _level(values: FloatArray) -> float:
    return max(noise_of(values), LEAST_NOISE * (float(np.ptp(values)) or 1.0))
