"""Nitsche's rim (Nitsche, 1971) is consistent: biharmonic polynomials up to degree five come back to rounding.

By Goursat's formula all of them are real parts of z^n and conj(z) z^n. Where nothing holds the plate its rigid motions
stay free.
"""

import numpy as np
import pytest

from fem_plate.elements.forms import rim_traces
from fem_plate.elements.model import PlateModel
from fem_plate.sections import bending_law
from meshes import annulus, disc, ellipse, polygon, rectangle

LAW = bending_law(0.3)
CASES = [(n, k) for k in (0, 1) for n in range(6 - k)]
C, S, F = "clamped", "simply-supported", "free"
SIDES = ("bottom", "right", "top", "left")
PLATES = {
    "disc": (disc(1.0, 1 / 4), {"rim": C}),
    "simply supported disc": (disc(1.0, 1 / 4), {"rim": S}),
    "free disc": (disc(1.0, 1 / 4), {"rim": F}),
    "ellipse": (ellipse(1.0, 0.6, 0.4), {"rim": S}),
    "annulus": (annulus(0.5, 1.0, 0.4), {"inner": F, "outer": S}),
    "clamped rectangle": (rectangle(2.0, 1.4, 0.5), dict.fromkeys(SIDES, C)),
    "free rectangle": (rectangle(2.0, 1.4, 0.5), dict.fromkeys(SIDES, F)),
    "cantilever": (rectangle(2.0, 1.4, 0.5), dict(zip(SIDES, (F, F, F, C), strict=True))),
    "every kind": (rectangle(2.0, 1.4, 0.5), dict(zip(SIDES, (C, S, F, S), strict=True))),
    "hinge": (rectangle(2.0, 1.4, 0.5), dict(zip(SIDES, (F, S, F, F), strict=True))),
    "notch": (polygon([(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)], 0.6, names=list("abcdef")), None),
}


class Goursat:
    """Re or Im of conj(z)^k z^n with its derivatives of orders 0 to 3, each (d, ...)."""

    def __init__(self, n, k, imaginary):
        self.n, self.k, self.part = n, k, np.imag if imaginary else np.real

    def __call__(self, xy):
        z = xy[..., 0] + 1j * xy[..., 1]
        n, k = self.n, self.k
        conj = np.conj(z) ** k
        factors = (1, n, n * (n - 1), n * (n - 1) * (n - 2))
        powers = [c * z ** max(n - i, 0) for i, c in enumerate(factors)]
        orders = []
        for order in range(4):
            by_z, by_c = conj * powers[order], k * powers[order - 1] if order else 0 * z
            # d/dx = d/dz + d/dconj and d/dy = i (d/dz - d/dconj); two by conj are never left.
            orders.append([1j**j * (by_z + (order - 2 * j) * by_c) for j in range(order + 1)])
        return [np.stack([self.part(f) for f in order]) for order in orders]


HELD = ["disc", "simply supported disc", "ellipse", "annulus", "clamped rectangle", "cantilever", "every kind"]


@pytest.mark.parametrize("name, degree", [*((name, 5) for name in PLATES), *((n, d) for n in HELD for d in (7, 10))])
def test_biharmonic_polynomials_come_back_from_their_rim_data(name, degree):
    mesh, supports = PLATES[name]
    supports = supports or dict(zip("abcdef", (C, S, F, S, F, C), strict=True))
    model = PlateModel(mesh, supports, LAW, degree=degree)
    rim, polynomials = model.space.rim, [Goursat(n, k, imaginary) for n, k in CASES for imaginary in (False, True)]
    traces = [rim_traces(polynomial(rim.points), rim.normal, LAW).ravel() for polynomial in polynomials]
    given = np.stack(traces, axis=1)
    found = model.solve(model.space.load(LAW) @ given) if degree == 5 else model.condensed.follow(given)
    points, _ = model.space.quadrature
    value, gradient, hessian = model.space.evaluate(points, found, orders=3)
    for column, polynomial in enumerate(polynomials):
        got = [value[:, column], gradient[:, column].T, hessian[:, column][:, [0, 0, 1], [0, 1, 1]].T]
        truth = polynomial(points)
        if model.rigid.size:  # compared but for the motion that is nearest to the difference
            motions = model.motions(points)
            free = np.linalg.lstsq(motions, truth[0][0] - got[0], rcond=None)[0]
            got[0] = got[0] + motions @ free
            got[1] = got[1] + (model.rigid @ free)[1:, None]
        for f, t, bound in zip(got, truth[:3], (1e-9, 1e-8, 5e-7), strict=True):
            assert np.abs(f - t).max() < bound, (polynomial.n, polynomial.k, polynomial.part)


@pytest.mark.parametrize("nu", [0.0, 0.45])
def test_whatever_poissons_ratio(nu):
    mesh, supports = PLATES["every kind"]
    law = bending_law(nu)
    model, polynomial = PlateModel(mesh, supports, law), Goursat(4, 1, True)
    rim = model.space.rim
    found = model.solve(model.space.load(law) @ rim_traces(polynomial(rim.points), rim.normal, bending_law(nu)).ravel())
    points, _ = model.space.quadrature
    assert np.abs(model.space.evaluate(points, found[:, None], 1)[0].T - polynomial(points)[0]).max() < 1e-10


@pytest.mark.parametrize("shape", ["disc", "ellipse", "annulus"])
def test_rim_points_lie_on_the_true_curve(shape):
    mesh, supports = PLATES[shape]
    points = PlateModel(mesh, supports, LAW).space.rim.points * mesh.size
    assert np.abs(mesh.outline.gap(points)).max() < 1e-15
