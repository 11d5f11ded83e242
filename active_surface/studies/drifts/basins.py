"""Basins: where a part ends that is carried on by a drift, period after period, and from how many of its starts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Final, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from active_surface.arrays import FloatArray, IntArray

STEP: Final = 0.2  # of the spacing: the longest way of many periods between two looks at the drift
SLOWER: Final = 0.5  # times that way, after a look at which the part turned back
FASTER: Final = 1.2  # after another
STILL: Final = 1e-6  # of the spacing, in a period: less is no drift
LOOKS: Final = 64  # after which a part ends that is on average where it was in the same number before
FARTHEST: Final = 60.0  # times the starts' extent: the way after which a part ends at the latest
JOINED: Final = 1.5  # spacings: ends as near to each other are of one basin


class Fate(IntEnum):
    """What becomes of a part: within a period, or in the end."""

    STAYS = 0
    MOVES = 1
    COMES_OFF = 2
    LEAVES = 3


@dataclass(frozen=True, eq=False)
class Field:
    """The displacement in a period from places on a square grid, linear between these along each axis."""

    origin: FloatArray  # (2,) m, of the grid's first place
    spacing: float  # m
    numbers: IntArray  # (nx, ny) of the places; -1: not on the plate
    moved: FloatArray  # (n, 2) m
    fates: IntArray  # (n,) of `Fate`, within the period

    @staticmethod
    def of(places: FloatArray, spacing: float, moved: FloatArray, fates: IntArray) -> Field:
        """The field of a drift (n, 2) [m] from places (n, 2) [m] of a grid."""
        origin = places.min(axis=0)
        rows = np.rint((places - origin) / spacing).astype(np.int64)
        numbers = np.full(rows.max(axis=0) + 1, -1)
        numbers[rows[:, 0], rows[:, 1]] = np.arange(len(places))
        return Field(origin, spacing, numbers, moved, fates)

    def at(self, points: FloatArray) -> tuple[FloatArray, IntArray]:
        """The displacement (k, 2) [m] in a period, and the fate (k,), from points (k, 2) [m].

        From the four places around those that keep the part; the fate is that of the nearest.
        """
        place = (points - self.origin) / self.spacing
        low = np.floor(place).astype(np.int64)
        total, weight, nearest = np.zeros(points.shape), np.zeros(len(points)), np.full(len(points), -1)
        most = np.zeros(len(points))
        for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
            cell = low + corner
            inside = np.all((cell >= 0) & (cell < self.numbers.shape), axis=1)
            number = np.where(inside, self.numbers[tuple(np.where(inside[:, None], cell, 0).T)], -1)
            share = np.where(number >= 0, (1 - np.abs(place - cell)).prod(axis=1), 0.0)
            nearest, most = np.where(share > most, number, nearest), np.maximum(share, most)
            share = np.where(self.fates[number] <= Fate.MOVES, share, 0.0)
            total, weight = total + share[:, None] * self.moved[number], weight + share
        fates = np.where(nearest < 0, Fate.LEAVES, self.fates[nearest])
        moved = total / np.where(weight > 0, weight, 1.0)[:, None]
        return np.where((fates <= Fate.MOVES)[:, None], moved, 0.0), fates

    def carried(self, points: FloatArray, periods: int) -> tuple[FloatArray, IntArray]:
        """Where parts are after so many periods, (k, 2) [m], and their fates (k,); points: (k, 2) [m]."""
        points, fates = points.copy(), np.full(len(points), int(Fate.STAYS))
        for _ in range(periods):
            moved, now = self.at(points)
            fates = np.maximum(fates, now)
            points += np.where((fates <= Fate.MOVES)[:, None], moved, 0.0)
        return points, fates


class Basin(NamedTuple):
    """A place, or an area, at which parts end, and the share of starts that are carried there."""

    place: tuple[float, float]  # m, the middle of the ends
    extent: float  # m, of the ends along x or y, the larger; within about a spacing it is a point
    share: float


@dataclass(frozen=True, eq=False)
class Basins:
    """Where parts end in the long run, carried on by the drift of where they are; shares are of all starts."""

    stay: float  # share that never moves
    come_off: float  # or tip, or are overloaded
    leave: float  # over the rim
    ends: tuple[Basin, ...]  # of those that move and are kept, the largest share first
    of_start: IntArray  # (n,) which of the ends each start has; -1: it stays, -2: it comes off, -3: it leaves
    reached: FloatArray  # (n, 2) m, where the part of each start ends, or is lost


def basins_of(field: Field, starts: FloatArray) -> Basins:
    """Follow a drift from starts (n, 2) [m] until each part stays, is lost, or is where it was before, on average."""
    _, own = field.at(starts)
    reached, fates, moving = starts.copy(), own.copy(), np.flatnonzero(own == Fate.MOVES)
    reached[moving], fates[moving] = _followed(field, starts[moving])
    kept = fates == Fate.MOVES
    numbers = np.select([own == Fate.STAYS, fates == Fate.COMES_OFF, fates == Fate.LEAVES], [-1, -2, -3], 0)
    ends, numbers[kept] = _joined(reached[kept], field.spacing, len(starts))
    stay, come_off, leave = (float((numbers == k).mean()) for k in (-1, -2, -3))
    return Basins(stay, come_off, leave, ends, numbers, reached)


def _followed(field: Field, points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Where moving parts end (k, 2) [m], to and fro in its middle, and their fates (k,).

    Where a period carries a part less than STEP of the spacing, many are taken at once, fewer where it turns back. A
    part that comes into a dead zone stays there; a lost one is where it was lost.
    """
    points, fates, live = points.copy(), np.full(len(points), int(Fate.MOVES)), np.arange(len(points))
    ends, farthest = points.copy(), STEP * field.spacing
    way, reach = np.zeros(points.shape), np.full(len(points), farthest)
    extent = float(np.ptp(points, axis=0).max(initial=0.0)) + field.spacing
    for _ in range(math.ceil(FARTHEST * extent / (LOOKS * farthest))):
        total = np.zeros((len(live), 2))
        for _ in range(LOOKS):
            moved, now = field.at(points[live])
            length = np.hypot(*moved.T)
            back = (moved * way[live]).sum(axis=1) < 0
            reach[live] = np.where(back, SLOWER * reach[live], np.minimum(FASTER * reach[live], farthest))
            times = np.maximum(1.0, reach[live] / np.maximum(length, 1e-300)) * (length > STILL * field.spacing)
            way[live], fates[live] = moved, np.maximum(fates[live], now)
            points[live] += times[:, None] * moved
            total += points[live]
        before, ends[live] = ends[live], total / LOOKS
        live = live[np.hypot(*(ends[live] - before).T) > LOOKS * STILL * field.spacing]
        if not len(live):
            break
    return ends, fates


def _joined(points: FloatArray, spacing: float, count: int) -> tuple[tuple[Basin, ...], IntArray]:
    """Ends (k, 2) [m] that are near to each other as basins, and the number of each; count: of all starts."""
    if not len(points):
        return (), np.empty(0, dtype=np.int64)
    pairs = cKDTree(points).query_pairs(JOINED * spacing, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(len(points),) * 2)
    found, labels = connected_components(graph, directed=False)
    order = np.argsort(-np.bincount(labels, minlength=found), kind="stable")
    ranks = np.empty(found, dtype=np.int64)
    ranks[order] = np.arange(found)
    labels = ranks[labels]
    basins = []
    for k in range(found):
        own = points[labels == k]
        x, y = own.mean(axis=0).tolist()
        basins.append(Basin((x, y), float(np.ptp(own, axis=0).max()), len(own) / count))
    return tuple(basins), labels
