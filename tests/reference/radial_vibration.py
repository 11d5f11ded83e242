"""A disc with an actuator at its centre that vibrates with radial symmetry, as exact series of Bessel functions.

Lengths r are divided by the outer radius a, forces by D / a^2 and squared angular frequencies by D / (rho t a^4). With
S = Y0 + 2/pi K0, which a force -8 k^2 at the centre bends, modes and static shapes are

    psi = A J0(k r) + B I0(k r) + C S(k r),  omega = k^2,     phi = p + q r^2 + P r^2 ln r / (8 pi).

Three conditions determine each: two at the rim, clamped (psi = psi' = 0) or free (no moment, no shear force), and one
at the centre: psi(0) = 0 if it is held, C = 0 if nothing holds it, 8 k^2 C = stiffness psi(0) on a spring. Green's
identity gives the shares of the modes in phi: k^4 int phi psi dA = 8 k^2 C, or psi(0) where a force pushes. Time
responses are Duhamel's integrals, in closed form by parts, in complex numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq
from scipy.special import ive, jv, kve, yv

HELD, FORCE = np.inf, 0.0


def _bessel(k: float, r: np.ndarray, order: int) -> np.ndarray:
    """J0, I0 exp(-k), S of k r, or their derivatives by r over k; (3, n)."""
    x = k * np.asarray(r, dtype=float)
    with np.errstate(all="ignore"):
        grown, fallen = np.exp(x - k), np.exp(-x)
        if order == 0:
            s = np.where(x > 0, yv(0, x) + 2 / np.pi * kve(0, x) * fallen, 0.0)
            return np.stack([jv(0, x), ive(0, x) * grown, s])
        s = np.where(x > 0, -yv(1, x) - 2 / np.pi * kve(1, x) * fallen, 0.0)
        return np.stack([-jv(1, x), ive(1, x) * grown, s])


def _laplacians(k: float, r: float, order: int) -> np.ndarray:
    """Of the same three, over k^2, or their derivatives by r over k^3; (3,)."""
    x, fallen = k * r, np.exp(-k * r)
    if order == 0:
        return np.array([-jv(0, x), ive(0, x), -yv(0, x) + 2 / np.pi * kve(0, x) * fallen])
    return np.array([jv(1, x), ive(1, x), yv(1, x) - 2 / np.pi * kve(1, x) * fallen])


@dataclass(frozen=True, eq=False)
class RadialDisc:
    """A disc, "clamped" or "free" at its rim, with an actuator at its centre.

    stiffness: of the actuator over D / a^2; HELD: rigid, FORCE: none, it pushes with a force.
    """

    rim: str = "clamped"
    nu: float = 0.3
    stiffness: float = HELD
    count: int = 120

    def _conditions(self, k: float) -> np.ndarray:
        """Rows of conditions on (A, B exp(k), C)."""
        value, slope = _bessel(k, np.array([1.0]), 0)[:, 0], _bessel(k, np.array([1.0]), 1)[:, 0]
        if self.rim == "clamped":
            rim = [value, slope]
        else:  # w'' + nu w'/r = laplacian - (1 - nu) w'/r
            rim = [_laplacians(k, 1.0, 0) - (1 - self.nu) * slope / k, _laplacians(k, 1.0, 1)]
        at_0 = np.array([1.0, np.exp(-k), 0.0])
        if np.isinf(self.stiffness):
            centre = at_0
        else:
            pushed = np.array([0.0, 0.0, 8 * k**2])  # the force up is -8 k^2 C, on an area element of the plane
            centre = (self.stiffness * at_0 - pushed) / (self.stiffness + 8 * k**2)
        return np.array([*rim, centre])

    @cached_property
    def k(self) -> np.ndarray:
        """(count,) the wave numbers; lambda^2 = k^2."""
        grid = np.arange(0.31, (self.count + 4) * np.pi, 0.05)
        sign = np.array([np.linalg.det(self._conditions(k)) for k in grid])
        roots = [
            brentq(lambda k: np.linalg.det(self._conditions(k)), grid[i], grid[i + 1], xtol=1e-15, rtol=1e-14)
            for i in np.flatnonzero(np.diff(np.sign(sign)))
        ]
        return np.array(roots[: self.count])

    @cached_property
    def _coefficients(self) -> np.ndarray:
        """(count, 3) A, B exp(k), C."""
        return np.array([np.linalg.svd(self._conditions(k))[2][-1] for k in self.k])

    def psi(self, r: np.ndarray) -> np.ndarray:
        """(n, count) the modes at radii."""
        return np.stack([c @ _bessel(k, r, 0) for k, c in zip(self.k, self._coefficients, strict=True)], axis=1)

    @cached_property
    def _static(self) -> tuple[float, float, float]:
        """p, q, P of phi."""
        if self.rim == "free":
            return 1.0, 0.0, 0.0  # it rides on the actuator
        per_force = 1 / (16 * np.pi)  # the deflection at the centre: r^2 ln r / 8 pi + (1 - r^2) / 16 pi
        force = 1.0 if self.stiffness == FORCE else 1 / (per_force + 1 / self.stiffness)  # 1 / inf = 0
        return force / (16 * np.pi), -force / (16 * np.pi), force

    def phi(self, r: np.ndarray) -> np.ndarray:
        """(n,) the static shape."""
        p, q, force = self._static
        r = np.asarray(r, dtype=float)
        with np.errstate(all="ignore"):
            return p + q * r**2 + force * np.where(r > 0, r**2 * np.log(r), 0.0) / (8 * np.pi)

    @cached_property
    def norms(self) -> np.ndarray:
        """(count,) int psi^2 dA."""
        s, weights = np.polynomial.legendre.leggauss(8)
        pieces = 2 * self.count + 100
        edges = np.linspace(0, 1, pieces + 1) ** 1.5  # finer at the centre, where S is not smooth
        half, middle = np.diff(edges) / 2, (edges[1:] + edges[:-1]) / 2
        r, dr = (middle[:, None] + half[:, None] * s).ravel(), (half[:, None] * weights).ravel()
        return (2 * np.pi * r * dr) @ self.psi(r) ** 2

    @cached_property
    def participation(self) -> np.ndarray:
        """(count,) (phi, psi) / (psi, psi)."""
        work = self.psi(np.zeros(1))[0] if self.stiffness == FORCE else 8 * self.k**2 * self._coefficients[:, 2]
        return work / self.k**4 / self.norms

    def transfer(self, r: np.ndarray, omega: np.ndarray, ratio: float) -> np.ndarray:
        """(n, F) the response at radii to a unit sine of the actuator, by angular frequency over the unit."""
        own = self.k[:, None] ** 2
        answer = omega**2 / (own**2 - omega**2 + 2j * ratio * own * omega)
        return self.phi(r)[:, None] + self.psi(r) @ (self.participation[:, None] * answer)

    def motion(
        self, pieces: Sequence[Piece | Wave], r: np.ndarray, time: float, unit: float, ratio: float
    ) -> np.ndarray:
        """(3, n) w, w_t and w_tt at a time [s], at rest at the height where the first piece begins; unit: rad/s."""
        omega = self.k**2 * unit
        turn = omega * np.sqrt(1 - ratio**2)
        p = -ratio * omega + 1j * turn
        z, height = np.zeros(len(p), complex), np.zeros(3)
        last = np.array([pieces[0].evaluate(pieces[0].begin)[0], 0.0])
        for piece in (one for one in pieces if one.begin <= time):
            begun = piece.evaluate(piece.begin)
            jump = begun[:2] - last  # h'' is then jump[0] delta' + jump[1] delta
            z += np.exp(p * (time - piece.begin)) * (p * jump[0] + jump[1])
            until = min(piece.end, time)
            z += piece.duhamel(p, until) * np.exp(p * (time - until))
            last, height = piece.evaluate(until)[:2], piece.evaluate(until)
        m, psi = self.participation, self.psi(r)
        eta = [-m * (p**order * z).imag / turn for order in range(3)]
        eta[2] = eta[2] - m * height[2]
        return np.stack([self.phi(r) * h + psi @ e for h, e in zip(height, eta, strict=True)])


@dataclass(frozen=True)
class Piece:
    """h as a polynomial of the time since its begin, lowest power first."""

    begin: float
    end: float
    powers: tuple[float, ...]

    def evaluate(self, time: float) -> np.ndarray:
        """h, h', h''."""
        h = np.polynomial.Polynomial(self.powers)
        return np.array([h.deriv(order)(time - self.begin) if order else h(time - self.begin) for order in range(3)])

    def duhamel(self, p: np.ndarray, until: float) -> np.ndarray:
        """int exp(p (until - s)) h''(s) ds, from its begin."""
        q, total, power = np.polynomial.Polynomial(self.powers).deriv(2), np.zeros(len(p), complex), p.copy()
        duration = until - self.begin
        for _ in self.powers:
            total += (np.exp(p * duration) * q(0.0) - q(duration)) / power
            q, power = q.deriv(), power * p
        return total


