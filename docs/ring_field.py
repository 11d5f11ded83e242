"""The plate of examples/ring_wave.toml in waves around it, from its frequency responses."""

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from active_surface.studies.response import response
from coupling.case import Case

INNER = 5e-3  # m, forces within make the wave, those beyond the track
WAVES = 2  # around the ring
PLACES = 32  # on a circle, to split a motion into waves
RADII = np.linspace(5.0e-3, 7.2e-3, 12)  # m, of these circles
KEPT = 1e-4  # of the largest wave: lower ones are left out
FREQUENCIES = (574, 588, 602, 616, 623, 630, 637, 644, 658, 672, 686)  # Hz, with a common period with the track's


def is_inner(case: Case) -> np.ndarray:
    """Which actuators make the wave."""
    return np.array([math.hypot(*one.position) < INNER for one in case.actuators])


@dataclass(frozen=True)
class Field:
    """The plate's motion in waves Im(p(r) exp(i (rate t + n angle))) with polynomials p, from frequency responses."""

    terms: tuple[tuple[float, int, np.ndarray, np.ndarray], ...]  # rate [1/s], n, p and its derivative [m, 1]

    def wave(self, radius: float, n: int) -> float:
        """The amplitude [m] of the lowest frequency's wave."""
        rate = min(term[0] for term in self.terms)
        return float(sum(abs(np.polyval(p, radius / INNER)) for r, m, p, _ in self.terms if (r, m) == (rate, n)))

    @cached_property
    def crest(self) -> float:
        """The radius [m] where the wave is largest."""
        radii = np.linspace(RADII[0], RADII[-1], 2201)
        return float(radii[np.argmax([self.wave(radius, -WAVES) for radius in radii])])

    def at(self, x: float, y: float, t: float) -> tuple[float, tuple[float, float], tuple[float, float]]:
        """w_tt [m/s^2], the slope and its second rate [1/s^2]."""
        radius, angle = math.hypot(x, y), math.atan2(y, x)
        w_tt, slope, bend = 0.0, 0j, 0j
        turn = cmath.exp(1j * angle)
        for rate, n, p, derivative in self.terms:
            phase = cmath.exp(1j * (rate * t + n * angle))
            value = _polynomial(p, radius) * phase
            along = (_polynomial(derivative, radius) * phase).imag + 1j * (1j * n * value).imag / radius
            w_tt -= rate**2 * value.imag
            slope += along * turn
            bend -= rate**2 * along * turn
        return w_tt, (slope.real, slope.imag), (bend.real, bend.imag)


def _polynomial(coefficients: np.ndarray, x: float) -> complex:
    value = 0j
    for coefficient in coefficients.tolist():
        value = value * (x / INNER) + coefficient
    return value


@dataclass(frozen=True)
class Responses:
    """How far circles of the plate follow each actuator, at the frequencies of the tables."""

    case: Case
    frequencies: np.ndarray
    values: np.ndarray  # (circles, places, actuators, frequencies)

    @staticmethod
    def of(case: Case) -> "Responses":
        angles = 2 * math.pi * np.arange(PLACES) / PLACES
        places = RADII[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
        frequencies = np.array(sorted({*FREQUENCIES, *(one.frequency or 0.0 for one in case.actuators)}))
        values = response(case, places.reshape(-1, 2), frequencies).values
        return Responses(case, frequencies, values.reshape(len(RADII), PLACES, *values.shape[1:]))

    def field(self, case: Case) -> Field:
        """Of the example with other drives."""
        terms = []
        for inner in (True, False):
            forces = np.array([(one.force or 0.0) * np.exp(1j * one.phase) for one in case.actuators])
            chosen = is_inner(case) == inner
            frequency = next(one.frequency or 0.0 for one, at in zip(case.actuators, chosen, strict=True) if at)
            at = int(np.argmin(np.abs(self.frequencies - frequency)))
            waves = np.fft.fft(self.values[..., at] @ (forces * chosen), axis=1) / PLACES
            largest = np.abs(waves).max(axis=0)
            for n in np.flatnonzero(largest > max(KEPT * largest.max(), 1e-15)):
                p = np.polyfit(RADII / INNER, waves[:, n], 8)
                wave = int(n) if n < PLACES / 2 else int(n) - PLACES
                terms.append((2 * math.pi * frequency, wave, p, np.polyder(p) / INNER))
        return Field(tuple(terms))
