"""Where cells must be small: towards corners, where an actuator is close to the rim, and at the rim under tension."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.elements.argyris import DEGREE
from fem_plate.elements.corners import MAX_EXPONENT, exponent
from fem_plate.types import FloatArray
from meshes import PlateMesh, areas

FAR = 0.7  # of the plate's half width: an actuator that far from the rim needs no smaller cells there
CORNER_GROWTH = 4.0  # of cells with the distance from a corner, times the plate's cells over its size
CORNER_ERROR = 1e-2  # of the error of the plate's other cells
LAYER_CELLS = 8.0  # of the plate's cells over its half width: cells at a stretched rim over the width of its layer
LAYER_GROWTH = 4.0  # widths of the layer over which cells grow e-fold
MAX_LAYER_CELLS = 1000.0  # spent on layers before any halving, about
# What halving the cells is sure to divide the error of w by: without layers (observed: 2^5.5 and more), with cells at
# the rim of up to COARSE_LAYER widths of a layer, and with larger ones.
GAIN, LAYER_GAIN, COARSE_GAIN, COARSE_LAYER = 2.0**5, 8.0, 2.0, 6.0
# Without corners w is off by about ERROR (RATE h)^(degree + 1) of its largest value, h the cells over the half width.
ERROR, RATE = 100.0, 0.28
MIN_CELL = 1e-6  # of the plate's size, at corners on the plate's own cells
FINER, LEAST_CELL = 64.0, 1e-8  # what halving the cells divides that by, down to where rounding is more than accuracy


@dataclass(frozen=True)
class SingularCorner:
    """A corner of the plate where w ~ r^(exponent + 1)."""

    point: FloatArray  # (2,) m
    exponent: float
    error: float = CORNER_ERROR  # of the error of the plate's other cells, what cells there may add
    largest: float = np.inf  # m, the largest cell there


def singular_corners(mesh: PlateMesh, supports: Mapping[str, str], poisson_ratio: float) -> list[SingularCorner]:
    """The corners where the deflection is not smooth."""
    singular = []
    for corner in mesh.corners:
        before, after = (supports[name] for name in corner.sides)
        smallest = exponent(round(corner.angle, 9), before, after, poisson_ratio)
        if smallest < MAX_EXPONENT:
            singular.append(SingularCorner(mesh.points[corner.row], smallest))
    return singular


@dataclass(frozen=True)
class MeshGrading:
    """How fine a plate's cells are before any grading."""

    cell: float  # m, mean size over the area
    half_width: float  # m, the largest distance of the plate from its rim
    size: float  # m, the scale of corners: the plate's size, or three half widths of a slender plate
    layer: float = np.inf  # m, over which a tension's boundary layer decays
    at_layer: float = np.inf  # m, of the cells there
    least: float = MIN_CELL  # of the size, of the cells at corners
    degree: int = DEGREE  # of the elements

    @staticmethod
    def of(mesh: PlateMesh, tension: float = 0.0) -> MeshGrading:
        """The fineness of a mesh's cells; tension: 1/m^2, over the plate's rigidity."""
        area = np.abs(areas(mesh.points, mesh.triangles))
        a, b, c = np.moveaxis(mesh.points[mesh.triangles], 1, 0)
        half_width = mesh.outline.gap(np.concatenate([mesh.points, (a + b + c) / 3])).max()
        size = min(mesh.size, 3 * half_width)
        cell = float(np.average(mesh.cell_sizes, weights=area))
        if tension <= 0:
            return MeshGrading(cell, float(half_width), float(size))
        ends = mesh.points[np.concatenate(list(mesh.boundaries.values()))]
        rim = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())
        layer = tension**-0.5
        return MeshGrading(cell, float(half_width), float(size), layer, _at_layer(cell / float(half_width), layer, rim))

    def on_patches(self, cell: float, rim: float) -> MeshGrading:
        """The same with another size of cell, for patches that extend `rim` along the plate's rim; all in m."""
        return replace(self, cell=cell, at_layer=_at_layer(cell / self.half_width, self.layer, rim))

    @property
    def gain(self) -> float:
        """What halving the cells divides the error of w by, at least."""
        if self.at_layer >= self.cell:
            return GAIN
        return LAYER_GAIN if self.at_layer <= COARSE_LAYER * self.layer else COARSE_GAIN

    def error(self, degree: int) -> float:
        """About how far off w is, relative to its largest value, of a plate of one law without corners or tension."""
        return float(ERROR * (RATE * self.cell / self.half_width) ** (degree + 1))

    def halved(self, times: int = 1) -> MeshGrading:
        """The fineness of cells halved so many times."""
        least = max(MIN_CELL / FINER**times, LEAST_CELL) if times else self.least
        return replace(self, cell=self.cell / 2**times, at_layer=self.at_layer / 2**times, least=least)

    def at_corner(self, corner: SingularCorner) -> tuple[float, bool]:
        """The size [m] of the cells at a corner, and whether they are as small as is good for its error."""
        others = (self.cell / self.size) ** 6 * self.error(self.degree) / self.error(DEGREE)
        needed = (corner.error * others) ** (1 / (2 * corner.exponent))
        return min(self.size * max(needed, self.least), corner.largest), needed >= self.least


