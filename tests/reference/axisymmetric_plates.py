"""Von Karman plates with radial symmetry, by Chebyshev collocation: a second discretisation, in one dimension.

Lengths are divided by the outer radius a, deflections by the thickness t, forces by D t / a^2, pressures by D t / a^4,
membrane forces by D / a^2 and energies by D t^2 / a^2. With theta = w', psi = r N_r and kappa = 12 (1 - nu^2),

    theta'' + theta'/r - theta/r^2 = psi theta / r + V / r,     V = C + p r^2 / 2,    2 pi V: the force that r bears
    psi''   + psi'/r   - psi/r^2   = -kappa theta^2 / (2 r),     N_theta = psi'

(S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 1959, section 97). A disc is solved for theta / r and
psi / r as functions of ln r, which takes the logarithm under a central force without loss.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

INNERMOST = 1e-8  # where a disc's coordinate ends: what is left out is of its square


@dataclass(frozen=True)
class RadialPlate:
    """A solution at n radii."""

    r: np.ndarray  # ascending
    w: np.ndarray
    slope: np.ndarray
    N_r: np.ndarray
    N_theta: np.ndarray
    force: float  # at the centre, up
    bending: float  # energies
    stretching: float

    def u(self, poisson_ratio: float) -> np.ndarray:
        """The radial motion over t^2 / a."""
        return self.r * (self.N_theta - poisson_ratio * self.N_r) / (12 * (1 - poisson_ratio**2))


def chebyshev(n: int, start: float, end: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n,), the matrix (n, n) that differentiates values there, and the one that integrates them to the end."""
    x = -np.cos(np.pi * np.arange(n) / (n - 1))
    c = (-1.0) ** np.arange(n)
    c[[0, -1]] *= 2
    D = np.outer(c, 1 / c) / (x[:, None] - x + np.eye(n))
    D -= np.diag(D.sum(axis=1))
    coefficients = np.linalg.inv(np.polynomial.chebyshev.chebvander(x, n - 1))
    integrals = np.polynomial.chebyshev.chebvander(x, n) @ np.polynomial.chebyshev.chebint(coefficients)
    half = (end - start) / 2
    return start + half * (x + 1), D / half, (integrals[-1] - integrals) * half


def newton(residual: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], start: np.ndarray) -> np.ndarray:
    """The root of a residual with its derivative."""
    x, size = start, np.inf
    for _ in range(60):
        value, derivative = residual(x)
        step = np.linalg.solve(derivative, -value)
        share = min(1.0, 2.0 * (1 + np.abs(x).max()) / np.abs(step).max())
        x = x + share * step
        last, size = size, float(np.abs(step).max() / np.abs(x).max())
        if size < 1e-13 or (size < 1e-9 and size >= last / 2):
            return x
    raise RuntimeError(f"no convergence: the last step was {size:.1e}")


