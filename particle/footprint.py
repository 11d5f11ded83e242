"""The face of a part: a rectangle, a disc or a polygon, and the rules that integrate over it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from particle.checks import finite, positive, refuse
from particle.types import FloatArray

FLAT = 1e-9  # of the squared size: a polygon with less area has none
HARMONICS, SIDE_POINTS, FACE_POINTS = 24, 40, 48  # of the torsion function: degree, on each side, and as `rule`


@dataclass(frozen=True, eq=False)
class Footprint:
    """The flat face on which a part stands, seen from above, in axes of its own; made by its three class methods.

    The origin is the foot of the centre of mass: for a part of uniform thickness the centroid, to which `rectangle`,
    `disc` and `polygon` move the face.
    """

    corners: FloatArray  # (n, 2) m, counter-clockwise, from the centroid; of a disc none, (0, 2)
    radius: float = 0.0  # m, of a disc

    @classmethod
    def rectangle(cls, width: float, height: float) -> Footprint:
        """A rectangle with sides [m] along the part's x and y.

        Raises
        ------
        ValueError
            A side is not positive; names each.
        """
        sides = {"width": width, "height": height}
        refuse("Footprint", [(positive(side), name, "positive, in m", side) for name, side in sides.items()])
        return cls(np.array([[-width, -height], [width, -height], [width, height], [-width, height]]) / 2)

    @classmethod
    def disc(cls, radius: float) -> Footprint:
        """A disc; ValueError where the radius [m] is not positive."""
        refuse("Footprint", [(positive(radius), "radius", "positive, in m", radius)])
        return cls(np.zeros((0, 2)), float(radius))

    @classmethod
    def polygon(cls, corners: Sequence[Sequence[float]]) -> Footprint:
        """A simple polygon, convex or not, by its corners (n, 2) [m] in order.

        Raises
        ------
        ValueError
            There are fewer than three corners, one is no pair of numbers, sides cross, or there is no area.
        """
        wanted = "three or more pairs of lengths in m, in order around the part, whose sides do not cross"
        pairs = [np.shape(pair) == (2,) and all(finite(value) for value in pair) for pair in corners]
        refuse("Footprint", [(len(pairs) >= 3 and all(pairs), "corners", wanted, corners)])
        points = np.array(corners, dtype=float)
        area, centroid, _ = _moments(points)
        solid = abs(area) > FLAT * np.ptp(points) ** 2 and not _crosses(points)
        refuse("Footprint", [(bool(solid), "corners", wanted, corners)])
        return cls((points if area > 0 else points[::-1]) - centroid)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Footprint) and self.radius == other.radius and np.array_equal(self.corners, other.corners)
        )

    def __hash__(self) -> int:
        return hash((self.radius, self.corners.tobytes()))

    @cached_property
    def area(self) -> float:
        """m^2."""
        return math.pi * self.radius**2 if self.radius else float(_moments(self.corners)[0])

    @cached_property
    def second_moments(self) -> FloatArray:
        """(2, 2) m^2, the mean of rho rho^T over the face, rho counted from the centroid."""
        return np.eye(2) * self.radius**2 / 4 if self.radius else _moments(self.corners)[2]

    @property
    def star_shaped(self) -> bool:
        """Whether the centroid sees all of it."""
        return bool((self.rule(1)[1] > 0).all())

    def outline(self, position: ArrayLike, heading: ArrayLike) -> FloatArray:
        """(..., k, 2) m, its corners, or places around a disc, at positions (..., 2) [m] and headings (...,) [rad]."""
        around, turn = 2 * math.pi * np.arange(48) / 48, np.asarray(heading, dtype=float)[..., None]
        x, y = self.radius * np.array([np.cos(around), np.sin(around)]) if self.radius else self.corners.T
        turned = np.stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y], axis=-1)
        return np.asarray(position, dtype=float)[..., None, :] + turned

    @cached_property
    def reach(self) -> float:
        """m, how far the face's farthest point is from its centroid."""
        return self.radius or float(np.hypot(*self.corners.T).max())

    @cached_property
    def hull(self) -> FloatArray:
        """(k, 2) m, the corners of the convex hull: those on which a part can tip."""
        from scipy.spatial import ConvexHull  # here, because points do without it

        return self.corners[ConvexHull(self.corners).vertices] if len(self.corners) else self.corners

    @lru_cache(maxsize=64)  # noqa: B019  # as bodies that differ in their start alone have one footprint
    def rule(self, points: int) -> tuple[FloatArray, FloatArray]:
        """Places (n, 2) [m] and weights (n,) that add up to 1: the mean over the face of a smooth function.

        `points` Gauss points from the centroid outwards and along each side: exact for polynomials of degree
        2 points - 2, and as good for these times the distance from the centroid. A face that is not star-shaped has
        some places outside, with negative weights.
        """
        nodes, weights = np.polynomial.legendre.leggauss(points)
        share, part = (nodes + 1) / 2, weights / 2
        if self.radius:
            angle = 2 * math.pi * (np.arange(2 * points) + 0.5) / (2 * points)
            r, w = self.radius * share[:, None], (2 * part * share)[:, None] / (2 * points)
            places = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1)
            return places.reshape(-1, 2), np.broadcast_to(w, places.shape[:2]).ravel()
        # A triangle from the centroid to each side; where the face is not star-shaped some of them count negatively.
        b, c = self.corners, np.roll(self.corners, -1, axis=0)
        s, t = share[:, None, None], share[None, :, None]
        places = s * (b[:, None, None] + t * (c - b)[:, None, None])
        twice = (b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])[:, None, None]
        return places.reshape(-1, 2), (np.outer(part * share, part) * twice / self.area).ravel()

    @cached_property
    def torsion(self) -> tuple[float, float]:
        """int phi dA [m^4] and int phi r^2 dA/(4 int phi dA) [m^2], -laplace(phi) = 1, phi = 0 at the rim.

        Harmonic polynomials that fit r^2/4 on the sides by least squares: to 1e-5 on convex faces, to some 3 % where a
        corner turns inwards.
        """
        if self.radius:
            return math.pi * self.radius**4 / 8, self.radius**2 / 12
        nodes = (np.polynomial.legendre.leggauss(SIDE_POINTS)[0][:, None] + 1) / 2
        a, b = self.corners[:, None] / self.reach, np.roll(self.corners, -1, axis=0)[:, None] / self.reach
        sides, (places, weights) = (a + nodes * (b - a)).reshape(-1, 2), self.rule(FACE_POINTS)
        x, y = np.concatenate([sides, places / self.reach]).T
        powers = (x + 1j * y)[:, None] ** np.arange(HARMONICS + 1)
        harmonics, parabola = np.concatenate([powers.real, powers.imag[:, 1:]], axis=1), (x * x + y * y) / 4
        fit = np.linalg.lstsq(harmonics[: len(sides)], parabola[: len(sides)], rcond=None)[0]
        function = weights * (harmonics @ fit - parabola)[len(sides) :]
        total, widened = float(function.sum()), float(function @ parabola[len(sides) :])
        return total * self.area * self.reach**2, widened / total * self.reach**2

    @property
    def is_rectangle(self) -> bool:
        """Whether it is a rectangle with sides along x and y."""
        size = np.abs(self.corners)
        return self._is_parallelogram and bool((np.ptp(size, axis=0) <= FLAT * self.reach).all())

    @property
    def _is_parallelogram(self) -> bool:
        return len(self.corners) == 4 and np.abs(self.corners[0] + self.corners[2]).max() <= FLAT * self.reach

    def even_rule(self, points: int) -> tuple[FloatArray, FloatArray]:
        """Places (n, 2) [m], about points squared, spread evenly over the face, and weights (n,) that add up to 1.

        Gauss's rule on a parallelogram; on a disc Gauss's in r^2 along 2 `points` rays: exact for polynomials of degree
        2 points - 1. On another polygon `rule` with two thirds as many points.
        """
        if self.radius:
            nodes, weights = np.polynomial.legendre.leggauss((points + 1) // 2)
            r, angle = self.radius * np.sqrt((1 + nodes) / 2)[:, None], math.pi * np.arange(2 * points) / points
            places = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1)
            return places.reshape(-1, 2), np.repeat(weights / (4 * points), 2 * points)
        if not self._is_parallelogram:
            return self.rule(2 * points // 3)
        a, b = self.corners[1:3] - self.corners[:2]
        nodes, weights = np.polynomial.legendre.leggauss(points)
        s, t = (axis.ravel()[:, None] / 2 for axis in np.meshgrid(nodes, nodes, indexing="ij"))
        return s * a + t * b, np.outer(weights, weights).ravel() / 4

    @lru_cache(maxsize=64)  # noqa: B019
    def averaging(self, points: int) -> tuple[FloatArray, FloatArray]:
        """Places (n, 2) [m] within a convex face, and weights (n,), exact for polynomials of degree 2 points - 1.

        Few places, as the surface is looked at in each: those of `even_rule` on a parallelogram and a disc; elsewhere
        those places of `rule` that interpolate best (Fekete's, by a QR decomposition with pivots).
        """
        if self.radius or self._is_parallelogram:
            return self.even_rule(points)
        from scipy.linalg import qr  # here, because points do without it

        degree = 2 * points - 1
        places, weights = self.rule(points + 4)
        x, y = places.T / self.reach
        powers = np.stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)])
        # An orthonormal basis over its places, so that pivots and weights are well conditioned.
        basis = np.linalg.solve(np.linalg.cholesky((powers * np.abs(weights)) @ powers.T), powers)
        chosen = np.sort(qr(basis, mode="economic", pivoting=True)[2][: len(powers)])
        return places[chosen], np.asarray(np.linalg.solve(basis[:, chosen], basis @ weights), dtype=float)


