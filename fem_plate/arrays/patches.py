"""Influence shapes of large arrays, each computed on a patch of the plate around its actuator.

Among held actuators a shape decays about fivefold per pitch, so a plate clamped some pitches away has the same one.
Actuators are solved tile by tile; a tile's patch extends beyond it by a margin, and tiles with like patches share one
solution. The cost grows with the number of actuators, or for a lattice with the number of its unlike tiles.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.arrays.cutting import Cut, Cutter, Turn, turns
from fem_plate.elements import PlateFunctions, PlateModel
from fem_plate.influence import held_shapes
from fem_plate.types import BoolArray, FloatArray, IntArray

ProgressCallback = Callable[[int, int], object]  # takes the number of tiles done, and their total

TILE = 10  # pitches across a tile
# A shape's largest deflection within a pitch of a cut 9 pitches away, and its decay with each pitch more.
FIRST_MARGIN, FIRST_VALUE, DECAY = 9.0, 1.4e-6, 3.7
MIN_MARGIN = 3.0
WIDENING = 2.0  # pitches added to a margin that was too narrow; twice as many each time
CUT_CLEARANCE = 0.75  # pitches: actuators closer to a cut are left out, as the cut holds the plate there
NEIGHBOURS = 8  # the closest actuators, one of which holds the plate best
COMPARED, REACHED = 2.5, 5.5  # pitches that actuators, and a patch, extend whose shapes on two meshes are compared
COMPLIANCE_TRUNCATION = 1e-3
MIN_REACH = 6.0  # pitches that a piece of plate extends at least whose first mode is computed
MAX_HOLDING = 1000  # actuators that hold it
MAX_GRID = 1000  # places along x and y searched for its middle
SAMPLES = 1000  # points at which shapes on two meshes are compared
PITCH_DIGITS = 8  # of a pitch, to which like patches agree


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of plate around an origin of its own, and the shapes of its tile's actuators."""

    box: FloatArray  # (2, 2) m
    actuators: FloatArray  # (n, 2) m
    core: IntArray  # (c,), rows of the actuators that have shapes
    size: float  # m, the length that makes the functions dimensionless
    functions: PlateFunctions  # the c shapes
    truncation: float  # the largest deflection of a shape close to the cut, over its largest: what is left out


@dataclass(frozen=True, eq=False)
class Tile:
    """Where a patch is used, and its actuators' rows (n,) in the array."""

    patch: Patch
    cut: Cut
    rows: IntArray
    turn: Turn  # how it sees the patch


