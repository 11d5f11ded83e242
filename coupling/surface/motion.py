"""From the plate's shapes and the drives to the moving surface: where statics meets time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from coupling.surface.cell_maker import OVERHANG
from coupling.surface.cells import PlateCells
from fem_plate import Shapes
from particle import AnyDrive, SurfaceMotion
from particle.drives import drive_table

SURFACE_TOLERANCE = 1e-8  # of a unit stroke
FLOOR = 1e-6  # of the plate's size: the radius below which a point load's Hessian grows no more


def surface_motion(
    shapes: Shapes,
    drives: Sequence[AnyDrive],
    surface_tolerance: float = SURFACE_TOLERANCE,
    half_thickness: float = 0.0,
) -> SurfaceMotion:
    """Combine influence shapes and drives into the surface over time, w(x, t) = sum_i h_i(t) phi_i(x).

    Parameters
    ----------
    shapes : Shapes
        Influence shapes of N actuators, from finite elements or in closed form.
    drives : sequence of drives
        One for each actuator.
    surface_tolerance : float
        Largest error of a unit shape's fit in w; the surface's `error` states what was measured.
    half_thickness : float
        Height over the mid-plane of the face that parts lie on, m; 0: parts lie on the mid-plane.

    Returns
    -------
    surface : SurfaceMotion
        The surface.

    Raises
    ------
    ValueError
        There is not one drive for each actuator, or the tolerance is not within [1e-13, 1e-3], or the half
        thickness is negative.
    """
    wrong = []
    if len(drives) != len(shapes.points):
        wrong.append(f"Input drives must be one an actuator, {len(shapes.points)}; got {len(drives)}")
    if not 1e-13 <= surface_tolerance <= 1e-3:
        wrong.append(f"Input surface_tolerance must be in [1e-13, 1e-3]; got {surface_tolerance!r}")
    if not 0 <= half_thickness < math.inf:
        wrong.append(f"Input half_thickness must be 0 or a positive length in m; got {half_thickness!r}")
    if wrong:
        raise ValueError("; ".join(wrong))
    return SurfaceMotion(
        drives=drive_table(drives),
        store=PlateCells(shapes, surface_tolerance),
        sources=shapes.points,
        size=shapes.size,
        floor=FLOOR * shapes.size,
        overhang=OVERHANG,
        conics=np.ascontiguousarray(shapes.outline.conics),
        edges=np.ascontiguousarray(shapes.outline.edges),
        half_thickness=half_thickness,
    )
