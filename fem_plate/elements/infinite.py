"""Infinite plates: their responses to loads in closed form, what finite elements need not approximate.

A unit force deflects a plate by F and a unit pressure by Q, all dimensionless. An isotropic plate has
F = r^2 ln(r) / (8 pi), which no polynomial can follow, and Q = r^4 / 64 (laplace^2 F = delta, laplace^2 Q = 1).
Under a tension beta^2 (negative: a compression) they solve laplace^2 w - beta^2 laplace w = load. With
t = beta^2 r^2 / 4 and the harmonic numbers H_k

    F = sum_{k >= 1} t^k / k!^2 (ln r + c - H_k) / (2 pi beta^2).

Any constant c will do, as I_0(beta r) needs no load. With c = ln(|beta| / 2) + gamma and z = |beta| r that is

    -(c + ln r + K_0(z)) / (2 pi beta^2),   in compression   -(c + ln r - pi/2 Y_0(z)) / (2 pi beta^2).

The series serves small z, where these cancel. Close to the force F is r^2 ln r / (8 pi) whatever the tension.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from scipy.special import k0, k1, y0, y1

from fem_plate.types import BoolArray, FloatArray

UNIT_STRENGTH = 1 / (8 * np.pi)
SERIES = 2.0  # |t| up to which the series is used
WEAK = 1.0  # |beta^2| below which nothing else is used: on a plate r^2 <= 8
TERMS = np.arange(1.0, 17.0)  # k
PER_TERM = 1 / np.cumprod(TERMS) ** 2  # 1 / k!^2
HARMONIC = np.cumsum(1 / TERMS)
# (1/r d/dr)^m F, m = 0 to 3, is (2 / r^2)^m r^2 / (8 pi) sum t^(k - 1) / k!^2 (a (ln r + c - H_k) + b) with these a, b:
OF_LOGARITHM = np.stack([TERMS**0, TERMS, TERMS * (TERMS - 1), TERMS * (TERMS - 1) * (TERMS - 2)])
OF_ONE = np.stack([0 * TERMS, 0 * TERMS + 0.5, TERMS - 0.5, 1.5 * TERMS**2 - 3 * TERMS + 1])
ORDERS = [[(order - k, k) for k in range(order + 1)] for order in range(4)]  # x and y times of each derivative
ROUND = np.stack([f(2 * np.pi * np.arange(8) / 8) for f in (np.cos, np.sin)], axis=-1)  # directions

Derivatives = list[list[FloatArray]]  # of some orders, each in the sequence of ORDERS


class Radial(NamedTuple):
    """F = r^2 (A + B ln r) at points (...), with A and B of the direction alone."""

    value: FloatArray  # F
    square: FloatArray  # r^2 B

    def mean(self, power: int) -> FloatArray:
        """int F(s) (s/r)^power s ds / r^2 along the ray from the force to each point."""
        return self.value / (power + 4) - self.square / (power + 4) ** 2


class InfinitePlate(ABC):
    """An infinite plate. Its responses to forces follow from their derivatives."""

    @abstractmethod
    def derivatives(self, offset: FloatArray, sources: FloatArray, orders: Sequence[int]) -> Derivatives:
        """Derivatives of F, each (..., N), at offsets (..., N, 2), none 0, from unit forces at sources (N, 2)."""

    @abstractmethod
    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """The derivatives of orders 0 to 3, each (d, ...), of Q at points (..., 2)."""

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """F around each source.

        xy: (n, 2).  sources: (N, 2).  Returns the value (n, N), gradient (n, N, 2) and Hessian (n, N, 2, 2). At a
        source, value and gradient are 0 and the diagonal of the Hessian is -inf.
        """
        offset, at_source = _offsets(xy, sources)
        (value,), slopes, (xx, x_y, yy) = self.derivatives(offset, sources, range(3))
        gradient = np.stack(slopes, -1)
        hessian = np.stack([np.stack([xx, x_y], -1), np.stack([x_y, yy], -1)], -1)
        value[at_source], gradient[at_source], hessian[at_source] = 0.0, 0.0, [[-np.inf, 0.0], [0.0, -np.inf]]
        return value, gradient, hessian

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        """F alone, (n, N)."""
        offset, at_source = _offsets(xy, sources)
        ((value,),) = self.derivatives(offset, sources, [0])
        value[at_source] = 0.0
        return value

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        """The Laplacian of F, (n, N); within the radius `floor` it grows no more, and is continuous there."""
        offset, at_source = _offsets(xy, sources)
        offset[at_source] = floor, 0.0
        ((xx, _, yy),) = self.derivatives(offset, sources, [2])
        square = (offset**2).sum(axis=-1)
        growth = 2 * UNIT_STRENGTH * self.logarithms(sources)  # times ln r^2
        inside = np.minimum(np.where(at_source, 0.0, square) / floor**2, 1.0)
        by_angle = xx + yy - growth * np.log(square)
        return np.asarray(growth * np.log(np.maximum(square, floor**2)) + by_angle * inside)

    def point_derivatives(self, xy: FloatArray, source: FloatArray) -> list[FloatArray]:
        """The derivatives of orders 0 to 3, each (d, ...), of F around one source (2,) at points (..., 2) off it."""
        found = self.derivatives((xy - source)[..., None, :], source[None], range(4))
        return [np.stack(order)[..., 0] for order in found]

    def radial(self, xy: FloatArray, source: FloatArray) -> Radial:
        """F around one source (2,) at points (..., 2), without a tension."""
        value, square = self._parts((xy - source)[..., None, :], source[None])
        return Radial(value[..., 0], square[..., 0])

    def acts(self, sources: FloatArray) -> BoolArray:
        """Whether forces at sources (N, 2) act on this plate, (N,)."""
        return np.ones(len(sources), dtype=bool)

    def logarithms(self, sources: FloatArray) -> FloatArray:
        """What multiplies r^2 ln(r) / (8 pi) close to unit forces at sources (N, 2), (N,), the mean over directions."""
        around = np.broadcast_to(ROUND[:, None], (len(ROUND), *sources.shape))
        return np.asarray(self._parts(around, sources)[1].mean(axis=0) / UNIT_STRENGTH)

    def _parts(self, offset: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray]:
        """F = r^2 (A + B ln r) and r^2 B = r dF/dr - 2 F at offsets (..., N, 2)."""
        (value,), slopes = self.derivatives(offset, sources, range(2))
        return value, sum(offset[..., k] * slope for k, slope in enumerate(slopes)) - 2 * value


@dataclass(frozen=True)
class IsotropicPlate(InfinitePlate):
    """The isotropic plate of rigidity 1 under a tension."""

    tension: float = 0.0  # beta^2

    def derivatives(self, offset: FloatArray, sources: FloatArray, orders: Sequence[int]) -> Derivatives:
        return _cartesian(offset, self._force((offset**2).sum(axis=-1), max(orders) + 1), orders)

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        """F alone, (n, N); of large arrays this is what takes the time."""
        square = _squares(xy, sources)
        at_source = square == 0
        square[at_source] = 1.0
        (value,) = self._force(square, 1)
        value[at_source] = 0.0
        return value

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        """The Laplacian of F, (n, N); within the radius `floor`, of the parabola in r^2 that continues F there (C2)."""
        square = _squares(xy, sources)
        bounded = np.maximum(square, floor**2)
        _, slope, bend = self._force(bounded, 3)
        return np.asarray(2 * slope + bend * (2 * square - bounded))

    def logarithms(self, sources: FloatArray) -> FloatArray:
        return np.ones(len(sources))

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """Those of -r^2 / (4 beta^2), or of (I_0(beta r) - 1 - t) / beta^4, which is r^4 / 64 under a small tension."""
        square = (xy**2).sum(axis=-1)
        if abs(self.tension) >= WEAK:
            value = square / -4 / self.tension
            radial = [value, np.full_like(square, -0.5 / self.tension), 0 * square, 0 * square]
        else:
            t = self.tension * square / 4
            sums = [polyval(t, (PER_TERM * factor)[1:]) for factor in OF_LOGARITHM[:3]]
            third = polyval(t, (PER_TERM * OF_LOGARITHM[3])[2:])
            radial = [square**2 / 16 * sums[0], square / 8 * sums[1], sums[2] / 4, self.tension / 8 * third]
        return [np.stack(order) for order in _cartesian(xy, radial, range(4))]

    def _force(self, square: FloatArray, count: int) -> list[FloatArray]:
        """The first `count` of F, (1/r d/dr) F, ... at distances of these squares (...), none 0."""
        if not self.tension:
            logarithm = np.log(square)  # 2 ln r
            results = [UNIT_STRENGTH * 0.5 * square * logarithm]
            if count > 1:
                results.append(UNIT_STRENGTH * (logarithm + 1))
            for order in range(2, count):
                results.append(UNIT_STRENGTH * -((-2) ** (order - 1)) / square ** (order - 1))
            return results
        weak = abs(self.tension) < WEAK
        near = np.full(square.shape, True) if weak else abs(self.tension) / 4 * square <= SERIES
        results = [np.empty(square.shape) for _ in range(count)]
        for part, function in ((near, self._series), (~near, self._closed)):
            if part.any():
                for result, values in zip(results, function(square[part], count), strict=True):
                    result[part] = values
        return results

    @property
    def _constant(self) -> float:
        """c; for a weak tension not its logarithm, which would hide the rest."""
        return float(np.log(np.sqrt(max(abs(self.tension), WEAK)) / 2) + np.euler_gamma)

    def _series(self, square: FloatArray, count: int) -> list[FloatArray]:
        t, logarithm, results = self.tension / 4 * square, np.log(square) / 2 + self._constant, []
        for order in range(count):
            a, b = OF_LOGARITHM[order] * PER_TERM, OF_ONE[order] * PER_TERM
            series = logarithm * polyval(t, a) + polyval(t, b - a * HARMONIC)
            results.append(UNIT_STRENGTH * square * (2 / square) ** order * series)
        return results

    def _closed(self, square: FloatArray, count: int) -> list[FloatArray]:
        size, pulls = abs(self.tension), self.tension > 0
        inverse = 1 / (size * square)  # z^-2
        z = np.sqrt(size * square)
        bessel = [k0(z), k1(z)] if pulls else [-np.pi / 2 * y0(z), -np.pi / 2 * y1(z)]
        for order in range(2, count):
            before = bessel[-2] if pulls else -bessel[-2]
            bessel.append(before + 2 * (order - 1) / z * bessel[-1])
        powers = [np.log(square) / 2 + self._constant, -inverse, -2 * inverse**2, -8 * inverse**3]
        sign = 1.0 if pulls else -1.0
        return [
            sign / (2 * np.pi) * (-size) ** (order - 1.0) * (powers[order] + bessel[order] / z**order)
            for order in range(count)
        ]


@dataclass(frozen=True)
class InteriorForces(InfinitePlate):
    """An infinite plate that forces at some points (k, 2) do not act on: those on the rim load the elements instead."""

    plate: InfinitePlate
    rim_points: FloatArray

    def acts(self, sources: FloatArray) -> BoolArray:
        return np.asarray(~(sources[:, None] == self.rim_points).all(axis=-1).any(axis=1))

    def derivatives(self, offset: FloatArray, sources: FloatArray, orders: Sequence[int]) -> Derivatives:
        acts = self.acts(sources)
        found = self.plate.derivatives(np.where(acts[:, None], offset, 1.0), sources, orders)
        return [[np.where(acts, part, 0.0) for part in order] for order in found]

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        return self.plate.pressure_derivatives(xy)

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        value, gradient, hessian = super().point_load(xy, sources)
        hessian[:, ~self.acts(sources)] = 0.0  # at the source, too
        return value, gradient, hessian


def _offsets(xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The offsets (n, N, 2) of points from sources, and where they are 0, (n, N): another offset stands there."""
    offset = xy[:, None] - sources
    at_source = (offset == 0).all(axis=-1)
    offset[at_source] = 1.0
    return offset, at_source


def _squares(xy: FloatArray, sources: FloatArray) -> FloatArray:
    return np.asarray((xy[:, :1] - sources[:, 0]) ** 2 + (xy[:, 1:] - sources[:, 1]) ** 2)


def _cartesian(xy: FloatArray, radial: list[FloatArray], orders: Sequence[int]) -> Derivatives:
    """The derivatives of some orders at points (..., 2), from f, (1/r d/dr) f, ... there."""
    x, y = np.moveaxis(xy, -1, 0)
    results = []
    for order in orders:
        if order < 2:
            results.append([radial[1] * x, radial[1] * y] if order else [radial[0]])
            continue
        slope, bend = radial[1:3]
        if order == 2:
            results.append([slope + bend * x**2, bend * x * y, slope + bend * y**2])
            continue
        third = radial[3]
        xxx, yyy = (3 * bend + third * x**2) * x, (3 * bend + third * y**2) * y
        results.append([xxx, (bend + third * x**2) * y, (bend + third * y**2) * x, yyy])
    return results


PLAIN = IsotropicPlate()
point_load, point_value = PLAIN.point_load, PLAIN.point_value
