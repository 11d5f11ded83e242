"""Air under a rectangular face, by collocation in two dimensions: the compressible Reynolds equation of a rarefied gas.

With the pressure p and the gap h = h0 - kappa/2 (x^2 + y^2 - (a^2 + b^2)/12), whose mean over the sides a, b is h0,

    d(p h)/dt = div(h^3 p Qbar/(12 mu) grad p),   p = p_a at the rim,   Qbar = 1 + 9.638 Kn^1.159,   Kn = mfp p_a/(p h)

(T. Veijola et al., Sensors and Actuators A 48, 1995, 239-248). The load is N_c + int (p - p_a) dA, N_c of asperities.
The state is u = p h / p_a. For a given u the load falls throughout as h0 grows, before pull-off and beyond, as air that
cannot leave is stiff; so h0 follows from the load. All is even in x and y, and Chebyshev's points fill a quadrant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from axisymmetric_plates import chebyshev
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.linalg import toeplitz
from scipy.optimize import brentq

from particle import KogutEtsion

PRESSURE, VISCOSITY = 101325.0, 1.82e-5  # Pa, Pa s: air at 293.15 K, of 287.05 J/(kg K)
FREE_PATH = VISCOSITY / PRESSURE * np.sqrt(np.pi * 287.05 * 293.15 / 2)  # m, 65.30 nm
SIDE = 1e-4  # m
TIP_MEAN = 0.045944  # over asperity_beta, in sigma: from the heights' mean to the tips', where KogutEtsion counts from
STROKE = 0.5e-3  # s


def flow(knudsen):
    """Qbar, the flow between plates over that of a continuum."""
    return 1 + 9.638 * knudsen**1.159


class RoughContact:
    """The load per area [Pa] over the gap [m], on the stable branch and beyond pull-off."""

    def __init__(self, contact: KogutEtsion) -> None:
        d = np.linspace(1.0, 40.0, 4001)
        gaps = (d + TIP_MEAN / contact.asperity_beta) * contact.roughness
        self.pressure = CubicSpline(gaps, contact.net_load(d) / contact.contact_area)
        self.slope = self.pressure.derivative()
        self.nearest, self.pull_off = gaps[0], gaps[np.argmin(self.pressure(gaps))]

    def gap(self, load: float) -> float:
        """At which a flat face bears a load [N] without air, on the stable branch."""
        return brentq(lambda h: self.pressure(h) * SIDE**2 - load, self.nearest, self.pull_off, xtol=1e-20)


def quadrant(n: int, side: float):
    """Distances from the middle (n,), weights, derivatives (n, n) of even and of odd functions."""
    x, D, integrals = chebyshev(2 * n, -side / 2, side / 2)
    near, far = D[n:, n:], D[n:, n - 1 :: -1]
    return x[n:], 2 * integrals[0, n:], near + far, near - far


@dataclass(frozen=True)
class Film:
    """A face that bears load(t) [N] with air on a surface of curvature(t) [1/m]; k states are the columns of u."""

    contact: RoughContact
    load: Callable[[float], float]
    curvature: Callable[[float], float] = lambda t: 0.0
    points: int = 10  # n, from the middle of a side to its end
    sides: tuple[float, float] = (SIDE, SIDE)  # m

    @cached_property
    def grid(self):
        """Points, weights and derivatives along half of each side."""
        return tuple(quadrant(self.points, side) for side in self.sides)

    def state(self, t, u, more=0.0):
        """h (k, n, n), p / p_a, h0 (k,) and the asperities' load (k,) under a load that is more by `more`."""
        (x, w_x, _, _), (y, w_y, _, _) = self.grid
        area = np.outer(w_x, w_y)
        shape = self.curvature(t) / 2 * (sum(side**2 for side in self.sides) / 12 - x[:, None] ** 2 - y**2)
        inner = np.s_[..., :-1, :-1]
        u = u.T.reshape(-1, self.points - 1, self.points - 1)
        h0 = np.einsum("kij,ij->k", u, area[inner])[:, None, None] / area[inner].sum()
        for _ in range(50):
            h = h0 + shape
            p = np.ones_like(h)
            p[inner] = u / h[inner]
            asperities = (area * self.contact.pressure(h0 + shape)).sum(axis=(1, 2))
            excess = asperities + PRESSURE * (area * (p - 1)).sum(axis=(1, 2)) - self.load(t) - more
            slope = self.contact.slope(h0 + shape)
            slope[inner] = slope[inner] - PRESSURE * u / h[inner] ** 2
            step = excess / (area * slope).sum(axis=(1, 2))
            h0 = h0 - step[:, None, None]
            if np.abs(step).max() < 1e-21:
                return h, p, h0[:, 0, 0], asperities
        raise RuntimeError(f"no convergence of the gap: the last step was {np.abs(step).max():.1e} m")

    def rates(self, t, u, more=0.0):
        """du/dt, of the shape of u."""
        (_, _, even_x, odd_x), (_, _, even_y, odd_y) = self.grid
        columns = u.reshape(len(u), -1)
        h, p, _, _ = self.state(t, columns, more)
        mobility = PRESSURE / (12 * VISCOSITY) * h**3 * p * flow(FREE_PATH / (p * h))
        rate = odd_x @ (mobility * (even_x @ p)) + (mobility * (p @ even_y.T)) @ odd_y.T
        return rate[:, :-1, :-1].reshape(columns.shape[1], -1).T.reshape(u.shape)

    def history(self, breaks: Sequence[float], tolerance: float = 1e-7, samples: int = 201):
        """From rest: times, h0 and the asperities' load, each (len(breaks) - 1, samples), smooth between breaks."""
        load = self.load(breaks[0]) * SIDE**2 / (self.sides[0] * self.sides[1])
        u = np.full((self.points - 1) ** 2, self.contact.gap(load))
        pieces = []
        for start, end in zip(breaks, breaks[1:], strict=False):
            scale = {"rtol": tolerance, "atol": tolerance * 1e-8}
            way = solve_ivp(self.rates, (start, end), u, "Radau", dense_output=True, vectorized=True, **scale)
            u, times = way.y[:, -1], np.linspace(start, end, samples)
            states = [self.state(t, way.sol(t)[:, None]) for t in times]
            pieces.append((times, [h0[0] for _, _, h0, _ in states], [load[0] for _, _, _, load in states]))
        return tuple(np.array(values) for values in zip(*pieces, strict=True))

    def share(self, frequency: float) -> complex:
        """The asperities' part of a small harmonic load, about rest on a flat surface: linear in small differences."""
        n = (self.points - 1) ** 2
        rest = self.contact.gap(self.load(0.0) * SIDE**2 / (self.sides[0] * self.sides[1]))
        columns, e, f = np.full((n, n), rest), 1e-5 * rest * np.eye(n), 1e-3 * self.load(0.0)
        by_state = (self.rates(0.0, columns + e) - self.rates(0.0, columns - e)) / (2e-5 * rest)
        by_load = (self.rates(0.0, columns[:, 0], f) - self.rates(0.0, columns[:, 0], -f)) / (2 * f)
        u = np.linalg.solve(2j * np.pi * frequency * np.eye(n) - by_state, by_load)
        of_state = (self.state(0.0, columns + e)[3] - self.state(0.0, columns - e)[3]) / (2e-5 * rest)
        direct = self.state(0.0, columns[:, :1], f)[3] - self.state(0.0, columns[:, :1], -f)[3]
        return of_state @ u + direct[0] / (2 * f)


