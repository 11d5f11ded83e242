"""A clamped disc with immovable rim that stretches and has mass, driven at its centre, with radial symmetry.

Lengths r are divided by the radius a, deflections by the thickness t, forces by D t / a^2. The deflection is
h phi + sum q_n psi_n with the shapes of `RadialDisc`; the in-plane motion u is (1 - r) times polynomials of sqrt(r),
whose energy Gauss points integrate. All modes are integrated in time, by an implicit Runge-Kutta method.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from tests.reference.radial_vibration import RadialDisc

POLYNOMIALS, POINTS = 30, 400


class StretchingDisc:
    """n modes of it; ratio: of damping.  unit: rad/s, sqrt(D / (rho t a^4))."""

    def __init__(self, count: int, unit: float, ratio: float, nu: float = 0.3) -> None:
        self.disc, self.nu, self.unit, self.ratio = RadialDisc(nu=nu, count=count), nu, unit, ratio
        s, weights = np.polynomial.legendre.leggauss(POINTS)
        s, weights = (s + 1) / 2, weights / 2
        r = s**2
        self.area = 2 * np.pi * r * (2 * s * weights)
        step = 1e-6
        inner = np.clip(r, step, 1 - step)
        self.psi_slope = (self.disc.psi(inner + step) - self.disc.psi(inner - step)) / (2 * step)
        self.phi_slope = (self.disc.phi(inner + step) - self.disc.phi(inner - step)) / (2 * step)
        legendre = [np.polynomial.legendre.Legendre.basis(k, domain=[0, 1]) for k in range(POLYNOMIALS)]
        p = np.stack([one(s) for one in legendre], axis=1)
        rate = np.stack([one.deriv()(s) for one in legendre], axis=1) / (2 * s)[:, None]
        self.hoop = (1 - r)[:, None] * p  # u / r
        self.radial = (1 - 2 * r)[:, None] * p + (r * (1 - r))[:, None] * rate  # u'
        e, g, w = self.radial, self.hoop, self.area[:, None]
        self.stiffness = 12 * (e.T @ (w * e) + g.T @ (w * g) + nu * (e.T @ (w * g) + g.T @ (w * e)))

    def pull(self, slope: np.ndarray) -> np.ndarray:
        """The membrane's force on each mode, for a slope at the Gauss points."""
        square = slope**2 / 2
        load = 12 * ((self.radial + self.nu * self.hoop).T @ (self.area * square))
        u = np.linalg.solve(self.stiffness, -load)
        force = 12 * (self.radial @ u + square + self.nu * (self.hoop @ u))
        return self.psi_slope.T @ (self.area * force * slope)

    def motion(self, height: Callable[[float], np.ndarray], times: np.ndarray, r: np.ndarray) -> np.ndarray:
        """(3, times, radii) w, w_t and w_tt from rest; height: h, h' and h'' over the thickness at a time [s]."""
        disc, unit = self.disc, self.unit
        omega, n = disc.k**2 * unit, len(disc.k)

        def accelerations(time: float, q: np.ndarray, q_t: np.ndarray) -> np.ndarray:
            h, _, h_tt = height(time)
            pull = self.pull(h * self.phi_slope + self.psi_slope @ q) * unit**2 / disc.norms
            return -omega * (omega * q + 2 * self.ratio * q_t) - pull - disc.participation * h_tt

        def rates(time: float, state: np.ndarray) -> np.ndarray:
            q, q_t = state[:n], state[n:] * omega
            return np.concatenate([q_t, accelerations(time, q, q_t) / omega])

        found = solve_ivp(
            rates, (0.0, times[-1]), np.zeros(2 * n), "Radau", times, rtol=1e-8, atol=1e-10, max_step=times[-1] / 200
        )
        q, q_t = found.y[:n].T, found.y[n:].T * omega
        q_tt = np.array([accelerations(*one) for one in zip(times, q, q_t, strict=True)])
        heights = np.array([height(time) for time in times])
        phi, psi = disc.phi(r), disc.psi(r)
        return np.stack([heights[:, [k]] * phi + one @ psi.T for k, one in enumerate((q, q_t, q_tt))])
