"""The membrane by Airy's stress function: force xx = F_yy, yy = F_xx, xy = -F_xy.

Its energy 1/(2 E t) int (laplace F)^2 - (1 + nu) [F, F] is that of a plate of Poisson's ratio -nu: where the rim is
immovable, as a free plate's, and where it is free to move, as a clamped one's. It bounds the
membrane energy from below.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fem_plate.elements import CLAMPED, FREE, PlateModel, PlateSpace, SingularCorner, factorised, singular_corners
from fem_plate.large_deflection.membranes.membrane import AIRY, Membrane
from fem_plate.large_deflection.membranes.samples import Samples
from fem_plate.section import bending_law
from fem_plate.types import FloatArray, IntArray
from meshes import PlateMesh

DEGREE = 12  # of the quadrature: forces have degree 3, slopes 4 each


def airy_corners(mesh: PlateMesh, movable: bool, poisson_ratio: float) -> list[SingularCorner]:
    """The corners where the stress function is not smooth."""
    return singular_corners(mesh, _supports(mesh, movable), -poisson_ratio)


def airy(mesh: PlateMesh, movable: bool, poisson_ratio: float, corners: Sequence[int]) -> Membrane:
    """The membrane of a plate without holes, whose whole rim is immovable, or free to move, in its plane.

    corners: rows of mesh points where second derivatives may jump.
    """
    model = PlateModel(mesh, _supports(mesh, movable), bending_law(-poisson_ratio), corners)
    space = model.space
    stiffness = (model.pinned_stiffness / (12 * (1 - poisson_ratio**2))).tocsc()
    xy, weights = get_quadrature(RefTri, DEGREE)
    triangles = space.triangles
    inside = triangles.points[:, 0, None] + np.einsum("mij,jn->mni", triangles.jacobian, xy)
    every = np.arange(len(inside))
    samples = [_samples(space, every, inside, triangles.determinant[:, None] * weights)]
    if len(space.slivers.triangle):
        samples.append(_samples(space, *space.slivers))
    return Membrane(
        name=AIRY,
        samples=tuple(samples),
        dofs=space.dofs,
        stiffness=stiffness,
        solve=factorised(stiffness),
        sign=-1.0,
        law=None,
        expand=space.all_unknowns,
        reduce=space.to_independent,
    )


def _supports(mesh: PlateMesh, movable: bool) -> dict[str, str]:
    """Those of the plate that the stress function is the deflection of."""
    return dict.fromkeys(mesh.boundaries, CLAMPED if movable else FREE)


def _samples(space: PlateSpace, triangle: IntArray, points: FloatArray, weights: FloatArray) -> Samples:
    xx, xy, yy = space.triangles.derivatives(points, triangle, 2)
    return Samples.at(space, triangle, points, weights, np.concatenate([yy, -xy, xx], axis=1))
