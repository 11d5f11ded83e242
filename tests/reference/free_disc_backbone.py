"""The first axisymmetric mode of a free disc, and how stretching stiffens it, by Bessel functions and quadrature."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import i0, i1, j0, j1


def backbone(nu):
    """lambda^2, and kappa of omega^2 = omega_1^2 (1 + kappa (A/t)^2), with A at the centre; D = t = a = 1."""

    def moment(x):  # of J0(x r) + c I0(x r) at the rim, where c frees it from shear
        c = -j1(x) / i1(x)
        slope, bend = -x * j1(x) + c * x * i1(x), x**2 * (-j0(x) + j1(x) / x + c * (i0(x) - i1(x) / x))
        return bend + nu * slope

    x = brentq(moment, 2.5, 3.5)
    c = -j1(x) / i1(x)
    stiff = 12 * (1 - nu**2)  # E t

    def w(r):
        return (j0(x * r) + c * i0(x * r)) / (1 + c)

    def slope(r):
        return x * (-j1(x * r) + c * i1(x * r)) / (1 + c)

    # Compatibility, (r^3 N')' = -E t/2 r w'^2, twice integrated, on Gauss points of panels; N vanishes at the rim.
    nodes, weights = np.polynomial.legendre.leggauss(60)
    r, weights = (nodes + 1) / 2, weights / 2
    rate = np.array([-stiff / 2 * quad(lambda s: s * slope(s) ** 2, 0, at, epsabs=1e-14)[0] / at**3 for at in r])
    # A polynomial through them is exact to rounding: N' is analytic.
    series = np.polynomial.legendre.Legendre.fit(r, rate, 40, domain=[0, 1])
    radial = series.integ()(r) - series.integ()(1.0)
    hoop = radial + r * rate
    area = 2 * np.pi * r * weights
    stretching = area @ (radial**2 + hoop**2 - 2 * nu * radial * hoop) / (2 * stiff)
    return x**2, 3 * stretching / (x**4 * area @ w(r) ** 2)
