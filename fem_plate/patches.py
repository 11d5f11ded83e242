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
WIDER = 2.0  # pitches added to a margin that was not wide enough
NEAR_CUT = 0.75  # pitches: actuators that near a cut are left to it
SAMPLES = 1000  # points at which shapes on two meshes are compared
SAME = 6  # digits of a pitch to which patches must look alike


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of plate around an origin of its own, and the shapes of its tile's actuators.

    box: (2, 2) m.  actuators: (n, 2) m.  core: (c,) rows of those that have shapes.
    size: m, the length that makes it dimensionless.  field: the shapes of the core.
    truncation: the largest deflection of a shape within a pitch of the cut: the size of what is left out.
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
        """The array in tiles, with margins wide enough for the truncation, as far as the plate reaches."""
        pitch = spacing(self.points)
        lowest = self.points.min(axis=0) - pitch / 2
        place = np.floor((self.points - lowest) / (TILE * pitch) + 1e-9).astype(np.int64)
        margin = max(LEAST_MARGIN, FIRST_MARGIN + math.log(FIRST_VALUE / truncation) / math.log(DECAY))
        tiles = []
        for corner in np.unique(place, axis=0):
            inside = np.flatnonzero((place == corner).all(axis=1))
            middle = lowest + (corner + 0.5) * TILE * pitch
            # Cuts half-way between the rows of a lattice.
            reach = (TILE / 2 + math.ceil(margin)) * pitch
            while True:
                tile = self._tile(middle, reach, inside, pitch)
                if tile.patch.truncation <= truncation or len(tile.rows) == len(self.points):
                    break
                reach = reach + WIDER * pitch
            tiles.append(tile)
        return tiles

    def _tile(self, middle: FloatArray, reach: FloatArray, inside: IntArray, pitch: FloatArray) -> Tile:
        cut = self.cutter.cut(middle, reach)
        near = np.array(self._tree.query_ball_point(middle, float(np.hypot(*reach))), dtype=np.int64)
        local = self.points[np.sort(near)] - cut.origin
        here = ((local > cut.box[0]) & (local < cut.box[1])).all(axis=1)
        if len(cut.edge):
            here &= cKDTree(cut.edge).query(local)[0] > NEAR_CUT * pitch.min()
        rows = np.sort(near)[here]
        core = np.isin(rows, inside)
        places = np.round(np.concatenate([cut.box, self.points[rows] - cut.origin]) / pitch, SAME) + 0.0
        key = cut.name + places.tobytes() + self.springs[rows].tobytes() + core.tobytes()
        if key not in self._known:
            self._known[key] = self._solve(self.cutter, cut, rows, np.flatnonzero(core), float(pitch.max()))
        return Tile(self._known[key], cut, rows)

    def difference(self, tile: Tile) -> float:
        """The largest change of a tile's shapes on cells of half the size, around its actuators."""
        patch = tile.patch
        finer = self._solve(self.cutter.halved(), tile.cut, tile.rows, patch.core, 0.0)
        around = patch.actuators[patch.core]
        spread = np.random.default_rng(0).uniform(around.min(axis=0), around.max(axis=0), (SAMPLES, 2))
        here, there = (p.field.values(spread / p.size) for p in (patch, finer))
        return float(np.abs(here - there).max())

    def _solve(self, cutter: Cutter, cut: Cut, rows: IntArray, core: IntArray, pitch: float) -> Patch:
        actuators, springs = self.points[rows] - cut.origin, self.springs[rows]
        mesh, supports, corners = cutter.mesh(cut, actuators)
        model = PlateModel(mesh, supports, self.poisson_ratio, corners)
        force_unit = self.rigidity / mesh.size**2
        field, _ = held_shapes(model, actuators / mesh.size, springs, force_unit, core)
        truncation = 0.0
        if len(cut.edge):
            x = mesh.points[cKDTree(cut.edge).query(mesh.points)[0] < 1.5 * pitch] / mesh.size
            truncation = float(np.abs(field.values(x)).max())
        return Patch(cut.box, actuators, core, mesh.size, field, truncation)


def spacing(points: FloatArray) -> FloatArray:
    """The pitch along x and y (2,) [m] of a lattice; of other layouts the distance of neighbours, in the median."""
    distance, _ = cKDTree(points).query(points, k=2)
    pitch = np.full(2, float(np.median(distance[:, 1])))
    for axis in range(2):
        steps = np.diff(np.unique(np.round(points[:, axis] / pitch[0], SAME)))
        if len(steps) and np.ptp(steps) < 10.0**-SAME * 10 and steps[0] > 0.5:
            pitch[axis] *= float(np.mean(steps))
    return pitch