def _moments(corners: FloatArray) -> tuple[float, FloatArray, FloatArray]:
    """Signed area, centroid (2,) and central second moments over the area (2, 2) of a polygon."""
    origin = corners.mean(axis=0)
    a = corners - origin
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2
    centroid = ((a + b) * cross[:, None]).sum(axis=0) / (6 * area) if area else np.zeros(2)
    pairs = np.einsum("k,ki,kj->ij", cross, a, a) + np.einsum("k,ki,kj->ij", cross, b, b)
    mixed = np.einsum("k,ki,kj->ij", cross, a, b)
    moments = (2 * pairs + mixed + mixed.T) / (24 * area) if area else np.zeros((2, 2))
    return float(area), centroid + origin, moments - np.outer(centroid, centroid)


def _cross(o: FloatArray, a: FloatArray, b: FloatArray) -> float:
    return float((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]))


def _crosses(corners: FloatArray) -> bool:
    """Whether two sides of a polygon that are not neighbours meet."""
    sides = list(zip(corners, np.roll(corners, -1, axis=0), strict=True))
    for i, (a, b) in enumerate(sides):
        for k, (c, d) in enumerate(sides[i + 2 :], i + 2):
            low, high = np.maximum(np.minimum(a, b), np.minimum(c, d)), np.minimum(np.maximum(a, b), np.maximum(c, d))
            if (i, k) == (0, len(sides) - 1) or (low > high).any():  # sides on one line may be apart
                continue
            if _cross(a, b, c) * _cross(a, b, d) <= 0 and _cross(c, d, a) * _cross(c, d, b) <= 0:
                return True
    return False
