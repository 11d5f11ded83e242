"""Element matrices of a Kirchhoff-Love plate, in dimensionless variables (lengths by the plate's size, rigidity 1).

The bending moments M(v) are linear in the second derivatives H(v) by the section's law; of an isotropic plate they
are (1 - nu) H(v) + nu tr H(v) I. For a v that needs no load, div div M(v) = 0, integration by parts gives

    int M(v):H(q) = rim[ (M(v) n).grad q - (div M(v).n) q ]        for every q.

A support prescribes T grad v and c v on the rim: clamped T = I, c = 1; simply supported T = t t^T (t along the rim),
c = 1; free T = 0, c = 0. Nitsche's method (Nitsche, 1971) seeks the v that equals g where the support prescribes it,
and has the moments and shears of g where it does not:

    int M(v):H(q) - R(v; q) - R(q; v - g) + S(v - g; q) = L(q)     for every q,    with

    R(v; q) = rim[ (M(v) n).T grad q - c (div M(v).n) q ] + ends[ +-(t.M(v) n) q ]
    S(v; q) = rim[ gamma1/h T grad v.grad q + gamma2/h^3 c v q ]
    L(q)    = rim[ (M(g) n).(I - T) grad q - (1 - c) (div M(g).n) q ] - ends[ +-(t.M(g) n) q ].

The ends are those of free edges at held ones, + where such an edge ends and - where it starts, along t. On a free edge
not the twist t.M n vanishes but the shear (d/dt)(t.M n) + div M.n; integrating by parts along the edge leaves the twist
at its ends, as a force on the corner.

Under a tension beta^2 the form of a stretched membrane is added, imposed in the same way where c = 1:

    beta^2 ( int grad v.grad q - rim[ c (dv/dn q + dq/dn (v - g)) ] + rim[ gamma0/h c (v - g) q ] )
        = beta^2 rim[ (1 - c) dg/dn q ].

The rim is its true curve: only there does a curved clamped plate have no slope.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fem_plate.elements.argyris import Triangles, chain_rule, reference
from fem_plate.elements.rim import RimQuadrature, unit_gauss
from fem_plate.types import FloatArray

# Anything within (20..2e4, 100..2000, 5000..4e5) gives the same digits; far less loses definiteness.
GAMMA_0 = 200.0
GAMMA_1 = 400.0
GAMMA_2 = 40000.0
# The channels of a function on the rim: value, gradient, M n, div M.n.
VALUE, GRADIENT, MOMENT, SHEAR = 0, slice(1, 3), slice(3, 5), 5
CHANNELS = 6
PAIRS = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]  # of the second derivatives xx, xy, yy


def triangle_quadrature(count: int) -> tuple[FloatArray, FloatArray]:
    """Quadrature of the reference triangle, exact to degree 2 count - 2: points (count^2, 2) and weights (count^2,)."""
    x, w = unit_gauss(count)
    ray, along = np.meshgrid(x, x, indexing="ij")
    xy = np.stack([ray * (1 - along), ray * along], axis=-1).reshape(-1, 2) - 1 / 3
    return xy, np.outer(x * w, w).reshape(-1)


@lru_cache
def _reference_matrices(degree: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """int h_a h_b of the reference functions' second derivatives, symmetrised (6, n, n); likewise of the first
    (3, n, n); int v q (n, n)."""
    xy, weights = triangle_quadrature(degree + 2)
    value, first, second = (reference(degree).derivatives(xy[:, 0], xy[:, 1], order) for order in range(3))
    curvature = np.einsum("n,naj,nbk->abjk", weights, second, second, optimize=True)
    slopes = np.einsum("n,naj,nbk->abjk", weights, first, first, optimize=True)
    return (
        np.stack([curvature[a, b] if a == b else curvature[a, b] + curvature[b, a] for a, b in PAIRS]),
        np.stack([slopes[0, 0], slopes[0, 1] + slopes[1, 0], slopes[1, 1]]),
        np.einsum("n,naj,nak->jk", weights, value, value, optimize=True),
    )


def bending(triangles: Triangles, law: FloatArray) -> FloatArray:
    """int M(v):H(q) on straight-sided triangles, (m, n, n)."""
    chain = chain_rule(triangles.inverse, 2)
    law = chain.transpose(0, 2, 1) @ law @ chain * triangles.determinant[:, None, None]
    pairs = np.stack([law[:, a, b] for a, b in PAIRS], axis=1)
    return _to_unknowns(triangles, np.tensordot(pairs, _reference_matrices(triangles.functions.degree)[0], axes=1))


def stretching(triangles: Triangles) -> FloatArray:
    """int grad v.grad q on straight-sided triangles, (m, n, n)."""
    inverse = triangles.inverse
    law = inverse @ inverse.transpose(0, 2, 1) * triangles.determinant[:, None, None]
    pairs = np.stack([law[:, 0, 0], law[:, 0, 1], law[:, 1, 1]], axis=1)
    return _to_unknowns(triangles, np.tensordot(pairs, _reference_matrices(triangles.functions.degree)[1], axes=1))


def mass(triangles: Triangles) -> FloatArray:
    """int v q on straight-sided triangles, (m, n, n)."""
    own = _reference_matrices(triangles.functions.degree)[2]
    return _to_unknowns(triangles, triangles.determinant[:, None, None] * own)


def _to_unknowns(triangles: Triangles, matrices: FloatArray) -> FloatArray:
    return np.asarray(triangles.transform.transpose(0, 2, 1) @ (matrices @ triangles.transform))


def bending_at(hessian: FloatArray, weights: FloatArray, law: FloatArray) -> FloatArray:
    """int M(v):H(q) by quadrature: second derivatives (3, k, n, i) and weights (k, n) give (k, i, i)."""
    moments = np.einsum("ab,bknj->aknj", law, hessian)  # M(v)
    return np.einsum("kn,aknj,aknl->kjl", weights, moments, hessian, optimize=True)


def stretching_at(gradient: FloatArray, weights: FloatArray) -> FloatArray:
    """int grad v.grad q by quadrature: gradients (2, k, n, i) and weights (k, n) give (k, i, i)."""
    return np.einsum("kn,aknj,aknl->kjl", weights, gradient, gradient, optimize=True)


def mass_at(value: FloatArray, weights: FloatArray) -> FloatArray:
    """int v q by quadrature: values (k, n, i) and weights (k, n) give (k, i, i)."""
    return np.einsum("kn,knj,knl->kjl", weights, value, value, optimize=True)


def products(one: FloatArray, other: FloatArray) -> FloatArray:
    """The sums (t, i, j) over d and n of tables (d, t, n, i) and (d, t, n, j)."""
    return np.asarray(sum(a.transpose(0, 2, 1) @ b for a, b in zip(one, other, strict=True)))


def rim_traces(derivatives: list[FloatArray], normal: FloatArray, law: FloatArray) -> FloatArray:
    """The six channels of functions on the rim: value, gradient, M n, div M.n; (6, k, n, ...).

    derivatives: of orders 0 to 3 in the sequence of DERIVATIVES, each (d, k, n, ...).  normal: (k, n, 2).
    law: (3, 3), of M(v):H(q) in the second derivatives xx, xy, yy.
    """
    (value,), slopes, second, third = derivatives
    nx, ny = (normal[..., i].reshape(normal.shape[:2] + (1,) * (value.ndim - 2)) for i in range(2))
    of_moments = law * np.array([1.0, 0.5, 1.0])[:, None]  # M_xx, M_xy, M_yy
    xx, xy, yy = np.tensordot(of_moments, second, axes=1)
    along_x, along_y = (np.tensordot(of_moments, third[k : k + 3], axes=1) for k in range(2))  # their derivatives
    shear = (along_x[0] + along_y[1]) * nx + (along_x[1] + along_y[2]) * ny
    return np.stack([value, *slopes, xx * nx + xy * ny, xy * nx + yy * ny, shear])


def rim_forms(rim: RimQuadrature, stiffness: FloatArray | float = 1.0) -> tuple[FloatArray, FloatArray]:
    """The rim's terms, as what couples the channels of q (rows) with those of v or g (columns).

    stiffness: (k, n), of the plate at the rim, by which S counts.
    Returns two arrays (k, n, 6, 6), weights included, for the left and the right side of

        S(v; q) - R(v; q) - R(q; v) = S(g; q) - R(q; g) + L(q).
    """
    k, n = rim.weights.shape
    R, S, L, ends = np.zeros((4, k, n, CHANNELS, CHANNELS))
    R[..., GRADIENT, MOMENT] = rim.T
    R[..., VALUE, SHEAR] = -rim.c
    S[..., GRADIENT, GRADIENT] = GAMMA_1 / rim.h[:, None, None, None] * rim.T
    S[..., VALUE, VALUE] = GAMMA_2 / rim.h[:, None] ** 3 * rim.c
    L[..., GRADIENT, MOMENT] = np.eye(2) - rim.T
    L[..., VALUE, SHEAR] = rim.c - 1
    S *= np.asarray(stiffness)[..., None, None]
    ends[..., VALUE, MOMENT] = rim.twist
    weights = rim.weights[..., None, None]
    R = weights * R + ends
    R_swapped = np.swapaxes(R, -1, -2)  # R(q; v)
    return weights * S - R - R_swapped, weights * (S + L) - R_swapped - ends


def rim_tension_forms(rim: RimQuadrature) -> tuple[FloatArray, FloatArray]:
    """What a unit tension adds to `rim_forms`."""
    k, n = rim.weights.shape
    R, S, L = np.zeros((3, k, n, CHANNELS, CHANNELS))
    R[..., VALUE, GRADIENT] = rim.c[..., None] * rim.normal
    S[..., VALUE, VALUE] = GAMMA_0 / rim.h[:, None] * rim.c
    L[..., VALUE, GRADIENT] = (1 - rim.c)[..., None] * rim.normal
    weights = rim.weights[..., None, None]
    R_swapped = np.swapaxes(R, -1, -2)
    return weights * (S - R - R_swapped), weights * (S + L - R_swapped)
