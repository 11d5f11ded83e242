"""What actuators are asked for beyond what they can bear."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from common import quantity_text
from coupling.case import Case, PlateCase
from coupling.drives import build_drives, moments, stroke_heights
from coupling.scene import actuator_stiffness, build_plate
from fem_plate import InfluenceShapes, PlateShapes

FloatArray = NDArray[np.float64]
SLACK = 1 + 1e-6  # of a limit that is met exactly


def largest_forces(case: Case, shapes: PlateShapes | None = None) -> FloatArray:
    """The largest forces (N,) [N], up or down, that actuators take to follow their drives.

    By linear theory, P(t) = K h(t), and with a pressure what holds the plate against that, without inertia and without
    the part. shapes: those of the case, if known.
    """
    assert isinstance(case.plate, PlateCase)
    if shapes is None:
        points = [actuator.position for actuator in case.actuators]
        shapes = build_plate(case.plate).influence(points, actuator_stiffness(case))
    drives = build_drives(case)
    heights = stroke_heights(drives, moments(drives, case.run.duration))
    forces = shapes.stiffness @ heights.T
    if case.plate.pressure:
        assert isinstance(shapes, InfluenceShapes)
        forces = forces + shapes.pressure_forces(case.plate.pressure)[:, None]
    return np.asarray(np.abs(forces).max(axis=1))


def limit_warnings(case: Case, shapes: PlateShapes | None = None) -> list[str]:
    """One sentence where actuators take more than their max_force; none where all are within it."""
    limits = np.array([actuator.max_force or np.inf for actuator in case.actuators])
    if not np.isfinite(limits).any():
        return []
    forces = largest_forces(case, shapes)
    beyond = np.flatnonzero(forces > SLACK * limits)
    if not beyond.size:
        return []
    worst = int(beyond[np.argmax(forces[beyond] / limits[beyond])])
    who = f"{len(beyond)} actuators take" if len(beyond) > 1 else f"Actuator {worst} takes"
    most = f", actuator {worst} most" if len(beyond) > 1 else ""
    needed, limit = quantity_text(float(forces[worst]), "N"), quantity_text(float(limits[worst]), "N")
    assert isinstance(case.plate, PlateCase)
    more = "; a plate that stretches takes more" if case.plate.theory == "von-karman" else ""
    return [
        f"{who} more than max_force{most}: {needed} of {limit}, by linear theory without inertia{more}. Reduce the "
        "strokes, or let neighbours share them."
    ]
