"""The picture of an aim or plan: the path over the plate with its targets, and where disturbed runs end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

from active_surface.steering.aimed import Aimed
from active_surface.steering.found import Found
from active_surface.steering.planned import Planned
from active_surface.steering.scatter import Scatter
from coupling import whole_file
from coupling.case import Case, PlateCase
from coupling.pictures import Unit, draw_path, is_visible, plain_ticks, readable
from meshes import rim_curves
from particle import HALO, Trajectory

FloatArray = NDArray[np.float64]
Place = tuple[float, float]

SIZE = 5.6  # inches, of a panel
SAMPLES = 4000
MARGIN = 0.04  # of the plate's longer side
ROOM = 1.15  # of the farthest end that is drawn
FAR = 4.0  # times the spread of the ends: a target farther off is pointed at
LEAST = 0.01  # of the way to a target that is pointed at, which the frame shows
SMALLEST = 1e-9  # m: no frame is smaller
SHARE = 0.97  # of the ends are drawn at least
NUMBERED = 100  # actuators at most
TARGET: dict[str, Any] = {
    "marker": "D",
    "markerfacecolor": "none",
    "markeredgecolor": "#c8371b",
    "markersize": 14,
    "markeredgewidth": 1.8,
}
NUMBER: dict[str, Any] = {"textcoords": "offset points", "fontsize": 9, "path_effects": HALO}
ENDS: dict[str, Any] = {"marker": "o", "color": "#1b4f9c", "markersize": 4, "markeredgewidth": 0, "alpha": 0.6}


def draw_aim(found: Aimed, path: Path) -> Path:
    """Draws what a search found into a PNG file; returns that."""
    said = f"{found.task.name}: the part ends {_off(found, found.task.target)}"
    return _draw(found, said, [found.task.target], path)


def draw_plan(found: Planned, path: Path) -> Path:
    """Draws what a plan found into a PNG file; returns that."""
    route = found.route
    targets = found.targets
    which = "the last of them" if len(targets) == len(route.through) else f"way-point {len(targets)}"
    count = f"{sum(found.reached)} of {len(route.through)} way-points within {_length(route.settings.tolerance)}"
    return _draw(found, f"{route.name}: {count}; the part ends {_off(found, targets[-1], which)}", targets, path)


def _draw(found: Found, said: str, targets: Sequence[Place], path: Path) -> Path:
    """Draws a path over its plate with the targets [m] in their order, and the ends of disturbed runs, into a file.

    said: above both.
    """
    assert found.scatter is not None
    case, trajectory, scatter = found.case, found.trajectory, found.scatter
    figure = Figure(figsize=(2 * SIZE + 0.8, SIZE + 0.5), layout="constrained")
    FigureCanvasAgg(figure)
    axes = [figure.add_subplot(1, 2, k + 1) for k in range(2)]
    keys = _draw_plate(axes[0], case, trajectory, targets)
    keys += _draw_ends(axes[1], trajectory, targets[-1], scatter)
    figure.suptitle(said, parse_math=False)
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys), frameon=False)
    with whole_file(path) as partial:
        figure.savefig(partial, dpi=110)
    return path


def _draw_plate(axes: Axes, case: Case, trajectory: Trajectory, targets: Sequence[Place]) -> list[Artist]:
    assert isinstance(case.plate, PlateCase)
    outline = case.plate.coarse_mesh.outline
    box = outline.box
    unit, longest = readable(box, "m"), float(np.ptp(box, axis=0).max())
    _label(axes, unit)
    axes.set_title("The path over the plate, and the actuators by their numbers", fontsize=10)
    curves = [curve * unit.per_si for curve in rim_curves(outline, longest / 200)]
    axes.add_collection(LineCollection(curves, colors="black", linewidths=1.5))
    frame = (box + MARGIN * longest * np.array([[-1.0], [1.0]])) * unit.per_si
    axes.set_xlim(*frame[:, 0])
    axes.set_ylim(*frame[:, 1])
    keys: list[Artist] = []
    moving = np.array([bool(actuator.stroke) or actuator.segments is not None for actuator in case.actuators])
    places = np.array([actuator.position for actuator in case.actuators]) * unit.per_si
    looks = ((moving, "#7fa8c9", "moving actuator"), (~moving, "white", "actuator at rest"))
    for chosen, colour, label in looks:
        if chosen.any():
            look: dict[str, Any] = {"color": colour, "markeredgecolor": "black", "linestyle": "", "markersize": 7}
            keys += axes.plot(*places[chosen].T, "^", **look, label=label)
    for number in range(len(places)) if len(places) <= NUMBERED else ():
        axes.annotate(str(number), places[number], (0, -20), ha="center", color="#606060", **NUMBER)
    line = trajectory.at(np.linspace(0, trajectory.time[-1], SAMPLES)).position
    keys += draw_path(axes, trajectory, line, unit, is_visible(line, box))
    drawn = np.array(targets) * unit.per_si
    keys += axes.plot(*drawn.T, linestyle="", **TARGET, path_effects=HALO, zorder=4, label="target")
    for number, place in enumerate(drawn.tolist() if len(targets) > 1 else [], 1):
        axes.annotate(str(number), place, (8, 8), color=TARGET["markeredgecolor"], weight="bold", **NUMBER)
    return keys


def _draw_ends(axes: Axes, trajectory: Trajectory, target: Place, scatter: Scatter) -> list[Artist]:
    """Draw the ends about the target, those far off left out, with circles that hold half and nine tenths of them.

    A circle that would have to hold lost parts is left out.
    Where all are far from the target they are drawn about their middle, with an arrow towards it.
    """
    circles = {share: away for share in (0.5, 0.9) if np.isfinite(away := scatter.quantile(share))}
    off, end = scatter.ends - target, trajectory.position[-1] - target
    middle = np.median(np.vstack([off, end]), axis=0)
    spread = float(np.quantile(np.hypot(*(np.vstack([off, end]) - middle).T), SHARE))
    missed = float(np.hypot(*middle)) > FAR * spread
    if missed:
        centre, shown = middle, max(spread, LEAST * float(np.hypot(*middle)))
    else:
        centre = np.zeros(2)
        shown = max(float(np.quantile(np.hypot(*off.T), SHARE)), float(np.hypot(*end)), *circles.values())
    side = ROOM * max(shown, SMALLEST)
    unit = readable(np.array([side + float(np.hypot(*centre))]), "m")
    _label(axes, unit, " from the target")
    keys: list[Artist] = []
    keys += axes.plot(*(off * unit.per_si).T, linestyle="", **ENDS, label="ends of disturbed runs")
    axes.plot(*(end * unit.per_si), "x", color="black", markersize=7, markeredgewidth=1.6, path_effects=HALO, zorder=5)
    if missed:
        way = -middle / np.hypot(*middle) * side * unit.per_si
        tail, tip = (centre * unit.per_si + share * way for share in (0.55, 0.95))
        axes.annotate("", tip, tail, arrowprops={"arrowstyle": "->", "color": TARGET["markeredgecolor"], "lw": 1.8})
        axes.annotate(f"target, {_length(float(np.hypot(*middle)))}", tail, (0, 14), ha="center", **NUMBER)
    else:
        axes.plot(0, 0, linestyle="", **TARGET, zorder=4)
        for share, distance in circles.items():
            radius = distance * unit.per_si
            axes.add_patch(Circle((0, 0), radius, fill=False, edgecolor="#606060", linewidth=0.8))
            axes.annotate(f"{share:.0%}", (0, radius), (2, 1), color="#606060", **NUMBER)
    low, high = (centre - side) * unit.per_si, (centre + side) * unit.per_si
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    beyond = int((np.abs(off - centre).max(axis=1) > side).sum())
    more = f", {beyond} of them beyond this frame" if beyond else ""
    axes.set_title(f"Where {len(off)} disturbed runs end{more}", fontsize=10)
    return keys


def _off(found: Found, target: Place, name: str = "the target") -> str:
    """How far from a target [m] the part ends, in words."""
    away = float(np.hypot(*(found.trajectory.position[-1] - target)))
    return f"{_length(away)} from {name}" if away > 0 else f"at {name}"


def _label(axes: Axes, unit: Unit, where: str = "") -> None:
    axes.set_aspect("equal")
    plain_ticks(axes)
    axes.set_xlabel(f"x{where} [{unit.name}]")
    axes.set_ylabel(f"y{where} [{unit.name}]")


def _length(length: float) -> str:
    unit = readable(np.array([length]), "m")
    return f"{length * unit.per_si:.3g} {unit.name}"
