"""The coefficients of a scikit-fem form, read off by unit fields.

A form that is bilinear in the value, the gradient and the Hessian of u and v is, at each point, a matrix (6, 6) in

    (w, w_x, w_y, w_xx, w_xy, w_yy).

Its entries are what the form returns for u and v that have one of these, each 1, and none of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from skfem import BilinearForm, DiscreteField

FloatArray = NDArray[np.float64]

CHANNELS = 6
SYMMETRIC = 1e-9  # of the largest entry at a point: more asymmetry is no rounding


def form_coefficients(form: BilinearForm, xy: FloatArray, name: str) -> FloatArray:
    """The matrices (n, 6, 6) of a form at points (n, 2) [m], in N m, and 1/m of it for each derivative less.

    Raises ValueError where it uses more than `w.x`, is not finite, or not symmetric.
    """
    from skfem import DiscreteField  # here, because it takes a while
    from skfem.assembly.form.form import FormExtraParams

    places = FormExtraParams(x=DiscreteField(np.ascontiguousarray(xy.T)[:, :, None]))
    units = [_unit_field(channel, len(xy)) for channel in range(CHANNELS)]
    entries = np.empty((len(xy), CHANNELS, CHANNELS))
    for row, v in enumerate(units):
        for column, u in enumerate(units):
            try:
                with np.errstate(all="ignore"):  # what is not finite is refused below
                    entries[:, row, column] = np.broadcast_to(form.form(u, v, places), (len(xy), 1))[:, 0]
            except (AttributeError, KeyError, TypeError, IndexError, ValueError) as wrong:
                raise ValueError(
                    f"Input {name} must be a form of u, v, their gradients and Hessians, and w.x alone: {wrong}"
                ) from None
    size = np.abs(entries).max(axis=(1, 2))
    _refuse(~np.isfinite(size), xy, name, "finite")
    asymmetry = np.abs(entries - entries.swapaxes(1, 2)).max(axis=(1, 2))
    _refuse(asymmetry > SYMMETRIC * size, xy, name, "symmetric in u and v")
    return (entries + entries.swapaxes(1, 2)) / 2


def _refuse(faulty: NDArray[np.bool_], xy: FloatArray, name: str, what: str) -> None:
    if faulty.any():
        x, y = xy[int(np.argmax(faulty))].tolist()
        raise ValueError(f"Input {name} must be {what} on the plate; it is not at ({x:.6g}, {y:.6g}) m")


def _unit_field(channel: int, count: int) -> DiscreteField:
    """A field (count, 1) one of whose derivatives is 1; the mixed one is both off-diagonal entries of the Hessian."""
    from skfem import DiscreteField

    value, gradient, hessian = np.zeros((count, 1)), np.zeros((2, count, 1)), np.zeros((2, 2, count, 1))
    if channel == 0:
        value[:] = 1.0
    elif channel < 3:
        gradient[channel - 1] = 1.0
    else:
        for i, j in {3: [(0, 0)], 4: [(0, 1), (1, 0)], 5: [(1, 1)]}[channel]:
            hessian[i, j] = 1.0
    return DiscreteField(value=value, grad=gradient, hess=hessian)
