"""Corner functions: what a plate does at an obtuse or re-entrant corner between simply supported sides, in closed form.

With r and theta from the corner, theta = 0 along one side and omega along the other, and alpha = pi / omega,

    r^(k alpha) sin(k alpha theta)   and   r^(2 +- k alpha) sin(k alpha theta)

meet the supports of both sides and carry no load (Williams, 1952). Where the corner is nearly straight the exponent is
close to 1: no grading of cells follows that, as the energy within a radius r falls only as r^(2 alpha - 2). With
zeta = r e^(i theta) they are Im zeta^p and Im conj(zeta) zeta^q.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_plate.elements.rim import RIM_POINTS, RimQuadrature, unit_gauss
from fem_plate.types import ComplexArray, FloatArray

ON_SIDE = 1e-9  # of the plate's size: how far off the line of a side a point of it may lie
FLOOR = 1e-12  # of the plate's size: closer to a corner than that second derivatives grow no more


@dataclass(frozen=True)
class CornerFunction:
    """Im zeta^power, or Im conj(zeta) zeta^power, around a corner.

    place: of the corner.  along: direction of the side theta = 0 [rad].  angle: omega.  middle: the theta opposite to
    which the plane is cut.
    """

    place: complex
    along: float
    angle: float
    middle: float
    power: float
    conjugate: bool

    @property
    def exponent(self) -> float:
        """That of r."""
        return self.power + self.conjugate

    def derivatives(self, z: ComplexArray, orders: int) -> list[list[FloatArray]]:
        """The first `orders` of value, first, second and third derivatives at points of any shape, as DERIVATIVES."""
        turn = np.exp(-1j * (self.along + self.middle))
        zeta = (z - self.place) * turn
        zeta = np.where(np.abs(zeta) < FLOOR, FLOOR, zeta)
        # Both are functions of z and conj(z): D[a] = d^a/dz^a, E[a] = d/dconj(z) of that.
        part = np.exp(1j * (self.power - self.conjugate) * self.middle) * zeta ** (self.power - orders + 1)
        factor, powers = 1.0, []
        for k in range(orders):
            powers.append(factor * turn**k * part * zeta ** (orders - 1 - k))
            factor *= self.power - k
        if self.conjugate:
            D, E = [np.conj(zeta) * p for p in powers], [np.conj(turn) * p for p in powers]
        else:
            D, E = powers, [np.zeros_like(p) for p in powers]
        found = [[D[0].imag]]
        if orders > 1:
            found.append([(D[1] + E[0]).imag, (D[1] - E[0]).real])
        if orders > 2:
            found.append([(D[2] + 2 * E[1]).imag, D[2].real, (2 * E[1] - D[2]).imag])
        if orders > 3:
            third = [(D[3] + 3 * E[2]).imag, (D[3] + E[2]).real, (E[2] - D[3]).imag, (3 * E[2] - D[3]).real]
            found.append(third)
        return found


@dataclass(frozen=True, eq=False)
class CornerFunctions:
    """E corner functions."""

    functions: Sequence[CornerFunction]

    def __len__(self) -> int:
        return len(self.functions)

    def derivatives(self, xy: FloatArray, orders: int) -> list[FloatArray]:
        """Value, first, second and third derivatives, the first `orders`, at points (..., 2): each (d, ..., E)."""
        z = xy[..., 0] + 1j * xy[..., 1]
        each = [function.derivatives(z, orders) for function in self.functions]
        return [np.stack([np.stack(one[order]) for one in each], axis=-1) for order in range(orders)]

    def at_rim(self, rim: RimQuadrature) -> tuple[list[FloatArray], list[FloatArray]]:
        """Derivatives of orders 0 to 3 at the rim's points, each (d, k, n, E): as functions, and to integrate with.

        The first are exactly 0 along the sides of a function's own corner. The second are, on edges that end in this
        corner, such that Gauss' rule integrates them times a polynomial exactly: the infinite part that is left out
        (Hadamard) also cancels from the integrals over plate and rim.
        """
        known = self.derivatives(rim.points, 4)
        to_integrate = [order.copy() for order in known]
        held = (rim.c[:, 0] > 0) & (np.trace(rim.T[:, 0], axis1=1, axis2=2) < 1.5)
        z = rim.points[..., 0] + 1j * rim.points[..., 1]
        for index, function in enumerate(self.functions):
            zeta = (z - function.place) * np.exp(-1j * function.along)
            for direction in (1.0, np.exp(-1j * function.angle)):
                turned = zeta * direction
                own = held & (np.abs(turned.imag) < ON_SIDE).all(axis=1) & (turned.real > -ON_SIDE).all(axis=1)
                for values in known:
                    values[:, own, :, index] = 0.0
                to_integrate[0][:, own, :, index] = 0.0
                for from_start, at in ((True, 0), (False, -1)):
                    for edge in np.flatnonzero(own & (np.abs(turned[:, at]) < ON_SIDE)).tolist():
                        for order, values in enumerate(to_integrate):
                            weights = singular_weights(function.exponent - order)
                            values[:, edge, :, index] *= np.pad(weights if from_start else weights[::-1], 1)
        return known, to_integrate


@lru_cache
def singular_weights(exponent: float) -> FloatArray:
    """What to multiply s^exponent with at Gauss' points s in (0, 1), so that it is integrated exactly: (RIM_POINTS,).

    Against polynomials of degree below RIM_POINTS; where the integral is infinite, its finite part (Hadamard).
    """
    s, _ = unit_gauss(RIM_POINTS)
    factor, moment = np.zeros(RIM_POINTS), 1 / (exponent + 1)
    for n in range(RIM_POINTS):
        # int s^e P_n(2 s - 1) ds = e (e - 1) ... (e - n + 1) / ((e + 1) ... (e + n + 1))
        factor += (2 * n + 1) * moment * np.polynomial.legendre.Legendre.basis(n)(2 * s - 1)
        moment *= (exponent - n) / (exponent + n + 2)
    return np.asarray(factor / s**exponent)
