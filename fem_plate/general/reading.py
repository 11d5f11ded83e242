"""The coefficients of a scikit-fem form, read off by unit fields.

A form that is bilinear in the value, the gradient and the Hessian of u and v is, at each point, a matrix (6, 6) in

    (w, w_x, w_y, w_xx, w_xy, w_yy).

Its entries are what the form returns for u and v that have one of these, each 1, and none of the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fem_plate.types import BoolArray, FloatArray

if TYPE_CHECKING:
    from skfem import BilinearForm, DiscreteField


JET = 6  # w and its derivatives to the second
ROUNDING = 1e-9  # of the largest entry at a point


def form_coefficients(form: BilinearForm, xy: FloatArray, name: str) -> FloatArray:
    """The matrices (n, 6, 6) of a form at points (n, 2) [m], in N m, and 1/m of it for each derivative less.

    Raises ValueError where it uses more than `w.x`, or is not real, finite, symmetric and bilinear.
    """
    from skfem import DiscreteField  # here, because it takes a while
    from skfem.assembly.form.form import FormExtraParams

    places = FormExtraParams(x=DiscreteField(np.ascontiguousarray(xy.T)[:, :, None]))

    def returned(u: FloatArray, v: FloatArray) -> FloatArray:
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused below
                result = form.form(_field(u, len(xy)), _field(v, len(xy)), places)
            values = np.broadcast_to(np.nan if result is None else result, (len(xy), 1))[:, 0]
        except (AttributeError, KeyError, TypeError, IndexError, ValueError) as wrong:
            raise ValueError(
                f"Input {name} must be a form of u, v, their gradients and Hessians, and w.x alone: {wrong}"
            ) from None
        if np.iscomplexobj(values):
            raise ValueError(f"Input {name} must be real; it returns complex numbers")
        return values

    entries = np.array([[returned(u, v) for u in np.eye(JET)] for v in np.eye(JET)], dtype=float).transpose(2, 0, 1)
    size = np.abs(entries).max(axis=(1, 2))
    _refuse(~np.isfinite(size), xy, name, "finite")
    asymmetry = np.abs(entries - entries.swapaxes(1, 2)).max(axis=(1, 2))
    _refuse(asymmetry > ROUNDING * size, xy, name, "symmetric in u and v")
    u, v = np.cos(np.arange(JET)), -2 * np.sin(1 + np.arange(JET))
    expected, most = v @ entries @ u, np.abs(v) @ np.abs(entries) @ np.abs(u)
    _refuse(~(np.abs(returned(u, v) - expected) <= ROUNDING * most), xy, name, "linear in u and in v")
    return np.asarray((entries + entries.swapaxes(1, 2)) / 2)


def _refuse(faulty: BoolArray, xy: FloatArray, name: str, what: str) -> None:
    if faulty.any():
        x, y = xy[int(np.argmax(faulty))].tolist()
        raise ValueError(f"Input {name} must be {what} on the plate; it is not at ({x:.6g}, {y:.6g}) m")


def _field(jet: FloatArray, count: int) -> DiscreteField:
    """The field at `count` points that has the value and derivatives of a jet (6,) at each."""
    from skfem import DiscreteField

    w, x, y, xx, xy, yy = np.tile(jet[:, None, None], (1, count, 1))
    return DiscreteField(value=w, grad=np.stack([x, y]), hess=np.array([[xx, xy], [xy, yy]]))
