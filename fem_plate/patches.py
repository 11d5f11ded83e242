"""Influence shapes of large arrays: each found on a patch of the plate around its actuator.

Among held actuators a shape falls off by about five times per pitch, so that a plate clamped some pitches away has the
same one. Actuators are taken tile by tile; a tile's patch reaches beyond it by a margin, and tiles whose patches look
alike share one answer. The cost grows with the number of actuators, for a lattice with that of its unlike tiles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem_plate.cutting import Cut, Cutter
from fem_plate.field import Field
from fem_plate.influence import held_shapes
from fem_plate.model import PlateModel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

TILE = 10  # pitches across a tile
# A shape's largest deflection within a pitch of a cut 9 pitches away, and by how much it falls with one pitch more.
FIRST_MARGIN, FIRST_VALUE, DECAY = 9.0, 1.4e-6, 3.7
LEAST_MARGIN = 3.0
WIDER = 2.0  # pitches added to a margin that was not wide enough; twice as many each time
NEAR_CUT = 0.75  # pitches: actuators that near a cut are left to it
NEIGHBOURS = 8  # the nearest actuators, one of which holds the plate best
SAMPLES = 1000  # points at which shapes on two meshes are compared
SAME = 8  # digits of a pitch to which patches must look alike


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of plate around an origin of its own, and the shapes of its tile's actuators.

    box: (2, 2) m.  actuators: (n, 2) m.  core: (c,) rows of those that have shapes.
    size: m, the length that makes it dimensionless.  field: the shapes of the core.
    truncation: the largest deflection of a shape near the cut, over its largest: the size of what is left out.
    """

    box: FloatArray
    actuators: FloatArray
    core: IntArray
    size: float
    field: Field
    truncation: float


@dataclass(frozen=True, eq=False)
class Tile:
    """Where a patch is used, and its actuators' rows (n,) in the array."""

    patch: Patch
    cut: Cut
    rows: IntArray


