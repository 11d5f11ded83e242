"""Face: the numbers of a part's face and body that kernels read."""

from __future__ import annotations

from typing import NamedTuple

from particle.types import FloatArray


class Face(NamedTuple):
    """The face of a part, in axes of its own around the foot of the centre of mass, and the part's inertia."""

    places: FloatArray  # (n, 2) m, where the surface is looked at
    weights: FloatArray  # (n,) of the averages over the face
    unmoments: FloatArray  # (2, 2) 1/m^2, S^-1, S the mean of rho rho^T
    corners: FloatArray  # (c, 2) m, counter-clockwise; of a disc none
    hull: FloatArray  # (c, 2) m, corners on which it can tip; of a disc none
    radius: float  # m, of a disc; else 0
    area: float  # m^2
    reach: float  # m, of the farthest point
    arm: float  # m, the mean of |rho|
    far: FloatArray  # (f, 3) m, m, m^2, a rule for friction that turns little: places and weights
    farther: FloatArray  # the same for friction that hardly turns
    inertia: FloatArray  # (3, 3) kg m^2, about the centre of mass
    linear: bool  # whether the pressure follows the moments; else it is uniform
    tips: bool  # whether the path ends where an edge lifts
