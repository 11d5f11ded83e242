"""The infinite plate of any elastic law that is the same everywhere, under a unit force: Lekhnitskii's solution.

A function f(x + m y) needs no load where m is a root of

    p(m) = l_00 + 2 l_01 m + (2 l_02 + l_11) m^2 + 2 l_12 m^3 + l_22 m^4,

with l the law of M(v):H(q). The roots come in conjugate pairs. With m_1 and m_2 of positive imaginary part and
g(z) = z^2 ln z, the response is the real part of a g(x + m_1 y) + b (g(x + m_2 y) - g(x + m_1 y)) / (m_2 - m_1). It has
one value at each point and the unit load at the origin where Im of a, a m_1 + b, a m_1^2 + b (m_1 + m_2) is 0, and of
a m_1^3 + b (m_1^2 + m_1 m_2 + m_2^2) is 1 / (4 pi l_22) (Lekhnitskii, Anisotropic Plates, 1968). The quotient keeps its
digits where the roots all but coincide: there it is an integral.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_plate.elements.infinite import InfinitePlate, Radial
from fem_plate.elements.rim import unit_gauss
from fem_plate.elements.singular import UNIT_STRENGTH
from fem_plate.types import ComplexArray, FloatArray

CLOSE = 0.25  # of the smaller imaginary part: roots closer than this take the integral
NODES = 12  # of that integral
ROUNDING = 1e-14  # of an entry of a law
ORDERS = [[(order - k, k) for k in range(order + 1)] for order in range(4)]  # x and y times of each derivative


@dataclass(frozen=True, eq=False)
class AnisotropicPlate(InfinitePlate):
    """The infinite plate of one law without a tension."""

    law: FloatArray  # (3, 3), of M(v):H(q) in xx, xy, yy

    @cached_property
    def _roots(self) -> tuple[complex, complex]:
        own = self.law
        roots = np.roots([own[2, 2], 2 * own[1, 2], 2 * own[0, 2] + own[1, 1], 2 * own[0, 1], own[0, 0]])
        first, second = sorted(roots[roots.imag > 0].tolist(), key=lambda m: (m.imag, m.real))
        return first, second

    @cached_property
    def _terms(self) -> list[tuple[complex, complex, complex]]:
        """Roots m with the weights of g(x + m y) and of its derivative in m."""
        m, n = self._roots
        powers = np.array([[1, m, m**2, m**3], [0, 1, m + n, m**2 + m * n + n**2]]).T
        # Im(powers (a, b)) in the real and imaginary parts of a and b.
        rows = np.concatenate([powers.imag, powers.real], axis=1)
        a_real, b_real, a_imag, b_imag = np.linalg.solve(rows, [0.0, 0.0, 0.0, 1 / (4 * np.pi * self.law[2, 2])])
        a, b = complex(a_real, a_imag), complex(b_real, b_imag)
        if abs(n - m) > CLOSE * min(m.imag, n.imag):
            return [(m, a - b / (n - m), 0j), (n, b / (n - m), 0j)]
        nodes, weights = unit_gauss(NODES)
        between = [
            (m + s * (n - m), 0j, b * weight) for s, weight in zip(nodes.tolist(), weights.tolist(), strict=True)
        ]
        return [(m, a, 0j), *between]

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        offset = xy[:, None] - sources
        at_source = (offset == 0).all(axis=-1)
        (value,), slopes, (xx, x_y, yy) = self._derivatives(np.where(at_source[..., None], 1.0, offset), range(3))
        hessian = np.stack([np.stack([xx, x_y], -1), np.stack([x_y, yy], -1)], -1)
        hessian[at_source] = [[-np.inf, 0.0], [0.0, -np.inf]]
        off = ~at_source
        return value * off, np.stack(slopes, -1) * off[..., None], hessian

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        offset = xy[:, None] - sources
        at_source = (offset == 0).all(axis=-1)
        (value,) = self._derivatives(np.where(at_source[..., None], 1.0, offset), [0])[0]
        return np.where(at_source, 0.0, value)

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        offset = xy[:, None] - sources
        at_source = (offset == 0).all(axis=-1)
        offset = np.where(at_source[..., None], [floor, 0.0], offset)
        xx, _, yy = self._derivatives(offset, [2])[0]
        square = (offset**2).sum(axis=-1)
        growth = sum((weight * (1 + m**2) + rate * 2 * m).real for m, weight, rate in self._terms)  # times ln r^2
        inside = np.minimum(np.where(at_source, 0.0, square) / floor**2, 1.0)
        by_angle = xx + yy - growth * np.log(square)
        return np.asarray(growth * np.log(np.maximum(square, floor**2)) + by_angle * inside)

    def point_derivatives(self, xy: FloatArray, source: FloatArray) -> list[FloatArray]:
        return [np.stack(order) for order in self._derivatives(xy - source, range(4))]

    def radial(self, xy: FloatArray, source: FloatArray) -> Radial:
        (x, y), ((value,),) = np.moveaxis(xy - source, -1, 0), self._derivatives(xy - source, [0])
        squares = [(weight * (x + m * y) ** 2 + rate * 2 * y * (x + m * y)).real for m, weight, rate in self._terms]
        return Radial(value, np.asarray(sum(squares)))

    def logarithms(self, sources: FloatArray) -> FloatArray:
        mean = sum((weight * (1 + m**2) / 2 + rate * m).real for m, weight, rate in self._terms)  # of r^2 ln r
        return np.full(len(sources), mean / UNIT_STRENGTH)

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """Those of r^4 over what a plate of this law carries by it."""
        own = self.law
        load = 24 * (own[0, 0] + own[2, 2]) + 8 * (2 * own[0, 2] + own[1, 1])
        return [64 / load * order for order in super().pressure_derivatives(xy)]

    def _derivatives(self, offset: FloatArray, orders: Sequence[int]) -> list[list[FloatArray]]:
        """The derivatives of some orders, each [(...)], at offsets (..., 2) from the force, none 0."""
        x, y = np.moveaxis(offset, -1, 0)
        turned = x + 1j * y
        logarithm = np.log(np.abs(turned))
        results = [[np.zeros(x.shape) for _ in ORDERS[order]] for order in orders]
        for m, weight, rate in self._terms:
            z = x + m * y
            # ln z less the angle of (x, y), which the sum of all terms does not hold: that has one value at each point.
            own = logarithm + np.log(z / turned)
            for order, result in zip(orders, results, strict=True):
                of_z = _of_square_logarithm(z, own, order)
                more = y * _of_square_logarithm(z, own, order + 1) if rate else 0.0
                for part, (_, k) in zip(result, ORDERS[order], strict=True):
                    part += ((weight * m**k + (rate * k * m ** (k - 1) if k else 0.0)) * of_z + rate * m**k * more).real
        return results


def is_isotropic(law: FloatArray) -> bool:
    """Whether a law (3, 3) over its rigidity is that of an isotropic plate."""
    nu = law[0, 2]
    return bool(np.abs(law - [[1, 0, nu], [0, 2 * (1 - nu), 0], [nu, 0, 1]]).max() <= ROUNDING)


def _of_square_logarithm(z: ComplexArray, logarithm: ComplexArray, order: int) -> ComplexArray:
    """The derivative of an order, 0 to 4, of z^2 ln z."""
    if order < 2:
        return z * (2 * logarithm + 1) if order else z**2 * logarithm
    return np.asarray([2 * logarithm + 3, 2 / z, -2 / z**2][order - 2])
