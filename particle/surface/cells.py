"""The cells of a moving surface: rectangles of a background grid, each with the shapes of the drives that count there.

In a cell, shape i is a polynomial plus the logarithms around the actuators close by. The polynomial has taken up
everything else, the logarithms farther off included, so that a cell knows neither how many actuators there are nor how
large the plate is. Cells where that is not good enough are divided into four.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import DTypeLike, NDArray

from particle.group import grouped
from particle.records import Record, new_records, record_type
from particle.types import FloatArray, IntArray

NOWHERE, UNBUILT = -1, -2  # the cell of points where there is no plate, and of those that nobody has asked for yet
WHOLE = -1  # what a cell that is not divided has in place of its quarters
NO_PLANE = np.zeros((0, 2, 1))  # the shapes in the plane of a surface that stays in place there


class Cell(Record):
    """One cell: where it is, and where what counts in it begins in the arrays of `Cells`."""

    x: float  # m, its centre
    y: float
    half_x: float  # m, half its width
    half_y: float
    clear: float  # m, how far it is from the rim at least, overhang included; 0: not known to be
    quarters: int  # the first of the four cells that it is divided into, those at lower x first, or WHOLE
    degree: int  # of its polynomials
    plane_degree: int  # of its shapes in the plane
    first_drive: int
    drives: int  # how many count in it
    first_near: int
    logarithms: int  # how many actuators are close by
    first_row: int  # NOWHERE off the plate
    first_plane: int


class Grid(Record):
    """The background grid, and the largest numbers of any cell."""

    x: float  # m, its lower left corner
    y: float
    width_x: float  # m, of its cells; inf: one cell is everywhere
    width_y: float
    most_drives: int
    most_near: int  # logarithms
    highest: int  # degree
    plane_highest: int


@grouped
class Cells(NamedTuple):
    """All cells that are built, as kernels read them. Cells that are translates of each other share their rows."""

    grid: NDArray[Any]  # (1,) of `Grid`
    roots: IntArray  # (nx, ny), the cell of each rectangle of the grid, or NOWHERE or UNBUILT
    cell: NDArray[Any]  # (c,) of `Cell`
    drive: IntArray  # the drives that count in a cell, from `first_drive` on
    weight: FloatArray  # how high [m] each one's shape is there at most, for a metre of its drive; inf: not known
    near: IntArray  # the actuators close by, from `first_near` on
    rows: FloatArray  # a shape after the other: monomials in (x - centre) / half, then the strengths of the logarithms
    plane_rows: FloatArray  # a shape in the plane after the other: monomials along x, then along y


# What `Cell` has under another name or shape in the columns of a file.
_PLACES = (("centre", "x", "y"), ("half", "half_x", "half_y"))
_COUNTS = {"first_drive": "drives", "first_near": "logarithms"}
_NUMBERS = ("quarters", "clear", "first_row", "degree", "first_plane", "plane_degree")
_SIZES = ("most_drives", "most_near", "highest", "plane_highest")
_RAGGED = ("roots", "drive", "weight", "near", "rows", "plane_rows")


def columns_of(cells: Cells) -> dict[str, Any]:
    """An array for each number of the cells, as files have them; `first_...` also has where the last cell's end."""
    grid, cell = cells.grid[0], cells.cell
    columns: dict[str, Any] = {"origin": [grid.x, grid.y], "width": [grid.width_x, grid.width_y]}
    columns |= {name: np.stack([cell[x], cell[y]], axis=1) for name, x, y in _PLACES}
    columns |= {first: np.append(0, np.cumsum(cell[count])) for first, count in _COUNTS.items()}
    columns |= {name: cell[name] for name in _NUMBERS} | {name: int(grid[name]) for name in _SIZES}
    return columns | {name: getattr(cells, name) for name in _RAGGED}


def cells_of(columns: dict[str, Any]) -> Cells:
    """The cells of such columns."""
    grid, cell = np.zeros(1, record_type(Grid)), np.zeros(len(columns["quarters"]), record_type(Cell))
    grid[0] = (*columns["origin"], *columns["width"], *(columns[name] for name in _SIZES))
    for name, x, y in _PLACES:
        cell[x], cell[y] = columns[name].T
    for first, count in _COUNTS.items():
        cell[first], cell[count] = columns[first][:-1], np.diff(columns[first])
    for name in _NUMBERS:
        cell[name] = columns[name]
    return Cells(grid, cell=cell, **{name: columns[name] for name in _RAGGED})


class CellFit(NamedTuple):
    """What one cell is made of.

    drive: (k,) drives.  weight: (k,), near: (j,) actuators, as in `Cells`.  clear: m, as in `Cell`.
    rows: (k, monomials + j).  shared: whether other cells are made of the same `rows`.  plane: (m, 2, monomials of
    `plane_degree`), all shapes in the plane.
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
        self._cell = _Growing(record_type(Cell))
        self._drive, self._weight, self._near = _Growing(np.int64), _Growing(np.float64), _Growing(np.int64)
        self._rows, self._plane_rows = _Growing(np.float64), _Growing(np.float64)
        self._shared: dict[int, tuple[FloatArray, int]] = {}
        self._most_drives, self._most_near, self._highest, self._plane_highest = 1, 0, 0, 0

    def add(self, centre: FloatArray, half: FloatArray, fit: CellFit | None, quarters: int = WHOLE) -> int:
        """A cell around a centre (2,) [m], half as wide as (2,) [m]; its row.

        None for one off the plate.  quarters: the first of the four cells, added before, that it is divided into.
        """
        rows = new_records(Cell)
        cell: Cell = rows[0]
        cell.x, cell.y = centre
        cell.half_x, cell.half_y = half
        cell.quarters, cell.first_row = quarters, NOWHERE
        cell.first_drive, cell.first_near, cell.first_plane = len(self._drive), len(self._near), len(self._plane_rows)
        if fit:
            cell.clear, cell.degree, cell.plane_degree = fit.clear, fit.degree, fit.plane_degree
            cell.drives, cell.logarithms, cell.first_row = len(fit.drive), len(fit.near), self._place(fit)
            self._drive.append(fit.drive)
            self._weight.append(fit.weight)
            self._near.append(fit.near)
            self._plane_rows.append(fit.plane.ravel())
            self._most_drives = max(self._most_drives, len(fit.drive))
            self._most_near = max(self._most_near, len(fit.near))
            self._highest = max(self._highest, fit.degree)
            self._plane_highest = max(self._plane_highest, fit.plane_degree)
        self._cell.append(rows)
        return len(self._cell) - 1

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
        grid = new_records(Grid)
        sizes = self._most_drives, self._most_near, self._highest, self._plane_highest
        grid[0] = (*self.origin, *self.width, *sizes)
        return Cells(
            grid,
            self.roots.copy(),
            self._cell.view(),
            self._drive.view(),
            self._weight.view(),
            self._near.view(),
            self._rows.view(),
            self._plane_rows.view(),
        )


class _Growing:
    """An array to whose end more is put; views of it stay as they are."""

    def __init__(self, kind: DTypeLike) -> None:
        self._buffer: NDArray[Any] = np.empty(16, dtype=kind)
        self._length = 0

    def __len__(self) -> int:
        return self._length

    def append(self, more: NDArray[Any]) -> None:
        length = self._length + len(more)
        if length > len(self._buffer):
            longer = np.empty(max(length, 2 * len(self._buffer)), self._buffer.dtype)
            longer[: self._length] = self._buffer[: self._length]
            self._buffer = longer
        self._buffer[self._length : length] = more
        self._length = length

    def view(self) -> NDArray[Any]:
        return self._buffer[: self._length]
