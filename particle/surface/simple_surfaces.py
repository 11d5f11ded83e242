"""Surfaces without actuators: polynomials and platforms."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike

from particle.drives import ORDER, AnyDrive, DriveTable, drive_table, monomial_table
from particle.surface.cells import OneCell
from particle.surface.moving_surface import SurfaceMotion
from particle.types import FloatArray


def polynomial_surface(
    coefficients: ArrayLike,
    base: Sequence[AnyDrive] | None = None,
    size: float = 1.0,
    in_plane: ArrayLike | None = None,
) -> SurfaceMotion:
    """A polynomial surface without rim and actuators, w = sum c[i, j, k] x^i y^j t^k in SI units: bowls, inclines,
    tests.

    Parameters
    ----------
    coefficients : array (I, J) or (I, J, K)
        c, for a surface at rest or a moving one with K <= 6.
    size : float
        Length that the integrator's tolerance refers to, m.
    base : two or three drives, optional
        Motion of the base along x and y [m], and its turn about the origin [rad].
    in_plane : array (2, I, J) or (2, I, J, K), optional
        Motion of the mid-plane in its plane, along x and y, as polynomials like w.

    Returns
    -------
    surface : SurfaceMotion
        The surface.

    Raises
    ------
    ValueError
        The coefficients have any other shape.
    """
    c = np.asarray(coefficients, dtype=float)
    c = c[:, :, None] if c.ndim == 2 else c
    if c.ndim != 3 or not 1 <= c.shape[2] <= ORDER:
        raise ValueError(
            f"Input coefficients must have shape (I, J) or (I, J, K) with K <= 6; got {np.shape(coefficients)}"
        )
    u = np.zeros((2, 1, 1, 0)) if in_plane is None else np.asarray(in_plane, dtype=float)
    u = u[..., None] if u.ndim == 3 else u
    if u.ndim != 4 or len(u) != 2 or u.shape[3] > ORDER:
        raise ValueError(f"Input in_plane must have shape (2, I, J) or (2, I, J, K) with K <= 6; got {u.shape}")
    if base is not None and len(base) not in (2, 3):
        wanted = "two drives, for x and y, or a third one for its turn"
        raise ValueError(f"Input base of polynomial_surface must be {wanted}; got {len(base)}")
    shapes, degree = _rows(c, size)
    (along_x, plane_degree), (along_y, _) = (_rows(component, size) for component in u)
    return SurfaceMotion(
        drives=reduce(_joined, [monomial_table(c.shape[2]), monomial_table(u.shape[3]), drive_table(base or [])]),
        store=OneCell(shapes, degree, size, np.stack([along_x, along_y], axis=1), plane_degree),
        sources=np.zeros((0, 2)),
        size=size,
        moving_base=base is not None,
        turning_base=base is not None and len(base) == 3,
        in_plane_count=u.shape[3],
    )


def _rows(c: FloatArray, size: float) -> tuple[FloatArray, int]:
    """Monomials (K, M) in x/size and y/size of coefficients (I, J, K), and their degree."""
    degree = c.shape[0] + c.shape[1] - 2
    square = np.zeros((degree + 1, degree + 1, c.shape[2]))
    square[: c.shape[0], : c.shape[1]] = c
    powers = [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]
    return np.array([[square[i, j, k] * size ** (i + j) for i, j in powers] for k in range(c.shape[2])]).reshape(
        c.shape[2], len(powers)
    ), degree


def platform_surface(
    x: AnyDrive | None = None,
    y: AnyDrive | None = None,
    z: AnyDrive | None = None,
    size: float = 1.0,
    turn: AnyDrive | None = None,
) -> SurfaceMotion:
    """A flat rigid surface without rim that drives move along x, y and z.

    Positions on it are relative to the platform.

    Parameters
    ----------
    x, y, z : drive, optional
        Motion along each axis; None: no motion.
    size : float
        Length that the integrator's tolerance refers to, m; the platform's largest travel suits.
    turn : drive, optional
        Its turn about the origin, counter-clockwise, with heights in rad.

    Returns
    -------
    surface : SurfaceMotion
        The surface.

    Raises
    ------
    ValueError
        The size is not positive.
    """
    if not (math.isfinite(size) and size > 0):
        raise ValueError(f"Input size of platform_surface must be a positive length in m; got {size!r}")
    flat = polynomial_surface([[1.0]], size=size)
    own = (z, x, y) if turn is None else (z, x, y, turn)
    tables = [_still_table() if drive is None else drive_table([drive]) for drive in own]
    return replace(flat, drives=reduce(_joined, tables), moving_base=True, turning_base=turn is not None)


def _still_table() -> DriveTable:
    """A drive that stays at 0, without breakpoints."""
    table = monomial_table(1)
    return table._replace(coefficients=np.zeros_like(table.coefficients))


def _joined(a: DriveTable, b: DriveTable) -> DriveTable:
    return DriveTable(
        np.concatenate([a.first, a.first[-1] + b.first[1:]]),
        np.concatenate([a.loop, a.first[-1] + b.loop]),
        *(np.concatenate([left, right]) for left, right in zip(a[2:], b[2:], strict=True)),
    )
