"""Equations (3)-(5) of the paper (Kogut and Etsion's contact), integrated anew by adaptive quadrature.

With its misprints corrected: K belongs to (3) as well, and the gap of an asperity that does not touch is eps + d - z.
"""

import math

import pytest
from scipy.integrate import quad

from particle import KogutEtsion

PRINTED = (-0.01, 0.09, -0.4, 0.85)
UNROUNDED = [1.03 * c for c in (-0.007, 0.085, -0.389, 0.822)]


def literal(
    d, shear=PRINTED, psi=2.5, nu=0.3, beta=0.0601, eps=0.3 / 20, h=1.96133e9, area=1e-8, energy=1.0, sigma=20e-9
):
    """P, F_s and Q [N] at d [sigma], all lengths over sigma."""
    s = math.sqrt(1 - 3.717e-4 / beta**2)
    w = s / psi**2
    k = 0.454 + 0.41 * nu
    theta = energy / (sigma * h)

    def phi(z):
        return math.exp(-0.5 * (z / s) ** 2) / (math.sqrt(2 * math.pi) * s)

    def integral(f, low, high):
        low, high = (d + w * low), min(d + w * high, d + 12.0)
        cuts = [low + (high - low) * i / 24 for i in range(25)] if high > low else []
        return math.fsum(
            quad(f, a, b, epsabs=0, epsrel=1e-12, limit=200)[0] for a, b in zip(cuts, cuts[1:], strict=False)
        )

    def i(b, low, high):
        return integral(lambda z: ((z - d) / w) ** b * phi(z), low, high)

    def j(b, c, low, high):
        return (eps / w) ** c * i(b, low, high)

    def j_nc(x):  # over the gap x = eps + d - z
        return 4 / 3 * ((eps / x) ** 2 - 0.25 * (eps / x) ** 8) * phi(eps + d - x)

    edges = [eps * 1.6**n for n in range(16)] + [eps + d + 12.0]
    near = math.fsum(
        quad(j_nc, a, b, epsabs=0, epsrel=1e-12, limit=200)[0] for a, b in zip(edges, edges[1:], strict=False)
    )
    unit = h * area * math.pi * beta
    load = i(1.5, 0, 1) + 1.03 * i(1.425, 1, 6) + 1.4 * i(1.263, 6, 110) + 3 / k * i(1.0, 110, math.inf)
    adhesion = near + 0.98 * j(0.298, -0.29, 0, 1) + 0.79 * j(0.356, -0.321, 1, 6) + 1.19 * j(0.093, -0.332, 6, 110)
    powers = (4.425, 3.425, 2.425, 1.425)
    friction = 0.52 * i(0.982, 0, 1) + math.fsum(c * i(b, 1, 6) for c, b in zip(shear, powers, strict=True))
    return 2 / 3 * unit * k * w * load, 2 * unit * theta * adhesion, 2 / 3 * unit * k * w * friction


@pytest.mark.parametrize("d", [0.5, 2.0, 3.0, 4.5])
@pytest.mark.parametrize("psi", [0.6, 2.5, 4.9128])
def test_load_adhesion_and_friction_are_the_equations_integrals(d, psi):
    """A plasticity index of 0.6 has all ranges at once; at 2.5 and more the last reaches far into the tail."""
    assert KogutEtsion(plasticity_index=psi).forces(d) == pytest.approx(literal(d, psi=psi), rel=1e-9)


def test_unrounded_friction_is_its_own_fit():
    assert KogutEtsion(coefficients="unrounded").forces(2.5) == pytest.approx(literal(2.5, UNROUNDED), rel=1e-9)


@pytest.mark.parametrize(
    "ours, theirs",
    [
        ({"roughness": 35e-9}, {"sigma": 35e-9, "eps": 0.3 / 35}),
        ({"contact_area": 3e-8}, {"area": 3e-8}),
        ({"hardness": 1e9}, {"h": 1e9}),
        ({"poisson_ratio": 0.17}, {"nu": 0.17}),
        ({"adhesion_energy": 0.4}, {"energy": 0.4}),
        ({"asperity_beta": 0.04}, {"beta": 0.04}),
        ({"intermolecular_distance": 0.5e-9}, {"eps": 0.5 / 20}),
    ],
    ids=lambda fields: next(iter(fields)),
)
def test_every_parameter_enters_as_in_the_equations(ours, theirs):
    assert KogutEtsion(**ours).forces(3.0) == pytest.approx(literal(3.0, **theirs), rel=1e-9)
