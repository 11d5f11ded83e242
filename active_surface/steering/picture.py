"""The picture of an aim or plan: the path over the plate with its targets, and where disturbed runs end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from active_surface.steering.result import Aimed, Planned, SteeringResult
from active_surface.steering.robustness import Scatter
from active_surface.steering.task import Place
from common import NOTHING, Drawing, quantity_text, unit_for
from coupling.case import PlateCase
from coupling.pictures import (
    PlateView,
    clear_labels,
    draw_maps,
    draw_path,
    map_axes,
    path_window,
    put_keys,
    put_label,
    put_title,
    save_picture,
)
from particle import HALO, Trajectory

SIZE = 5.6  # inches, of a panel
SAMPLES = 4000
ROOM = 1.15  # of the distance of the farthest end that is drawn
FAR = 4.0  # times the spread of the ends: an arrow points to a target farther off
SHARE_OF_WAY = 0.01  # to a target that is pointed at: the least that the frame shows
MIN_FRAME = 1e-9  # m
SHARE = 0.97  # of the ends: at least so many are drawn
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
    task = result.task
    ends = f"the part ends {_off(result, 'the target' if task.heading is None else 'target and heading')}"
    return _draw(result, f"{task.name}: {ends if result.reached else f'target missed, {ends}'}", path)


def draw_plan(result: Planned, path: Path) -> Path:
    """Draw the result of a plan into a PNG file; return its path."""
    route = result.route
    targets = result.targets
    which = "the last of them" if len(targets) == len(route.through) else f"way-point {len(targets) - 1}"
    tolerance = quantity_text(route.settings.tolerance, "m")
    count = f"{sum(result.reached)} of {len(route.through)} way-points within {tolerance}"
    return _draw(result, f"{route.name}: {count}; the part ends {_off(result, which)}", path)


def _draw(result: SteeringResult, title: str, path: Path) -> Path:
    """Draw a path over its plate with the targets in their order, and the ends of disturbed runs, into a file."""
    assert result.scatter is not None
    case, trajectory, scatter = result.case, result.trajectory, result.scatter
    assert isinstance(case.plate, PlateCase)
    line, places = trajectory.at(np.linspace(0, trajectory.time[-1], SAMPLES)).position, np.array(result.targets)
    actuators = np.array([actuator.position for actuator in case.actuators])
    moving = np.array([bool(actuator.stroke) or actuator.segments is not None for actuator in case.actuators])
    plate = PlateView(case.plate.coarse_mesh.outline, actuators, moving=moving, numbered=True)
    window = path_window(np.concatenate([line, places]), plate.outline.box, actuators)
    maps = 1 if window is None else 2
    figure = Drawing(figsize=((maps + 1) * SIZE + 0.8, SIZE + 0.9))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.1)
    axes = [figure.add_subplot(1, maps + 1, k + 1) for k in range(maps + 1)]
    keys, unit = draw_maps(axes[:maps], plate, window)
    keys = draw_path(axes[maps - 1], trajectory, line, unit, plate.outline.box) + keys
    what = "The path over the plate" if window is None else "The plate"
    axes[0].set_title(f"{what}, and the actuators by their numbers", fontsize=10)
    if window is not None:
        axes[1].set_title("Around the path", fontsize=10)
    drawn = places * unit.per_si
    keys += axes[-2].plot(*drawn.T, linestyle="", **TARGET, path_effects=HALO, zorder=4, label="target")
    for number, place in enumerate(drawn if len(drawn) > 1 else []):
        put_label(axes[-2], str(number), place, (11.5, 11.5), color=TARGET["markeredgecolor"], weight="bold", **WORDS)
    keys += _draw_ends(axes[-1], trajectory, result.targets[-1], scatter)
    put_title(figure, title)
    put_keys(figure, keys)
    clear_labels(figure)
    return save_picture(figure, path)


def _draw_ends(axes: Axes, trajectory: Trajectory, target: Place, scatter: Scatter) -> list[Artist]:
    """Draw the ends around the target, without outliers, and circles around half and nine tenths of them.

    Lost parts are counted, and drawn where all are lost; a circle that would have to include some is left out. Where
    all ends are far from the target, draw them around their median, with an arrow to the target.
    """
    off, end = scatter.ends - target, trajectory.position[-1] - target
    lost = np.isinf(scatter.distance)
    places = Scatter(scatter.ends, np.where(lost, np.inf, np.hypot(*off.T)))  # whatever headings
    off = off[~lost | lost.all()]
    circles = {share: away for share in (0.5, 0.9) if np.isfinite(away := places.quantile(share))}
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
    more += f"; {scatter.lost} are lost" if scatter.lost else ""
    axes.set_title(f"Where {len(lost)} disturbed runs end{more}", fontsize=10)
    return keys


def _off(result: SteeringResult, name: str) -> str:
    """How far from its last target the part ends, in words."""
    away = result.off(result.trajectory)
    return f"{quantity_text(away, 'm')} from {name}" if away > NOTHING else f"at {name}"
