"""The picture of a case: its plate from above with the actuators, and the part where it starts."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from coupling.case import Case
from coupling.plate_case import PlateCase
from fem_plate.picture import draw_rim, mark_actuators
from particle.picture import PLACE, RING
from plotting.drawing import plan, put_below

ARROW = 0.15  # of the frame's side is the arrow of the start's velocity


def draw_case(case: Case, axes: Axes) -> None:
    """Draw a case into axes in m."""
    keys: list[Artist] = []
    if isinstance(case.plate, PlateCase):
        mesh = case.plate.coarse_mesh
        keys += draw_rim(axes, mesh, case.plate.supports_of(list(mesh.boundaries)))
    keys += mark_actuators(axes, np.array([actuator.position for actuator in case.actuators]).reshape(-1, 2))
    start, velocity = np.array(case.part.position), np.array(case.part.velocity)
    keys += axes.plot(*start, **RING, **PLACE, label="the part at the start")
    plan(axes)
    speed = float(np.hypot(*velocity))
    if speed:
        tip = start + velocity / speed * ARROW * np.ptp(axes.get_xlim())
        axes.annotate("", tuple(tip), tuple(start), arrowprops={"arrowstyle": "->", "linewidth": 1.4})
    put_below(axes, handles=keys, ncols=min(len(keys), 3))