def strokes(weight: float, size: float) -> Callable[[float], float]:
    """The load of smooth strokes, up and down by turns, with this largest change of the load [N]."""

    def load(t: float) -> float:
        k = int(t / STROKE)
        u = t / STROKE - k
        return weight + (-1) ** k * size * (60 * u - 180 * u**2 + 120 * u**3) / 5.7735027

    return load


def extremes(times: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Least and largest over all pieces, between samples as well."""
    found = []
    for t, v in zip(times, values, strict=True):
        spline = CubicSpline(t, v)
        found += [v, spline(spline.derivative().roots(extrapolate=False))]
    return float(np.concatenate(found).min()), float(np.concatenate(found).max())


def share_of_series(stiffness: float, gap: float, frequency: float, terms: int = 400) -> complex:
    """The asperities' part of a small harmonic load, from the membrane's modes: p_a A/h in parallel relaxing parts."""
    m = np.arange(1.0, 2 * terms, 2)
    squares = m[:, None] ** 2 + m**2
    rates = gap**2 * PRESSURE * flow(FREE_PATH / gap) / (12 * VISCOSITY) * squares * (np.pi / SIDE) ** 2
    weights, omega = 64 / np.pi**4 / np.outer(m, m) ** 2, 2j * np.pi * frequency
    return stiffness / (stiffness + PRESSURE * SIDE**2 / gap * (weights * omega / (omega + rates)).sum())


def tilt_by_collocation(points: int) -> float:
    """12 int phi x over a unit square, -laplace(phi) = x and phi = 0 at the rim."""
    x, w, even, odd = quadrant(points, 1.0)
    one = np.eye(points - 1)
    laplacian = np.kron((even @ odd)[:-1, :-1], one) + np.kron(one, (odd @ even)[:-1, :-1])
    phi = np.linalg.solve(-laplacian, np.repeat(x[:-1], points - 1))
    return 12 * np.kron((x * w)[:-1], w[:-1]) @ phi


def bgk_flow(knudsen: float, cells: int = 200) -> float:
    """Qbar of the linearised BGK equation between diffuse walls (C. Cercignani, A. Daneri, J. Appl. Phys. 34, 1963).

    Z(x) = 1 + 1/sqrt(pi) int T_-1(|x - y|) Z(y) dy over a width of sqrt(pi)/(2 Kn), with the Abramowitz functions
    T_n(x) = int_0^inf t^n exp(-t^2 - x/t) dt, by Galerkin's method with constants in cells: exact, as T_1'' = T_-1.
    """
    width = np.sqrt(np.pi) / (2 * knudsen)
    s = np.arange(-16.0, 2.0, 0.05)  # t = exp(s): the trapezoidal rule is then exact to rounding
    x = np.linspace(0, width, cells + 1)
    t_1 = 0.05 * np.exp(2 * s - np.exp(2 * s) - x[:, None] * np.exp(-s)).sum(axis=1)
    smooth = toeplitz(t_1 + x * np.sqrt(np.pi) / 2)  # without the bend of T_1(|x|) at 0
    kernel = -np.diff(np.diff(smooth, axis=0), axis=1)
    share = np.linalg.solve(width / cells * np.eye(cells) - kernel / np.sqrt(np.pi), np.full(cells, width / cells))
    return 6 * (share.mean() * width - width) / width**3
