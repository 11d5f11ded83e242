"""The path in the picture of a run: a line with its two ends, and the places where the part rests."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from coupling.readable import Unit, readable
from coupling.window import extent
from particle import State, Trajectory

FloatArray = NDArray[np.float64]

PATH_COLOUR, STICK_COLOUR = "#c8371b", "#1b4f9c"
HALO = [withStroke(linewidth=2.6, foreground="white")]
RING: dict[str, Any] = {"marker": "o", "markerfacecolor": "none", "markersize": 8, "markeredgewidth": 1.4}
CROSS: dict[str, Any] = {"marker": "x", "markersize": 7, "markeredgewidth": 1.6}


def draw_path(axes: Axes, trajectory: Trajectory, line: FloatArray, unit: Unit, visible: bool) -> list[Artist]:
    """Draw the path, points (n, 2) [m] along it, or a point where no more would be visible; return keys."""
    points = trajectory.position * unit.per_si
    common: dict[str, Any] = {"color": "black", "linestyle": "", "path_effects": HALO, "zorder": 5}
    if not visible:
        return [*axes.plot(*points[:1].T, **RING, **common, label=_staying(extent(line)))]
    keys: list[Artist] = []
    keys += axes.plot(
        *(line * unit.per_si).T, color=PATH_COLOUR, linewidth=1.2, path_effects=HALO, zorder=3, label="path"
    )
    rests = points[trajectory.state == State.STICK]
    if rests.size:
        look: dict[str, Any] = {
            "color": STICK_COLOUR,
            "markeredgecolor": "white",
            "markeredgewidth": 0.6,
            "markersize": 4.5,
        }
        keys += axes.plot(*rests.T, "o", **look, zorder=4, label="rests here")
    keys += axes.plot(*points[:1].T, **RING, **common, label="start")
    keys += axes.plot(*points[-1:].T, **CROSS, **common, label="end")
    return keys


def _staying(length: float) -> str:
    """What is said of a part whose path is no more than a point."""
    unit = readable(np.array([length]), "m")
    moved = f"within {length * unit.per_si:.2g} {unit.name}" if unit.name != "m" else "where it is"
    return f"the part, which stays {moved}"
