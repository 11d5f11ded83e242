"""Basins of attraction: to which actuator parts come from where they start."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from active_surface.studies.pictures.heat import COLOURS, draw_classes, draw_field, draw_outline
from active_surface.studies.pictures.selection import Scale, Selection, mean
from active_surface.studies.record import OUTCOMES
from common import draw_rim, quantity_text, unit_for
from fem_plate import mark_actuators
from particle import Outcome

STARTS = ("part.position.0", "part.position.1")
STAYING = (Outcome.STUCK, Outcome.MOVING)
MAX_ACTUATORS = 20  # with a colour each
SHORT = 0.02  # of the distance between the outermost actuators: less is hardly a way
NEARNESS = "end to nearest actuator"
STAYS = "#f2efe6"
WHITE = withStroke(linewidth=2.0, foreground="white")


def is_over_starts(selection: Selection) -> bool:
    """Whether a sweep's axes are the start's x and y, over a few actuators."""
    paths = {scale.axis.field.path for scale in selection.axes}
    return paths == set(STARTS) and 0 < len(selection.findings.actuators) <= MAX_ACTUATORS


class Basins:
    """Where parts are carried from where, over the start's x and y."""

    def __init__(self, selection: Selection) -> None:
        turned = selection.axes[0].axis.field.path == STARTS[1]
        places = [Scale.of(scale.axis, np.sort(scale.axis.values)) for scale in selection.axes]
        self.across, self.up = reversed(places) if turned else places
        self.findings = selection.findings
        actuators = selection.findings.actuators
        away = np.linalg.norm(selection.end[..., None, :] - actuators, axis=-1)  # (n, m, repeats, N)
        numbers, staying = selection.usual_outcome, [OUTCOMES.index(outcome.value) for outcome in STAYING]
        nearest = np.argmin(mean(np.moveaxis(away, -2, -1)), axis=-1)
        widest = np.ptp(actuators, axis=0).max() if len(actuators) > 1 else np.abs(self.across.values).max()
        self.short_way = SHORT * float(widest)
        carried = selection.mean_distance > self.short_way
        classes = np.where(np.isin(numbers, staying), len(OUTCOMES) + np.where(carried, 1 + nearest, 0), numbers)
        lengths = np.where(np.isin(numbers, staying), mean(away.min(axis=-1)), np.nan)
        holds = selection.holds
        if turned:
            classes, lengths, holds = classes.T, lengths.T, None if holds is None else holds.T
        self.classes, self.lengths, self.holds = classes, lengths, holds

    def draw_carried(self, axes: Axes) -> None:
        """Draw the actuator that is nearest to the end."""
        count = len(self.findings.actuators)
        stays = f"carried less than {quantity_text(self.short_way, 'm', 2)}"
        names = (*OUTCOMES, stays, *(f"carried, nearest to actuator {k}" for k in range(count)))
        colours = (*COLOURS, STAYS, *(colormaps["tab20"](2 * k % 20 + 2 * k // 20) for k in range(count)))
        draw_classes(axes, self.across, self.up, self.classes, names, colours)
        self._draw_plate(axes)

    def draw_nearness(self, figure: Figure, axes: Axes) -> None:
        """Draw how near the end is to the nearest actuator."""
        known = self.lengths[np.isfinite(self.lengths)]
        unit = unit_for(known if known.size else np.zeros(1), "m")
        draw_field(figure, axes, self.across, self.up, self.lengths, NEARNESS, unit)
        self._draw_plate(axes)

    def _draw_plate(self, axes: Axes) -> None:
        """Draw the rim, the actuators and the threshold's line, without making the frame larger."""
        scale = np.array([self.across.unit.per_si, self.up.unit.per_si])
        limits = axes.get_xlim(), axes.get_ylim()
        draw_rim(axes, self.findings.rim, scale)
        mark_actuators(axes, self.findings.actuators, per_metre=scale)
        look: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small", "path_effects": [WHITE]}
        for k, place in enumerate(self.findings.actuators * scale):
            axes.annotate(str(k), place, (4, 4), clip_on=True, **look)
        axes.set_aspect("equal")
        axes.set_xlim(*limits[0])
        axes.set_ylim(*limits[1])
        draw_outline(axes, self.across, self.up, self.holds)
