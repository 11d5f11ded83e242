"""Basins of attraction: to which actuator parts come from where they start."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from coupling.plate_case import PlateCase
from coupling.readable import readable
from coupling.rim import rim_curves
from particle import Outcome
from studies.heat import COLOURS, draw_classes, draw_field, draw_outline
from studies.record import OUTCOMES
from studies.shown import Scale, Shown, mean

STARTS = (("part", "position", 0), ("part", "position", 1))
STAYING = (Outcome.STUCK, Outcome.MOVING)
MOST_ACTUATORS = 20  # with a colour each
SHORT = 0.02  # of the distance between the outermost actuators: less is hardly a way
STAYS = "#f2efe6"
WHITE = withStroke(linewidth=2.0, foreground="white")


def is_over_starts(shown: Shown) -> bool:
    """Whether a sweep's axes are the start's x and y, over a few actuators."""
    found = {scale.axis.field.locations[0] for scale in shown.axes}
    return found == set(STARTS) and 0 < len(shown.study.case.actuators) <= MOST_ACTUATORS


def draw_basins(figure: Figure, axes: list[Axes], shown: Shown) -> None:
    """Draw the actuator that is nearest to the end into the first axes, and how near it is into the second."""
    turned = shown.axes[0].axis.field.locations[0] == STARTS[1]
    places = [Scale.of(scale.axis, np.sort(scale.axis.values)) for scale in shown.axes]
    across, up = reversed(places) if turned else places
    actuators = np.array([actuator.position for actuator in shown.study.case.actuators])
    away = np.linalg.norm(shown.end[..., None, :] - actuators, axis=-1)  # (n, m, repeats, N)
    numbers, staying = shown.usual_outcome, [OUTCOMES.index(outcome.value) for outcome in STAYING]
    nearest = np.argmin(mean(np.moveaxis(away, -2, -1)), axis=-1)
    near = SHORT * float(np.ptp(actuators, axis=0).max() if len(actuators) > 1 else np.abs(across.values).max())
    carried = shown.mean_distance > near
    classes = np.where(np.isin(numbers, staying), len(OUTCOMES) + np.where(carried, 1 + nearest, 0), numbers)
    lengths = np.where(np.isin(numbers, staying), mean(away.min(axis=-1)), np.nan)
    unit = readable(np.array([near]), "m")
    stays = f"carried less than {near * unit.per_si:.2g} {unit.name}"
    names = (*OUTCOMES, stays, *(f"carried, nearest to actuator {k}" for k in range(len(actuators))))
    colours = (*COLOURS, STAYS, *(colormaps["tab20"](2 * k % 20 + 2 * k // 20) for k in range(len(actuators))))
    holds = shown.holds
    if turned:
        classes, lengths, holds = classes.T, lengths.T, None if holds is None else holds.T
    draw_classes(axes[0], across, up, classes, names, colours)
    axes[0].set_title("where the part is carried", fontsize=10)
    draw_field(figure, axes[1], across, up, lengths, "end to nearest actuator")
    for one in axes[:2]:
        _draw_plate(one, shown, across, up)
        draw_outline(one, across, up, holds)


def _draw_plate(axes: Axes, shown: Shown, across: Scale, up: Scale) -> None:
    """Draw the rim and the actuators, without making the frame larger."""
    scale = np.array([across.unit.per_si, up.unit.per_si])
    limits = axes.get_xlim(), axes.get_ylim()
    plate = shown.study.case.plate
    if isinstance(plate, PlateCase):
        outline = plate.coarse_mesh.outline
        step = float(np.ptp(outline.box, axis=0).max()) / 200
        axes.add_collection(LineCollection([c * scale for c in rim_curves(outline, step)], colors="black"))
    actuators = np.array([actuator.position for actuator in shown.study.case.actuators]) * scale
    axes.plot(*actuators.T, "^", color="white", markeredgecolor="black", markersize=7)
    for k, place in enumerate(actuators):
        axes.annotate(str(k), place, (4, 4), textcoords="offset points", fontsize=8, path_effects=[WHITE], clip_on=True)
    axes.set_aspect("equal")
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
