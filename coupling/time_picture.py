"""Curves over time in the picture of a run, with the stuck stretches shaded, and those in flight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from numpy.typing import NDArray

from coupling.path_picture import PATH_COLOUR, STICK_COLOUR
from coupling.readable import NOTHING, Unit, plain_ticks, readable
from coupling.scene import Scene
from particle import Samples, State, Trajectory

FloatArray = NDArray[np.float64]

SHADES = {State.STICK: (STICK_COLOUR, "stuck"), State.FLIGHT: ("#606060", "in flight")}
MARGIN = 0.05  # of the values' range, above and below


class Curves(NamedTuple):
    """What one pair of axes shows over time."""

    label: str
    si: str
    values: dict[str, FloatArray]


def curves_of(scene: Scene, samples: Samples) -> list[Curves]:
    """Height and speed of the part and, where the surface moves in its plane, the velocities along its axes."""
    speed = f"speed {'on ' + scene.origin if scene.base else 'in the plane'}"
    found = [Curves(speed, "m/s", {"": np.hypot(*samples.velocity.T)})]
    if samples.height.any():
        found.insert(0, Curves("height of the part", "m", {"": samples.height}))
    for name, drive, relative in zip("xy", scene.base, samples.velocity.T, strict=False):
        velocity = drive.evaluate(samples.time * (1 - 1e-12))[1]  # before a motion's end, not after it
        if velocity.any():
            found.append(Curves(f"velocity along {name}", "m/s", {"part": velocity + relative, "platform": velocity}))
    return found


def draw_over_time(axes: Axes, trajectory: Trajectory, times: FloatArray, curves: Curves, time_unit: Unit) -> None:
    """Draw curves of values (n,) at times (n,) [s]."""
    everything = np.concatenate(list(curves.values.values()))
    unit = readable(everything, curves.si)
    for (name, values), colour, style in zip(curves.values.items(), ("black", PATH_COLOUR), ("-", "--"), strict=False):
        axes.plot(
            times * time_unit.per_si, values * unit.per_si, color=colour, linestyle=style, linewidth=1.2, label=name
        )
    if len(curves.values) > 1:
        axes.legend(frameon=False, fontsize=9, loc="lower left", bbox_to_anchor=(0, 0.97), ncols=2, borderpad=0.1)
    edges = trajectory.time * time_unit.per_si
    for state, (colour, _) in SHADES.items():
        for begin, end in stretches(trajectory.state == state):
            axes.axvspan(edges[begin], edges[end], color=colour, alpha=0.18, linewidth=0)
    plain_ticks(axes)
    axes.set_xlim(0, edges[-1])
    axes.set_ylim(*limits(everything * unit.per_si))
    if np.abs(everything).max() < NOTHING:
        axes.set_yticks([0])
    axes.set_ylabel(f"{curves.label} [{unit.name}]")
    axes.grid(alpha=0.3)


def limits(values: FloatArray) -> tuple[float, float]:
    """The lowest and highest value that an axis shows, for values with a good unit; 0 is among them."""
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    if high - low < NOTHING:
        high = 1.0
    return low - MARGIN * (high - low), high + MARGIN * (high - low)


def shade_keys(trajectory: Trajectory) -> list[Artist]:
    """Keys of the shades that there are."""
    return [
        Patch(color=colour, alpha=0.18, linewidth=0, label=name)
        for state, (colour, name) in SHADES.items()
        if stretches(trajectory.state == state)
    ]


def stretches(holds: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last row of each stretch of rows during which something (n,) holds."""
    change = np.diff(np.concatenate([[0], holds[:-1].astype(int), [0]]))
    return list(zip(np.flatnonzero(change == 1).tolist(), np.flatnonzero(change == -1).tolist(), strict=True))
