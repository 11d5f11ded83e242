"""The picture of an aim or plan: the path over the plate with its targets, and where disturbed runs end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from active_surface.arrays import FloatArray
from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.scatter import Scatter
from common import NOTHING, Drawing, Unit, draw_rim, quantity_text, unit_for
from coupling.case import Case, PlateCase
from coupling.pictures import (
    clear_labels,
    draw_path,
    draw_window,
    is_visible,
    join,
    map_axes,
    path_window,
    put_keys,
    put_label,
    put_title,
    save_picture,
)
from fem_plate import frame_around, mark_actuators, marker_size
from meshes import rim_curves
from particle import HALO, Trajectory

Place = tuple[float, float]

SIZE = 5.6  # inches, of a panel
SAMPLES = 4000
ROOM = 1.15  # of the distance of the farthest end that is drawn
FAR = 4.0  # times the spread of the ends: an arrow points to a target farther off
SHARE_OF_WAY = 0.01  # to a target that is pointed at: the least that the frame shows
MIN_FRAME = 1e-9  # m
SHARE = 0.97  # of the ends: at least so many are drawn
MAX_NUMBERED = 100  # actuators
MIN_MARKER = 1.5  # points, of actuators too many to be drawn apart
TARGET: dict[str, Any] = {
    "marker": "D",
    "markerfacecolor": "none",
    "markeredgecolor": "#c8371b",
    "markersize": 14,
    "markeredgewidth": 1.8,
}
WORDS: dict[str, Any] = {"fontsize": 9, "path_effects": HALO}
ENDS: dict[str, Any] = {"marker": "o", "color": "#1b4f9c", "markersize": 4, "markeredgewidth": 0, "alpha": 0.6}


def draw_aim(result: Aimed, path: Path) -> Path:
    """Draw the result of a search into a PNG file; return its path."""
    title = f"{result.task.name}: the part ends {_off(result, result.task.target)}"
    return _draw(result, title, [result.task.target], path)


def draw_plan(result: Planned, path: Path) -> Path:
    """Draw the result of a plan into a PNG file; return its path."""
    route = result.route
    targets = result.targets
    which = "the last of them" if len(targets) == len(route.through) else f"way-point {len(targets) - 1}"
    tolerance = quantity_text(route.settings.tolerance, "m")
    count = f"{sum(result.reached)} of {len(route.through)} way-points within {tolerance}"
    return _draw(result, f"{route.name}: {count}; the part ends {_off(result, targets[-1], which)}", targets, path)


def _draw(result: SteeringResult, title: str, targets: Sequence[Place], path: Path) -> Path:
    """Draw a path over its plate with the targets [m] in their order, and the ends of disturbed runs, into a file."""
    assert result.scatter is not None
    case, trajectory, scatter = result.case, result.trajectory, result.scatter
    way = _way_of(case, trajectory, targets)
    maps = 1 if way.window is None else 2
    figure = Drawing(figsize=((maps + 1) * SIZE + 0.8, SIZE + 0.9))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    axes = [figure.add_subplot(1, maps + 1, k + 1) for k in range(maps + 1)]
    keys = _draw_plate(figure, axes[:maps], case, way)
    keys += _draw_ends(axes[-1], trajectory, targets[-1], scatter)
    put_title(figure, title)
    put_keys(figure, keys)
    clear_labels(figure)
    return save_picture(figure, path)


class _Way(NamedTuple):
    """A path with its targets, and where it lies on its plate."""

    trajectory: Trajectory
    line: FloatArray  # (k, 2) m, the path with as many points as make it smooth
    targets: FloatArray  # (n, 2) m, in their order
    box: FloatArray  # (2, 2) m, around the plate
    window: FloatArray | None  # (2, 2) m, around path and targets; None: they are long enough to see on the plate


def _way_of(case: Case, trajectory: Trajectory, targets: Sequence[Place]) -> _Way:
    assert isinstance(case.plate, PlateCase)
    box, places = case.plate.coarse_mesh.outline.box, np.array(targets)
    line = trajectory.at(np.linspace(0, trajectory.time[-1], SAMPLES)).position
    actuators = np.array([actuator.position for actuator in case.actuators])
    return _Way(trajectory, line, places, box, path_window(np.concatenate([line, places]), box, actuators))


def _draw_plate(figure: Figure, axes: Sequence[Axes], case: Case, way: _Way) -> list[Artist]:
    """Draw the path over the plate, or in a window beside it, with the targets; return keys."""
    frame = frame_around(way.box)
    unit = unit_for(way.box, "m")
    keys = _draw_actuators(axes[0], case, frame, unit)
    axes[0].set_title("The path over the plate, and the actuators by their numbers", fontsize=10)
    if way.window is not None:
        axes[0].set_title("The plate, and the actuators by their numbers", fontsize=10)
        draw_window(axes[0], unit, way.window)
        frame, whole = way.window, unit
        unit = unit_for(frame, "m")
        _draw_actuators(axes[1], case, frame, unit)
        axes[1].set_title("Around the path", fontsize=10)
        join(figure, list(axes), whole, frame)
    keys += draw_path(axes[-1], way.trajectory, way.line, unit, is_visible(way.line, frame))
    drawn = way.targets * unit.per_si
    keys += axes[-1].plot(*drawn.T, linestyle="", **TARGET, path_effects=HALO, zorder=4, label="target")
    for number, place in enumerate(drawn.tolist() if len(drawn) > 1 else []):
        put_label(axes[-1], str(number), place, (11.5, 11.5), color=TARGET["markeredgecolor"], weight="bold", **WORDS)
    return keys


def _draw_actuators(axes: Axes, case: Case, frame: FloatArray, unit: Unit) -> list[Artist]:
    """Draw the rim and the actuators within a frame (2, 2) [m], with their numbers; return keys."""
    assert isinstance(case.plate, PlateCase)
    map_axes(axes, unit)
    draw_rim(axes, rim_curves(case.plate.coarse_mesh.outline), unit.per_si)
    axes.set_xlim(*(frame[:, 0] * unit.per_si))
    axes.set_ylim(*(frame[:, 1] * unit.per_si))
    keys: list[Artist] = []
    moving = np.array([bool(actuator.stroke) or actuator.segments is not None for actuator in case.actuators])
    places = np.array([actuator.position for actuator in case.actuators])
    size = marker_size(places, frame) or MIN_MARKER
    for some, colour, label in ((moving, "#7fa8c9", "moving actuator"), (~moving, "white", "actuator at rest")):
        keys += mark_actuators(axes, places[some], frame, unit.per_si, size=size, colour=colour, label=label)
    within = ((places > frame[0]) & (places < frame[1])).all(axis=1)
    for number in np.flatnonzero(within).tolist() if len(places) <= MAX_NUMBERED else ():
        put_label(axes, str(number), places[number] * unit.per_si, (0, -6), color="#606060", **WORDS)
    return keys


def _draw_ends(axes: Axes, trajectory: Trajectory, target: Place, scatter: Scatter) -> list[Artist]:
    """Draw the ends around the target, without outliers, and circles that hold half and nine tenths of them.

    A circle that would have to hold lost parts is left out. Where all ends are far from the target, draw them around
    their median, with an arrow to the target.
    """
    circles = {share: away for share in (0.5, 0.9) if np.isfinite(away := scatter.quantile(share))}
    off, end = scatter.ends - target, trajectory.position[-1] - target
    middle = np.median(np.vstack([off, end]), axis=0)
    spread = float(np.quantile(np.hypot(*(np.vstack([off, end]) - middle).T), SHARE))
    missed = float(np.hypot(*middle)) > FAR * spread
    if missed:
        centre, reach = middle, max(spread, SHARE_OF_WAY * float(np.hypot(*middle)))
    else:
        centre = np.zeros(2)
        reach = max(float(np.quantile(np.hypot(*off.T), SHARE)), float(np.hypot(*end)), *circles.values())
    side = ROOM * max(reach, MIN_FRAME)
    unit = unit_for(side + float(np.hypot(*centre)), "m")
    map_axes(axes, unit, " from the target")
    keys: list[Artist] = []
    keys += axes.plot(*(off * unit.per_si).T, linestyle="", **ENDS, label="ends of disturbed runs")
    axes.plot(*(end * unit.per_si), "x", color="black", markersize=7, markeredgewidth=1.6, path_effects=HALO, zorder=5)
    if missed:
        way = -middle / np.hypot(*middle) * side * unit.per_si
        tail, tip = (centre * unit.per_si + share * way for share in (0.55, 0.95))
        axes.annotate("", tip, tail, arrowprops={"arrowstyle": "->", "color": TARGET["markeredgecolor"], "lw": 1.8})
        put_label(axes, f"target, {quantity_text(float(np.hypot(*middle)), 'm')}", tail, (0, 6), **WORDS)
    else:
        axes.plot(0, 0, linestyle="", **TARGET, zorder=4)
        for share, distance in circles.items():
            radius = distance * unit.per_si
            axes.add_patch(Circle((0, 0), radius, fill=False, edgecolor="#606060", linewidth=0.8))
            put_label(axes, f"{share:.0%}", (0, radius), (0, 3), color="#606060", **WORDS)
    low, high = (centre - side) * unit.per_si, (centre + side) * unit.per_si
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    beyond = int((np.abs(off - centre).max(axis=1) > side).sum())
    more = f", {beyond} of them beyond this frame" if beyond else ""
    axes.set_title(f"Where {len(off)} disturbed runs end{more}", fontsize=10)
    return keys


def _off(result: SteeringResult, target: Place, name: str = "the target") -> str:
    """How far from a target [m] the part ends, in words."""
    away = float(np.hypot(*(result.trajectory.position[-1] - target)))
    return f"{quantity_text(away, 'm')} from {name}" if away > NOTHING else f"at {name}"
