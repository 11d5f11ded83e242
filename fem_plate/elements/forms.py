"""Element matrices of a Kirchhoff-Love plate, in dimensionless variables (lengths by the plate's size, rigidity 1).

Bending energy with moments M(v) = (1 - nu) H(v) + nu tr H(v) I, and on the rim Nitsche's method (Nitsche, 1971): for a
biharmonic v, integrating by parts,

    int M(v):H(q) = rim[ (M(v) n).grad q - (div M(v).n) q ]        for every q,    div M(v) = grad(laplace v).

A support prescribes T grad v and c v there: clamped T = I, c = 1; simply supported T = t t^T (t along the rim), c = 1;
free T = 0, c = 0. With v to be g where it is prescribed and the moments and shears of v to be those of g where not,

    int M(v):H(q) - R(v; q) - R(q; v - g) + rim[ gamma1/h T grad(v - g).grad q + gamma2/h^3 c (v - g) q ]
        = rim[ (M(g) n).(1 - T) grad q - (1 - c)(div M(g).n) q ],

where R(v; q) = rim[ (M(v) n).T grad q - c (div M(v).n) q ] + ends[ +-(t.M(v) n) q ].

The ends are those of free edges at held ones, + where such an edge ends and - where it starts, along t: what a free
edge lacks is not the twist t.M n itself but the shear (d/dt)(t.M n) + div M.n, and integrating by parts along the edge
leaves the twist at its ends, a force on the corner. On the right side the ends count for g too, with a minus.

The rim is its true curve: only there does a curved clamped plate have no slope.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fem_plate.elements.argyris import DERIVATIVES, FUNCTIONS, REFERENCE, Triangles, chain_rule, monomials

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Anything within (100..2000, 5000..4e5) gives the same digits; far less loses definiteness.
NITSCHE_SLOPE = 400.0
NITSCHE_VALUE = 40000.0
CHANNELS = 6  # of rim data: value, gradient (2), moments on the rim (2), div M.n
PAIRS = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]


class Rim(NamedTuple):
    """Quadrature on the rim, n points on each of k edges; dimensionless."""

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2), on the true curve
    weights: FloatArray  # (k, n), arc length included
    normal: FloatArray  # (k, n, 2), outward
    slope: FloatArray  # (k, n, 2, 2), T
    value: FloatArray  # (k, n), c
    size: FloatArray  # (k,), h, the length of the edge or less where its cell is flat
    twist: FloatArray  # (k, n, 2), t at the end of a free edge at a held one, -t at its start, 0 elsewhere


def bending_law(poisson_ratio: float) -> FloatArray:
    """M:H as a quadratic form of (xx, xy, yy), (3, 3)."""
    nu = poisson_ratio
    return np.array([[1.0, 0.0, nu], [0.0, 2 * (1 - nu), 0.0], [nu, 0.0, 1.0]])


def square(points: int) -> tuple[FloatArray, FloatArray]:
    """Quadrature of the reference triangle, exact to degree 2 points - 2: points (n, 2) and weights (n,)."""
    x, w = np.polynomial.legendre.leggauss(points)
    x, w = (x + 1) / 2, w / 2
    ray, along = np.meshgrid(x, x, indexing="ij")
    xy = np.stack([ray * (1 - along), ray * along], axis=-1).reshape(-1, 2) - 1 / 3
    return xy, np.outer(x * w, w).reshape(-1)


def _reference_matrices() -> tuple[FloatArray, FloatArray]:
    """int h_a h_b of the reference functions' second derivatives, symmetrised (6, 21, 21); int v q (21, 21)."""
    xy, weights = square(7)
    x, y = xy.T
    second = np.stack([monomials(x, y, *d) @ REFERENCE for d in DERIVATIVES[2]])
    value = monomials(x, y) @ REFERENCE
    curvature = np.einsum("n,anj,bnk->abjk", weights, second, second)
    pairs = np.stack([curvature[a, b] if a == b else curvature[a, b] + curvature[b, a] for a, b in PAIRS])
    return pairs, np.einsum("n,nj,nk->jk", weights, value, value)


