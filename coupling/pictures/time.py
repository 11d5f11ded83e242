"""Curves over time in the picture of a run, with shades where the part is stuck or in flight."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from coupling.pictures.portrait import Portrait
from coupling.pictures.ticks import plain_ticks
from meshes import NOTHING, Unit, unit_for
from particle import PATH_COLOUR, Rows, shade

FloatArray = NDArray[np.float64]

MARGIN = 0.05  # of the values' range, above and below


class Curves(NamedTuple):
    """What one pair of axes shows over time."""

    label: str
    si: str
    values: dict[str, FloatArray]


def curves_of(portrait: Portrait) -> list[Curves]:
    """Height and speed of the part and, where the surface moves in its plane, the velocities along its axes."""
    samples = portrait.samples
    speed = f"speed {'on ' + portrait.origin if portrait.base else 'in the plane'}"
    curves = [Curves(speed, "m/s", {"": np.hypot(*samples.velocity.T)})]
    if samples.height.any():
        curves.insert(0, Curves("height of the part", "m", {"": samples.height}))
    for name, drive, relative in zip("xy", portrait.base, samples.velocity.T, strict=False):
        velocity = drive.evaluate(samples.time * (1 - 1e-12))[1]  # just before the end of a motion, where it may jump
        if velocity.any():
            curves.append(Curves(f"velocity along {name}", "m/s", {"part": velocity + relative, "platform": velocity}))
    return curves


def draw_over_time(axes: Axes, rows: Rows, times: FloatArray, curves: Curves, time_unit: Unit) -> None:
    """Draw curves of values (n,) at times (n,) [s], with shades where the part does not slip."""
    everything = np.concatenate(list(curves.values.values()))
    unit = unit_for(everything, curves.si)
    for (name, values), colour, style in zip(curves.values.items(), ("black", PATH_COLOUR), ("-", "--"), strict=False):
        axes.plot(
            times * time_unit.per_si, values * unit.per_si, color=colour, linestyle=style, linewidth=1.2, label=name
        )
    if len(curves.values) > 1:
        axes.legend(
            frameon=False,
            fontsize="small",
            loc="lower left",
            bbox_to_anchor=(0, 0.97),
            ncols=2,
            borderpad=0.1,
            handlelength=1.6,
            columnspacing=1.0,
        )
    shade(axes, rows, time_unit.per_si)
    plain_ticks(axes)
    axes.set_xlim(0, rows.time[-1] * time_unit.per_si)
    axes.set_ylim(*limits(everything * unit.per_si))
    if np.abs(everything).max() < NOTHING:
        axes.set_yticks([0])
    axes.set_ylabel(f"{curves.label} [{unit.name}]")
    axes.grid(alpha=0.3)


def limits(values: FloatArray) -> tuple[float, float]:
    """The limits of an axis for values in a suitable unit; 0 lies between them."""
    low, high = min(float(values.min()), 0.0), max(float(values.max()), 0.0)
    if high - low < NOTHING:
        high = 1.0
    return low - MARGIN * (high - low), high + MARGIN * (high - low)
