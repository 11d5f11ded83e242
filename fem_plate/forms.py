"""The weak form of a Kirchhoff-Love plate, in dimensionless variables (lengths by the plate's size, rigidity 1).

For a biharmonic v on a plate whose rim is clamped to a given g, Nitsche's method (Nitsche, 1971) finds v from

    int M(v):H(q) - rim[(M(v) n).grad q - (div M(v).n) q] - rim[(M(q) n).grad(v - g) - (div M(q).n) (v - g)]
                  + rim[(gamma1/h) grad(v - g).grad q + (gamma2/h^3) (v - g) q] = 0       for every q,

with the moments M(v) = (1 - nu) H(v) + nu tr H(v) I of the bending energy, whose divergence is grad(laplace v). The rim
is its true curve: only there does a curved clamped plate have no slope.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import BilinearForm
from skfem.helpers import ddot, dot, eye, mul, trace

# Anything within (100..2000, 5000..4e5) gives the same digits; far less loses definiteness.
NITSCHE_SLOPE = 400.0
NITSCHE_VALUE = 40000.0

Field = Any  # scikit-fem's fields and form parameters carry no types


def moments(v: Field, poisson_ratio: float) -> NDArray[np.float64]:
    """M(v), (2, 2, ...), for rigidity 1 and positive where the plate is bent like a bowl."""
    curvature = v.hess
    return np.asarray((1 - poisson_ratio) * curvature + poisson_ratio * eye(trace(curvature), 2))


def moment_divergence(v: Field) -> NDArray[np.float64]:
    """div M(v) = grad(laplace v), (2, ...), whatever Poisson's ratio."""
    return np.asarray(v.grad3[:, 0, 0] + v.grad3[:, 1, 1])


def bending(poisson_ratio: float) -> BilinearForm:
    """The bending energy, int M(v):H(q)."""

    @BilinearForm
    def form(v: Field, q: Field, _: Field) -> Field:
        return ddot(moments(v, poisson_ratio), q.hess)

    return form


@BilinearForm
def mass(v: Field, q: Field, _: Field) -> Field:
    """int v q, for vibrations."""
    return v * q


def clamped_rim(poisson_ratio: float) -> BilinearForm:
    """The rim's integrals with v and q; needs the outward normal `n` and the cells' `edge` length h at the rim."""

    @BilinearForm
    def form(v: Field, q: Field, w: Field) -> Field:
        return (
            -_reaction(v, q.grad, q, w, poisson_ratio)
            - _reaction(q, v.grad, v, w, poisson_ratio)
            + _penalty(v.grad, v, q, w)
        )

    return form


def rim_data(poisson_ratio: float) -> list[Callable[[Field, Field], Field]]:
    """What one unit of (g, g_x, g_y) at a rim point adds to the right side for a test function q."""

    def unit(slope: tuple[float, float], value: float) -> Callable[[Field, Field], Field]:
        def density(q: Field, w: Field) -> Field:
            one = np.ones_like(np.asarray(q))
            grad = np.stack([slope[0] * one, slope[1] * one])
            return -_reaction(q, grad, value * one, w, poisson_ratio) + _penalty(grad, value * one, q, w)

        return density

    return [unit((0.0, 0.0), 1.0), unit((1.0, 0.0), 0.0), unit((0.0, 1.0), 0.0)]


def _reaction(v: Field, slope: Field, value: Field, w: Field, poisson_ratio: float) -> Field:
    """The work of v's edge moments and shear on a motion given by its slope and value."""
    return dot(mul(moments(v, poisson_ratio), w.n), slope) - dot(moment_divergence(v), w.n) * value


def _penalty(slope: Field, value: Field, q: Field, w: Field) -> Field:
    return NITSCHE_SLOPE / w.edge * dot(slope, q.grad) + NITSCHE_VALUE / w.edge**3 * value * q