REFERENCE_BENDING, REFERENCE_MASS = _reference_matrices()


def bending(triangles: Triangles, poisson_ratio: float) -> FloatArray:
    """int M(v):H(q) on straight-sided triangles, (m, 21, 21)."""
    chain = chain_rule(triangles.inverse, 2)
    law = chain.transpose(0, 2, 1) @ bending_law(poisson_ratio) @ chain * triangles.determinant[:, None, None]
    pairs = np.stack([law[:, a, b] for a, b in PAIRS], axis=1)
    return _to_unknowns(triangles, (pairs @ REFERENCE_BENDING.reshape(6, -1)).reshape(-1, FUNCTIONS, FUNCTIONS))


def mass(triangles: Triangles) -> FloatArray:
    """int v q on straight-sided triangles, (m, 21, 21)."""
    return _to_unknowns(triangles, triangles.determinant[:, None, None] * REFERENCE_MASS)


def _to_unknowns(triangles: Triangles, matrices: FloatArray) -> FloatArray:
    return np.asarray(triangles.transform.transpose(0, 2, 1) @ (matrices @ triangles.transform))


def bending_at(hessian: FloatArray, weights: FloatArray, poisson_ratio: float) -> FloatArray:
    """int M(v):H(q) by quadrature: second derivatives (3, k, n, 21) and weights (k, n) give (k, 21, 21)."""
    moments = np.einsum("ab,bknj->aknj", bending_law(poisson_ratio), hessian)
    return np.einsum("kn,aknj,aknl->kjl", weights, moments, hessian, optimize=True)


def mass_at(value: FloatArray, weights: FloatArray) -> FloatArray:
    """int v q by quadrature: values (k, n, 21) and weights (k, n) give (k, 21, 21)."""
    return np.einsum("kn,knj,knl->kjl", weights, value, value, optimize=True)


def rim_traces(derivatives: list[FloatArray], normal: FloatArray, poisson_ratio: float) -> FloatArray:
    """The six channels of functions on the rim: value, gradient, M n, div M.n; (6, k, n, ...).

    derivatives: of orders 0 to 3 in the sequence of DERIVATIVES, each (d, k, n, ...).  normal: (k, n, 2).
    """
    nu = poisson_ratio
    (value,), (x, y), (xx, xy, yy), (xxx, xxy, xyy, yyy) = derivatives
    nx, ny = (normal[..., i].reshape(normal.shape[:2] + (1,) * (value.ndim - 2)) for i in range(2))
    moments = (xx + nu * yy) * nx + (1 - nu) * xy * ny, (1 - nu) * xy * nx + (yy + nu * xx) * ny
    return np.stack([value, x, y, *moments, (xxx + xyy) * nx + (xxy + yyy) * ny])


def rim_forms(at: Rim) -> tuple[FloatArray, FloatArray]:
    """What couples the channels of q (rows) with those of v and of g (columns): two arrays (k, n, 6, 6)."""
    k, n = at.weights.shape
    reaction, penalty, natural = np.zeros((3, k, n, CHANNELS, CHANNELS))
    reaction[..., 1:3, 3:5] = at.slope
    reaction[..., 0, 5] = -at.value
    natural[..., 1:3, 3:5] = np.eye(2) - at.slope
    natural[..., 0, 5] = at.value - 1
    penalty[..., 1:3, 1:3] = NITSCHE_SLOPE / at.size[:, None, None, None] * at.slope
    penalty[..., 0, 0] = NITSCHE_VALUE / at.size[:, None] ** 3 * at.value
    weights = at.weights[..., None, None]
    corner = np.zeros_like(reaction)
    corner[..., 0, 3:5] = at.twist
    reaction = weights * reaction + corner
    turned = np.swapaxes(reaction, -1, -2)
    return weights * penalty - reaction - turned, weights * (penalty + natural) - turned - corner
