"""Infinite plates of any elastic law under a unit force: Lekhnitskii's solution.

A function f(x + m y) needs no load where m is a root of

    p(m) = l_00 + 2 l_01 m + (2 l_02 + l_11) m^2 + 2 l_12 m^3 + l_22 m^4,

with l the law of M(v):H(q). The roots come in conjugate pairs. With m_1 and m_2 of positive imaginary part and
g(z) = z^2 ln z, F is the real part of a g(x + m_1 y) + b (g(x + m_2 y) - g(x + m_1 y)) / (m_2 - m_1). It has one value
at each point and the unit load at the origin where Im of a, a m_1 + b, a m_1^2 + b (m_1 + m_2) is 0, and of
a m_1^3 + b (m_1^2 + m_1 m_2 + m_2^2) is 1 / (4 pi l_22) (Lekhnitskii, Anisotropic Plates, 1968). The quotient keeps its
digits where the roots all but coincide: there it is an integral.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from fem_plate.elements.infinite import ORDERS, Derivatives, InfinitePlate, IsotropicPlate
from fem_plate.elements.rim import unit_gauss
from fem_plate.types import ComplexArray, FloatArray

CLOSE = 0.25  # of the smaller imaginary part: roots closer than this take the integral
NODES = 12  # of that integral
ROUNDING = 1e-14  # of an entry of a law


@dataclass(frozen=True, eq=False)
class AnisotropicPlate(InfinitePlate):
    """Infinite plates without a tension, each of the law (3, 3) of M(v):H(q), in xx, xy, yy, at its force.

    laws: one law, or what gives the laws (N, 3, 3) at places (N, 2).
    """

    laws: FloatArray | Callable[[FloatArray], FloatArray]
    known: dict[bytes, FloatArray] = field(default_factory=dict)  # laws, by their places

    def derivatives(self, offset: FloatArray, sources: FloatArray, orders: Sequence[int]) -> Derivatives:
        laws = self._laws_at(sources)
        if len(laws) and (laws == laws[0]).all():
            return _of_law(laws[0], offset, orders)
        results = [[np.zeros(offset.shape[:-1]) for _ in ORDERS[order]] for order in orders]
        for k, law in enumerate(laws):
            for result, found in zip(results, _of_law(law, offset[..., k, :], orders), strict=True):
                for whole, part in zip(result, found, strict=True):
                    whole[..., k] = part
        return results

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """Those of r^4 over what a plate of one law carries by it; 0 where laws vary: elements follow all of Q."""
        if callable(self.laws):
            return [np.zeros((order + 1, *xy.shape[:-1])) for order in range(4)]
        own = self.laws
        load = 24 * (own[0, 0] + own[2, 2]) + 8 * (2 * own[0, 2] + own[1, 1])
        return [64 / load * order for order in IsotropicPlate().pressure_derivatives(xy)]

    def _laws_at(self, sources: FloatArray) -> FloatArray:
        if not callable(self.laws):
            return np.broadcast_to(self.laws, (len(sources), 3, 3))
        key = sources.tobytes()
        if key not in self.known:
            self.known[key] = self.laws(sources) if len(sources) else np.empty((0, 3, 3))
        return self.known[key]


def infinite_plate(law: FloatArray, tension: float) -> InfinitePlate:
    """The infinite plate of one law (3, 3) over its rigidity; isotropic if it has a tension."""
    return IsotropicPlate(tension) if is_isotropic(law) else AnisotropicPlate(law)


def is_isotropic(law: FloatArray) -> bool:
    """Whether a law (3, 3) over its rigidity is that of an isotropic plate."""
    nu = law[0, 2]
    return bool(np.abs(law - [[1, 0, nu], [0, 2 * (1 - nu), 0], [nu, 0, 1]]).max() <= ROUNDING)


def _of_law(law: FloatArray, offset: FloatArray, orders: Sequence[int]) -> Derivatives:
    """The derivatives of some orders of F at offsets (..., 2) from a unit force, none 0."""
    rigidity = float(law[0, 0])
    if is_isotropic(law / rigidity):
        plain = IsotropicPlate().derivatives(offset, np.zeros((0, 2)), orders)
        return [[part / rigidity for part in order] for order in plain]
    x, y = np.moveaxis(offset, -1, 0)
    turned = x + 1j * y
    logarithm = np.log(np.abs(turned))
    results = [[np.zeros(x.shape) for _ in ORDERS[order]] for order in orders]
    for m, weight, rate in _terms(law.tobytes()):
        z = x + m * y
        # ln z less the angle of (x, y), which the sum of all terms does not hold: that has one value at each point.
        own = logarithm + np.log(z / turned)
        for order, result in zip(orders, results, strict=True):
            of_z = _of_square_logarithm(z, own, order)
            more = y * _of_square_logarithm(z, own, order + 1) if rate else 0.0
            for part, (_, k) in zip(result, ORDERS[order], strict=True):
                part += ((weight * m**k + (rate * k * m ** (k - 1) if k else 0.0)) * of_z + rate * m**k * more).real
    return results


@lru_cache(maxsize=256)
def _terms(law_bytes: bytes) -> list[tuple[complex, complex, complex]]:
    """Roots m of a law with the weights of g(x + m y) and of its derivative in m."""
    law = np.frombuffer(law_bytes).reshape(3, 3)
    roots = np.roots([law[2, 2], 2 * law[1, 2], 2 * law[0, 2] + law[1, 1], 2 * law[0, 1], law[0, 0]])
    m, n = sorted(roots[roots.imag > 0].tolist(), key=lambda m: (m.imag, m.real))
    powers = np.array([[1, m, m**2, m**3], [0, 1, m + n, m**2 + m * n + n**2]]).T
    # Im(powers (a, b)) in the real and imaginary parts of a and b.
    rows = np.concatenate([powers.imag, powers.real], axis=1)
    a_real, b_real, a_imag, b_imag = np.linalg.solve(rows, [0.0, 0.0, 0.0, 1 / (4 * np.pi * law[2, 2])])
    a, b = complex(a_real, a_imag), complex(b_real, b_imag)
    if abs(n - m) > CLOSE * min(m.imag, n.imag):
        return [(m, a - b / (n - m), 0j), (n, b / (n - m), 0j)]
    nodes, weights = unit_gauss(NODES)
    between = [(m + s * (n - m), 0j, b * weight) for s, weight in zip(nodes.tolist(), weights.tolist(), strict=True)]
    return [(m, a, 0j), *between]


def _of_square_logarithm(z: ComplexArray, logarithm: ComplexArray, order: int) -> ComplexArray:
    """The derivative of an order, 0 to 4, of z^2 ln z."""
    if order < 2:
        return z * (2 * logarithm + 1) if order else z**2 * logarithm
    return np.asarray([2 * logarithm + 3, 2 / z, -2 / z**2][order - 2])
