"""PatchedShapes: the influence shapes of a large array, put together from patches."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import coo_matrix, csr_matrix, vstack

from fem_plate.arrays.cutting import CELL, FINER_CELL, Cutter
from fem_plate.arrays.patches import ActuatorArray, Patch, ProgressCallback, Tile, spacing
from fem_plate.elements import Derivatives, PlateFunctions, source_basis
from fem_plate.graded import GradedPlate
from fem_plate.influence import MAX_DENSE, InfluenceShapes
from fem_plate.modes import HeldPlate, first_frequency
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray
from meshes import Outline

PatchFunction = Callable[[Patch, FloatArray], FloatArray]  # values (n, c) of a patch's shapes at points (n, 2)

PLACE_DIGITS = 9  # of a patch's size, to which points lie alike
CHUNK = 4096  # points evaluated at a time
SLACK = 1e-8  # of a patch's size: points on the rim may seem to lie beyond it
MAX_VALUES = 20_000_000  # points times actuators for which all shapes are evaluated at once
PATCH_FINENESS = 0.16  # of the half width, eight cells: shapes at the rim are then good to 1e-6
PATCH_RIM = 30.0  # pitches, about, that a patch extends along the rim


class PatchedShapes(Shapes):
    """Influence shapes of many actuators, each 0 beyond its patch; made by `Plate.influence`.

    Attributes
    ----------
    strengths : (N, N) sparse matrix
        As of `Shapes`.
    truncation_error : float
        The largest deflection left out of a shape, over its largest, as measured.
    """

    def __init__(
        self, array: ActuatorArray, truncation: float, size: float, outline: Outline, tell: ProgressCallback
    ) -> None:
        self.tiles = array.tiles(truncation, tell)
        self.points, self.springs = np.ascontiguousarray(array.points), array.actuator_stiffness
        self.size, self.outline = size, outline
        self._array = array
        self._stiffness_unit = array.rigidity / size**2
        self.truncation_error = max(tile.patch.truncation for tile in self.tiles)
        self.strengths: csr_matrix = self._strengths()

    def _strengths(self) -> csr_matrix:
        data, rows, columns = [], [], []
        for tile in self.tiles:
            patch = tile.patch
            forces = patch.functions.forces * (self.size / patch.size) ** 2  # in the same dimensionless unit
            core = tile.rows[patch.core]
            data.append(forces.ravel())
            rows.append(np.repeat(tile.rows, len(core)))
            columns.append(np.tile(core, len(tile.rows)))
        flat = [np.concatenate(parts) for parts in (data, rows, columns)]
        return coo_matrix((flat[0], (flat[1], flat[2])), shape=(len(self.points),) * 2).tocsr()

    @property
    def unknowns(self) -> int:
        """Number of unknowns of the largest patch."""
        return max(tile.patch.functions.space.unknowns for tile in self.tiles)

    @cached_property
    def error_estimate(self) -> float:
        """Largest error of w over a shape's largest deflection: what is left out, or what halving the cells changes."""
        inner = max(self.tiles, key=lambda tile: len(tile.rows))
        outer = max(self.tiles, key=lambda tile: tile.patch.functions.space.unknowns)
        rounding = max(
            source_basis(tile.patch.functions.sources, self.springs[tile.rows] > 0).rounding for tile in self.tiles
        )
        return max(self.truncation_error, self._array.difference(inner), self._array.difference(outer)) + rounding

    @property
    def stiffness(self) -> csr_matrix:
        """Force at i for a unit stroke of actuator j, (N, N) sparse [N/m]; for a floating one, for a unit force."""
        return self.strengths * self._stiffness_unit

    @property
    def compliance(self) -> FloatArray:
        """Raises ValueError: patches do not give a compliance, whose entries all count, however far apart."""
        raise ValueError(
            f"Input points of influence must be at most {MAX_DENSE}, and without a truncation, for a compliance; got "
            f"{len(self.points)} on patches"
        )

    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        width = self._width(x, weights)
        value, gradient, hessian = (
            np.zeros((len(x), width)),
            np.zeros((len(x), width, 2)),
            np.zeros((len(x), width, 2, 2)),
        )
        for functions, entries, x_patch, (axes, scale) in self._pieces(x, weights):
            w, w_grad, w_hess = functions.evaluate(x_patch)  # at actuators the Hessians are infinite
            value[entries] += w
            gradient[entries] += w_grad[..., axes] * scale
            with np.errstate(invalid="ignore"):  # infinities of either sign meet at an actuator
                hessian[entries] += w_hess[..., axes, :][..., axes] * np.outer(scale, scale)
        return value, gradient, hessian

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        x = np.asarray(xy, dtype=float) / self.size
        value = np.zeros((len(x), self._width(x, weights)))
        for functions, entries, x_patch, _ in self._pieces(x, weights):
            value[entries] += functions.values(x_patch)
        return value

    def matrix(self, xy: ArrayLike, least: float = 0.0, weights: FloatArray | None = None) -> csr_matrix | FloatArray:
        """The shapes' values as a sparse matrix, or the values of their weighted sums.

        Points in like places of like patches, as on a grid in step with the array, are evaluated once.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points [m].
        least : float
            Leave out entries below this fraction of the shape's value at its own actuator.
        weights : (N, k) array, optional
            Weights of k sums of the shapes.

        Returns
        -------
        (n, N) sparse matrix, or (n, k) array with weights
        """
        return self._sparse(xy, _values, least, weights)

    def laplacians(
        self, xy: ArrayLike, floor: float, least: float = 0.0, weights: FloatArray | None = None
    ) -> csr_matrix | FloatArray:
        """The shapes' Laplacians as a sparse matrix, or those of their weighted sums.

        Parameters
        ----------
        xy, least, weights
            As for `matrix`.
        floor : float
            As for `InfluenceShapes.laplacians` [m].

        Returns
        -------
        (n, N) sparse matrix, or (n, k) array with weights
            [1/m^2]; with weights, times their unit.
        """

        def laplacians(patch: Patch, x: FloatArray) -> FloatArray:
            return patch.functions.laplacians(x, floor / patch.size) / patch.size**2

        return self._sparse(xy, laplacians, least, weights)

    def _sparse(
        self, xy: ArrayLike, function: PatchFunction, least: float, weights: FloatArray | None
    ) -> csr_matrix | FloatArray:
        """A function of a patch's shapes at points (n, 2) [m], as a matrix (n, N), or its sums with weights (N, k)."""
        xy = np.asarray(xy, dtype=float)
        alike: dict[int, list[tuple[Tile, FloatArray, IntArray]]] = {}
        for tile in self.tiles:
            x, on_patch = self._within(tile, xy)
            alike.setdefault(id(tile.patch), []).append((tile, x[on_patch], on_patch))
        sums = None if weights is None else np.zeros((len(xy), weights.shape[1]))
        entries = []
        for tiles in alike.values():
            patch = tiles[0][0].patch
            spots = np.concatenate([x for _, x, _ in tiles])
            at = np.ascontiguousarray(np.round(spots, PLACE_DIGITS) + 0.0).view(complex)[:, 0]
            _, first, which = np.unique(at, return_index=True, return_inverse=True)
            values = _entries(partial(function, patch), spots[first], least * _at_own(function, patch))
            ends = np.cumsum([len(on_patch) for _, _, on_patch in tiles])[:-1]
            for (tile, _, on_patch), rows in zip(tiles, np.split(which, ends), strict=True):
                core, own = tile.rows[patch.core], values[rows]
                if sums is not None and weights is not None:
                    sums[on_patch] += own @ weights[core]
                else:
                    row = np.repeat(on_patch, np.diff(own.indptr)).astype(np.int32)
                    entries.append((own.data, row, core[own.indices].astype(np.int32)))
        if sums is not None:
            return sums
        flat = [np.concatenate(parts) for parts in zip(*entries, strict=True)]
        entries.clear()  # to make room for the matrix
        return coo_matrix((flat[0], (flat[1], flat[2])), shape=(len(xy), len(self.points))).tocsr()

    def compliance_at(self, place: ArrayLike) -> float:
        """The deflection [m/N] at a place (2,) [m] under a unit force there, with actuators held; three digits."""
        return self._array.compliance_at(np.asarray(place, dtype=float))

    def first_frequency(self, inertia: float) -> float:
        """The first frequency [Hz] of the piece of plate around the widest gap between held actuators.

        The piece is clamped where it is cut out, so its frequency is no lower than the plate's.
        inertia: kg/m^2, mass per area.
        """
        cut, rows = self._array.sparsest()
        held = self.points[rows] - cut.origin
        model = self._array.model(self._array.cutter, cut, held)
        held_plate = HeldPlate(model, held, self._array.rigidity, self.springs[rows])
        return first_frequency(held_plate, inertia)

    def _width(self, x: FloatArray, weights: FloatArray | None) -> int:
        """The number of functions to evaluate; ValueError when they are too many for the points."""
        n, count = len(x), len(self.points)
        if weights is None and n * count > MAX_VALUES:
            raise ValueError(
                f"Input xy of evaluate must be at most {MAX_VALUES // count} points for all {count} shapes at once; "
                f"got {n}; give weights for their sum"
            )
        return count if weights is None else int(weights.shape[1])

    def _pieces(
        self, x: FloatArray, weights: FloatArray | None
    ) -> Iterator[tuple[PlateFunctions, Any, FloatArray, tuple[list[int], FloatArray]]]:
        """Yield what each tile adds at x (n, 2): functions, entries to add to, points, and how derivatives turn."""
        for tile in self.tiles:
            patch = tile.patch
            turn, core = (tile.turn.axes, self.size / patch.size * tile.turn.signs), tile.rows[patch.core]
            if weights is not None and not weights[core].any():
                continue
            x_patch, on_patch = self._within(tile, x * self.size)
            if on_patch.size and weights is None:
                yield patch.functions, np.ix_(on_patch, core), x_patch[on_patch], turn
            elif on_patch.size and weights is not None:
                yield patch.functions.weighted(weights[core]), on_patch, x_patch[on_patch], turn

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        rows, values = [np.zeros(0, dtype=np.int64)], [np.zeros((len(xy), 0))]
        for tile in self.tiles:
            x, on_patch = self._within(tile, xy)
            if on_patch.size:
                rows.append(tile.rows[tile.patch.core])
                values.append(np.zeros((len(xy), len(rows[-1]))))
                values[-1][on_patch] = tile.patch.functions.values(x[on_patch])
        return np.concatenate(rows), np.concatenate(values, axis=1)

    def own_heights(self) -> FloatArray:
        heights = np.empty(len(self.points))
        for tile in self.tiles:
            heights[tile.rows[tile.patch.core]] = _at_own(_values, tile.patch)
        return heights

    def _within(self, tile: Tile, xy: FloatArray) -> tuple[FloatArray, IntArray]:
        """Points (n, 2) [m] in the dimensionless coordinates of a tile's patch, and the rows of those on it."""
        patch = tile.patch
        x, box = tile.turn.of(xy - tile.cut.origin) / patch.size, patch.box / patch.size
        in_box = np.flatnonzero(((x >= box[0] - SLACK) & (x <= box[1] + SLACK)).all(axis=1))
        return x, in_box[patch.functions.space.holds(x[in_box])] if in_box.size else in_box


