"""From the plate's shapes and the drives to the moving surface: where statics meets time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from coupling.surface.cell import Fitted, InPlane
from coupling.surface.cell_maker import OVERHANG
from coupling.surface.cells import PlateCells
from particle import AnyDrive, SurfaceMotion
from particle.drives import drive_table

SURFACE_TOLERANCE = 1e-8  # of a unit stroke
FLOOR = 1e-6  # of the plate's size: the radius below which a point load's Hessian grows no more


def surface_motion(
    shapes: Fitted,
    drives: Sequence[AnyDrive],
    surface_tolerance: float = SURFACE_TOLERANCE,
    half_thickness: float = 0.0,
    in_plane_drives: Sequence[AnyDrive] = (),
) -> SurfaceMotion:
    """Combine influence shapes and drives into the surface over time, w(x, t) = sum_i h_i(t) phi_i(x).

    Parameters
    ----------
    shapes : Shapes
        Influence shapes of N actuators, from finite elements or in closed form; or any object with their `points`,
        `strengths` (J, K), `size`, `outline`, `own_heights` and `nonzero_values`, of K shapes with logarithms at J
        points. With `in_plane_values(xy)`, an array (n, M, 2), and `in_plane_heights()`, an array (M,), M more shapes
        move the mid-plane in its plane, u(x, t) = sum_m g_m(t) U_m(x).
    drives : sequence of drives
        One for each actuator, then one for each further shape.
    surface_tolerance : float
        Largest error of a unit shape's fit in w; the surface's `error` states what was measured.
    half_thickness : float
        Height over the mid-plane of the face that parts lie on, m; 0: parts lie on the mid-plane.
    in_plane_drives : sequence of drives
        g_m, one for each shape in the plane.

    Returns
    -------
    surface : SurfaceMotion
        The surface.

    Raises
    ------
    ValueError
        There is not one drive for each shape, or the tolerance is not within [1e-13, 1e-3], or the half thickness is
        negative.
    """
    wrong = []
    count, in_plane_count = (
        shapes.strengths.shape[1],
        len(shapes.in_plane_heights()) if isinstance(shapes, InPlane) else 0,
    )
    if len(drives) != count:
        one = "an actuator" if count == len(shapes.points) else "a shape"
        wrong.append(f"Input drives must be one {one}, {count}; got {len(drives)}")
    if len(in_plane_drives) != in_plane_count:
        wrong.append(
            f"Input in_plane_drives must be one a shape in the plane, {in_plane_count}; got {len(in_plane_drives)}"
        )
    if not 1e-13 <= surface_tolerance <= 1e-3:
        wrong.append(f"Input surface_tolerance must be in [1e-13, 1e-3]; got {surface_tolerance!r}")
    if not 0 <= half_thickness < math.inf:
        wrong.append(f"Input half_thickness must be 0 or a positive length in m; got {half_thickness!r}")
    if wrong:
        raise ValueError("; ".join(wrong))
    return SurfaceMotion(
        drives=drive_table([*drives, *in_plane_drives]),
        store=PlateCells(shapes, surface_tolerance),
        sources=shapes.points,
        size=shapes.size,
        floor=FLOOR * shapes.size,
        overhang=OVERHANG,
        conics=np.ascontiguousarray(shapes.outline.conics),
        edges=np.ascontiguousarray(shapes.outline.edges),
        half_thickness=half_thickness,
        in_plane_count=in_plane_count,
    )
