"""A square plate with immovable sides under uniform pressure, by Ritz's method with polynomials on the whole square.

The square is (-1, 1)^2: lengths are divided by half of the side a, deflections by the thickness t, pressures by
D t / a^4 and energies by D t^2 / a^2. The trial functions have the symmetry of the load: w is even in x and y and alike
in both; u_x is odd in x and even in y, and u_y(x, y) = u_x(y, x).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre


def pressed_square(
    pressure: float, clamped: bool, nu: float = 0.3, count: int = 9, sliding: bool = False
) -> tuple[float, float, float]:
    """The deflection of the middle and the energies of bending and stretching.

    Where sides are sliding they may move along themselves, though not across.
    """
    x, weight = legendre.leggauss(6 * count)
    rim = (1 - x**2) ** (2 if clamped else 1)
    even = _with_rim(np.arange(0, 2 * count, 2), 2 if clamped else 1)
    along, held_odd = (
        _with_rim(np.arange(0, 3 * count, 2), 0 if sliding else 1),
        _with_rim(np.arange(1, 3 * count, 2), 1),
    )
    assert np.allclose(even(x, 0)[:, 0], rim)
    W = np.outer(weight, weight)

    def products(left, right, orders):  # type: ignore[no-untyped-def]
        return np.einsum("xi,yj->ijxy", left(x, orders[0]), right(x, orders[1])).reshape(-1, len(x), len(x))

    w = {orders: products(even, even, orders) for orders in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))}
    u_x, u_y = products(held_odd, along, (1, 0)), products(held_odd, along, (0, 1))
    # v(x, y) = u(y, x): its derivatives are those of u, transposed.
    v_x, v_y = u_y.transpose(0, 2, 1), u_x.transpose(0, 2, 1)
    strains = np.stack([u_x, u_y + v_x, v_y])
    kappa = 12.0
    law = kappa * np.array([[1, 0, nu], [0, (1 - nu) / 2, 0], [nu, 0, 1]])
    forces = np.einsum("ab,bkxy->akxy", law, strains)
    membrane = np.einsum("xy,akxy,alxy->kl", W, forces, strains, optimize=True)
    xx, xy, yy = w[2, 0], w[1, 1], w[0, 2]
    bending = np.einsum("xy,ixy,jxy->ij", W, xx + nu * yy, xx, optimize=True)
    bending += np.einsum("xy,ixy,jxy->ij", W, yy + nu * xx, yy, optimize=True)
    bending += 2 * (1 - nu) * np.einsum("xy,ixy,jxy->ij", W, xy, xy, optimize=True)
    load = pressure * np.einsum("xy,ixy->i", W, w[0, 0])
    inverse = np.linalg.inv(membrane)
    flat = [w[1, 0].reshape(len(load), -1), w[0, 1].reshape(len(load), -1)]
    c = np.linalg.solve(bending, load) * 0.3

    def state(c):  # type: ignore[no-untyped-def]
        p, q = np.tensordot(c, w[1, 0], 1), np.tensordot(c, w[0, 1], 1)
        square = np.stack([p * p, 2 * p * q, q * q]) / 2
        u = -inverse @ np.einsum("xy,akxy,axy->k", W, forces, square, optimize=True)
        N = np.tensordot(law, square, 1) + np.einsum("akxy,k->axy", forces, u)
        return p, q, square + np.einsum("akxy,k->axy", strains, u), N

    for _ in range(60):
        p, q, strain, N = state(c)
        at = [N[0] * p + N[1] * q, N[1] * p + N[2] * q]
        residual = bending @ c - load + sum(f @ (W * a).ravel() for f, a in zip(flat, at, strict=True))
        # d strain of w, (3, i, x, y), then of the membrane at rest.
        of_w = np.stack([p * w[1, 0], p * w[0, 1] + q * w[1, 0], q * w[0, 1]])
        coupled = np.einsum("xy,akxy,aixy->ki", W, forces, of_w, optimize=True)
        tangent = bending + np.einsum("xy,ab,aixy,bjxy->ij", W, law, of_w, of_w, optimize=True)
        tangent -= coupled.T @ inverse @ coupled
        for i, j, n in ((0, 0, N[0]), (0, 1, N[1]), (1, 0, N[1]), (1, 1, N[2])):
            tangent += flat[i] * (W * n).ravel() @ flat[j].T
        step = np.linalg.solve(tangent, -residual)
        c = c + step
        if np.abs(step).max() < 1e-8 * np.abs(c).max():
            break
    else:
        raise RuntimeError("no convergence")
    _, _, strain, N = state(c)
    middle = np.outer(even(np.zeros(1), 0)[0], even(np.zeros(1), 0)[0]).ravel() @ c
    return float(middle), float(c @ bending @ c) / 2, float((W * (N * strain).sum(axis=0)).sum()) / 2


def _with_rim(degrees: np.ndarray, power: int):  # type: ignore[no-untyped-def]
    """(1 - x^2)^power times Legendre polynomials, as a function of points and the order of a derivative."""
    rim = legendre.poly2leg(([1.0], [1, 0, -1], [1, 0, -2, 0, 1])[power])
    functions = [legendre.legmul(rim, np.eye(degree + 1)[degree]) for degree in degrees]

    def at(x: np.ndarray, order: int) -> np.ndarray:
        return np.stack([legendre.legval(x, legendre.legder(f, order)) for f in functions], axis=1)

    return at
