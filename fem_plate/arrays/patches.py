"""Influence shapes of large arrays: each found on a patch of the plate around its actuator.

Among held actuators a shape falls off by about five times per pitch, so that a plate clamped some pitches away has the
same one. Actuators are taken tile by tile; a tile's patch reaches beyond it by a margin, and tiles whose patches look
alike share one answer. The cost grows with the number of actuators, for a lattice with that of its unlike tiles.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem_plate.arrays.cutting import Cut, Cutter
from fem_plate.elements import Field, PlateModel
from fem_plate.influence import held_shapes

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Tell = Callable[[int, int], object]

TILE = 10  # pitches across a tile
# A shape's largest deflection within a pitch of a cut 9 pitches away, and by how much it falls with one pitch more.
FIRST_MARGIN, FIRST_VALUE, DECAY = 9.0, 1.4e-6, 3.7
LEAST_MARGIN = 3.0
WIDER = 2.0  # pitches added to a margin that was not wide enough; twice as many each time
NEAR_CUT = 0.75  # pitches: actuators that near a cut are left to it
NEIGHBOURS = 8  # the nearest actuators, one of which holds the plate best
COMPARED, REACHED = 5.5, 8.5  # pitches that actuators, and a patch, reach, whose shapes on two meshes are compared
GIVE_TRUNCATION = 1e-3
SPARSE = 6.0  # pitches, at least, that a piece of plate reaches of which the first mode is found
MOST_HOLDING = 1000  # actuators that hold it
MOST_LOOKED_AT = 1000  # places along x and y
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

    def tiles(self, truncation: float, tell: Tell) -> list[Tile]:
        """The array in tiles, with margins wide enough for the truncation, as far as the plate reaches.

        Where a margin takes the whole plate there is one tile. tell: gets how many tiles are done, and of how many.
        Raises ValueError when the truncation is not positive.
        """
        if not truncation > 0:
            raise ValueError(f"Input truncation of influence must be positive; got {truncation!r}")
        pitch = self.cutter.pitch
        lowest = self.points.min(axis=0) - pitch / 2
        place = np.floor((self.points - lowest) / (TILE * pitch) + 1e-9).astype(np.int64)
        tiles: list[Tile] = []
        corners = np.unique(place, axis=0)
        for corner in corners:
            tell(len(tiles), len(corners))
            inside = np.flatnonzero((place == corner).all(axis=1))
            middle = lowest + (corner + 0.5) * TILE * pitch
            tile = self._wide_tile(middle, inside, TILE / 2, truncation)
            if not len(tile.cut.edge):
                # All of the plate, as others would take too: one answer for the whole array.
                box = self.cutter.plate.outline.box
                tiles = [self._tile(box.mean(axis=0), np.ptp(box, axis=0), np.arange(len(self.points)))]
                break
            tiles.append(tile)
        self._known.clear()
        return tiles

    def _wide_tile(self, middle: FloatArray, inside: IntArray, half: float, truncation: float) -> Tile:
        """The tile of actuators `inside`, within `half` pitches of the middle, with a margin for the truncation."""
        pitch = self.cutter.pitch
        # Cuts half-way between the rows of a lattice.
        longest = pitch.max() / pitch  # shapes fall off over the longer pitch either way
        reach, wider = (half + np.ceil(margin(truncation) * longest)) * pitch, WIDER
        while True:
            tile = self._tile(middle, reach, inside)
            if tile.patch.truncation <= truncation or not len(tile.cut.edge):
                return tile
            reach, wider = reach + np.ceil(wider * longest) * pitch, 2 * wider

    def cut_out(self, middle: FloatArray, reach: FloatArray) -> tuple[Cut, IntArray]:
        """The patch that reaches from `middle` (2,) along x and y by `reach` (2,) [m], and its actuators' rows (n,)."""
        pitch = self.cutter.pitch
        cut = self.cutter.cut(middle, reach)
        near = np.array(self._tree.query_ball_point(middle, float(np.hypot(*reach))), dtype=np.int64)
        # In an order that depends on where they are alone.
        near = near[np.lexsort(np.round((self.points[near] - cut.origin) / pitch, SAME).T)]
        local = self.points[near] - cut.origin
        here = ((local > cut.box[0]) & (local < cut.box[1])).all(axis=1)
        if len(cut.edge):
            here &= cKDTree(cut.edge).query(local)[0] > NEAR_CUT * pitch.min()
        return cut, near[here]

    def _tile(self, middle: FloatArray, reach: FloatArray, inside: IntArray) -> Tile:
        pitch = self.cutter.pitch
        cut, rows = self.cut_out(middle, reach)
        core = np.isin(rows, inside)
        places = np.round(np.concatenate([cut.box, self.points[rows] - cut.origin]) / pitch, SAME) + 0.0
        key = cut.name + places.tobytes() + self.springs[rows].tobytes() + core.tobytes()
        if key not in self._known:
            self._known[key] = self._solve(self.cutter, cut, rows, np.flatnonzero(core))
        return Tile(self._known[key], cut, rows)

    def difference(self, tile: Tile) -> float:
        """The largest change of shapes on cells of half the size, around their actuators, over their largest.

        Those compared are around the one of the tile's actuators that is nearest to the rim, on a smaller patch.
        """
        pitch, own = self.cutter.pitch, self.points[tile.rows[tile.patch.core]]
        nearest = own[np.argmin(self.cutter.plate.outline.gap(own))]
        cut, rows = self.cut_out(nearest, REACHED * pitch)
        core = np.flatnonzero((np.abs(self.points[rows] - nearest) < COMPARED * pitch).all(axis=1))
        patch, finer = (self._solve(cutter, cut, rows, core) for cutter in (self.cutter, self.cutter.halved()))
        own = patch.actuators[patch.core]
        low, high = own.min(axis=0) - pitch / 2, own.max(axis=0) + pitch / 2
        spread = np.random.default_rng(0).uniform(low, high, (SAMPLES, 2))
        spread = np.concatenate([own, spread[patch.field.space.holds(spread / patch.size)]])
        here, there = (p.field.values(spread / p.size) for p in (patch, finer))
        return float((np.abs(here - there) / np.abs(here).max(axis=0)).max())

    def give(self, place: FloatArray) -> float:
        """The deflection [m/N] of a place (2,), at which no actuator stands, under a unit force there; three digits."""
        points, springs = np.concatenate([self.points, place[None]]), np.append(self.springs, 0.0)
        loaded = Array(self.cutter, points, springs, self.rigidity, self.poisson_ratio)
        tile = loaded._wide_tile(place, np.array([len(self.points)]), 0.0, GIVE_TRUNCATION)
        return float(tile.patch.field.values((place - tile.cut.origin)[None] / tile.patch.size)[0, 0])

    def sparsest(self) -> tuple[Cut, IntArray]:
        """A piece of plate around the place that is farthest from any held actuator, and the rows of those that hold.

        Of the places that are as far, to a hundredth of a pitch, the one nearest to the rim.
        """
        pitch, outline, held = self.cutter.pitch, self.cutter.plate.outline, np.flatnonzero(self.springs > 0)
        tree = cKDTree(self.points[held])
        count = np.minimum(np.ceil(np.ptp(outline.box, axis=0) / pitch * 2), MOST_LOOKED_AT).astype(int)
        low, high = outline.box
        steps = np.meshgrid(*(np.arange(n + 1) / n for n in count), indexing="ij")
        grid = low + (high - low) * np.stack(steps, axis=-1).reshape(-1, 2)
        grid = grid[outline.inside(grid)]
        distance = tree.query(grid)[0]
        far = grid[distance > distance.max() - 0.01 * pitch.min()]
        place = far[np.argmin(outline.gap(far))]
        most = min(MOST_HOLDING, len(held))
        reach = max(SPARSE * pitch.max(), 3 * float(distance.max()))
        reach = max(min(reach, float(tree.query(place, k=[most])[0][0])), LEAST_MARGIN * pitch.max())
        cut, rows = self.cut_out(place, np.ceil(reach / pitch) * pitch)
        return cut, rows[self.springs[rows] > 0]

    def model(self, cutter: Cutter, cut: Cut, actuators: FloatArray) -> PlateModel:
        """The plate on a patch, for actuators at points (n, 2) [m] from its origin."""
        mesh, supports, corners = cutter.mesh(cut, actuators)
        return PlateModel(mesh, supports, self.poisson_ratio, corners)

    def _solve(self, cutter: Cutter, cut: Cut, rows: IntArray, core: IntArray) -> Patch:
        actuators, springs = self.points[rows] - cut.origin, self.springs[rows]
        model = self.model(cutter, cut, actuators)
        mesh = model.mesh
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
