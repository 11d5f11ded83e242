"""Kogut and Etsion's contact by mpmath's quadrature in 30 digits, with the misprints of (3)-(5) corrected."""

from functools import cache

import mpmath as mp

DIGITS = 30
REACH = 12  # widths
SHEAR = {"printed": (1, "-0.01", "0.09", "-0.4", "0.85"), "unrounded": ("1.03", "-0.007", "0.085", "-0.389", "0.822")}


def forces(contact, d):
    """P, F_s and Q [N] of a KogutEtsion at the separation d, for its parameters as the floats that they are."""
    with mp.workdps(DIGITS):
        of = mp.mpf
        d, psi, nu, beta = of(d), of(contact.plasticity_index), of(contact.poisson_ratio), of(contact.asperity_beta)
        s = mp.sqrt(1 - of("3.717e-4") / beta**2)
        w, k = s / psi**2, of("0.454") + of("0.41") * nu
        eps = of(contact.intermolecular_distance) / of(contact.roughness)
        theta = of(contact.adhesion_energy) / (of(contact.roughness) * of(contact.hardness))

        narrow, top = -1 / (2 * s**2), 1 / (mp.sqrt(2 * mp.pi) * s)

        def phi(z):
            return top * mp.exp(narrow * z**2)

        @cache
        def at(x):
            """What all integrals over the same range share at a point of it."""
            return mp.log(x / w), phi(d + x)

        def integrand(x, b):
            log, density = at(x)
            return density * mp.exp(b * log)

        def attraction(x):
            square = (eps / x) ** 2
            return (square - square**4 / 4) * phi(eps + d - x)

        @cache
        def i(b, low, high):
            low, high = low * w, min(high * w, REACH * s + max(-d, 0))
            if high <= low:
                return of(0)
            cuts = [low]
            while cuts[-1] < high:
                cuts.append(min(high, cuts[-1] + s))
            return mp.quad(lambda x: integrand(x, of(b)), cuts)

        def j(b, c, low, high):
            return i(b, low, high) * (eps / w) ** of(c)

        gaps = [eps * 2**n for n in range(12) if eps * 2**n < 3 * s]
        while gaps[-1] < eps + d + REACH * s:
            gaps.append(min(gaps[-1] + s, eps + d + REACH * s))
        near = of(4) / 3 * mp.quad(attraction, gaps)
        load = i("1.5", 0, 1) + of("1.03") * i("1.425", 1, 6) + of("1.4") * i("1.263", 6, 110)
        load += 3 / k * i(1, 110, mp.inf)
        adhesion = near + of("0.98") * j("0.298", "-0.29", 0, 1) + of("0.79") * j("0.356", "-0.321", 1, 6)
        adhesion += of("1.19") * j("0.093", "-0.332", 6, 110)
        factor, *bracket = map(of, SHEAR[contact.coefficients])
        powers = ("4.425", "3.425", "2.425", "1.425")
        shear = sum(c * i(b, 1, 6) for c, b in zip(bracket, powers, strict=True))
        friction = of("0.52") * i("0.982", 0, 1) + factor * shear
        unit = of(contact.hardness) * of(contact.contact_area) * mp.pi * beta
        return of(2) / 3 * unit * k * w * load, 2 * unit * theta * adhesion, of(2) / 3 * unit * k * w * friction


def net_load(contact, d):
    """P - F_s [N]."""
    load, adhesion, _ = forces(contact, d)
    return load - adhesion


def friction_limit(contact, load, near):
    """Q [N] under a net load [N] whose separation is `near` but for rounding, which one step of Newton mends."""
    with mp.workdps(DIGITS):
        d, h = mp.mpf(near), mp.mpf("1e-9")
        (p_0, f_0, q_0), (p_1, f_1, q_1) = forces(contact, d), forces(contact, d - h)
        return q_0 + (q_1 - q_0) / (p_1 - f_1 - p_0 + f_0) * (mp.mpf(load) - p_0 + f_0)
