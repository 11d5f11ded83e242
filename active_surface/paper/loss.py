"""Loss: the frequency from which on parts are lost, and curves through such frequencies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.paper.share import HARDLY_ANY

TOLERATED = HARDLY_ANY  # share of the starts that may be lost below a threshold


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
    """What becomes of parts at every frequency and start, (F, n) each. Some do neither: they go to and fro."""

    converges: BoolArray
    lost: BoolArray
    moves: BoolArray  # friction does not hold them where they were placed


def first_loss(frequencies: FloatArray, ends: Ends) -> float:
    """The lowest of frequencies (F,) [Hz] at which more than TOLERATED of the starts are lost, less half a step.

    nan: there is none.
    """
    lost = np.flatnonzero(ends.lost.mean(axis=1) > TOLERATED)
    return float(frequencies[lost[0]] - (frequencies[1] - frequencies[0]) / 2) if len(lost) else float("nan")


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
