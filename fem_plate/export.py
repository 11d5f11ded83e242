"""Influence functions as arrays, for designers of deformable mirrors and for other programs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from os import PathLike

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.arrays import PatchedShapes
from fem_plate.influence import InfluenceShapes
from fem_plate.optics import LAYOUTS, Layout, save_fits
from fem_plate.types import FloatArray, IntArray

CHUNK = 64  # shapes evaluated at a time, to bound memory
ONE_OF_LAYOUTS = ", ".join(LAYOUTS[:-1]) + f" or {LAYOUTS[-1]}"
TIE = 1e-6  # of a distance: neighbours that differ by less are equally near


def neighbour_coupling(shapes: InfluenceShapes | PatchedShapes) -> FloatArray:
    """Each shape's mean deflection at the nearest other actuators, over that at its own.

    This ratio describes deformable mirrors whose actuators yield or float. It is zero where all are rigid. The nearest
    are all whose distance exceeds the least by no more than a millionth.

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
    tree = cKDTree(points)
    reach = (1 + TIE) * tree.query(points, k=2)[0][:, 1]
    coupling = []
    for rows in _chunks(len(points)):
        around = tree.query_ball_point(points[rows], reach[rows])  # with the actuator itself
        where, columns = np.concatenate(around), np.repeat(np.arange(len(rows)), [len(near) for near in around])
        places, row_of = np.unique(where, return_inverse=True)
        values = _values(shapes, points[places], rows)[row_of, columns]
        own = where == rows[columns]
        total = np.bincount(columns[~own], values[~own], len(rows))
        coupling.append(total / np.bincount(columns[~own], minlength=len(rows)) / values[own])
    return np.concatenate(coupling)


def save_influence(
    path: str | PathLike[str],
    shapes: InfluenceShapes | PatchedShapes,
    across: int = 101,
    layout: Layout | None = None,
    dead: Sequence[int] = (),
    actuator: int | None = None,
) -> None:
    """Write the influence functions on a square grid over the plate to a file.

    Without a layout it is an .npz file with the arrays

    - x (nx,) and y (ny,): the grid [m];
    - shapes (N, nx, ny): metres per metre of a held actuator's stroke, or per newton on a floating one; NaN off the
      plate;
    - points (N, 2): places of the actuators [m];
    - stiffness (N, N) [N/m];
    - coupling (N,): `neighbour_coupling`, 0 for a single actuator;
    - pitch: median distance of neighbours [m].

    With one it is a FITS file, by astropy, of what another program reads; 0 and a mask are off the plate. A table
    ACTUATORS has their places, stiffness, height at their own place, and whether they are dead.

    - "proper": one function around its actuator in the middle pixel, ten pixels a pitch, over its value there.
    - "compass": all functions as stamps, version 1.2.
    - "specula": all functions at the pixels of a mask, version 1.

    Parameters
    ----------
    path : path-like
        The file.
    shapes : InfluenceShapes or PatchedShapes
        Shapes of N actuators.
    across : int
        Points of the grid along the plate's longer side, at least 2; of a FITS file its pixels.
    layout : {"proper", "compass", "specula"}, optional
        The layout of a FITS file.
    dead : sequence of int
        Actuators that do not answer: their functions are 0. What they do to the others' is in the shapes: of a
        stiffness they stand still, and with a stiffness of 0 they follow passively. Of a layout with all functions.
    actuator : int, optional
        Whose function the layout "proper" has; by default of the one closest to the middle of the plate.

    Raises
    ------
    ValueError
        There are fewer than two points across, the layout is unknown or does not go with the file's name, the
        dead or chosen actuators do not exist or go with it, or "proper" has no pitch to count pixels in.
    """
    if mistakes := [*_mistakes(path, len(shapes.points), across, layout, dead, actuator)]:
        raise ValueError("; ".join(f"Input {name} of save_influence {message}" for name, message in mistakes))
    if layout is not None:
        return save_fits(path, shapes, layout, across, dead, actuator)
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


def _mistakes(
    path: str | PathLike[str],
    count: int,
    across: int,
    layout: str | None,
    dead: Sequence[int],
    actuator: int | None,
) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with an input, and how."""
    if across < 2:
        yield "across", f"must be at least 2; got {across!r}"
    if layout is None and str(path).lower().endswith((".fits", ".fit")):
        yield "layout", f"must be {ONE_OF_LAYOUTS} for a FITS file; got None"
    if layout is None:
        if len(dead) or actuator is not None:
            yield "layout", f"must be {ONE_OF_LAYOUTS} with dead or chosen actuators; got None"
        return
    if layout not in LAYOUTS:
        yield "layout", f"must be {ONE_OF_LAYOUTS}; got {layout!r}"
    if not str(path).lower().endswith((".fits", ".fit")):
        yield "path", f"must end in .fits with a layout; got {str(path)!r}"
    wrong = [row for row in dead if not 0 <= row < count]
    if wrong:
        yield "dead", f"must be actuators from 0 to {count - 1}; got {wrong}"
    elif len(set(dead)) == count:
        yield "dead", "must leave an actuator alive; got all of them"
    if actuator is not None and layout != "proper":
        yield "actuator", f'must not be given with layout "{layout}", which has all'
    elif actuator is not None and (not 0 <= actuator < count or actuator in dead):
        yield "actuator", f"must be one from 0 to {count - 1} that is not dead; got {actuator}"
    if layout == "proper" and count < 2:
        yield (
            "shapes",
            'must have two actuators or more with layout "proper", whose pixels are counted in pitches; got 1',
        )


def _values(shapes: InfluenceShapes | PatchedShapes, xy: FloatArray, rows: IntArray) -> FloatArray:
    """The shapes of some actuators at points (n, 2) [m]: (n, rows)."""
    weights = np.zeros((len(shapes.points), len(rows)))
    weights[rows, np.arange(len(rows))] = 1.0
    return shapes.derivatives(xy / shapes.size, weights)[0]


def _chunks(count: int) -> list[IntArray]:
    return [np.arange(start, min(start + CHUNK, count)) for start in range(0, count, CHUNK)]
