"""Wedges: corners between straight simply supported sides, whose singular functions are known in closed form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fem_plate.elements.corner_functions import CornerFunction, CornerFunctions
from fem_plate.elements.grading import SingularCorner
from fem_plate.elements.rim import SIMPLY_SUPPORTED
from fem_plate.types import BoolArray, FloatArray
from meshes import Corner, PlateMesh, cross

LEAST_TURN = np.deg2rad(0.1)  # of the rim at a wedge; less is a straight side
OBTUSE = np.pi / 2 + 1e-6  # elsewhere second derivatives are bounded
STRAIGHT = 1e-9  # of its length: an edge whose middle is closer to it is straight
CUTS = (0.5, 0.25, 0.75, 0.1, 0.9)  # of the outer angle: where to try the cut of a corner function's plane
MAX_EXPONENT = 3.0  # of w: what is smoother is left to elements
WHOLE = 1e-6  # an exponent closer than that to a whole number is that of a polynomial
MAX_WEDGES = 100  # more are not treated: cost grows with their square
ERROR = 1.0  # of the error of the plate's other cells: what cells at a wedge may add
SMALL_TURN = np.deg2rad(15.01)  # a rim that turns by no more at so many corners is a round one's polygon
MANY = 12
APART = 0.5  # of the distance to the next wedge: the largest cell at one


@dataclass(frozen=True)
class Wedge:
    """A corner between straight simply supported sides.

    point: (2,) m.  along: direction of one side [rad].  angle: of the plate, from there counter-clockwise [rad].
    middle: in that sense, the angle opposite to which there is no plate on a ray from the corner [rad].
    next: m, to the next wedge.
    """

    point: FloatArray
    along: float
    angle: float
    middle: float
    next: float

    @property
    def exponent(self) -> float:
        """As of a `SingularCorner`."""
        return self._exponents()[0][0] - 1

    @property
    def corner(self) -> SingularCorner:
        """What is left of it without its corner functions, to grade cells."""
        left = min(exponent for exponent, *_ in self._exponents() if exponent >= MAX_EXPONENT)
        return SingularCorner(self.point, left - 1, ERROR, APART * self.next)

    def functions(self, size: float) -> list[CornerFunction]:
        """Its corner functions, of places over `size` [m]."""
        place = complex(*self.point) / size
        return [
            CornerFunction(place, self.along, self.angle, self.middle, exponent - conjugate, conjugate)
            for exponent, conjugate in self._exponents()
            if exponent < MAX_EXPONENT
        ]

    def _exponents(self) -> list[tuple[float, bool]]:
        """Exponents of bounded slope, ascending, and whether of functions that are not harmonic."""
        found = []
        for multiple in np.pi / self.angle * np.arange(1, 12):
            found += [(multiple, False), (2 + multiple, True), (2 - multiple, True)]
        return sorted((float(e), c) for e, c in found if e > 1 + WHOLE and abs(e - round(e)) > WHOLE)


def wedges(mesh: PlateMesh, supports: Mapping[str, str], tension: float) -> list[Wedge]:
    """The wedges of a plate whose moments are infinite; those off which no cut of the plane leaves the plate are none.

    Under a tension only harmonic corner functions carry no load, so re-entrant corners are none. Nor are there any if
    there would be more than MAX_WEDGES.
    """
    ends = mesh.points[np.concatenate(list(mesh.boundaries.values()))]
    found: list[Wedge] = []
    for corner, own in _straight_corners(mesh, supports):
        if corner.angle < OBTUSE or (tension and corner.angle > np.pi):
            continue
        for share in CUTS:
            middle = corner.angle + share * (2 * np.pi - corner.angle) - np.pi
            towards = corner.direction + middle + np.pi
            if not _crosses(mesh.points[corner.row], np.array([np.cos(towards), np.sin(towards)]), ends[~own]):
                found.append(Wedge(mesh.points[corner.row], corner.direction, corner.angle, middle, np.inf))
                break
    return _apart(found) if len(found) <= MAX_WEDGES else []


def rounded_corners(mesh: PlateMesh, supports: Mapping[str, str]) -> int:
    """The number of corners by which a simply supported rim of straight sides stands for a round one; 0 if it does not.

    As their number grows such plates tend to a round one that has no curvature along its rim in place of no bending
    moment across it (I. Babuska, The stability of domains, 1961; V. G. Mazya and S. A. Nazarov, 1986).
    """
    small = [corner for corner, _ in _straight_corners(mesh, supports) if abs(np.pi - corner.angle) <= SMALL_TURN]
    return len(small) if len(small) >= MANY else 0


def _straight_corners(mesh: PlateMesh, supports: Mapping[str, str]) -> Iterator[tuple[Corner, BoolArray]]:
    """Corners between straight simply supported edges, and which edges (k,) these are."""
    edges = np.concatenate(list(mesh.boundaries.values()))
    bent = np.concatenate([_bent(mesh, name) for name in mesh.boundaries])
    for corner in mesh.turns(LEAST_TURN):
        if all(supports[name] == SIMPLY_SUPPORTED for name in corner.sides):
            own = (edges == corner.row).any(axis=1)
            if own.sum() == 2 and not bent[own].any():
                yield corner, own


def _apart(found: list[Wedge]) -> list[Wedge]:
    """Wedges with their distances to the next."""
    places = np.array([wedge.point for wedge in found]).reshape(-1, 2)
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + np.where(np.eye(len(places)), np.inf, 0.0)
    nearest = apart.min(axis=1, initial=np.inf).tolist()
    return [Wedge(w.point, w.along, w.angle, w.middle, next) for w, next in zip(found, nearest, strict=True)]


def _bent(mesh: PlateMesh, name: str) -> BoolArray:
    """Which edges of a boundary are not straight."""
    points, _ = mesh.arcs(name, np.array([0.0, 0.5, 1.0]))
    chord = points[:, 2] - points[:, 0]
    off = np.abs(cross(chord, points[:, 1] - points[:, 0]))
    return np.asarray(off > STRAIGHT * (chord**2).sum(axis=1))


def _crosses(start: FloatArray, direction: FloatArray, edges: FloatArray) -> bool:
    """Whether a ray crosses one of the edges (k, 2, 2)."""
    a, b = edges[:, 0] - start, edges[:, 1] - start
    left_a, left_b = cross(direction, a), cross(direction, b)
    level = left_a == left_b
    distance = cross(a, b) / np.where(level, np.inf, left_b - left_a)
    return bool(np.any((left_a * left_b <= 0) & ~level & (distance > 0)))


def corner_functions(places: Sequence[Wedge], size: float) -> CornerFunctions:
    """The corner functions of wedges, of places over `size` [m]."""
    return CornerFunctions([function for wedge in places for function in wedge.functions(size)])
