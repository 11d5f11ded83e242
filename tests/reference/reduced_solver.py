"""The equilibrium of a reduced plate at one moment, by numpy: what the kernels are compared with."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem_plate.large_deflection import ReducedPlate

FloatArray = NDArray[np.float64]

MAX_STEPS, CONVERGED = 60, 1e-12  # of Newton; a step over the largest correction
SUFFICIENT, MIN_STEP = 1e-4, 1e-10  # the share of the slope by which the energy must fall; of a step
ENERGY_ROUNDING = 1e-13  # of the energy's terms


class ReducedEquilibrium(NamedTuple):
    """Corrections and in-plane motions with their derivatives in time."""

    corrections: FloatArray  # (3, n): c, c', c''
    in_plane: FloatArray  # (3, M): g, g', g''
    hessian: FloatArray  # (n, n), of the energy in c


def energy(plate: ReducedPlate, corrections: ArrayLike, drives: ArrayLike) -> float:
    """E(c; d) of `ReducedPlate`, for corrections (n,) and drives (N,)."""
    c = np.asarray(corrections, dtype=float)
    _, forces = _membrane(plate, np.concatenate([np.asarray(drives, dtype=float), c]))
    return float(0.5 * c @ plate.stiffness @ c + plate.load @ c + 0.5 * forces @ forces)


def reduced_equilibrium(
    plate: ReducedPlate,
    drives: ArrayLike,
    rates: ArrayLike | None = None,
    accelerations: ArrayLike | None = None,
    start: ArrayLike | None = None,
) -> ReducedEquilibrium:
    """Find the corrections that make the energy least, by Newton's method with a line search.

    Parameters
    ----------
    plate : ReducedPlate
        The plate.
    drives, rates, accelerations : array (N,)
        The drives d, d' and d''; the latter two are 0 by default.
    start : array (n,), optional
        Where Newton's method begins; 0 by default.

    Returns
    -------
    equilibrium : ReducedEquilibrium
        c and g, with the derivatives that g(c; d) = 0 has in time.

    Raises
    ------
    ValueError
        The method does not converge, or ends where the energy is not least.
    """
    n, count = len(plate.stiffness), plate.drive_count
    d = np.asarray(drives, dtype=float)
    c = np.zeros(n) if start is None else np.array(start, dtype=float)
    largest = np.abs(c).max()
    for _ in range(MAX_STEPS):
        gradient, hessian = _derivatives(plate, np.concatenate([d, c]))
        step = np.asarray(-np.linalg.solve(_convex(plate, hessian, np.concatenate([d, c])), gradient), dtype=float)
        factor = _factor(plate, c, d, step, float(gradient @ step))
        c = c + factor * step
        largest = max(largest, np.abs(c).max())
        if np.abs(step).max() <= CONVERGED * largest:
            break
    else:
        raise ValueError("The corrections of the plate do not converge; reduce the strokes")
    hessian = _derivatives(plate, np.concatenate([d, c]))[1]
    if np.linalg.eigvalsh(hessian)[0] <= 0:
        raise ValueError("The plate is not stable there: its energy is not least")
    zero = np.zeros(count)
    b, b_t = np.concatenate([d, c]), np.concatenate([zero if rates is None else np.asarray(rates, float), np.zeros(n)])
    b_tt = np.concatenate([zero if accelerations is None else np.asarray(accelerations, float), np.zeros(n)])
    forms = plate.membrane
    rows, forces = _membrane(plate, b)

    def answer(f_t: FloatArray, rows_of: FloatArray) -> FloatArray:
        return np.asarray(np.linalg.solve(hessian, -(f_t @ rows + rows_of)[count:]), dtype=float)

    b_t[count:] = answer(rows @ b_t, forces @ (forms @ b_t))
    rows_t = forms @ b_t
    f_t = rows @ b_t
    f_tt = rows_t @ b_t + rows @ b_tt
    b_tt[count:] = answer(f_tt, 2 * f_t @ rows_t + forces @ (forms @ b_tt))
    in_plane = plate.in_plane
    g = 0.5 * (in_plane @ b) @ b + plate.in_plane_offset
    g_t = (in_plane @ b) @ b_t
    g_tt = (in_plane @ b_t) @ b_t + (in_plane @ b) @ b_tt
    return ReducedEquilibrium(np.stack([c, b_t[count:], b_tt[count:]]), np.stack([g, g_t, g_tt]), hessian)


def _membrane(plate: ReducedPlate, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A_r b (R, N+n) and f_r (R,)."""
    rows = plate.membrane @ b
    return rows, 0.5 * rows @ b + plate.prestress


def _derivatives(plate: ReducedPlate, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The energy's gradient (n,) and Hessian (n, n) in the corrections."""
    count = plate.drive_count
    rows, forces = _membrane(plate, b)
    own = rows[:, count:]
    gradient = plate.stiffness @ b[count:] + plate.load + forces @ own
    bending = np.tensordot(forces, plate.membrane[:, count:, count:], 1)
    return gradient, plate.stiffness + own.T @ own + bending


def _convex(plate: ReducedPlate, hessian: FloatArray, b: FloatArray) -> FloatArray:
    """The Hessian if it is positive definite, else without what can make it indefinite."""
    if np.linalg.eigvalsh(hessian)[0] > 0:
        return hessian
    own = _membrane(plate, b)[0][:, plate.drive_count :]
    return plate.stiffness + own.T @ own


def _factor(plate: ReducedPlate, c: FloatArray, d: FloatArray, step: FloatArray, slope: float) -> float:
    """The share of a step after which the energy has fallen enough."""
    before, factor = energy(plate, c, d), 1.0
    slack = ENERGY_ROUNDING * (abs(before) + abs(plate.load @ c))
    while energy(plate, c + factor * step, d) > before + SUFFICIENT * factor * slope + slack:
        factor *= 0.5
        if factor < MIN_STEP:
            raise ValueError("The corrections of the plate do not converge; reduce the strokes")
    return factor
