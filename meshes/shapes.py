"""Meshes of the standard outlines."""

from __future__ import annotations

import math

import numpy as np

from meshes.curves import Circle, FloatArray
from meshes.mesh import PlateMesh


def disc(radius: float, cell_size: float) -> PlateMesh:
    """A disc around the origin, in rings: ring k has 6 k points, so that all triangles are nearly equilateral.

    radius, cell_size: m; rings are at most `cell_size` wide (a cell's longest edge 1.45 times
    that), and at least two are made.
    Raises ValueError when either is not positive and finite.
    """
    for name, value in (("radius", radius), ("cell_size", cell_size)):
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"Input {name} of disc must be a positive length in m; got {value!r}")
    rings = max(2, math.ceil(radius / cell_size * (1 - 1e-12)))
    points = np.concatenate([np.zeros((1, 2)), *(_ring(k, radius * k / rings) for k in range(1, rings + 1))])
    triangles = []
    for k in range(rings):
        for sector in range(6):
            for step in range(k + 1):
                inner, outer = sector * k + step, sector * (k + 1) + step
                triangles.append((_row(k, inner), _row(k + 1, outer), _row(k + 1, outer + 1)))
                if step < k:
                    triangles.append((_row(k, inner), _row(k + 1, outer + 1), _row(k, inner + 1)))
    rim = np.array([(_row(rings, i), _row(rings, i + 1)) for i in range(6 * rings)])
    return PlateMesh(points, np.array(triangles), {"rim": rim}, {"rim": Circle(radius)})


def _ring(k: int, radius: float) -> FloatArray:
    angle = 2 * np.pi * np.arange(6 * k) / (6 * k)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _row(ring: int, place: int) -> int:
    """Row of a point in `points` from its ring and its place on it (counted round and round)."""
    return 0 if ring == 0 else 1 + 3 * ring * (ring - 1) + place % (6 * ring)
