"""Corners of the plate, where its deflection is singular and Argyris' common second derivatives are too strict.

Near a corner of angle omega the deflection is w = r^(lambda + 1) f(theta) (Williams, 1952), where the supports of both
sides admit only some exponents lambda. Where lambda < 1 the second derivatives are unbounded.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix

from fem_plate.elements.rim import CLAMPED, FREE
from fem_plate.types import ComplexArray, FloatArray, IntArray

Copies = list[tuple[int, int, int, int]]

MAX_EXPONENT = 4.0  # to polynomials of degree five, larger exponents are smooth
STEP = 0.02  # of the grid on which exponents are searched


@lru_cache
def exponent(angle: float, before: str, after: str, poisson_ratio: float) -> float:
    """The smallest positive real part of lambda, other than integers, at a corner between two supports.

    angle: rad, of the plate inside the corner.  Returns at most MAX_EXPONENT.
    """
    from scipy.optimize import minimize  # here, because most plates have no such corner

    real, imaginary = np.meshgrid(np.arange(STEP, MAX_EXPONENT + STEP, STEP), np.arange(0, 1.5, STEP), indexing="ij")
    grid = _singular_value(real + 1j * imaginary, angle, before, after, poisson_ratio)
    padded = np.pad(grid, 1, constant_values=np.inf)
    padded[:, 0] = padded[:, 2]  # conjugates mirror each other
    around = [np.roll(padded, shift, (0, 1))[1:-1, 1:-1] for shift in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    for i, j in np.argwhere((grid <= np.min(around, axis=0)) & (grid < 0.05)).tolist():
        start = np.array([real[i, j], imaginary[i, j]])
        minimum = minimize(
            lambda p: _singular_value(np.array(p[0] + 1j * p[1]), angle, before, after, poisson_ratio).item(),
            start,
            method="Nelder-Mead",
            bounds=[(STEP / 2, MAX_EXPONENT + 1), (0.0, 2.0)],
            # Small enough to separate close exponents.
            options={"initial_simplex": start + STEP / 2 * np.eye(3, 2, -1), "xatol": 1e-9, "fatol": 1e-12},
        )
        real_part, imaginary_part = minimum.x
        integer = np.hypot(real_part - round(real_part), imaginary_part) < 1e-5  # w is a polynomial
        if minimum.fun < 1e-6 and real_part > STEP / 2 and not integer:
            return float(real_part)
    return MAX_EXPONENT


def _singular_value(exponents: FloatArray, angle: float, before: str, after: str, poisson_ratio: float) -> FloatArray:
    """The smallest singular value of the four conditions on f, which vanishes at the admissible exponents."""
    rows = [*_conditions(exponents, 0.0, before, poisson_ratio), *_conditions(exponents, angle, after, poisson_ratio)]
    matrix = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
    matrix /= np.linalg.norm(matrix, axis=-1, keepdims=True) + 1e-300
    return np.asarray(np.linalg.svd(matrix, compute_uv=False)[..., -1])


def _conditions(exponents: FloatArray, angle: float, support: str, poisson_ratio: float) -> list[list[ComplexArray]]:
    """Two rows of four coefficients: of cos and sin of (lambda + 1) theta and of (lambda - 1) theta."""
    s, nu = exponents.astype(complex), poisson_ratio  # s is lambda
    a, b = (s + 1) * angle, (s - 1) * angle
    b = np.where(np.abs(s - 1) < 1e-12, 1e-12 * angle, b)
    d = np.where(np.abs(s - 1) < 1e-12, 1e-12, s - 1)  # the last function is sin((lambda - 1) theta) / (lambda - 1)
    # The functions and their derivatives in theta.
    f = [np.cos(a), np.sin(a), np.cos(b), np.sin(b) / d]
    f1 = [-(s + 1) * np.sin(a), (s + 1) * np.cos(a), -d * np.sin(b), np.cos(b)]
    f2 = [-((s + 1) ** 2) * f[0], -((s + 1) ** 2) * f[1], -(d**2) * f[2], -(d**2) * f[3]]
    f3 = [-((s + 1) ** 2) * f1[0], -((s + 1) ** 2) * f1[1], -(d**2) * f1[2], -(d**2) * f1[3]]
    if support == CLAMPED:
        return [f, f1]
    moment = [h + (s + 1) * (1 + nu * s) * g for g, h in zip(f, f2, strict=True)]
    if support == FREE:
        return [moment, [h + ((s + 1) ** 2 + (1 - nu) * s * (s - 1)) * g for g, h in zip(f1, f3, strict=True)]]
    return [f, moment]


def split(triangles: IntArray, rows: list[int], points: int) -> tuple[IntArray, Copies]:
    """Give every triangle at the points `rows` a point of its own.

    triangles: (m, 3).  points: their number.
    Returns the new triangles, and for every new point (new, first, neighbour, end): the corner it copies, the copy in
    the next triangle around the corner (first itself at the start), and the other end of the edge between them.
    """
    triangles, copies = triangles.copy(), []
    for row in rows:
        around = {
            t: set(triangles[t].tolist()) - {row} for t in np.flatnonzero((triangles == row).any(axis=1)).tolist()
        }
        ends = [end for others in around.values() for end in others]
        here = next(t for t, others in around.items() if any(ends.count(end) == 1 for end in others))
        label, current = row, around.pop(here)
        while around:
            following = [(t, min(o & current)) for t, o in around.items() if o & current]
            if not following:
                raise ValueError(
                    f"Input mesh of Plate must not have cells that touch only in a point; they do in point {row}"
                )
            there, shared = following[0]
            current = around.pop(there) - {shared}
            copies.append((points, row, label, shared))
            triangles[there][triangles[there] == row] = points
            label, points = points, points + 1
    return triangles, copies


def continuity(xy: FloatArray, copies: Copies, edges: int) -> csc_matrix:
    """The matrix that gives all unknowns of a mesh with split corners from those that keep it C1.

    A copy shares value and gradient with its corner; second derivatives may jump by a multiple of n n^T across each
    edge with normal n.

    xy: (n, 2), points before the split.  copies: from `split`.  edges: their number.
    """
    n, new = len(xy), len(copies)
    total = 6 * (n + new) + edges
    kept = np.concatenate([np.arange(6 * n), np.arange(6 * (n + new), total)])
    columns = np.full(total, -1)
    columns[kept] = np.arange(len(kept))
    rows, cols, data = [kept], [columns[kept]], [np.ones(len(kept))]

    def add(row: int, col: int, value: float) -> None:
        rows.append(np.array([row]))
        cols.append(np.array([col]))
        data.append(np.array([value]))

    jumps: dict[int, list[tuple[int, FloatArray]]] = {}  # of each copy against its corner
    for index, (copy, corner, neighbour, end) in enumerate(copies):
        along = xy[end] - xy[corner]
        x, y = along[1] / np.hypot(*along), -along[0] / np.hypot(*along)
        jumps[copy] = [*jumps.get(neighbour, []), (len(kept) + index, np.array([x * x, x * y, y * y]))]
        for k in range(6):
            add(6 * copy + k, 6 * corner + k, 1.0)
        for column, jump in jumps[copy]:
            for k in range(3):
                add(6 * copy + 3 + k, column, float(jump[k]))
    flat = [np.concatenate(parts) for parts in (data, rows, cols)]
    return coo_matrix((flat[0], (flat[1], flat[2])), shape=(total, len(kept) + new)).tocsc()
