"""Surfaces w = sum_k h_k(t) p_k(x, y), u = sum_m g_m(t) q_m(x, y) of any drives and polynomials."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from particle import AnyDrive, HermiteDrive, SurfaceMotion, TableDrive, polynomial_surface
from particle.drives import drive_table


def driven(
    drives: Sequence[AnyDrive],
    shapes: Sequence[ArrayLike] = ([[1.0]],),
    base: Sequence[AnyDrive] = (),
    size: float = 1.0,
    rim: float | None = None,
    in_plane_drives: Sequence[AnyDrive] = (),
    in_plane: Sequence[ArrayLike] = (),
) -> SurfaceMotion:
    """drives: K <= 6; shapes: K times the coefficients (I, J) of x^i y^j; base: none or two; rim: m, of a disc.

    in_plane: coefficients (2, I, J) along x and y, one pair for each of its drives.
    """
    c = np.zeros((4, 4, len(shapes)))
    for k, shape in enumerate(shapes):
        p = np.asarray(shape, dtype=float)
        c[: p.shape[0], : p.shape[1], k] = p
    u = np.zeros((2, 4, 4, len(in_plane)))
    for m, pair in enumerate(in_plane):
        q = np.asarray(pair, dtype=float)
        u[:, : q.shape[1], : q.shape[2], m] = q
    surface = polynomial_surface(c, size=size, in_plane=u if in_plane else None)
    conics = np.array([[0.0, 0.0, rim, rim]]) if rim is not None else surface.conics
    table = drive_table([*drives, *in_plane_drives, *base])
    return replace(surface, drives=table, moving_base=bool(base), conics=conics)


def level(height: float = 1.0) -> TableDrive:
    """A drive that never moves."""
    return TableDrive([0.0, 1.0], [height, height])


def steady(velocity: float, end: float, delay: float = 0.0) -> HermiteDrive:
    """From rest at once at a constant velocity [m/s], and after `end` [s] at once at rest again."""
    return HermiteDrive([0.0, end], [0.0, velocity * end], [velocity] * 2, [0.0] * 2, delay=delay)
