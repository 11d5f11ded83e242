"""A disc with an actuator at its centre that vibrates with radial symmetry, as exact series of Bessel functions.

Lengths r are divided by the outer radius a, forces by D / a^2, as are forces per length times a, and squared angular
frequencies by D / (rho t a^4). Under a tension T, lap lap psi - T lap psi = omega^2 psi. With b^2 = k^2 + T and
S = Y0(k r) + 2/pi K0(b r), which a force -4 (k^2 + b^2) at the centre bends, modes and static shapes are

    psi = A J0(k r) + B I0(b r) + C S,  omega = k b,     phi = p + q r^2 + P r^2 ln r / (8 pi),

and with tension, s^2 = T, phi = p + q I0(s r) - P (ln r + K0(s r)) / (2 pi T). Three conditions determine each: two at
the rim, clamped (psi = psi' = 0) or, without tension, free (no moment, no shear force), and one at the centre:
psi(0) = 0 if it is held, C = 0 if nothing holds it, 4 (k^2 + b^2) C = stiffness psi(0) on a spring. Green's identity
gives the shares of the modes in phi: omega^2 int phi psi dA = 4 (k^2 + b^2) C, or psi(0) where a force pushes. Time
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


def _bessel(k: float, b: float, r: np.ndarray, order: int) -> np.ndarray:
    """J0(k r), I0(b r) exp(-b) and S, or their derivatives by r over k; (3, n)."""
    r = np.asarray(r, dtype=float)
    x, y = k * r, b * r
    with np.errstate(all="ignore"):
        grown, fallen = np.exp(y - b), np.exp(-y)
        if order == 0:
            s = np.where(r > 0, yv(0, x) + 2 / np.pi * kve(0, y) * fallen, 2 / np.pi * np.log(k / b))
            return np.stack([jv(0, x), ive(0, y) * grown, s])
        s = np.where(r > 0, -yv(1, x) - 2 / np.pi * b / k * kve(1, y) * fallen, 0.0)
        return np.stack([-jv(1, x), b / k * ive(1, y) * grown, s])


def _laplacians(k: float, r: float, order: int) -> np.ndarray:
    """Of the same three without tension, over k^2, or their derivatives by r over k^3; (3,)."""
    x, fallen = k * r, np.exp(-k * r)
    if order == 0:
        return np.array([-jv(0, x), ive(0, x), -yv(0, x) + 2 / np.pi * kve(0, x) * fallen])
    return np.array([jv(1, x), ive(1, x), yv(1, x) - 2 / np.pi * kve(1, x) * fallen])


@dataclass(frozen=True, eq=False)
class RadialDisc:
    """A disc, "clamped" or "free" at its rim, with an actuator at its centre.

    stiffness: of the actuator over D / a^2; HELD: rigid, FORCE: none, it pushes with a force.  tension: over D / a^2,
        of a clamped disc.
    """

    rim: str = "clamped"
    nu: float = 0.3
    stiffness: float = HELD
    count: int = 120
    tension: float = 0.0

    def _rise(self, k: np.ndarray) -> np.ndarray:
        """b, with which modes of wave numbers k grow and fall towards the rim."""
        return np.sqrt(np.asarray(k) ** 2 + self.tension)

    def _conditions(self, k: float) -> np.ndarray:
        """Rows of conditions on (A, B exp(b), C)."""
        b, rim_at = float(self._rise(k)), np.array([1.0])
        value, slope = (_bessel(k, b, rim_at, order)[:, 0] for order in (0, 1))
        if self.rim == "clamped":
            rim = [value, slope]
        else:  # w'' + nu w'/r = laplacian - (1 - nu) w'/r
            assert not self.tension
            rim = [_laplacians(k, 1.0, 0) - (1 - self.nu) * slope / k, _laplacians(k, 1.0, 1)]
        at_0 = _bessel(k, b, np.zeros(1), 0)[:, 0]
        if np.isinf(self.stiffness):
            centre = at_0
        else:
            force = 4 * (k**2 + b**2)  # the force up is minus that times C, on an area element of the plane
            centre = (self.stiffness * at_0 - np.array([0.0, 0.0, force])) / (self.stiffness + force)
        return np.array([*rim, centre])

    @cached_property
    def k(self) -> np.ndarray:
        """(count,) the wave numbers; lambda^2 = k^2 without tension."""
        grid = np.arange(0.31, (self.count + 4) * np.pi, 0.05)
        sign = np.array([np.linalg.det(self._conditions(k)) for k in grid])
        roots = [
            brentq(lambda k: np.linalg.det(self._conditions(k)), grid[i], grid[i + 1], xtol=1e-15, rtol=1e-14)
            for i in np.flatnonzero(np.diff(np.sign(sign)))
        ]
        return np.array(roots[: self.count])

    @property
    def omega(self) -> np.ndarray:
        """(count,) the angular frequencies."""
        return self.k * self._rise(self.k)

    @cached_property
    def _coefficients(self) -> np.ndarray:
        """(count, 3) A, B exp(b), C."""
        return np.array([np.linalg.svd(self._conditions(k))[2][-1] for k in self.k])

    def psi(self, r: np.ndarray) -> np.ndarray:
        """(n, count) the modes at radii."""
        every = zip(self.k, self._rise(self.k), self._coefficients, strict=True)
        return np.stack([c @ _bessel(k, b, r, 0) for k, b, c in every], axis=1)

    def _per_force(self, r: np.ndarray) -> np.ndarray:
        """(n,) the shape of a clamped disc under a unit force at its centre."""
        with np.errstate(all="ignore"):
            if not self.tension:
                return (1 - r**2 + 2 * np.where(r > 0, r**2 * np.log(r), 0.0)) / (16 * np.pi)
            s = np.sqrt(self.tension)
            at_0 = -np.log(s / 2) - np.euler_gamma
            logs = np.where(r > 0, np.log(r) + kve(0, s * r) * np.exp(-s * r), at_0)
        q = (1 - s * kve(1, s) * np.exp(-s)) / (s * ive(1, s))  # times exp(s): no slope at the rim
        grown = q * ive(0, s * r) * np.exp(s * (r - 1))
        return (kve(0, s) * np.exp(-s) - logs + grown - q * ive(0, s)) / (2 * np.pi * self.tension)

    def phi(self, r: np.ndarray) -> np.ndarray:
        """(n,) the static shape."""
        r = np.asarray(r, dtype=float)
        if self.rim == "free":
            return np.ones_like(r)  # it rides on the actuator
        at_0 = float(self._per_force(np.zeros(1))[0])
        force = 1.0 if self.stiffness == FORCE else 1 / (at_0 + 1 / self.stiffness)  # 1 / inf = 0
        return force * self._per_force(r)

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
        force = 4 * (self.k**2 + self._rise(self.k) ** 2) * self._coefficients[:, 2]
        work = self.psi(np.zeros(1))[0] if self.stiffness == FORCE else force
        return work / self.omega**2 / self.norms

    def transfer(self, r: np.ndarray, omega: np.ndarray, ratio: float | np.ndarray) -> np.ndarray:
        """(n, F) the response at radii to a unit sine of the actuator, by angular frequency over the unit.

        ratio: of damping, of all modes or of each (count,).
        """
        own, ratio = self.omega[:, None], np.broadcast_to(ratio, len(self.k))[:, None]
        answer = omega**2 / (own**2 - omega**2 + 2j * ratio * own * omega)
        return self.phi(r)[:, None] + self.psi(r) @ (self.participation[:, None] * answer)

    def motion(
        self, pieces: Sequence[Piece | Wave], r: np.ndarray, time: float, unit: float, ratio: float | np.ndarray
    ) -> np.ndarray:
        """(3, n) w, w_t and w_tt at a time [s], at rest at the height where the first piece begins; unit: rad/s.

        ratio: as for `transfer`.
        """
        omega = self.omega * unit
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
