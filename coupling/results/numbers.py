"""Numbers of a result file: whether they are such as a run writes, before anything is made of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray


def checked_count(name: str, value: Any, most: int | None = None) -> int:
    """A count of the file; raises ValueError unless it is a whole number from 0 to the most that it can be."""
    number = np.asarray(value)
    if number.shape or number.dtype.kind not in "iu" or not 0 <= number <= (np.inf if most is None else most):
        wanted = "not negative" if most is None else f"from 0 to {most}"
        got = f"; got {number.item()}" if not number.shape and number.dtype.kind in "iuf" else ""
        raise ValueError(f"{name} must be a whole number, {wanted}{got}")
    return int(number)


def checked_cells(points: NDArray[Any], corners: NDArray[Any]) -> NDArray[np.int64]:
    """The triangles (m, 3) of corners (3 m,), rows of points; raises ValueError where these are no mesh."""
    if points.shape[1:] != (3,):
        raise ValueError("Points must be three numbers a point")
    check_finite(Points=points)
    if corners.dtype.kind not in "iu" or corners.ndim != 1 or not corners.size or corners.size % 3:
        raise ValueError("Connectivity must be whole numbers, three a triangle")
    if corners.min() < 0 or corners.max() >= len(points):
        raise ValueError(f"a triangle has a corner that is none of the {len(points)} points")
    return corners.reshape(-1, 3)


def check_shapes(group: str, arrays: Mapping[str, NDArray[Any]], columns: Mapping[str, int]) -> None:
    """Raises ValueError unless all arrays of a group are as long, and have one number a row, or so many as stated."""
    length = len(next(iter(arrays.values())))
    for name, array in arrays.items():
        shape = (length, columns[name]) if name in columns else (length,)
        if np.shape(array) != shape:
            raise ValueError(f"{group} has {name} of the shape {np.shape(array)}, not {shape}")


def check_finite(**arrays: NDArray[Any]) -> None:
    """Raises ValueError unless arrays hold finite real numbers."""
    for name, array in arrays.items():
        if array.dtype.kind not in "iuf":
            raise ValueError(f"{name} must be real numbers")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} has a number that is not finite")