@dataclass(frozen=True)
class Wave:
    """h = stroke sin(omega (t - begin) + phase)."""

    begin: float
    end: float
    stroke: float
    omega: float
    phase: float = 0.0

    def evaluate(self, time: float) -> np.ndarray:
        """h, h', h''."""
        angle = self.omega * (time - self.begin) + self.phase
        return self.stroke * np.array([np.sin(angle), self.omega * np.cos(angle), -(self.omega**2) * np.sin(angle)])

    def duhamel(self, p: np.ndarray, until: float) -> np.ndarray:
        """int exp(p (until - s)) h''(s) ds, from its begin."""
        duration, total = until - self.begin, np.zeros(len(p), complex)
        for sign in (1, -1):
            rate, factor = 1j * sign * self.omega, -(self.omega**2) * self.stroke * np.exp(1j * sign * self.phase)
            total += factor / (2j * sign) * (np.exp(rate * duration) - np.exp(p * duration)) / (rate - p)
        return total


def strokes(height: float, frequency: float, count: int, begin: float = 0.0) -> list[Piece]:
    """Strokes up and down, 10 s^3 - 15 s^4 + 6 s^5 in half a cycle each."""
    half, pieces = 0.5 / frequency, []
    for number in range(2 * count):
        rise = -height if number % 2 else height
        powers = (
            height if number % 2 else 0.0,
            0.0,
            0.0,
            10 * rise / half**3,
            -15 * rise / half**4,
            6 * rise / half**5,
        )
        pieces.append(Piece(begin + number * half, begin + (number + 1) * half, powers))
    return pieces