def _at_layer(share: float, layer: float, rim: float) -> float:
    """The size [m] of cells in a boundary layer.

    share: the plate's cells over its half width.  layer, rim: m, how wide and long the layer is.
    """
    if not np.isfinite(layer):
        return float(np.inf)
    # As measured, cells of size h at the rim take 8 rim / h (1 + layer / h) of them.
    half = 4 * rim / MAX_LAYER_CELLS
    return max(LAYER_CELLS * share * layer, half + float(np.sqrt(half**2 + 2 * half * layer)))


def grade_mesh(
    mesh: PlateMesh, fine: MeshGrading, corners: list[SingularCorner], points: FloatArray | None = None
) -> PlateMesh:
    """The mesh with smaller cells at corners, at a stretched rim, and where actuators at points (N, 2) [m] are close.

    The smooth part of the response to a force varies over the distance to its mirror images beyond the rim: cells are
    as small in proportion as the plate's are for an actuator at FAR of the half width from the rim. Towards a corner
    they shrink in proportion to their distance, until they change w there by less than the plate's other cells do.
    Under a large tension the plate bends in a layer along its rim only.
    """
    images, nearest = None, 0.0
    if points is not None and len(points):
        # An image across a hole may lie on the plate's other rim. None is closer to the plate than its actuator.
        images, nearest = cKDTree(mesh.mirrored(points)), mesh.outline.gap(points).min()
    share = fine.cell / fine.size
    smallest = [fine.at_corner(corner)[0] for corner in corners]
    while True:
        centre = mesh.points[mesh.triangles].mean(axis=1)
        allowed = np.full(len(centre), np.inf)
        if images is not None:
            allowed = fine.cell / (FAR * fine.half_width) * np.maximum(images.query(centre)[0], nearest)
        for corner, floor in zip(corners, smallest, strict=True):
            distance = np.hypot(*(centre - corner.point).T)
            allowed = np.minimum(allowed, np.maximum(min(CORNER_GROWTH * share, 1.0) * distance, floor))
        if fine.at_layer < fine.cell:
            with np.errstate(over="ignore"):
                nearest_corner = mesh.outline.gap(mesh.points)[mesh.triangles].min(axis=1)
                growth = np.exp(np.maximum(nearest_corner, 0.0) / (LAYER_GROWTH * fine.layer))
            allowed = np.minimum(allowed, fine.at_layer * growth)
        large = mesh.cell_sizes > allowed
        if not large.any():
            return mesh
        mesh = mesh.refined(large)


def corner_rows(mesh: PlateMesh, corners: list[SingularCorner]) -> list[int]:
    """The rows of the mesh's points at corners."""
    rows = [int(np.argmin(((mesh.points - corner.point) ** 2).sum(axis=1))) for corner in corners]
    return list(dict.fromkeys(rows))
