"""The cells of a moving surface: rectangles of a background grid, each with the shapes of the drives that count there.

In a cell, shape i is a polynomial plus the logarithms around the actuators close by. The polynomial has taken up
everything else, the logarithms farther off included, so that a cell knows neither how many actuators there are nor how
large the plate is. Cells where that is not good enough are divided into four.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from particle.types import FloatArray, IntArray

NOWHERE, UNBUILT = -1, -2  # the cell of points where there is no plate, and of those that nobody has asked for yet
WHOLE = -1  # what a cell that is not divided has in place of its quarters
NO_PLANE = np.zeros((0, 2, 1))  # the shapes in the plane of a surface that stays in place there


class Cells(NamedTuple):
    """All cells that are built, as kernels read them; cell c has a[c] .. a[c + 1] of what `first_...` counts.

    Cells that are translates of each other share their shapes.
    """

    origin: FloatArray  # (2,) m, the grid's lower left corner
    width: FloatArray  # (2,) m, of the grid's cells; inf: one cell is everywhere
    roots: IntArray  # (nx, ny), the cell of each rectangle of the grid, or NOWHERE or UNBUILT
    quarters: IntArray  # (c,) the first of the four cells that a cell is divided into, those at lower x first, or WHOLE
    centre: FloatArray  # (c, 2) m
    half: FloatArray  # (c, 2) m, half its width
    clear: FloatArray  # (c,) m, how far it is from the rim at least, overhang included; 0: not known to be
    first_drive: IntArray  # (c + 1,)
    drive: IntArray  # the drives that count in it
    weight: FloatArray  # how high [m] each one's shape is there at most, for a metre of its drive; inf: not known
    first_near: IntArray  # (c + 1,)
    near: IntArray  # the actuators close by
    first_row: IntArray  # (c,) where its first shape begins in `rows`; NOWHERE off the plate
    degree: IntArray  # (c,) of its polynomials
    rows: FloatArray  # a shape after the other: monomials in (x - centre) / half, then the strengths of the logarithms
    first_plane: IntArray  # (c,) where its first shape in the plane begins in `plane_rows`
    plane_degree: IntArray  # (c,) of these shapes
    plane_rows: FloatArray  # a shape in the plane after the other: monomials along x, then along y
    most_drives: int  # of any cell
    most_near: int
    highest: int  # degree of any cell
    plane_highest: int  # of any cell's shapes in the plane


class CellFit(NamedTuple):
    """What one cell is made of.

    drive: (k,) drives.  weight: (k,), near: (j,) actuators, clear: m, as in `Cells`.  rows: (k, monomials + j).
    shared: whether other cells are made of the same `rows`.  plane: (m, 2, monomials of `plane_degree`), all shapes in
    the plane.
    """

    degree: int
    drive: IntArray
    weight: FloatArray
    near: IntArray
    rows: FloatArray
    clear: float
    shared: bool = False
    plane: FloatArray = NO_PLANE
    plane_degree: int = 0


class CellStore(Protocol):
    """Where a surface's cells come from; it may be shared by surfaces that differ in their drives alone."""

    @property
    def cells(self) -> Cells:
        """Those built so far. What has been handed out does not change."""

    @property
    def error(self) -> float:
        """The largest error measured in them, relative to each shape's height at its own actuator."""

    def build(self, places: FloatArray) -> None:
        """Makes sure that there are cells at places (n, 2) [m] on the plate."""


class OneCell:
    """A single exact cell that is everywhere, around the origin, half as wide as `size` [m]."""

    error = 0.0

    def __init__(
        self, shapes: FloatArray, degree: int, size: float, plane: FloatArray = NO_PLANE, plane_degree: int = 0
    ) -> None:
        pool = CellPool(np.zeros(2), np.full(2, math.inf), np.array([[UNBUILT]]))
        weight, near = np.full(len(shapes), math.inf), np.zeros(0, dtype=np.int64)
        drive = np.arange(len(shapes))
        fit = CellFit(degree, drive, weight, near, shapes, clear=0.0, plane=plane, plane_degree=plane_degree)
        pool.roots[0, 0] = pool.add(np.zeros(2), np.full(2, size), fit)
        self.cells = pool.cells()

    def build(self, places: FloatArray) -> None:
        """There is nothing left to build."""


