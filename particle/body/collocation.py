"""Radau's collocation with five stages (Radau IIA, of order 9): stable however stiff friction makes a slow slip.

With nodes c_i, c_5 = 1, and A the integrals of Lagrange's polynomials, a step of h takes

    V_i = v + h sum_j A_ij u(q_i, V_i),   q_i = q + h sum_j A_ij V_j        to V_5 and q_5.

Its error is the difference from the formula of order 5 that also weighs the rate at the start by 1/(the real
eigenvalue of A^-1), filtered as Hairer and Wanner (1996, IV.8) do.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from particle.types import FloatArray

STAGES: Final = 5
ORDER: Final = STAGES + 1  # of the error


def _nodes() -> FloatArray:
    """The right Radau points in (0, 1], the roots of P_5 - P_4."""
    legendre = np.polynomial.legendre
    difference = legendre.Legendre.basis(STAGES) - legendre.Legendre.basis(STAGES - 1)
    roots = np.sort(difference.roots().real)
    return np.append((1 + roots[:-1]) / 2, 1.0)


def _weights(nodes: FloatArray) -> tuple[FloatArray, float, FloatArray]:
    """A (5, 5), the weight of the rate at the start in the embedded formula, and the others' less those of the step."""
    powers = nodes[:, None] ** np.arange(STAGES)
    a = nodes[:, None] ** np.arange(1, STAGES + 1) / np.arange(1, STAGES + 1) @ np.linalg.inv(powers)
    values = np.linalg.eigvals(np.linalg.inv(a))
    start = 1.0 / float(values[np.abs(values.imag).argmin()].real)
    wanted = 1.0 / np.arange(1, STAGES + 1)
    wanted[0] -= start
    return a, start, np.linalg.solve(powers.T, wanted) - a[-1]


NODES = _nodes()
# (5, 5) from the values at the nodes to the coefficients of their polynomial in powers of s - 1, s the share of a step.
AHEAD = np.linalg.inv((NODES[:, None] - 1) ** np.arange(STAGES))
A, AT_START, DIFFERENCE = _weights(NODES)
