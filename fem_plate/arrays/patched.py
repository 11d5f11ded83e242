"""The influence shapes of a large array, put together from patches."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_matrix, csr_matrix

from fem_plate.arrays.patches import Array, Patch, Tell, Tile
from fem_plate.elements import Field, Fields
from fem_plate.influence import MOST_DENSE, InfluenceShapes, Shapes
from fem_plate.vibration import modes
from meshes import Outline

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SAME = 9  # digits of a patch's size to which points must lie alike
AT_ONCE = 4096  # points
SLACK = 1e-8  # of a patch's size: points on the rim may seem to lie beyond it
MOST_VALUES = 20_000_000  # points times actuators of which all shapes may be asked for at once


class PatchedShapes(Shapes):
    """Influence shapes of many actuators, each 0 beyond its patch; made by `Plate.influence`.

    strengths: (N, N) sparse.  truncation_error: the largest deflection left out of a shape, over its largest, measured.
    """

    def __init__(self, array: Array, truncation: float, size: float, outline: Outline, tell: Tell) -> None:
        self.tiles = array.tiles(truncation, tell)
        self.points, self.springs = np.ascontiguousarray(array.points), array.springs
        self.size, self.outline = size, outline
        self._array = array
        self._force_unit = array.rigidity / size**2
        self.truncation_error = max(tile.patch.truncation for tile in self.tiles)
        self.strengths: csr_matrix = self._strengths()

    def _strengths(self) -> csr_matrix:
        data, rows, columns = [], [], []
        for tile in self.tiles:
            patch = tile.patch
            forces = patch.field.forces * (self.size / patch.size) ** 2  # of the same dimensionless unit
            core = tile.rows[patch.core]
            data.append(forces.ravel())
            rows.append(np.repeat(tile.rows, len(core)))
            columns.append(np.tile(core, len(tile.rows)))
        flat = [np.concatenate(parts) for parts in (data, rows, columns)]
        return coo_matrix((flat[0], (flat[1], flat[2])), shape=(len(self.points),) * 2).tocsr()

    @property
    def unknowns(self) -> int:
        """How many unknowns the largest patch has."""
        return max(tile.patch.field.space.unknowns for tile in self.tiles)

    @cached_property
    def error_estimate(self) -> float:
        """Largest error in w over a shape's largest: of what is left out, or of what cells of half the size change."""
        inner = max(self.tiles, key=lambda tile: len(tile.rows))
        outer = max(self.tiles, key=lambda tile: tile.patch.field.space.unknowns)
        return max(self.truncation_error, self._array.difference(inner), self._array.difference(outer))

    @property
    def stiffness(self) -> csr_matrix:
        """Force at i that a unit stroke of j takes, (N, N) sparse [N/m]; of a floating one, per unit of its force."""
        return self.strengths * self._force_unit

    @property
    def compliance(self) -> FloatArray:
        """Raises ValueError: every entry counts, and patches know only those nearby."""
        raise ValueError(
            f"Input points of influence must be at most {MOST_DENSE}, and without a truncation, for a compliance; got "
            f"{len(self.points)} on patches"
        )

    def fields(self, x: FloatArray, weights: FloatArray | None) -> Fields:
        width = self._width(x, weights)
        value, gradient, hessian = (
            np.zeros((len(x), width)),
            np.zeros((len(x), width, 2)),
            np.zeros((len(x), width, 2, 2)),
        )
        for field, at, local, ratio in self._pieces(x, weights):
            w, slope, bend = field.evaluate(local)  # at actuators the Hessians are infinite
            value[at] += w
            gradient[at] += slope * ratio
            with np.errstate(invalid="ignore"):  # infinities of either sign meet at an actuator
                hessian[at] += bend * ratio**2
        return value, gradient, hessian

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        x = np.asarray(xy, dtype=float) / self.size
        value = np.zeros((len(x), self._width(x, weights)))
        for field, at, local, _ in self._pieces(x, weights):
            value[at] += field.values(local)
        return value

    def matrix(self, xy: ArrayLike, least: float = 0.0) -> csr_matrix:
        """The shapes at points as a sparse matrix.

        Where patches are alike and points lie alike on them, such as a grid in step with the array, one answer serves
        all.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.
        least : float
            Entries below this, relative to the shape at its own actuator, are left out.

        Returns
        -------
        shapes : sparse array (n, N)
            The shapes.
        """
        return self._sparse(xy, lambda patch, x: patch.field.values(x), least)

    def laplacians(self, xy: ArrayLike, floor: float, least: float = 0.0) -> csr_matrix:
        """The shapes' Laplacians at points as a sparse matrix.

        Parameters
        ----------
        xy : array (n, 2)
            Points, m.
        floor : float
            As in `InfluenceShapes.laplacians`, m.
        least : float
            As in `matrix`.

        Returns
        -------
        laplacians : sparse array (n, N)
            1/m^2 for each unit of the shapes' weights.
        """
        return self._sparse(xy, lambda patch, x: patch.field.laplacians(x, floor / patch.size) / patch.size**2, least)

    def _sparse(self, xy: ArrayLike, of: Callable[[Patch, FloatArray], FloatArray], least: float) -> csr_matrix:
        """What a patch's shapes give at points (n, 2) of it, dimensionless, as a matrix (n, N) for points [m]."""
        xy = np.asarray(xy, dtype=float)
        known: dict[tuple[int, bytes], tuple[IntArray, IntArray, FloatArray]] = {}
        found = []
        for tile in self.tiles:
            patch, core = tile.patch, tile.rows[tile.patch.core]
            local, near = self._within(tile, xy)
            key = id(patch), np.round(local[near], SAME).tobytes()
            if key not in known:
                known[key] = _entries(partial(of, patch), local[near], least * _at_own(of, patch))
            row, column, value = known[key]
            found.append((value, near[row].astype(np.int32), core[column].astype(np.int32)))
        flat = [np.concatenate(parts) for parts in zip(*found, strict=True)]
        known.clear()
        found.clear()
        return coo_matrix((flat[0], (flat[1], flat[2])), shape=(len(xy), len(self.points))).tocsr()

    def give(self, place: ArrayLike) -> float:
        """How far [m/N] the plate, its actuators held, gives at a place (2,) [m] under a unit force; three digits."""
        return self._array.give(np.asarray(place, dtype=float))

    def first_frequency(self, inertia: float) -> float:
        """The first frequency [Hz] of the piece of plate around the widest gap between actuators, with them held.

        It is clamped where it is cut out, and so no lower than that of the plate. inertia: kg/m^2, mass per area.
        """
        cut, rows = self._array.sparsest()
        held = self.points[rows] - cut.origin
        model, rigidity = self._array.model(self._array.cutter, cut, held), self._array.rigidity
        give = rigidity / model.mesh.size**2 / self.springs[rows]
        return float(modes(model, held, give, 1, rigidity / (inertia * model.mesh.size**4)).frequencies[0])

    def _width(self, x: FloatArray, weights: FloatArray | None) -> int:
        """How many functions are asked for; ValueError when they are too many for the points."""
        n, count = len(x), len(self.points)
        if weights is None and n * count > MOST_VALUES:
            raise ValueError(
                f"Input xy of evaluate must be at most {MOST_VALUES // count} points for all {count} shapes at once; "
                f"got {n}; give weights for their sum"
            )
        return count if weights is None else int(weights.shape[1])

    def _pieces(self, x: FloatArray, weights: FloatArray | None) -> Iterator[tuple[Field, Any, FloatArray, float]]:
        """Yield what each tile adds at x (n, 2): a field, to which entries, at its points, and the ratio of lengths."""
        for tile in self.tiles:
            patch = tile.patch
            ratio, core = self.size / patch.size, tile.rows[patch.core]
            if weights is not None and not weights[core].any():
                continue
            local, near = self._within(tile, x * self.size)
            if near.size and weights is None:
                yield patch.field, np.ix_(near, core), local[near], ratio
            elif near.size and weights is not None:
                yield patch.field.weighted(weights[core]), near, local[near], ratio

    def nearby(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        rows, values = [np.zeros(0, dtype=np.int64)], [np.zeros((len(xy), 0))]
        for tile in self.tiles:
            local, near = self._within(tile, xy)
            if near.size:
                rows.append(tile.rows[tile.patch.core])
                values.append(np.zeros((len(xy), len(rows[-1]))))
                values[-1][near] = tile.patch.field.values(local[near])
        return np.concatenate(rows), np.concatenate(values, axis=1)

    def own_heights(self) -> FloatArray:
        heights = np.empty(len(self.points))
        for tile in self.tiles:
            heights[tile.rows[tile.patch.core]] = _at_own(lambda patch, x: patch.field.values(x), tile.patch)
        return heights

    def _within(self, tile: Tile, xy: FloatArray) -> tuple[FloatArray, IntArray]:
        """Points (n, 2) [m] in the dimensionless coordinates of a tile's patch, and which of them lie on it."""
        patch = tile.patch
        local, box = (xy - tile.cut.origin) / patch.size, patch.box / patch.size
        near = np.flatnonzero(((local >= box[0] - SLACK) & (local <= box[1] + SLACK)).all(axis=1))
        return local, near[patch.field.space.holds(local[near])] if near.size else near


PlateShapes = InfluenceShapes | PatchedShapes


def _at_own(of: Callable[[Patch, FloatArray], FloatArray], patch: Patch) -> FloatArray:
    """What a patch's shapes (c,) give at their own actuators, without its sign."""
    return np.abs(np.diag(of(patch, patch.actuators[patch.core] / patch.size)))


def _entries(
    of: Callable[[FloatArray], FloatArray], x: FloatArray, least: FloatArray
) -> tuple[IntArray, IntArray, FloatArray]:
    """Rows, columns and values of functions (k,) at points (n, 2) that are larger than the least (k,)."""
    found = [(np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))]
    for start in range(0, len(x), AT_ONCE):
        values = of(x[start : start + AT_ONCE])
        row, column = np.nonzero(np.abs(values) > least)
        found.append((row + start, column, values[row, column]))
    row, column, value = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return row, column, value