class BuiltCells:
    """Cells to which no more are added."""

    def __init__(self, cells: Cells, error: float) -> None:
        self.cells, self.error = cells, error

    def build(self, places: FloatArray) -> None:
        """Raises ValueError: there is nothing to build them from."""
        x, y = (places[0] * 1e6).tolist()
        raise ValueError(
            f"The surface has no cell at ({x:.6g}, {y:.6g}) um: it was saved before anything had been asked of it there"
        )


class CellPool:
    """Cells as they are added, in arrays that grow. `rows` that are shared are kept once."""

    def __init__(self, origin: FloatArray, width: FloatArray, roots: IntArray) -> None:
        self.origin, self.width, self.roots = origin, width, roots
        self._quarters, self._first_row = _Growing(np.int64), _Growing(np.int64)
        self._centre, self._half = _Growing(np.float64, 2), _Growing(np.float64, 2)
        self._clear, self._rows = _Growing(np.float64), _Growing(np.float64)
        self._drive, self._weight, self._near = _Growing(np.int64), _Growing(np.float64), _Growing(np.int64)
        self._first_drive, self._first_near = _Growing(np.int64), _Growing(np.int64)
        self._first_drive.append([0])
        self._first_near.append([0])
        self._shared: dict[int, tuple[FloatArray, int]] = {}
        self._degree = _Growing(np.int64)
        self._first_plane, self._plane_degree = _Growing(np.int64), _Growing(np.int64)
        self._plane_rows = _Growing(np.float64)
        self._most_drives, self._most_near, self._highest, self._plane_highest = 1, 0, 0, 0

    def add(self, centre: FloatArray, half: FloatArray, fit: CellFit | None, quarters: int = WHOLE) -> int:
        """A cell around a centre (2,) [m], half as wide as (2,) [m]; its row.

        None for one off the plate.  quarters: the first of the four cells, added before, that it is divided into.
        """
        self._quarters.append([quarters])
        self._centre.append([centre])
        self._half.append([half])
        self._clear.append([fit.clear if fit else 0.0])
        self._degree.append([fit.degree if fit else 0])
        self._first_row.append([self._place(fit) if fit else NOWHERE])
        self._first_plane.append([len(self._plane_rows)])
        self._plane_degree.append([fit.plane_degree if fit else 0])
        if fit:
            self._drive.append(fit.drive)
            self._weight.append(fit.weight)
            self._near.append(fit.near)
            self._most_drives = max(self._most_drives, len(fit.drive))
            self._most_near = max(self._most_near, len(fit.near))
            self._highest = max(self._highest, fit.degree)
            self._plane_rows.append(fit.plane.ravel())
            self._plane_highest = max(self._plane_highest, fit.plane_degree)
        self._first_drive.append([len(self._drive)])
        self._first_near.append([len(self._near)])
        return len(self._quarters) - 1

    def _place(self, fit: CellFit) -> int:
        rows, place = self._shared.get(id(fit.rows), (None, 0))
        if rows is fit.rows:  # in a copy of the pool it may be another one
            return place
        place = len(self._rows)
        self._rows.append(fit.rows.ravel())
        if fit.shared:
            self._shared[id(fit.rows)] = (fit.rows, place)
        return place

    def cells(self) -> Cells:
        """What there is now; it stays as it is when more is added."""
        return Cells(
            self.origin,
            self.width,
            self.roots.copy(),
            self._quarters.view(),
            self._centre.view(),
            self._half.view(),
            self._clear.view(),
            self._first_drive.view(),
            self._drive.view(),
            self._weight.view(),
            self._first_near.view(),
            self._near.view(),
            self._first_row.view(),
            self._degree.view(),
            self._rows.view(),
            self._first_plane.view(),
            self._plane_degree.view(),
            self._plane_rows.view(),
            self._most_drives,
            self._most_near,
            self._highest,
            self._plane_highest,
        )


class _Growing:
    """An array to whose end more is put; views of it stay as they are."""

    def __init__(self, kind: type, *shape: int) -> None:
        self._buffer: NDArray[Any] = np.empty((16, *shape), dtype=kind)
        self._length = 0

    def __len__(self) -> int:
        return self._length

    def append(self, more: Any) -> None:
        more = np.asarray(more)
        length = self._length + len(more)
        if length > len(self._buffer):
            longer = np.empty((max(length, 2 * len(self._buffer)), *self._buffer.shape[1:]), self._buffer.dtype)
            longer[: self._length] = self._buffer[: self._length]
            self._buffer = longer
        self._buffer[self._length : length] = more
        self._length = length

    def view(self) -> NDArray[Any]:
        return self._buffer[: self._length]
