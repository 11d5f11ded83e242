"""Pictures over the start's x and y: to which actuator parts come from where, or where they end."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from active_surface.arrays import FloatArray
from active_surface.studies.columns import OUTCOMES
from active_surface.studies.pictures.charts import COLOURS, draw_classes, draw_field, draw_outline, frame, marks
from active_surface.studies.pictures.selection import Scale, Selection, mean
from common import draw_rim, quantity_text, unit_for
from fem_plate import mark_actuators
from particle import Outcome

STARTS: Final = ["part.position.0", "part.position.1"]
STAYING: Final = [OUTCOMES.index(outcome.value) for outcome in (Outcome.STUCK, Outcome.MOVING)]
MAX_ACTUATORS: Final = 20  # with a colour each
SHORT: Final = 0.02  # of the distance between the outermost actuators: less is hardly a way
NEARNESS: Final = "end to nearest actuator"
STAYS: Final = "#f2efe6"
NUMBERS: Final[dict[str, Any]] = {
    "textcoords": "offset points",
    "fontsize": "small",
    "path_effects": [withStroke(linewidth=2.0, foreground="white")],
    "clip_on": True,
}


def is_over_starts(selection: Selection) -> bool:
    """Whether a sweep's axes are the start's x and y, over a few actuators."""
    paths = sorted(scale.axis.field.path for scale in selection.axes)
    return paths == STARTS and 0 < len(selection.findings.actuators) <= MAX_ACTUATORS


def draw_basins(axes: Axes, selection: Selection) -> None:
    """Draw near which actuator a part ends that is carried."""
    (across, up), actuators = _places(selection), selection.findings.actuators
    widest = np.ptp(actuators, axis=0).max() if len(actuators) > 1 else np.abs(across.values).max()
    short = SHORT * float(widest)
    nearest = np.argmin(mean(np.moveaxis(_distances(selection), -2, -1)), axis=-1)
    carried = np.where(selection.mean_distance > short, len(OUTCOMES) + 1 + nearest, len(OUTCOMES))
    numbers = selection.usual_outcome
    classes = _turned(selection, np.where(np.isin(numbers, STAYING), carried, numbers))
    stays, count = f"carried less than {quantity_text(short, 'm', 2)}", len(actuators)
    names = (*OUTCOMES, stays, *(f"carried, nearest to actuator {k}" for k in range(count)))
    colours = (*COLOURS, STAYS, *(colormaps["tab20"](2 * k % 20 + 2 * k // 20) for k in range(count)))
    draw_classes(axes, across, up, classes, names, colours)
    _draw_plate(axes, across, up, selection)


def draw_nearness(axes: Axes, selection: Selection) -> None:
    """Draw how near the end is to the nearest actuator."""
    across, up = _places(selection)
    stays = np.isin(selection.usual_outcome, STAYING)
    lengths = np.where(stays, mean(_distances(selection).min(axis=-1)), np.nan)
    known = lengths[np.isfinite(lengths)]
    unit = unit_for(known if known.size else np.zeros(1), "m")
    draw_field(axes, across, up, _turned(selection, lengths), NEARNESS, unit)
    _draw_plate(axes, across, up, selection)


def draw_ends(axes: Axes, selection: Selection) -> None:
    """Draw where parts ended, for all repeats, and the plate's rim."""
    across, up = selection.axes
    order = [STARTS.index(scale.axis.field.path) for scale in selection.axes]
    scale = np.array([across.unit.per_si, up.unit.per_si])
    ends = selection.end.reshape(-1, 2)[:, order] * scale
    frame(axes, across, up)
    draw_rim(axes, [selection.findings.rim[:, order]], scale)
    mark_actuators(axes, selection.findings.actuators[:, order], per_metre=scale)
    axes.scatter(ends[:, 0], ends[:, 1], c="black", **marks(len(ends)))
    axes.set_aspect("equal")


def _turned(selection: Selection, values: Any) -> Any:
    """Values over the axes of a selection, turned so that x is the first."""
    return values if selection.axes[0].axis.field.path == STARTS[0] else values.T


def _places(selection: Selection) -> list[Scale]:
    """The start's x and y as places, however uneven they are."""
    ordered = sorted(selection.axes, key=lambda scale: scale.axis.field.path)
    return [Scale.of(scale.axis, np.sort(scale.axis.values)) for scale in ordered]


def _distances(selection: Selection) -> FloatArray:
    """How far each end is from each actuator (n, m, repeats, N) [m]."""
    distances: FloatArray = np.linalg.norm(selection.end[..., None, :] - selection.findings.actuators, axis=-1)
    return distances


def _draw_plate(axes: Axes, across: Scale, up: Scale, selection: Selection) -> None:
    """Draw the rim, the actuators by their numbers and the threshold's line, without making the frame larger."""
    scale, limits = np.array([across.unit.per_si, up.unit.per_si]), (axes.get_xlim(), axes.get_ylim())
    draw_rim(axes, [selection.findings.rim], scale)
    mark_actuators(axes, selection.findings.actuators, per_metre=scale)
    for k, place in enumerate(selection.findings.actuators * scale):
        axes.annotate(str(k), place, (4, 4), **NUMBERS)
    axes.set(aspect="equal", xlim=limits[0], ylim=limits[1])
    draw_outline(axes, across, up, None if selection.holds is None else _turned(selection, selection.holds))
