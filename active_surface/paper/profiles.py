"""Profiles: the surface of several actuators put together from equation (2) for each, as the paper must have done.

Actuator i raises a disc of radius a around itself, phi_i = 1 - q^2 + 2 q^2 ln q with q = |x - x_i| / a, and nothing
beyond it. "superposed": the sum of all. "nearest": that of the nearest actuator alone; then the surface jumps half-way
between actuators. A plate does neither: each actuator would have to let the others' deflection through.

The cells hold the profiles exactly. Those that a disc's rim crosses are divided, down to CROSSED of the radius.
The surface ends at the discs' rim.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from active_surface.arrays import BoolArray, FloatArray, IntArray
from meshes import Outline
from particle import AnyDrive, SurfaceMotion
from particle.drives import drive_table
from particle.surface import NOWHERE, UNBUILT, WHOLE, BuiltCells, CellFit, CellPool

SUPERPOSED, NEAREST = "superposed", "nearest"
PER_PITCH = 2  # cells from one actuator to the next, so that the jump lies between cells
CROSSED = 0.005
FLOOR = 1e-6  # of the radius
OVERHANG = 1.02  # half widths that a step may end outside of its cell
ARC = 48  # edges of each disc's rim
QUARTERS = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]]) / 2


def profile_outline(pitch: float, radius: float) -> Outline:
    """The rim of the two discs around (0, 0) and (pitch, 0) [m] together.

    Raises ValueError when the discs do not overlap, or one pitch is not shorter than the radius.
    """
    if not 0 < pitch < radius:
        raise ValueError(f"Input pitch of profile_outline must be positive and below the radius {radius}; got {pitch}")
    half = np.arccos(pitch / 2 / radius)
    angle = np.linspace(half, 2 * np.pi - half, 2 * ARC + 1)
    left = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    right = np.array([pitch, 0.0]) - left
    rims = [np.stack([rim[:-1:2], rim[1::2], rim[2::2]], axis=1) for rim in (left, right)]
    return Outline(edges=np.concatenate(rims))


def profile_surface(kind: str, pitch: float, radius: float, drives: Sequence[AnyDrive]) -> SurfaceMotion:
    """The surface of two actuators at (0, 0) and (pitch, 0) [m]; kind: SUPERPOSED or NEAREST."""
    points = np.array([[0.0, 0.0], [pitch, 0.0]])
    return SurfaceMotion(
        drives=drive_table(drives),
        store=_Maker(kind, points, radius).store(),
        sources=points,
        size=radius,
        floor=FLOOR * radius,
        overhang=OVERHANG,
        edges=profile_outline(pitch, radius).edges,
    )


class _Maker:
    """Makes the cells of profiles."""

    def __init__(self, kind: str, points: FloatArray, radius: float) -> None:
        self.kind, self.points, self.radius = kind, points, radius
        self.width = (points[1, 0] - points[0, 0]) / PER_PITCH
        reach = int(np.ceil(radius / self.width))
        self.origin = np.array([-reach * self.width, -reach * self.width])
        counts = (2 * reach + PER_PITCH, 2 * reach)
        self.pool = CellPool(self.origin, np.full(2, self.width), np.full(counts, UNBUILT))

    def store(self) -> BuiltCells:
        """All cells."""
        half = np.full(2, self.width / 2)
        for i, j in np.ndindex(*self.pool.roots.shape):
            centre = self.origin + self.width * (np.array([i, j]) + 0.5)
            reached = self._reached(centre, half).any()
            self.pool.roots[i, j] = self.pool.add(centre, half, *self._content(centre, half)) if reached else NOWHERE
        return BuiltCells(self.pool.cells(), 0.0)

    def _content(self, centre: FloatArray, half: FloatArray) -> tuple[CellFit | None, int]:
        """What a cell holds: a fit, or the first of its quarters."""
        if self.kind == NEAREST:
            return self._fit(centre, half, np.array([int(centre[0] > self.points[:, 0].mean())])), WHOLE
        crossed = self._reached(centre, half) != self._covered(centre, half)
        if crossed.any() and half[0] > CROSSED * self.radius:
            places = [centre + quarter * half for quarter in QUARTERS]
            below = [self._content(place, half / 2) for place in places]
            rows = [self.pool.add(place, half / 2, *content) for place, content in zip(places, below, strict=True)]
            return None, rows[0]
        away = np.hypot(*(self.points - centre).T)
        inside = np.flatnonzero(away < self.radius)
        return self._fit(centre, half, inside if len(inside) else np.array([int(np.argmin(away))])), WHOLE

    def _reached(self, centre: FloatArray, half: FloatArray) -> BoolArray:
        """Which discs (2,) have a point in the cell."""
        away = np.maximum(np.abs(self.points - centre) - half, 0.0)
        return np.asarray(np.hypot(*away.T) < self.radius)

    def _covered(self, centre: FloatArray, half: FloatArray) -> BoolArray:
        """Which discs (2,) have all of the cell."""
        return np.asarray(np.hypot(*(np.abs(self.points - centre) + half).T) <= self.radius)

    def _fit(self, centre: FloatArray, half: FloatArray, members: IntArray) -> CellFit:
        rows = np.zeros((len(members), 6 + len(members)))
        for row, i in enumerate(members):
            (c_x, c_y), (h_x, h_y) = (centre - self.points[i]) / self.radius, half / self.radius
            # 1 - q^2 in the order 1, y, y^2, x, x y, x^2
            rows[row, :6] = 1 - c_x**2 - c_y**2, -2 * c_y * h_y, -(h_y**2), -2 * c_x * h_x, 0.0, -(h_x**2)
            rows[row, 6 + row] = 2.0
        return CellFit(2, members, np.ones(len(members)), members, rows, clear=0.0)
