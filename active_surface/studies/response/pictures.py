"""The picture of a response: amplitude and phase over frequency, and where its points and actuators are."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from active_surface.arrays import FloatArray
from active_surface.studies.response.functions import ComplexArray
from active_surface.studies.response.response import FrequencyResponse
from common import Drawing, draw, unit_for
from coupling.pictures import PlateView, clear_labels, draw_plate, put_keys, put_label, put_title

MAX_CURVES: Final = 10
MARK: Final[dict[str, Any]] = {"color": "#404040", "linewidth": 1.1, "linestyle": (0, (1, 1.5))}  # of a resonance


@draw.register(FrequencyResponse)
def draw_response(response: FrequencyResponse) -> Figure:
    """Draw a response; of many curves those with the largest amplitudes."""
    figure = Drawing(figsize=(12.0, 6.8))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.08)
    grid = figure.add_gridspec(2, 2, width_ratios=(2.2, 1), height_ratios=(1.5, 1))
    amplitude = figure.add_subplot(grid[0, 0])
    phase = figure.add_subplot(grid[1, 0], sharex=amplitude)
    curves = _curves(response)
    keys = _draw_curves(amplitude, phase, response, curves)
    _draw_places(figure.add_subplot(grid[:, 1]), response)
    put_title(figure, f"{response.case.name}: response of the plate to its actuators")
    put_keys(figure, keys)
    clear_labels(figure)
    return figure


def _curves(response: FrequencyResponse) -> list[tuple[int, int]]:
    """Point and actuator of the curves that are drawn."""
    most = np.abs(response.values).max(axis=2)
    order = np.argsort(-most, axis=None)[:MAX_CURVES]
    pairs = [np.unravel_index(k, most.shape) for k in sorted(order.tolist())]
    return [(int(point), int(actuator)) for point, actuator in pairs]


def _draw_curves(
    amplitude: Axes, phase: Axes, response: FrequencyResponse, curves: list[tuple[int, int]]
) -> list[Artist]:
    """Draw curves of point and actuator; return keys."""
    unit = unit_for(response.frequencies, "Hz")
    across = response.frequencies * unit.per_si
    for point, actuator in curves:
        values = response.values[point, actuator]
        amplitude.plot(across, np.abs(values), linewidth=1.4, label=_label(response, point, actuator))
        phase.plot(*_wrapped(across, values), linewidth=1.4)
    for axes in (amplitude, phase):
        for frequency in response.resonances:
            axes.axvline(frequency * unit.per_si, **MARK)
        axes.set_xscale("log")
        axes.set_xlim(across[0], across[-1])
        axes.grid(alpha=0.3, which="both")
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter("")
    amplitude.set_yscale("log")
    forces = [actuator.force is not None for actuator in response.case.actuators]
    amplitude.set_ylabel(f"amplitude of the plate over the drive's{' [m/N]' if all(forces) else ''}")
    phase.set_ylabel("phase [deg]")
    phase.set_ylim(-190, 190)
    phase.set_yticks((-180, -90, 0, 90, 180))
    phase.set_xlabel(f"frequency [{unit.name}]")
    keys: list[Artist] = [*amplitude.get_legend_handles_labels()[0]]
    return [*keys, Line2D([], [], label="resonance", **MARK)] if len(response.resonances) else keys


def _wrapped(across: FloatArray, values: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """The phase [deg] along a curve, from -180 to 180; the line breaks where it leaps by a whole turn."""
    phase = np.degrees(np.angle(values))
    leaps = np.flatnonzero(np.abs(np.diff(phase)) > 180) + 1
    return np.insert(across, leaps, across[leaps]), np.insert(phase, leaps, np.nan)


def _label(response: FrequencyResponse, point: int, actuator: int) -> str:
    if len(response.points) == 1:
        return f"actuator {actuator}"
    return f"point {point}, actuator {actuator}" if len(response.actuators) > 1 else f"point {point}"


def _draw_places(axes: Axes, response: FrequencyResponse) -> None:
    unit, few = unit_for(response.outline.box, "m"), len(response.actuators) <= MAX_CURVES
    draw_plate(axes, PlateView(response.outline, response.actuators, numbered=few), unit)
    axes.plot(*(response.points * unit.per_si).T, "o", color="black", markersize=5)
    for number, place in enumerate(response.points[:MAX_CURVES]):
        text = "point" if len(response.points) == 1 else f"point {number}"
        put_label(axes, text, place * unit.per_si, (0, -7), fontsize=8)
    axes.set_title("The actuators by their numbers" if few else "The actuators", fontsize=10)