PlateShapes = InfluenceShapes | PatchedShapes


def _values(patch: Patch, x: FloatArray) -> FloatArray:
    return patch.functions.values(x)


def _at_own(function: PatchFunction, patch: Patch) -> FloatArray:
    """The magnitude (c,) of a function of a patch's shapes at their own actuators."""
    return np.abs(np.diag(function(patch, patch.actuators[patch.core] / patch.size)))


def _entries(function: Callable[[FloatArray], FloatArray], x: FloatArray, floor: FloatArray) -> csr_matrix:
    """The values (n, k) of k functions at points (n, 2) that exceed the floor (k,)."""
    parts = [csr_matrix((0, len(floor)))]
    for start in range(0, len(x), CHUNK):
        values = function(x[start : start + CHUNK])
        parts.append(csr_matrix(np.where(np.abs(values) > floor, values, 0.0)))
    return vstack(parts).tocsr()


def patched_shapes(
    plate: GradedPlate, points: FloatArray, actuator_stiffness: FloatArray, truncation: float, tell: ProgressCallback
) -> PatchedShapes:
    """The influence shapes of actuators at points (N, 2) [m], each cut off where it is below the truncation."""
    mesh, section = plate.mesh, plate.section
    cell = min(plate.grading.cell, PATCH_FINENESS * plate.grading.half_width)
    pitch = spacing(points)
    grading = plate.grading.on_patches(cell, PATCH_RIM * min(float(pitch.max()), mesh.size))
    pitches = CELL if plate.tolerance is None else FINER_CELL
    cutter = Cutter(mesh, plate.supports, grading, plate.corners, points, pitch, pitches)
    array = ActuatorArray(cutter, points, actuator_stiffness, section.rigidity, section.law, plate.relative_tension)
    return PatchedShapes(array, truncation, mesh.size, mesh.outline, tell)
