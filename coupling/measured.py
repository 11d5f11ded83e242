"""Measured motions as drives: splines of degree five through, or close to, measured positions."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle import HermiteDrive

FloatArray = NDArray[np.float64]

DEGREE = 5  # four derivatives are continuous, and between two knots the spline is a drive's piece itself


@dataclass(frozen=True)
class MotionFit:
    """How closely a drive follows the positions that were measured along one axis."""

    axis: str
    rms: float  # m, root mean square of the differences
    largest: float  # m


def fit_motion(
    axis: str, times: ArrayLike, positions: ArrayLike, smoothing: float | None = None
) -> tuple[HermiteDrive, MotionFit]:
    """The drive through positions (n,) [m] at increasing times (n,) [s] from 0, n at least 6, and how close it is.

    smoothing: m, the noise of the positions: the spline has as few knots as bring the root mean square of the
    differences down to that. None: it goes through every position.
    """
    from scipy import interpolate  # here, because few cases have measured motions

    t, h = np.asarray(times, dtype=float), np.asarray(positions, dtype=float)
    if smoothing is None:
        through = interpolate.make_interp_spline(t, h, DEGREE)
        knots, derivatives = np.unique(through.t), [through.derivative(k) if k else through for k in range(3)]
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that the noise was not met: the residual says so
            close = interpolate.UnivariateSpline(t, h, w=np.full(len(t), 1 / smoothing), k=DEGREE, s=len(t))
        knots, derivatives = close.get_knots(), [close.derivative(k) if k else close for k in range(3)]
    drive = HermiteDrive(knots, *(derivative(knots) for derivative in derivatives))
    difference = drive.evaluate(t)[0] - h
    return drive, MotionFit(axis, float(np.sqrt(np.mean(difference**2))), float(np.abs(difference).max()))
