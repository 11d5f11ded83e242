"""Split: the frequency that best predicts what parts do below it and above it, and curves through such frequencies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray


class Split(NamedTuple):
    """A frequency, and which share of (frequency, start) pairs do below it the one and from it on the other thing."""

    frequency: float  # Hz, half-way between two that were looked at, half a step beyond the outer ones, or nan
    predicted: float  # of all pairs
    below: float  # of those below; nan: there are none
    above: float


class Fits(NamedTuple):
    """A power law and a quadratic through frequencies over strokes."""

    unit: float  # m, that strokes count in
    exponent: float
    level: float  # Hz, of the power law at the unit stroke
    law_misfit: float  # Hz
    coefficients: tuple[float, ...]  # Hz, of the quadratic, highest power first
    quadratic_misfit: float  # Hz

    def __str__(self) -> str:
        return (
            f"quadratic off by {self.quadratic_misfit:.0f} Hz, power law stroke^{self.exponent:.2f} by "
            f"{self.law_misfit:.0f} Hz"
        )


class Ends(NamedTuple):
    """What becomes of the part at every stroke, frequency and start: (S, F, n). Some do neither: they go to and fro."""

    converges: BoolArray
    lost: BoolArray


class Thresholds(NamedTuple):
    """One model's thresholds, at every stroke (S,)."""

    ends: Ends
    split: list[Split]  # below it parts converge, above it they are lost: the paper's threshold
    scatter: list[tuple[float, float]]  # Hz, 10 and 90 % of the same from single starts
    fits: Fits | None
    others: dict[str, FloatArray]  # Hz (S,), by other definitions of a threshold


def best_split(frequencies: FloatArray, low: BoolArray, high: BoolArray) -> Split:
    """The frequency below which most do `low` and from which on most do `high`, both (F, n); nan: none does either.

    frequencies: (F,) Hz, evenly spaced.  Where several tell as much it is the middle one.
    """
    none = np.zeros(1)
    right = np.append(none, low.sum(axis=1).cumsum()) + np.append(high.sum(axis=1)[::-1].cumsum()[::-1], none)
    if not right.any():
        return Split(float("nan"), 0.0, float("nan"), float("nan"))
    best = np.flatnonzero(right == right.max())
    k = int(best[(len(best) - 1) // 2])
    step = float(frequencies[1] - frequencies[0])
    shares = [float(rows.mean()) if rows.size else float("nan") for rows in (low[:k], high[k:])]
    return Split(float(frequencies[0] + (k - 0.5) * step), float(right.max() / low.size), *shares)


def first_loss(frequencies: FloatArray, lost: BoolArray) -> float:
    """The median over starts of the lowest frequency [Hz] at which they are lost, of (F, n), less half a step.

    A start that never is counts as one beyond the highest frequency.
    """
    step = float(frequencies[1] - frequencies[0])
    first = np.where(lost.any(axis=0), lost.argmax(axis=0), len(frequencies))
    return float(frequencies[0] + step * (np.median(first) - 0.5))


def fits_of(strokes: FloatArray, frequencies: FloatArray, unit: float) -> Fits | None:
    """Both fits; strokes (n,) [m] count in `unit` [m].  None: fewer than four frequencies that are numbers.

    A misfit is the root of the summed squares over the numbers left free, so that both laws compare.
    """
    known = np.isfinite(frequencies)
    if known.sum() < 4:
        return None
    x, f = strokes[known] / unit, frequencies[known]
    exponent, level = np.polyfit(np.log(x), np.log(f), 1)
    quadratic = np.polyfit(x, f, 2)
    law = np.exp(level) * x**exponent
    return Fits(
        unit, float(exponent), float(np.exp(level)), _misfit(law - f, 2),
        tuple(quadratic.tolist()), _misfit(np.polyval(quadratic, x) - f, 3),
    )  # fmt: skip


def _misfit(off: FloatArray, numbers: int) -> float:
    return float(np.sqrt((off**2).sum() / (len(off) - numbers)))
