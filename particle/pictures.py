"""Pictures of a path: its line with start, end and rests, and shades over time for what the part does."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from common import SIZE, Drawing, draw, figure_of, label_axis, label_places
from particle.modes import State
from particle.trajectory import Trajectory
from particle.types import BoolArray, FloatArray, IntArray

PATH_COLOUR, STICK_COLOUR = "#c8371b", "#1b4f9c"
HALO = [withStroke(linewidth=2.6, foreground="white")]
RING: dict[str, Any] = {"marker": "o", "markerfacecolor": "none", "markersize": 8, "markeredgewidth": 1.4}
CROSS: dict[str, Any] = {"marker": "x", "markersize": 7, "markeredgewidth": 1.6}
PLACE: dict[str, Any] = {"color": "black", "linestyle": "", "path_effects": HALO, "zorder": 5}
REST: dict[str, Any] = {"color": STICK_COLOUR, "markeredgewidth": 0, "markersize": 4.5}
SHADES = {State.STICK: (STICK_COLOUR, "stuck"), State.FLIGHT: ("#606060", "in flight")}
SAMPLES = 2000
HALF_FRAME = 0.6  # of a path's extent, from its middle to the frame
MIN_HALF_FRAME = 1e-6  # m, around a part that stays where it is


class Rows(Protocol):
    """A path at n moments, such as a `Trajectory`; a state holds from its row to the next."""

    @property
    def time(self) -> FloatArray:
        """(n,) s."""

    @property
    def position(self) -> FloatArray:
        """(n, 2) m."""

    @property
    def state(self) -> IntArray:
        """(n,) State."""


def draw_line(axes: Axes, rows: Rows, line: FloatArray, per_metre: float = 1.0) -> list[Artist]:
    """Draw a path through points (k, 2) [m], its ends and where the part rests; return keys."""
    points = rows.position * per_metre
    keys: list[Artist] = []
    keys += axes.plot(
        *(line * per_metre).T, color=PATH_COLOUR, linewidth=1.2, path_effects=HALO, zorder=3, label="path"
    )
    rests = np.unique(points[rows.state == State.STICK], axis=0)
    if rests.size:
        keys += axes.plot(
            *rests.T, "o", **REST, zorder=2.9, label="rests here"
        )  # below the line, which many rests would hide
    keys += axes.plot(*points[:1].T, **RING, **PLACE, label="start")
    keys += axes.plot(*points[-1:].T, **CROSS, **PLACE, label="end")
    return keys


def shade(axes: Axes, rows: Rows, per_second: float = 1.0) -> None:
    """Shade the times at which the part does not slip."""
    across = axes.get_xaxis_transform()  # times along x, from the bottom to the top of the axes along y
    for state in SHADES:
        spans = rows.time[np.array(stretches(rows.state == state), dtype=np.int64).reshape(-1, 2)] * per_second
        if not len(spans):
            continue
        bars = np.zeros((len(spans), 4, 2))
        bars[:, :, 0], bars[:, 1:3, 1] = spans[:, [0, 0, 1, 1]], 1.0
        shades = PolyCollection(list(bars), transform=across, zorder=0, **_look(state))
        shades.set_snap(False)  # moved to whole pixels, short stretches would vanish here and fill pixels there
        if state is not State.STICK:  # one path, as each with a hatch takes a millisecond
            whole: Any = Path.make_compound_path_from_polys(bars)
            shades.set_verts_and_codes([whole.vertices], [whole.codes])
        axes.add_collection(shades, autolim=False)


def shade_keys(rows: Rows) -> list[Artist]:
    """Keys of the shades in use."""
    return [Patch(label=name, **_look(state)) for state, (_, name) in SHADES.items() if stretches(rows.state == state)]


def _look(state: State) -> dict[str, Any]:
    colour = SHADES[state][0]
    if state is State.STICK:
        return {"color": colour, "alpha": 0.18, "linewidth": 0}
    return {"facecolor": "none", "edgecolor": colour, "hatch": "////", "linewidth": 0}  # differs in grey, too


def stretches(holds: BoolArray) -> list[tuple[int, int]]:
    """The first and last row of each stretch of time during which a condition (n,) holds."""
    change = np.diff(np.concatenate([[0], holds[:-1].astype(int), [0]]))
    return list(zip(np.flatnonzero(change == 1).tolist(), np.flatnonzero(change == -1).tolist(), strict=True))


@draw.register(Trajectory)
def draw_trajectory(trajectory: Trajectory, axes: Axes | None = None) -> Figure:
    """Draw the path, and beside it the speed over time, in SI units; with axes in m only the path, into these."""
    if axes is not None:
        _draw_path(axes, trajectory)
        return figure_of(axes)
    figure = Drawing(figsize=(2 * SIZE[0], SIZE[1]))
    places, speeds = figure.subplots(1, 2)
    keys = _draw_path(places, trajectory) + shade_keys(trajectory)
    samples = trajectory.at(np.linspace(trajectory.time[0], trajectory.time[-1], SAMPLES))
    speeds.plot(samples.time, np.hypot(*samples.velocity.T), color="black", linewidth=1.0)
    shade(speeds, trajectory)
    label_axis(speeds.xaxis, "time", "s")
    label_axis(speeds.yaxis, "speed in the plane", "m/s")
    speeds.set_xlim(trajectory.time[0], trajectory.time[-1])
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys), frameon=False)
    return figure


def _draw_path(axes: Axes, trajectory: Trajectory) -> list[Artist]:
    """Draw the path into axes in m; return keys."""
    samples = trajectory.at(np.linspace(trajectory.time[0], trajectory.time[-1], SAMPLES))
    keys = draw_line(axes, trajectory, samples.position)
    low, high = samples.position.min(axis=0), samples.position.max(axis=0)
    half = HALF_FRAME * float((high - low).max()) or MIN_HALF_FRAME
    (left, bottom), (right, top) = (low + high) / 2 - half, (low + high) / 2 + half
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    label_places(axes)
    return keys
