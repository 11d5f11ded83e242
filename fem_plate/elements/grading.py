"""Where cells must be small: towards corners, and where an actuator is near the rim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem_plate.elements.corners import MOST, exponent
from meshes import PlateMesh

FloatArray = NDArray[np.float64]

FAR = 0.7  # of the plate's half width: an actuator that far from the rim needs no smaller cells there
CORNER_SLOPE = 4.0  # how much of its distance a cell at a corner may be, against the plate's cells of its size
CORNER_ERROR = 1e-2  # of the error that cells of the plate's fineness leave anyhow
LEAST = 1e-6  # of the plate's size: cells any smaller add more rounding than accuracy


@dataclass(frozen=True)
class Singular:
    """A corner of the plate where w ~ r^(exponent + 1)."""

    point: FloatArray  # (2,) m
    exponent: float


def singular_corners(mesh: PlateMesh, supports: Mapping[str, str], poisson_ratio: float) -> list[Singular]:
    """The corners where the deflection is not smooth."""
    found = []
    for corner in mesh.corners:
        before, after = (supports[name] for name in corner.sides)
        smallest = exponent(round(corner.angle, 9), before, after, poisson_ratio)
        if smallest < MOST:
            found.append(Singular(mesh.points[corner.row], smallest))
    return found


@dataclass(frozen=True)
class Fineness:
    """How fine a plate's cells are before any grading."""

    cell: float  # m, their mean size over the area
    half_width: float  # m, how far the plate reaches from its rim at most
    size: float  # m, what corners are measured by: the plate's size, or three half widths of a slender one

    @staticmethod
    def of(mesh: PlateMesh) -> Fineness:
        a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
        area = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        half_width = mesh.outline.gap(np.concatenate([mesh.points, (a + b + c) / 3])).max()
        size = min(mesh.size, 3 * half_width)
        return Fineness(float(np.average(mesh.cell_sizes, weights=area)), float(half_width), float(size))

    def halved(self, times: int = 1) -> Fineness:
        """That of cells halved some times."""
        return replace(self, cell=self.cell / 2**times)


def graded(mesh: PlateMesh, fine: Fineness, corners: list[Singular], points: FloatArray | None = None) -> PlateMesh:
    """The mesh with smaller cells at corners, and at the rim where actuators at points (N, 2) [m] are near it.

    The smooth part of a force's answer varies over the distance to its mirror images beyond the rim: cells stay as
    small in comparison as the plate's are for an actuator at FAR of the half width from the rim. Towards a corner they
    shrink in proportion to their distance, until what is left there changes w by less than the plate's cells do.
    """
    images, nearest = None, 0.0
    if points is not None and len(points):
        # An image across a hole may come to lie on the plate's other rim. None is nearer to the plate than its point.
        images, nearest = cKDTree(mesh.mirrored(points)), mesh.outline.gap(points).min()
    share = fine.cell / fine.size
    error = CORNER_ERROR * share**6
    least = np.array([fine.size * max(error ** (1 / (2 * c.exponent)), LEAST) for c in corners])
    places = np.array([c.point for c in corners]).reshape(-1, 2)
    while True:
        centre = mesh.points[mesh.triangles].mean(axis=1)
        allowed = np.full(len(centre), np.inf)
        if images is not None:
            allowed = fine.cell / (FAR * fine.half_width) * np.maximum(images.query(centre)[0], nearest)
        for place, smallest in zip(places, least, strict=True):
            distance = np.hypot(*(centre - place).T)
            allowed = np.minimum(allowed, np.maximum(min(CORNER_SLOPE * share, 1.0) * distance, smallest))
        large = mesh.cell_sizes > allowed
        if not large.any():
            return mesh
        mesh = mesh.refined(large)


def corner_rows(mesh: PlateMesh, corners: list[Singular]) -> list[int]:
    """The rows of the mesh's points at corners."""
    rows = [int(np.argmin(((mesh.points - corner.point) ** 2).sum(axis=1))) for corner in corners]
    return list(dict.fromkeys(rows))
