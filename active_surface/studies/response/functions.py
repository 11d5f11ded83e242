"""Frequency response functions of a plate with mass: in the steady state under a sine of one actuator.

Under h_i exp(i w t) each mode answers with eta_n = m_ni w^2 h_i / (omega_n^2 - w^2 + 2 i zeta_n omega_n w), so that

    H_i(x, w) = phi_i(x) + sum_n psi_n(x) m_ni w^2 / (omega_n^2 - w^2 + 2 i zeta_n omega_n w).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray
from common import quantity_text
from fem_plate import Excitation, ExcitedModes, InfluenceShapes

ComplexArray = NDArray[np.complex128]

STILL = 1e-6  # of a shape: points that move less stand still
TOLERANCE = 3e-5  # of the largest of each curve: what more modes may change


def frequency_response(
    shapes: InfluenceShapes,
    excitation: Excitation,
    damping: Callable[[FloatArray], FloatArray],
    xy: FloatArray,
    frequencies: FloatArray,
) -> tuple[ComplexArray, ExcitedModes, float]:
    """H (points, actuators, frequencies) [m/m, of forces m/N] at points (k, 2) [m] and frequencies (F,) [Hz].

    Also the modes that it is made of, and the largest change of any curve by the last of them, over the largest H.
    """
    static = shapes.values(xy)
    before, change = None, np.inf
    while True:
        modes = excitation.modes()
        answers = _of_modes(static, modes.functions.values(xy / shapes.size), modes, damping, frequencies)
        if before is not None:
            known = np.isfinite(answers) & np.isfinite(before)  # not so at resonances without damping
            largest = max(float(np.abs(answers[known]).max()), STILL * float(shapes.own_heights().max()))
            change = float(np.abs(answers - before)[known].max()) / largest
        if change < TOLERANCE or excitation.exhausted:
            return answers, modes, change
        before = answers
        excitation.grow()


def _of_modes(
    static: FloatArray,
    values: FloatArray,
    modes: ExcitedModes,
    damping: Callable[[FloatArray], FloatArray],
    frequencies: FloatArray,
) -> ComplexArray:
    w, omega = 2 * np.pi * frequencies, modes.omega[:, None]
    ratio = damping(modes.frequencies)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # at a resonance without damping
        answer = w**2 / (omega**2 - w**2 + 2j * ratio * omega * w)
    moving = np.einsum("kn,ni,nf->kif", values, modes.participation, answer, optimize=True)
    return np.asarray(static[:, :, None] + moving)


def range_fault(
    caller: str, lowest: float | None, highest: float | None, low: float, high: float, defaults: tuple[str, str]
) -> str | None:
    """What is wrong with frequencies from low to high [Hz], in the words of those that were given; None: nothing.

    lowest, highest: as given.  defaults: what low and high are where these are None.
    """
    if 0 < low < high < math.inf:
        return None
    bottom, top = (quantity_text(frequency, "Hz", 6) for frequency in (low, high))
    if lowest is None:
        by_default = f"by default {defaults[0]}, {bottom}"
        return f"Input highest of {caller} must be above the lowest, {by_default}, and finite; got {top}"
    default = f"by default {defaults[1]}, " if highest is None else ""
    return f"Input lowest of {caller} must be positive and below the highest, {default}{top}; got {bottom}"
