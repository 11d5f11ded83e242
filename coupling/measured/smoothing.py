"""Smoothing: how rough a motion is and how noisy its measurement, by generalised cross-validation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coupling.measured.series import Motion, Series, smoothed

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]

ROUGHNESS = np.arange(-18.0, 13.0, 1.0)  # decimal logarithms of those tried first
PRECISION = 0.02  # of the logarithm of a roughness
ROUNDS = 12  # of the noises of several columns
LEAST_LEFT = 0.1  # of the samples: fewer degrees of freedom do not tell noise
SETTLED = 0.02  # relative change of a noise that counts as none


def validation(motion: Motion, noise: FloatArray, chosen: BoolArray | slice = slice(None)) -> float:
    """The generalised cross-validation of a motion (Craven and Wahba 1979); a kick's time is a parameter as well.

    chosen: (n,) of samples, by default all; all kicks are among them.
    """
    places = motion.places[chosen]
    count = int((motion.nodes.weight[places] > 0).sum())
    left = count - float(motion.out.leverage[places].sum()) - float((motion.nodes.kick > 0).sum())
    squares = float(((motion.residuals[chosen] / noise) ** 2).sum())
    return count * squares / left**2 if left > 0 else np.inf


def noises(motion: Motion, series: Series) -> FloatArray:
    """The noise of heights, velocities and accelerations (3,) that is left of a motion, in the series' units.

    It is as before where nearly all freedom is taken, as by a motion with impacts that are not found yet.
    """
    kicks = float((motion.nodes.kick > 0).sum())
    counts = series.measured.sum(axis=0)
    left = counts - motion.freedom - kicks * counts / counts.sum()
    squares = (motion.residuals**2).sum(axis=0)
    known = left > LEAST_LEFT * counts
    return np.where(known, np.sqrt(squares / np.where(known, left, 1.0)), series.noise)


def best_roughness(series: Series, kicks: FloatArray) -> float:
    """The roughness of least cross-validation."""

    def cost(logarithm: float) -> float:
        return validation(smoothed(series, kicks, 10.0**logarithm), series.noise)

    costs = [cost(logarithm) for logarithm in ROUGHNESS]
    k = int(np.argmin(costs))
    return 10.0 ** _least(cost, ROUGHNESS[max(k - 1, 0)], ROUGHNESS[min(k + 1, len(ROUGHNESS) - 1)])


def roughness_of(series: Series, kicks: FloatArray, rms: float) -> float:
    """The least roughness whose motion is as close to the heights as that, root mean square in the series' unit."""
    low, high = ROUGHNESS[0], ROUGHNESS[-1]
    while high - low > PRECISION:
        middle = 0.5 * (low + high)
        left = smoothed(series, kicks, 10.0**middle).residuals[:, 0]
        low, high = (middle, high) if float(np.sqrt(np.mean(left**2))) > rms else (low, middle)
    return float(10.0**high)


def _least(cost: Callable[[float], float], low: float, high: float) -> float:
    """Where a cost is least between two logarithms, by golden sections."""
    share = (5**0.5 - 1) / 2
    one, other = high - share * (high - low), low + share * (high - low)
    at_one, at_other = cost(one), cost(other)
    while high - low > PRECISION:
        if at_one < at_other:
            high, other, at_other = other, one, at_one
            one = high - share * (high - low)
            at_one = cost(one)
        else:
            low, one, at_one = one, other, at_other
            other = low + share * (high - low)
            at_other = cost(other)
    return 0.5 * (low + high)


def chosen(series: Series, kicks: FloatArray) -> tuple[Series, float]:
    """The series with the noises that its smoothing leaves, and its roughness; each column is weighed by its own."""
    several = int(series.measured.any(axis=0).sum()) > 1
    for _ in range(ROUNDS if several else 1):
        roughness = best_roughness(series, kicks)
        found = np.maximum(noises(smoothed(series, kicks, roughness), series), series.least_noise)
        change = float(np.abs(np.log(found / series.noise)).max())
        series = replace(series, noise=found)
        if not several or change < SETTLED:
            break
    return series, roughness
