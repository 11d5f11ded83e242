"""The infinite plate: its responses to loads in closed form, with and without a tension.

Under a tension beta^2 (dimensionless; negative: a compression) they solve laplace^2 w - beta^2 laplace w = load. With
t = beta^2 r^2 / 4 and the harmonic numbers H_k a unit force deflects the plate by

    F = sum_{k >= 1} t^k / k!^2 (ln r + c - H_k) / (2 pi beta^2).

Any constant c will do, as I_0(beta r) needs no load. With c = ln(|beta| / 2) + gamma and z = |beta| r that is

    -(c + ln r + K_0(z)) / (2 pi beta^2),   in compression   -(c + ln r - pi/2 Y_0(z)) / (2 pi beta^2).

The series serves small z, where these cancel. Close to the force F is r^2 ln r / (8 pi) whatever the tension.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from scipy.special import k0, k1, y0, y1

from fem_plate.elements import singular
from fem_plate.types import FloatArray

SERIES = 2.0  # |t| up to which the series is used
WEAK = 1.0  # |beta^2| below which nothing else is used: on a plate r^2 <= 8
TERMS = np.arange(1.0, 17.0)  # k
PER_TERM = 1 / np.cumprod(TERMS) ** 2  # 1 / k!^2
HARMONIC = np.cumsum(1 / TERMS)
# (1/r d/dr)^m F, m = 0 to 3, is (2 / r^2)^m r^2 / (8 pi) sum t^(k - 1) / k!^2 (a (ln r + c - H_k) + b) with these a, b:
OF_LOGARITHM = np.stack([TERMS**0, TERMS, TERMS * (TERMS - 1), TERMS * (TERMS - 1) * (TERMS - 2)])
OF_ONE = np.stack([0 * TERMS, 0 * TERMS + 0.5, TERMS - 0.5, 1.5 * TERMS**2 - 3 * TERMS + 1])


class Radial(NamedTuple):
    """F = r^2 (A + B ln r) at points (...), with A and B of the direction alone."""

    value: FloatArray  # F
    square: FloatArray  # r^2 B

    def mean(self, power: int) -> FloatArray:
        """int F(s) (s/r)^power s ds / r^2 along the ray from the force to each point."""
        return self.value / (power + 4) - self.square / (power + 4) ** 2


@dataclass(frozen=True)
class InfinitePlate:
    """The infinite plate without a tension; `singular` says what its functions take and return."""

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        return singular.point_load(xy, sources)

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        return singular.point_value(xy, sources)

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        return singular.point_laplacian(xy, sources, floor)

    def point_derivatives(self, xy: FloatArray, source: FloatArray) -> list[FloatArray]:
        return singular.point_derivatives(xy, source)

    def radial(self, xy: FloatArray, source: FloatArray) -> Radial:
        """F around one source (2,) at points (..., 2)."""
        square = ((xy - source) ** 2).sum(axis=-1)
        return Radial(singular.UNIT_STRENGTH * 0.5 * square * np.log(square), singular.UNIT_STRENGTH * square)

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        return singular.pressure_derivatives(xy)

    def logarithms(self, sources: FloatArray) -> FloatArray:
        """What multiplies r^2 ln(r) / (8 pi) close to unit forces at sources (N, 2), (N,), the mean over directions."""
        return np.ones(len(sources))


@dataclass(frozen=True)
class StretchedPlate(InfinitePlate):
    """The infinite plate under a tension."""

    tension: float  # beta^2, not 0

    def point_load(self, xy: FloatArray, sources: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        offset = xy[:, None] - sources
        square = (offset**2).sum(axis=-1)
        at_source = square == 0
        value, slope, bend = self._force(np.where(at_source, 1.0, square), 3)
        gradient = slope[..., None] * offset
        hessian = bend[..., None, None] * offset[..., :, None] * offset[..., None, :]
        hessian[..., 0, 0] += np.where(at_source, -np.inf, slope)
        hessian[..., 1, 1] += np.where(at_source, -np.inf, slope)
        return np.where(at_source, 0.0, value), gradient, hessian

    def point_value(self, xy: FloatArray, sources: FloatArray) -> FloatArray:
        square = _squares(xy, sources)
        at_source = square == 0
        (value,) = self._force(np.where(at_source, 1.0, square), 1)
        return np.where(at_source, 0.0, value)

    def point_laplacian(self, xy: FloatArray, sources: FloatArray, floor: float) -> FloatArray:
        square = _squares(xy, sources)
        bounded = np.maximum(square, floor**2)
        _, slope, bend = self._force(bounded, 3)
        return np.asarray(2 * slope + bend * (2 * square - bounded))

    def point_derivatives(self, xy: FloatArray, source: FloatArray) -> list[FloatArray]:
        offset = xy - source
        return _cartesian(offset, self._force((offset**2).sum(axis=-1), 4))

    def pressure_derivatives(self, xy: FloatArray) -> list[FloatArray]:
        """Those of -r^2 / (4 beta^2), or of (I_0(beta r) - 1 - t) / beta^4, which is r^4 / 64 under a small tension."""
        square = (xy**2).sum(axis=-1)
        if abs(self.tension) >= WEAK:
            value = square / -4 / self.tension
            return _cartesian(xy, [value, np.full_like(square, -0.5 / self.tension), 0 * square, 0 * square])
        t = self.tension * square / 4
        sums = [polyval(t, (PER_TERM * factor)[1:]) for factor in OF_LOGARITHM[:3]]
        third = polyval(t, (PER_TERM * OF_LOGARITHM[3])[2:])
        return _cartesian(xy, [square**2 / 16 * sums[0], square / 8 * sums[1], sums[2] / 4, self.tension / 8 * third])

    def _force(self, square: FloatArray, count: int) -> list[FloatArray]:
        """The first `count` of F, (1/r d/dr) F, ... at distances of these squares (..., ), none 0."""
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
            results.append(singular.UNIT_STRENGTH * square * (2 / square) ** order * series)
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


def infinite_plate(tension: float) -> InfinitePlate:
    """The infinite plate under a dimensionless tension beta^2, which may be 0."""
    return StretchedPlate(tension) if tension else InfinitePlate()


def _squares(xy: FloatArray, sources: FloatArray) -> FloatArray:
    return np.asarray((xy[:, :1] - sources[:, 0]) ** 2 + (xy[:, 1:] - sources[:, 1]) ** 2)


def _cartesian(xy: FloatArray, radial: list[FloatArray]) -> list[FloatArray]:
    """The derivatives of orders 0 to 3, each (d, ...), at points (..., 2), from f, (1/r d/dr) f, ... there."""
    (x, y), (value, slope, bend, third) = np.moveaxis(xy, -1, 0), radial
    orders = [
        [value],
        [slope * x, slope * y],
        [slope + bend * x**2, bend * x * y, slope + bend * y**2],
        [
            (3 * bend + third * x**2) * x,
            (bend + third * x**2) * y,
            (bend + third * y**2) * x,
            (3 * bend + third * y**2) * y,
        ],
    ]
    return [np.stack(order) for order in orders]
