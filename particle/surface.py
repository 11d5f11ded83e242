"""SurfaceMotion: the moving surface w(x, y, t) as arrays that every kernel reads.

    w(x, t) = sum_i h_i(t) v_i(x) + sum_j f_j(t) r_j^2 ln(r_j) / (8 pi),   f_j = sum_i strengths[j, i] h_i(t)

The logarithms around the sources are kept explicitly; the smooth shapes v_i are polynomials on the cells of a
background grid. Between two kinks of the drives h_i is one quintic, so that a cell's whole smooth part is one
polynomial in x, y, t.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.drive import ORDER, AnyDrive, DriveTable, drive_table, monomial_table
from particle.fields import evaluate_points

FloatArray = NDArray[np.float64]


class SurfaceState(NamedTuple):
    """The surface at points (n, 2) and one time."""

    w: FloatArray  # (n,) m
    w_t: FloatArray  # (n,) m/s
    w_tt: FloatArray  # (n,) m/s^2
    gradient: FloatArray  # (n, 2)
    gradient_t: FloatArray  # (n, 2) 1/s
    hessian: FloatArray  # (n, 2, 2) 1/m


class SurfaceMotion(NamedTuple):
    """A moving surface; made by `coupling.surface_motion`, `platform_surface` or `polynomial_surface`."""

    drives: DriveTable  # N drives, then the base's x and y where it moves
    sources: FloatArray  # (J, 2) m, the centres of the logarithms
    strengths: FloatArray  # (J, N), their strength per metre of drive
    size: float  # m, the length in the logarithms and that tolerances refer to
    floor: float  # m, radius below which the Hessian of a logarithm grows no more
    origin: FloatArray  # (2,) m, the grid's lower left corner
    cell_width: float  # m; inf: one polynomial everywhere, in x / size and y / size
    cell_rows: NDArray[np.int64]  # (nx, ny), a grid cell's row in `cells`, -1 where there is no plate
    cells: FloatArray  # (C, N, M), coefficients in (x - centre) / half a width, sorted by powers of x, then of y
    degree: int  # of those polynomials
    overhang: float  # a cell's polynomials hold out to this many half widths
    conics: FloatArray  # (k, 4) m, the rim's whole ellipses: centre x, y and semi-axes
    edges: FloatArray  # (m, 3, 2) m, its other edges: start, middle and end of parabolas; no rim where both are empty
    moving_base: bool  # whether two more drives carry the base in its plane
    error: float  # largest measured error of the shapes, relative to each one's height at its own actuator

    def evaluate(self, xy: ArrayLike, time: float) -> SurfaceState:
        """The surface at points (n, 2) [m] and a time [s].

        Raises ValueError when a point lies beyond the rim.
        """
        xy = np.atleast_2d(np.asarray(xy, dtype=float))
        rows = evaluate_points(self, xy, float(time))
        if np.isnan(rows).any():
            beyond = xy[np.isnan(rows).any(axis=1)][0].tolist()
            raise ValueError(f"Input xy of evaluate must lie on the surface; got {beyond} m")
        w, w_t, w_tt, x, y, xt, yt, xx, xy_, yy = rows.T
        hessian = np.stack([np.stack([xx, xy_], axis=-1), np.stack([xy_, yy], axis=-1)], axis=-2)
        return SurfaceState(w, w_t, w_tt, np.stack([x, y], axis=-1), np.stack([xt, yt], axis=-1), hessian)


def polynomial_surface(
    coefficients: ArrayLike, base: Sequence[AnyDrive] | None = None, size: float = 1.0
) -> SurfaceMotion:
    """A surface without rim and actuators, w = sum c[i, j, k] x^i y^j t^k in SI units: bowls, inclines, tests.

    coefficients: (I, J) for a surface at rest or (I, J, K) with K <= 6.  base: two drives that move it along x and y.
    size: m, the length that the integrator's tolerance refers to.
    Raises ValueError for any other shape.
    """
    c = np.asarray(coefficients, dtype=float)
    c = c[:, :, None] if c.ndim == 2 else c
    if c.ndim != 3 or not 1 <= c.shape[2] <= ORDER:
        raise ValueError(
            f"Input coefficients must have shape (I, J) or (I, J, K) with K <= 6; got {np.shape(coefficients)}"
        )
    if base is not None and len(base) != 2:
        raise ValueError(f"Input base of polynomial_surface must be two drives, for x and y; got {len(base)}")
    degree = c.shape[0] + c.shape[1] - 2
    square = np.zeros((degree + 1, degree + 1, c.shape[2]))
    square[: c.shape[0], : c.shape[1]] = c
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    cells = np.array([[square[i, j, k] * size ** (i + j) for i, j in powers] for k in range(c.shape[2])])
    return SurfaceMotion(
        drives=_joined(monomial_table(c.shape[2]), drive_table(base or [])),
        sources=np.zeros((0, 2)),
        strengths=np.zeros((0, c.shape[2])),
        size=size,
        floor=0.0,
        origin=np.zeros(2),
        cell_width=math.inf,
        cell_rows=np.zeros((1, 1), dtype=np.int64),
        cells=cells[None],
        degree=degree,
        overhang=math.inf,
        conics=np.zeros((0, 4)),
        edges=np.zeros((0, 3, 2)),
        moving_base=base is not None,
        error=0.0,
    )


def platform_surface(
    x: AnyDrive | None = None, y: AnyDrive | None = None, z: AnyDrive | None = None, size: float = 1.0
) -> SurfaceMotion:
    """A flat rigid surface without rim that drives move along x, y and z; None: not at all.

    Positions on it are counted from the platform.
    size: m, the length that the integrator's tolerance refers to; the platform's largest travel suits.
    Raises ValueError when the size is not positive.
    """
    if not (math.isfinite(size) and size > 0):
        raise ValueError(f"Input size of platform_surface must be a positive length in m; got {size!r}")
    flat = polynomial_surface([[1.0]], size=size)
    tables = [_still_table() if drive is None else drive_table([drive]) for drive in (z, x, y)]
    return flat._replace(drives=reduce(_joined, tables), moving_base=True)


def _still_table() -> DriveTable:
    """A drive that stays at 0, without kinks."""
    table = monomial_table(1)
    return table._replace(coefficients=np.zeros_like(table.coefficients))


def _joined(a: DriveTable, b: DriveTable) -> DriveTable:
    return DriveTable(
        np.concatenate([a.first, a.first[-1] + b.first[1:]]),
        *(np.concatenate([left, right]) for left, right in zip(a[1:], b[1:], strict=True)),
    )