def disc(
    *,
    height: float | None = None,
    force: float = 0.0,
    pressure: float = 0.0,
    support: str = "clamped",
    movable: bool = False,
    poisson_ratio: float = 0.3,
    points: int = 200,
) -> RadialPlate:
    """A disc under pressure whose centre is held at a height, or bears a force."""
    nu, kappa, n = poisson_ratio, 12 * (1 - poisson_ratio**2), points
    x, D, to_end = chebyshev(n, np.log(INNERMOST), 0.0)
    r, total = np.exp(x), to_end[0]  # the integral over ln r
    DD = D @ D

    def residual(unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        f, g, P = unknowns[:n], unknowns[n : 2 * n], unknowns[-1]
        # With theta = r f:  r^2 (theta'' + theta'/r - theta/r^2) = r (f_xx + 2 f_x).
        of_f = DD @ f + 2 * D @ f - r**2 * f * g - P / (2 * np.pi) - pressure * r**2 / 2
        of_g = DD @ g + 2 * D @ g + kappa / 2 * r**2 * f**2
        J = np.zeros((2 * n + 1,) * 2)
        J[:n, :n] = DD + 2 * D - np.diag(r**2 * g)
        J[:n, n : 2 * n], J[:n, -1] = -np.diag(r**2 * f), -1 / (2 * np.pi)
        J[n : 2 * n, :n], J[n : 2 * n, n : 2 * n] = kappa * np.diag(r**2 * f), DD + 2 * D
        # At the centre theta ~ P r ln r / (4 pi), and N is bounded.
        of_f[0], J[0] = D[0] @ f - P / (4 * np.pi), 0.0
        J[0, :n], J[0, -1] = D[0], -1 / (4 * np.pi)
        of_g[0], J[n] = D[0] @ g, 0.0
        J[n, n : 2 * n] = D[0]
        J[n - 1] = J[2 * n - 1] = 0.0
        at_rim = np.eye(n)[-1]
        rows = at_rim if support == "clamped" else D[-1] + (1 + nu) * at_rim
        of_f[-1], J[n - 1, :n] = rows @ f, rows
        rows = at_rim if movable else D[-1] + (1 - nu) * at_rim
        of_g[-1], J[2 * n - 1, n : 2 * n] = rows @ g, rows
        if height is None:
            last, J[-1, -1] = P - force, 1.0
        else:  # w(0) = -int theta dr
            last, J[-1, :n] = height + (total * r**2) @ f, total * r**2
        return np.concatenate([of_f, of_g, [last]]), J

    solution = newton(residual, np.zeros(2 * n + 1))
    f, g, P = solution[:n], solution[n : 2 * n], float(solution[-1])
    slope, N_r = r * f, g
    N_theta, bent = D @ g + g, D @ f + f
    energies = _energies(total * r**2, bent, f, N_r, N_theta, nu)
    return RadialPlate(r, -to_end @ (r**2 * f), slope, N_r, N_theta, P, *energies)


def annulus(
    inner: float,
    *,
    pressure: float,
    held: bool = True,
    support: str = "clamped",
    poisson_ratio: float = 0.3,
    points: int = 80,
) -> RadialPlate:
    """An annulus under pressure, its outer rim immovable with a support; its inner one held alike, or free."""
    nu, kappa, n = poisson_ratio, 12 * (1 - poisson_ratio**2), points
    r, D, to_end = chebyshev(n, inner, 1.0)
    total = to_end[0]
    plain = D @ D + np.diag(1 / r) @ D - np.diag(1 / r**2)
    at = np.eye(n)

    def bend(i: int) -> np.ndarray:
        return at[i] if support == "clamped" and (held or i) else D[i] + nu / r[i] * at[i]

    def stretch(i: int) -> np.ndarray:
        return D[i] - nu / r[i] * at[i] if held or i else at[i]

    def residual(unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        theta, psi, C = unknowns[:n], unknowns[n : 2 * n], unknowns[-1]
        value = np.concatenate(
            [
                plain @ theta - psi * theta / r - (C + pressure * r**2 / 2) / r,
                plain @ psi + kappa / 2 * theta**2 / r,
                [total @ theta if held else C + pressure * inner**2 / 2],
            ]
        )
        J = np.zeros((2 * n + 1,) * 2)
        J[:n, :n], J[:n, n : 2 * n], J[:n, -1] = plain - np.diag(psi / r), -np.diag(theta / r), -1 / r
        J[n : 2 * n, :n], J[n : 2 * n, n : 2 * n] = np.diag(kappa * theta / r), plain
        if held:
            J[-1, :n] = total
        else:
            J[-1, -1] = 1.0
        for i in (0, n - 1):
            J[i] = J[n + i] = 0.0
            J[i, :n], J[n + i, n : 2 * n] = bend(i), stretch(i)
            value[i], value[n + i] = bend(i) @ theta, stretch(i) @ psi
        return value, J

    solution = newton(residual, np.zeros(2 * n + 1))
    theta, psi = solution[:n], solution[n : 2 * n]
    N_r, N_theta = psi / r, D @ psi
    energies = _energies(total * r, D @ theta, theta / r, N_r, N_theta, nu)
    return RadialPlate(r, -to_end @ theta, theta, N_r, N_theta, 0.0, *energies)


def at_radii(plate: RadialPlate, values: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Values at the plate's radii, interpolated to others: barycentric, in ln r for a disc."""
    x, y = plate.r, np.maximum(radii, plate.r[0])
    if x[0] < 2 * INNERMOST:
        x, y = np.log(x), np.log(y)
    weights = (-1.0) ** np.arange(len(x))
    weights[[0, -1]] /= 2
    with np.errstate(divide="ignore", invalid="ignore"):
        share = weights / (y[:, None] - x)
        result = (share @ values) / share.sum(axis=1)
    nearest = np.abs(y[:, None] - x).argmin(axis=1)
    hit = np.abs(y - x[nearest]) < 1e-13
    return np.where(hit, values[nearest], result)


def _energies(
    weights: np.ndarray, bent: np.ndarray, curved: np.ndarray, N_r: np.ndarray, N_theta: np.ndarray, nu: float
) -> tuple[float, float]:
    """Of bending and stretching."""
    bending = np.pi * weights @ (bent**2 + curved**2 + 2 * nu * bent * curved)
    stretching = np.pi / (12 * (1 - nu**2)) * weights @ (N_r**2 + N_theta**2 - 2 * nu * N_r * N_theta)
    return float(bending), float(stretching)