class Array:
    """A large array on a plate, to be solved tile by tile.

    points: (N, 2) m.  springs: (N,) N/m.
    """

    def __init__(self, cutter: Cutter, points: FloatArray, springs: FloatArray, rigidity: float, nu: float) -> None:
        self.cutter, self.points, self.springs = cutter, points, springs
        self.rigidity, self.poisson_ratio = rigidity, nu
        self._tree = cKDTree(points)
        self._known: dict[bytes, Patch] = {}

    def tiles(self, truncation: float) -> list[Tile]:
        """The array in tiles, with margins wide enough for the truncation, as far as the plate reaches.

        Where a margin takes the whole plate there is one tile. Raises ValueError when the truncation is not positive.
        """
        if not truncation > 0:
            raise ValueError(f"Input truncation of influence must be positive; got {truncation!r}")
        pitch = self.cutter.pitch
        lowest = self.points.min(axis=0) - pitch / 2
        place = np.floor((self.points - lowest) / (TILE * pitch) + 1e-9).astype(np.int64)
        tiles = []
        for corner in np.unique(place, axis=0):
            inside = np.flatnonzero((place == corner).all(axis=1))
            middle = lowest + (corner + 0.5) * TILE * pitch
            # Cuts half-way between the rows of a lattice.
            longest = pitch.max() / pitch  # shapes fall off over the longer pitch either way
            reach, wider = (TILE / 2 + np.ceil(margin(truncation) * longest)) * pitch, WIDER
            while True:
                tile = self._tile(middle, reach, inside)
                if tile.patch.truncation <= truncation or not len(tile.cut.edge):
                    break
                reach, wider = reach + np.ceil(wider * longest) * pitch, 2 * wider
            if not len(tile.cut.edge):
                # All of the plate, as others would take too: one answer for the whole array.
                tiles = [self._tile(middle, reach, np.arange(len(self.points)))]
                break
            tiles.append(tile)
        self._known.clear()
        return tiles

    def _tile(self, middle: FloatArray, reach: FloatArray, inside: IntArray) -> Tile:
        pitch = self.cutter.pitch
        cut = self.cutter.cut(middle, reach)
        near = np.array(self._tree.query_ball_point(middle, float(np.hypot(*reach))), dtype=np.int64)
        # In an order that depends on where they are alone.
        near = near[np.lexsort(np.round((self.points[near] - cut.origin) / pitch, SAME).T)]
        local = self.points[near] - cut.origin
        here = ((local > cut.box[0]) & (local < cut.box[1])).all(axis=1)
        if len(cut.edge):
            here &= cKDTree(cut.edge).query(local)[0] > NEAR_CUT * pitch.min()
        rows = near[here]
        core = np.isin(rows, inside)
        places = np.round(np.concatenate([cut.box, self.points[rows] - cut.origin]) / pitch, SAME) + 0.0
        key = cut.name + places.tobytes() + self.springs[rows].tobytes() + core.tobytes()
        if key not in self._known:
            self._known[key] = self._solve(self.cutter, cut, rows, np.flatnonzero(core))
        return Tile(self._known[key], cut, rows)

    def difference(self, tile: Tile) -> float:
        """The largest change of a tile's shapes on cells of half the size, around its actuators, over their largest."""
        patch, half = tile.patch, self.cutter.pitch / 2
        finer = self._solve(self.cutter.halved(), tile.cut, tile.rows, patch.core)
        own = patch.actuators[patch.core]
        spread = np.random.default_rng(0).uniform(own.min(axis=0) - half, own.max(axis=0) + half, (SAMPLES, 2))
        spread = np.concatenate([own, spread[patch.field.space.holds(spread / patch.size)]])
        here, there = (p.field.values(spread / p.size) for p in (patch, finer))
        return float((np.abs(here - there) / np.abs(here).max(axis=0)).max())

    def _solve(self, cutter: Cutter, cut: Cut, rows: IntArray, core: IntArray) -> Patch:
        actuators, springs = self.points[rows] - cut.origin, self.springs[rows]
        mesh, supports, corners = cutter.mesh(cut, actuators)
        model = PlateModel(mesh, supports, self.poisson_ratio, corners)
        force_unit = self.rigidity / mesh.size**2
        field, _ = held_shapes(model, actuators / mesh.size, springs, force_unit, core)
        truncation = 0.0
        if len(cut.edge):
            near = mesh.points[self._near_cut(mesh.points, cut, actuators, springs)]
            largest = np.abs(field.values(actuators / mesh.size)).max(axis=0)
            truncation = float((np.abs(field.values(near / mesh.size)) / largest).max())
        return Patch(cut.box, actuators, core, mesh.size, field, truncation)

    def _near_cut(self, xy: FloatArray, cut: Cut, actuators: FloatArray, springs: FloatArray) -> NDArray[np.bool_]:
        """Which of the points (n, 2) feel that the plate is clamped along the cut.

        They are within a pitch or nearer to it than to what holds the plate: an actuator, or where one yields the plate
        around it, over a length l with D / l^4 = k / pitch^2.
        """
        pitch, held = self.cutter.pitch.max(), springs > 0
        to_cut = cKDTree(cut.edge).query(xy)[0]
        if not held.any():
            return np.full(len(xy), True)
        give = (self.rigidity * pitch**2 / springs[held]) ** 0.25
        distance, row = cKDTree(actuators[held]).query(xy, k=range(1, min(NEIGHBOURS, len(give)) + 1))
        return np.asarray(to_cut < np.maximum(1.5 * pitch, (distance + give[row]).min(axis=1)))


def margin(truncation: float) -> float:
    """How many pitches off a cut must be for its effect on a shape to be that of a truncation."""
    return max(LEAST_MARGIN, FIRST_MARGIN + math.log(FIRST_VALUE / truncation) / math.log(DECAY))


def spacing(points: FloatArray) -> FloatArray:
    """The pitch along x and y (2,) [m] of a lattice; of other layouts the distance of neighbours, in the median.

    Infinite for one point.
    """
    distance, _ = cKDTree(points).query(points, k=2)
    near = float(np.median(distance[:, 1]))
    pitch = np.full(2, near)
    for axis in range(2):
        steps = np.diff(np.sort(points[:, axis])) / near
        rows = steps[steps > 10.0**-SAME * 10]
        if len(rows) and np.ptp(rows) < 10.0**-SAME * 10 and rows[0] > 0.5:
            pitch[axis] *= float(np.mean(rows))
    return pitch