class ActuatorArray:
    """The actuators of a plate, to be solved tile by tile.

    points: (N, 2) m.  actuator_stiffness: (N,) N/m.  rigidity: N m.  law: (3, 3), over it.  tension: 1/m^2, over it.
    """

    def __init__(
        self,
        cutter: Cutter,
        points: FloatArray,
        actuator_stiffness: FloatArray,
        rigidity: float,
        law: FloatArray,
        tension: float = 0.0,
    ) -> None:
        self.cutter, self.points, self.actuator_stiffness = cutter, points, actuator_stiffness
        self.rigidity, self.law, self.tension = rigidity, law, tension
        self._tree = cKDTree(points)
        mirrored = not law[1, [0, 2]].any()  # where the plate bends alike both ways
        square = round(cutter.pitch[0] / cutter.pitch[1], PITCH_DIGITS) == 1
        self._turns = turns(mirrored, mirrored and square and bool(law[0, 0] == law[2, 2]))
        self._solved: dict[bytes, Patch] = {}

    def tiles(self, truncation: float, tell: ProgressCallback) -> list[Tile]:
        """The array in tiles, with margins wide enough for the truncation, as far as the plate reaches.

        Where a margin takes in the whole plate there is one tile.
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
                # The patch is the whole plate, as others would be too: one solution for the whole array.
                box = self.cutter.plate.outline.box
                tiles = [self._tile(box.mean(axis=0), np.ptp(box, axis=0), np.arange(len(self.points)))]
                break
            tiles.append(tile)
        self._solved.clear()
        return tiles

    def _wide_tile(self, middle: FloatArray, inside: IntArray, half: float, truncation: float) -> Tile:
        """The tile of actuators `inside`, within `half` pitches of the middle, with a margin for the truncation."""
        pitch = self.cutter.pitch
        longest = pitch.max() / pitch  # shapes decay over the longer pitch either way
        # Whole pitches, so that cuts run half-way between the rows of a lattice.
        reach, widening = (half + np.ceil(margin(truncation) * longest)) * pitch, WIDENING
        while True:
            tile = self._tile(middle, reach, inside)
            if tile.patch.truncation <= truncation or not len(tile.cut.edge):
                return tile
            reach, widening = reach + np.ceil(widening * longest) * pitch, 2 * widening

    def cut_out(self, middle: FloatArray, reach: FloatArray) -> tuple[Cut, IntArray]:
        """The patch from `middle` (2,) by `reach` (2,) [m] along x and y, and the rows (n,) of its actuators."""
        pitch = self.cutter.pitch
        cut = self.cutter.cut(middle, reach)
        rows = np.array(self._tree.query_ball_point(middle, float(np.hypot(*reach))), dtype=np.int64)
        # In an order that depends on their places alone.
        rows = rows[np.lexsort(np.round((self.points[rows] - cut.origin) / pitch, PITCH_DIGITS).T)]
        xy = self.points[rows] - cut.origin
        on_patch = ((xy > cut.box[0]) & (xy < cut.box[1])).all(axis=1)
        if len(cut.edge):
            on_patch &= cKDTree(cut.edge).query(xy)[0] > CUT_CLEARANCE * pitch.min()
        return cut, rows[on_patch]

    def _tile(self, middle: FloatArray, reach: FloatArray, inside: IntArray) -> Tile:
        cut, rows = self.cut_out(middle, reach)
        ways = [self._seen(cut, rows, inside, turn) for turn in self._turns if cut.sides or turn.is_none]
        for (key, turned), turn in zip(ways, self._turns, strict=False):
            if key in self._solved:
                return Tile(self._solved[key], cut, turned, turn)
        patch = self._solve(self.cutter, cut, rows, np.flatnonzero(np.isin(rows, inside)))
        self._solved[ways[0][0]] = patch
        return Tile(patch, cut, rows, self._turns[0])

    def _seen(self, cut: Cut, rows: IntArray, inside: IntArray, turn: Turn) -> tuple[bytes, IntArray]:
        """What a patch is known by, seen one way round, and the rows of its actuators in the order of their places."""
        places = np.round(turn.of(self.points[rows] - cut.origin) / self.cutter.pitch, PITCH_DIGITS) + 0.0
        order = np.lexsort(places.T)
        box = np.round(np.sort(turn.of(cut.box), axis=0) / self.cutter.pitch, PITCH_DIGITS) + 0.0
        rows = rows[order]
        alike = box, places[order], self.actuator_stiffness[rows], np.isin(rows, inside)
        return cut.seen(turn) + b"".join(array.tobytes() for array in alike), rows

    def difference(self, tile: Tile) -> float:
        """The largest change of shapes on cells of half the size, around their actuators, over their largest.

        The shapes compared are those around the tile's actuator closest to the rim, on a smaller patch.
        """
        pitch, own = self.cutter.pitch, self.points[tile.rows[tile.patch.core]]
        nearest = own[np.argmin(self.cutter.plate.outline.gap(own))]
        cut, rows = self.cut_out(nearest, REACHED * pitch)
        core = np.flatnonzero((np.abs(self.points[rows] - nearest) < COMPARED * pitch).all(axis=1))
        patch, finer = (self._solve(cutter, cut, rows, core) for cutter in (self.cutter, self.cutter.halved()))
        own = patch.actuators[patch.core]
        low, high = own.min(axis=0) - pitch / 2, own.max(axis=0) + pitch / 2
        xy = np.random.default_rng(0).uniform(low, high, (SAMPLES, 2))
        xy = np.concatenate([own, xy[patch.functions.space.holds(xy / patch.size)]])
        w, w_finer = (p.functions.values(xy / p.size) for p in (patch, finer))
        return float((np.abs(w - w_finer) / np.abs(w).max(axis=0)).max())

    def compliance_at(self, place: FloatArray) -> float:
        """The deflection [m/N] under a unit force at a place (2,) [m] clear of actuators, to three digits."""
        points, stiffness = np.concatenate([self.points, place[None]]), np.append(self.actuator_stiffness, 0.0)
        loaded = ActuatorArray(self.cutter, points, stiffness, self.rigidity, self.law, self.tension)
        tile = loaded._wide_tile(place, np.array([len(self.points)]), 0.0, COMPLIANCE_TRUNCATION)
        return float(tile.patch.functions.values((place - tile.cut.origin)[None] / tile.patch.size)[0, 0])

    def sparsest(self) -> tuple[Cut, IntArray]:
        """A piece of plate around the place farthest from any held actuator, and the rows of those that hold it.

        Of places equally far, to a hundredth of a pitch, it is the one closest to the rim.
        """
        pitch, outline, held = self.cutter.pitch, self.cutter.plate.outline, np.flatnonzero(self.actuator_stiffness > 0)
        tree = cKDTree(self.points[held])
        count = np.minimum(np.ceil(np.ptp(outline.box, axis=0) / pitch * 2), MAX_GRID).astype(int)
        low, high = outline.box
        steps = np.meshgrid(*(np.arange(n + 1) / n for n in count), indexing="ij")
        grid = low + (high - low) * np.stack(steps, axis=-1).reshape(-1, 2)
        grid = grid[outline.inside(grid)]
        distance = tree.query(grid)[0]
        far = grid[distance > distance.max() - 0.01 * pitch.min()]
        place = far[np.argmin(outline.gap(far))]
        limit = min(MAX_HOLDING, len(held))
        reach = max(MIN_REACH * pitch.max(), 3 * float(distance.max()))
        reach = max(min(reach, float(tree.query(place, k=[limit])[0][0])), MIN_MARGIN * pitch.max())
        cut, rows = self.cut_out(place, np.ceil(reach / pitch) * pitch)
        return cut, rows[self.actuator_stiffness[rows] > 0]

    def model(self, cutter: Cutter, cut: Cut, actuators: FloatArray) -> PlateModel:
        """The plate on a patch, for actuators at points (n, 2) [m] from its origin."""
        mesh, supports, corners = cutter.mesh(cut, actuators)
        return PlateModel(mesh, supports, self.law, corners, self.tension)

    def _solve(self, cutter: Cutter, cut: Cut, rows: IntArray, core: IntArray) -> Patch:
        actuators, stiffness = self.points[rows] - cut.origin, self.actuator_stiffness[rows]
        model = self.model(cutter, cut, actuators)
        mesh = model.mesh
        stiffness_unit = self.rigidity / mesh.size**2
        functions, _ = held_shapes(model, actuators / mesh.size, stiffness, stiffness_unit, core)
        truncation = 0.0
        if len(cut.edge):
            at_cut = mesh.points[self._feel_cut(mesh.points, cut, actuators, stiffness)]
            largest = np.abs(functions.values(actuators / mesh.size)).max(axis=0)
            truncation = float((np.abs(functions.values(at_cut / mesh.size)) / largest).max())
        return Patch(cut.box, actuators, core, mesh.size, functions, truncation)

    def _feel_cut(self, xy: FloatArray, cut: Cut, actuators: FloatArray, stiffness: FloatArray) -> BoolArray:
        """Which of the points (n, 2) [m] feel that the plate is clamped along the cut.

        They are within 1.5 pitches of it, or closer to it than to what holds the plate: an actuator or, where that
        yields, the plate around it, over a length l with D / l^4 + N / l^2 = k / pitch^2, N a tension.
        """
        pitch, held = self.cutter.pitch.max(), stiffness > 0
        to_cut = cKDTree(cut.edge).query(xy)[0]
        if not held.any():
            return np.full(len(xy), True)
        length = (self.rigidity * pitch**2 / stiffness[held]) ** 0.25
        pull = self.tension * length**2 / 2
        length = length * np.sqrt(pull + np.sqrt(pull**2 + 1))
        distance, row = cKDTree(actuators[held]).query(xy, k=range(1, min(NEIGHBOURS, len(length)) + 1))
        return np.asarray(to_cut < np.maximum(1.5 * pitch, (distance + length[row]).min(axis=1)))


def margin(truncation: float) -> float:
    """How many pitches away a cut must be to change a shape by the truncation."""
    return max(MIN_MARGIN, FIRST_MARGIN + math.log(FIRST_VALUE / truncation) / math.log(DECAY))


def spacing(points: FloatArray) -> FloatArray:
    """The pitch along x and y (2,) [m] of a lattice; of other layouts the median distance of neighbours.

    It is infinite for one point.
    """
    distance, _ = cKDTree(points).query(points, k=2)
    median = float(np.median(distance[:, 1]))
    pitch = np.full(2, median)
    for axis in range(2):
        steps = np.diff(np.sort(points[:, axis])) / median
        rows = steps[steps > 10.0**-PITCH_DIGITS * 10]
        if len(rows) and np.ptp(rows) < 10.0**-PITCH_DIGITS * 10 and rows[0] > 0.5:
            pitch[axis] *= float(np.mean(rows))
    return pitch
