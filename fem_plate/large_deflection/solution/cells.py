"""Which cells a plate needs that stretches: smaller ones around actuators, and at the rim where it bends in a layer."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.types import FloatArray
from meshes import PlateMesh

# Around an actuator the plate also bends as r^4 ln r, which halved cells take up: how often, and how near (in cells).
AROUND, NEAR = 2, 2.0
# From so many thicknesses on: the bands at the rim whose cells are halved, over the half width, and the halvings added
# around actuators.
ROUNDING = 1e-6  # of that many
LEVELS = ((0.0, (), 0), (5.0, (0.16,), 1), (15.0, (0.2, 0.08), 2))


def level_of(thicknesses: float) -> int:
    """The level of fineness for a largest deflection over the thickness."""
    return sum(thicknesses > least * (1 + ROUNDING) for least, _, _ in LEVELS[1:])


def refined_for(mesh: PlateMesh, points: FloatArray, half_width: float, level: int) -> PlateMesh:
    """The mesh with halved cells around actuators at points (N, 2) [m] and at the rim."""
    _, bands, more = LEVELS[level]
    for band in bands:
        mesh = mesh.refined(mesh.outline.gap(_centres(mesh)) < band * half_width)
    if len(points):
        tree = cKDTree(points)
        for _ in range(AROUND + more):
            mesh = mesh.refined(tree.query(_centres(mesh))[0] < NEAR * mesh.cell_sizes)
    return mesh


def _centres(mesh: PlateMesh) -> FloatArray:
    return np.asarray(mesh.points[mesh.triangles].mean(axis=1))
