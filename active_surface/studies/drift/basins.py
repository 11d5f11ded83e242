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

from active_surface.arrays import BoolArray, FloatArray, IntArray

STEP: Final = 0.2  # of the spacing: the way between two looks at the drift
STILL: Final = 1e-4  # of the spacing, in a period: less is no drift
FARTHEST: Final = 60.0  # times the plate's longer side: the way after which a part is where it ends
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
            inside = ((cell >= 0) & (cell < self.numbers.shape)).all(axis=1)
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
    extent: float  # m, of the ends; within about a spacing it is a point
    share: float


@dataclass(frozen=True, eq=False)
class Basins:
    """Where parts end in the long run; shares are of all starts."""

    stay: float  # share that never moves
    come_off: float
    leave: float
    ends: tuple[Basin, ...]  # of those that moved, the largest share first
    of_start: IntArray  # (n,) the number of the end of each start; -1: it stays, -2: it comes off, -3: it leaves


def basins_of(field: Field, starts: FloatArray) -> Basins:
    """Follow a drift from starts (n, 2) [m] until each part stays, is lost, or goes about where others do.

    Where a period carries it less than STEP of the spacing, many periods are taken at once.
    """
    _, own = field.at(starts)
    points, fates, live = starts.copy(), own.copy(), own == Fate.MOVES
    extent = float(np.ptp(starts, axis=0).max()) + field.spacing
    for _ in range(math.ceil(FARTHEST * extent / (STEP * field.spacing))):
        if not live.any():
            break
        moved, now = field.at(points[live])
        length = np.hypot(*moved.T)
        points[live] += moved * np.maximum(1.0, STEP * field.spacing / np.maximum(length, 1e-300))[:, None] * (
            length > STILL * field.spacing
        )[:, None]
        fates[live] = np.maximum(fates[live], now)
        rows = np.flatnonzero(live)
        live[rows[(length <= STILL * field.spacing) | (now > Fate.MOVES)]] = False
    kept = fates == Fate.MOVES
    numbers = np.select([own == Fate.STAYS, fates == Fate.COMES_OFF, fates == Fate.LEAVES], [-1, -2, -3], 0)
    ends, of_kept = _joined(points[kept], field.spacing, len(starts))
    numbers[kept] = of_kept
    shares = [float((numbers == k).mean()) for k in (-1, -2, -3)]
    return Basins(*shares, ends, numbers)


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


def kept(fates: IntArray) -> BoolArray:
    """Whether parts stay on the plate."""
    return fates <= Fate.MOVES
