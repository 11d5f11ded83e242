"""The picture of a case: its plate from above with actuators and start, or the motion of its platform."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from common import axes_or_new, draw, figure_of, label_axis, label_places, legend_below
from coupling.case import AXES, Case, PlateCase, PlatformCase
from coupling.progress import silent
from coupling.scene import platform_scene
from fem_plate import draw_supports, frame_around, mark_actuators
from particle import PATH_COLOUR, PLACE, RING

ARROW = 0.15  # of the frame's side: the length of the arrow of the initial velocity
SAMPLES = 1000
STYLES = "-", "--", ":"


@draw.register(Case)
def draw_case(case: Case, axes: Axes | None = None) -> Figure:
    """Draw a case into axes in m, or of a platform in s and m."""
    axes = axes_or_new(axes)
    if isinstance(case.plate, PlateCase):
        _draw_plate(case, case.plate, axes)
    else:
        _draw_motion(case.plate, case.run.duration, axes)
    return figure_of(axes)


def _draw_plate(case: Case, plate: PlateCase, axes: Axes) -> None:
    mesh = plate.coarse_mesh
    keys = draw_supports(axes, mesh, plate.supports_of(list(mesh.boundaries)))
    places = np.array([actuator.position for actuator in case.actuators])
    keys += mark_actuators(axes, places, frame_around(mesh.outline.box))
    start, velocity = np.array(case.part.position), np.array(case.part.velocity)
    keys += axes.plot(*start, **RING, **PLACE, label="start")
    label_places(axes)
    speed = float(np.hypot(*velocity))
    if speed:
        tip = start + velocity / speed * ARROW * np.ptp(axes.get_xlim())
        axes.annotate("", tuple(tip), tuple(start), arrowprops={"arrowstyle": "->", "linewidth": 1.4})
    legend_below(axes, handles=keys, ncols=min(len(keys), 3))


def _draw_motion(platform: PlatformCase, duration: float, axes: Axes) -> None:
    """Draw the displacement of a platform along each axis over time, and its turn on a scale at the right."""
    scene = platform_scene(platform, silent)
    times = np.linspace(0, duration, SAMPLES)
    for name, drive, style in zip(AXES, (*scene.base[:2], *scene.lifts), STYLES, strict=True):
        axes.plot(times, drive.evaluate(times)[0], style, color="black", label=f"along {name}")
    for turn in scene.base[2:]:
        right = axes.twinx()
        right.plot(times, turn.evaluate(times)[0], color=PATH_COLOUR)
        label_axis(right.yaxis, "turn of the platform", "rad")
        right.yaxis.label.set_color(PATH_COLOUR)
    axes.set_xlim(0, duration)
    label_axis(axes.xaxis, "time", "s")
    label_axis(axes.yaxis, "place of the platform", "m")
    legend_below(axes, ncols=len(STYLES))
