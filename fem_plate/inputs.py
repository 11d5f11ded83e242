"""Checks of the points and numbers that a user passes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from fem_plate.types import BoolArray, FloatArray
from meshes import Outline, PlateMesh

SAME_PLACE = 1e-9  # of the plate's size: points closer than this coincide


def as_points(points: ArrayLike, name: str) -> FloatArray:
    """Points as an array (N, 2); ValueError for any other shape."""
    array = np.asarray(points, dtype=float)
    if array.size and (array.ndim not in (1, 2) or array.shape[-1] != 2):
        raise ValueError(f"Input {name} must have shape (N, 2); got {array.shape}")
    return array.reshape(-1, 2)


def one_per_point(values: ArrayLike, count: int, name: str) -> FloatArray:
    """One number per point, (count,), from `count` numbers or one for all; ValueError for any other shape."""
    array = np.asarray(values, dtype=float)
    if array.shape not in ((), (count,)) or count == 0 < array.size:
        raise ValueError(f"Input {name} must be one a point, {count}; got shape {array.shape}")
    return np.broadcast_to(array, count).copy()


def stiffness_per_point(stiffness: ArrayLike | None, count: int, caller: str, may_float: bool) -> FloatArray:
    """The stiffness (count,) [N/m] of the actuators, inf (rigid) by default; ValueError names the first wrong one."""
    if stiffness is None:
        return np.full(count, np.inf)
    values = one_per_point(stiffness, count, f"stiffness of {caller}")
    wrong = np.flatnonzero(~(values >= 0) if may_float else ~(values > 0)).tolist()
    if wrong:
        bound = "0 or more" if may_float else "positive"
        got = f"{values[wrong[0]]} N/m for point {wrong[0]}"
        raise ValueError(f"Input stiffness of {caller} must be {bound}; got {got}")
    return values


def check_points(
    caller: str, points: FloatArray, gap: FloatArray, size: float, least: float = 0.0, free: bool = False
) -> None:
    """Raise ValueError, naming every one of the points (N, 2) [m] that is not inside the rim or coincides with another.

    gap: (N,) m, how far inside the rim they are.  size: m, of the plate.  least: m, the gap that is needed.
    free: whether they might lie on a free boundary.
    """
    mistakes = [] if points.size else ["at least one point is needed"]
    needed = f" by more than {least:.3g} m" if least else ""
    for i in np.flatnonzero(~(gap > max(least, SAME_PLACE * size))).tolist():
        on = abs(gap[i]) <= SAME_PLACE * size
        or_on = ", or on a free boundary and as far off the others" if free else ""
        place = f"point {i} at {points[i].tolist()} m must lie inside the rim{needed}{or_on}"
        at = "on it" if on else f"{abs(gap[i]):.3g} m {'inside' if gap[i] > 0 else 'beyond'} it"
        mistakes.append(f"{place}; it is {at}")
    finite = np.flatnonzero(np.isfinite(points).all(axis=1))
    for i, j in finite[sorted(cKDTree(points[finite]).query_pairs(SAME_PLACE * size))].tolist():
        mistakes.append(f"points {i} and {j} must differ; both are at {points[i].tolist()} m")
    if mistakes:
        raise ValueError(f"Input points of {caller}: " + "; ".join(mistakes))


def places_on(
    mesh: PlateMesh,
    points: ArrayLike,
    caller: str,
    name: str = "points",
    most: float = math.inf,
    least: int = 0,
    free: Sequence[str] = (),
) -> FloatArray:
    """Points of `caller` as an array (N, 2) [m], of which there may be none; ValueError as of the checks above.

    free: boundaries that the points may lie on.
    """
    places = as_points(points, f"{name} of {caller}")
    if not least <= len(places) <= most:
        bound = f"at most {most} points" if len(places) > most else "one point or more"
        raise ValueError(f"Input {name} of {caller} must be {bound}; got {len(places)}")
    if places.size:
        gap = np.where(mesh.on_rim(places, free), np.inf, mesh.outline.gap(places))
        check_points(caller, places, gap, mesh.size, mesh.least_gap, bool(free))
    return places


def check_held(caller: str, motions: FloatArray, held: BoolArray) -> None:
    """Raise ValueError when the held actuators do not stop the rigid motions (N, r, at all of them) of the supports."""
    r = motions.shape[1]
    if r and (held.sum() < r or np.linalg.matrix_rank(motions[held], tol=1e-9) < r):
        raise ValueError(
            f"Input points of {caller} leave the plate a rigid motion: its supports and the actuators that hold "
            f"it, {int(held.sum())}, must fix three points that are not on one line"
        )


def check_on_plate(outline: Outline, xy: FloatArray, size: float) -> None:
    """Raise ValueError when one of the points (n, 2) [m] lies beyond the rim."""
    beyond = outline.gap(xy) < -SAME_PLACE * size
    if np.any(beyond):
        raise ValueError(f"Input xy of evaluate must lie on the plate; got {xy[beyond][0].tolist()} m")


def not_positive(section: str, **values: float | None) -> list[str]:
    """A message for each value that is given and not a positive number."""
    return [
        f"Input {name} of {section} must be positive; got {value!r}"
        for name, value in values.items()
        if value is not None and not (math.isfinite(value) and value > 0)
    ]
