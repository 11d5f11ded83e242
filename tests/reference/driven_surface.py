"""Surfaces w = sum_k h_k(t) p_k(x, y) of any drives h_k and polynomials p_k, to try a part's motion on."""

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
) -> SurfaceMotion:
    """drives: K <= 6; shapes: K times the coefficients (I, J) of x^i y^j; base: none or two; rim: m, of a disc."""
    c = np.zeros((4, 4, len(shapes)))
    for k, shape in enumerate(shapes):
        p = np.asarray(shape, dtype=float)
        c[: p.shape[0], : p.shape[1], k] = p
    surface = polynomial_surface(c, size=size)
    conics = np.array([[0.0, 0.0, rim, rim]]) if rim is not None else surface.conics
    return replace(surface, drives=drive_table([*drives, *base]), moving_base=bool(base), conics=conics)


def level(height: float = 1.0) -> TableDrive:
    """A drive that never moves."""
    return TableDrive([0.0, 1.0], [height, height])


def steady(velocity: float, end: float, delay: float = 0.0) -> HermiteDrive:
    """From rest at once at a constant velocity [m/s], and after `end` [s] at once at rest again."""
    return HermiteDrive([0.0, end], [0.0, velocity * end], [velocity] * 2, [0.0] * 2, delay=delay)
