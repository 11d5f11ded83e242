"""Influence functions as arrays, for designers of deformable mirrors and for other programs."""

from __future__ import annotations

from os import PathLike

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem_plate.arrays import PatchedShapes
from fem_plate.influence import InfluenceShapes

FloatArray = NDArray[np.float64]

CHUNK = 64  # shapes evaluated at a time, to bound memory


def neighbour_coupling(shapes: InfluenceShapes | PatchedShapes) -> FloatArray:
    """Each shape's deflection at the nearest other actuator, over that at its own.

    This ratio describes deformable mirrors whose actuators yield or float. It is zero where all are rigid.

    Parameters
    ----------
    shapes : InfluenceShapes or PatchedShapes
        Shapes of N actuators.

    Returns
    -------
    (N,) array

    Raises
    ------
    ValueError
        There is only one actuator.
    """
    points = shapes.points
    if len(points) < 2:
        raise ValueError("Input shapes of neighbour_coupling must have at least two actuators; got one")
    nearest = cKDTree(points).query(points, k=2)[1][:, 1]
    coupling = []
    for rows in _chunks(len(points)):
        xy = np.concatenate([points[rows], points[nearest[rows]]])
        own, other = np.split(_values(shapes, xy, rows), 2)
        coupling.append(np.diagonal(other) / np.diagonal(own))
    return np.concatenate(coupling)


def save_influence(path: str | PathLike[str], shapes: InfluenceShapes | PatchedShapes, across: int = 101) -> None:
    """Write the influence functions on a square grid over the plate to an .npz file.

    Its arrays are

    - x (nx,) and y (ny,): the grid [m];
    - shapes (N, nx, ny): metres per metre of a held actuator's stroke, or per newton on a floating one; NaN off the
      plate;
    - points (N, 2): places of the actuators [m];
    - stiffness (N, N) [N/m];
    - coupling (N,): `neighbour_coupling`, 0 for a single actuator;
    - pitch: median distance of neighbours [m].

    Parameters
    ----------
    path : path-like
        The file.
    shapes : InfluenceShapes or PatchedShapes
        Shapes of N actuators.
    across : int
        Points of the grid along the plate's longer side, at least 2.

    Raises
    ------
    ValueError
        There are fewer than two points across.
    """
    if across < 2:
        raise ValueError(f"Input across of save_influence must be at least 2; got {across!r}")
    low, high = shapes.outline.box
    step = float(np.max(high - low)) / (across - 1)
    x, y = (np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(low, high, strict=True))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    on_plate = shapes.outline.gap(grid) >= 0
    values = np.full((len(shapes.points), len(grid)), np.nan)
    for rows in _chunks(len(shapes.points)):
        values[np.ix_(rows, on_plate)] = _values(shapes, grid[on_plate], rows).T
    several = len(shapes.points) > 1
    np.savez_compressed(
        path,
        x=x,
        y=y,
        shapes=values.reshape(-1, len(x), len(y)),
        points=shapes.points,
        stiffness=shapes.stiffness.toarray() if isinstance(shapes, PatchedShapes) else shapes.stiffness,
        coupling=neighbour_coupling(shapes) if several else np.zeros(1),
        pitch=np.median(cKDTree(shapes.points).query(shapes.points, k=2)[0][:, 1]) if several else np.nan,
    )


def _values(shapes: InfluenceShapes | PatchedShapes, xy: FloatArray, rows: NDArray[np.int64]) -> FloatArray:
    """The shapes of some actuators at points (n, 2) [m]: (n, rows)."""
    weights = np.zeros((len(shapes.points), len(rows)))
    weights[rows, np.arange(len(rows))] = 1.0
    return shapes.derivatives(xy / shapes.size, weights)[0]


def _chunks(count: int) -> list[NDArray[np.int64]]:
    return [np.arange(start, min(start + CHUNK, count)) for start in range(0, count, CHUNK)]
