"""The picture of a feasibility: a chart over frequency and stroke, a map of the plate, and areas over frequency."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.area import Feasible
from active_surface.studies.feasibility.chart_picture import draw_chart
from active_surface.studies.feasibility.result import Feasibility
from common import Drawing, draw, quantity_text, unit_for
from coupling.pictures import PlateView, draw_plate, put_title

LOST, LINE, PALE = "#c8371b", "#40719c", "#8a8a8a"
CURVES: Final = 2.0  # times the largest useful area: the end of the axis, at most
SMALLEST: Final = 1e-6  # m: areas are in the square of this at least


@draw.register(Feasibility)
def draw_feasibility(feasibility: Feasibility, picked: tuple[float, float] | None = None) -> Figure:
    """Draw a feasibility, with a picked frequency [Hz] and stroke [m or N]."""
    areas = feasibility.areas
    figure = Drawing(figsize=(6.5, 6.2) if areas is None else (13.0, 9.4))
    figure.set_layout_engine("constrained", w_pad=0.12, h_pad=0.08)
    if areas is None:
        draw_chart(figure.add_subplot(), feasibility, picked)
    else:
        grid = figure.add_gridspec(2, 2, height_ratios=(1.9, 1), width_ratios=(1, 1))
        draw_chart(figure.add_subplot(grid[0, 0]), feasibility, picked)
        _draw_map(figure, figure.add_subplot(grid[0, 1]), feasibility, areas)
        _draw_curves(figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1]), feasibility, areas)
    put_title(
        figure,
        f"{feasibility.case.name}: fastest drive {quantity_text(feasibility.frequency, 'Hz', 4)}, largest stroke "
        f"{quantity_text(feasibility.stroke, feasibility.stroke_unit, 4)}",
    )
    return figure


def _draw_map(figure: Figure, axes: Axes, feasibility: Feasibility, areas: Feasible) -> None:
    unit = unit_for(feasibility.outline.box, "m")
    x, y, share = _grid(areas, np.where(areas.own.lost, np.nan, 100 * areas.own.shares))
    half = areas.spacing / 2
    edges = [np.append(side - half, side[-1] + half) * unit.per_si for side in (x, y)]
    slipping = np.ma.masked_where(~(share > 0), share)
    mesh = axes.pcolormesh(*edges, slipping.T, cmap="viridis", vmin=0)
    lost = _grid(areas, np.where(areas.own.lost, 1.0, np.nan))[2]
    axes.pcolormesh(*edges, np.ma.masked_invalid(lost).T, cmap=ListedColormap([LOST]), vmin=0, vmax=1)
    if slipping.count():
        figure.colorbar(mesh, ax=axes, label="share of the time in which the part slips [%]", shrink=0.8)
    keys: list[Artist] = [Patch(facecolor="white", edgecolor="black", label="the part stays at rest")]
    if areas.own.lost.any():
        keys.append(Patch(facecolor=LOST, label="it comes off at some moment"))
    keys += draw_plate(axes, PlateView(feasibility.outline, feasibility.actuators), unit)
    axes.set_title(f"any start, at the case's drives, {quantity_text(areas.window, 's', 4)}", fontsize=10)
    axes.legend(handles=keys, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=3, frameon=False, fontsize=9)


def _grid(areas: Feasible, values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The squares' centres along x (n,) and y (m,) and values (n, m), nan where there is no plate."""
    low = areas.points.min(axis=0)
    rows = np.rint((areas.points - low) / areas.spacing).astype(int)
    table = np.full(rows.max(axis=0) + 1, np.nan)
    table[rows[:, 0], rows[:, 1]] = values
    x, y = (low[k] + areas.spacing * np.arange(table.shape[k]) for k in (0, 1))
    return x, y, table


def _draw_curves(peak: Axes, integral: Axes, feasibility: Feasibility, areas: Feasible) -> None:
    frequencies = areas.factors * feasibility.frequency
    unit, side = unit_for(frequencies, "Hz"), unit_for(max(float(areas.slipping.peak.max()) ** 0.5, SMALLEST), "m")
    per_si, area, square = unit.per_si, side.per_si**2, f"{side.name}²"
    across = frequencies * per_si
    peak.plot(across, areas.slipping.peak * area, "--", color=PALE, linewidth=1.1, label="it slips, attached then")
    peak.plot(across, areas.feasible.peak * area, color=LINE, linewidth=1.6, label="it slips and never comes off")
    peak.plot(across, areas.lost_area * area, ":", color=LOST, linewidth=1.6, label="it comes off at some moment")
    integral.plot(across, areas.slipping.integral * area * 1e3, "--", color=PALE, linewidth=1.1)
    integral.plot(across, areas.feasible.integral * area * 1e3, color=LINE, linewidth=1.6)
    peak.set_ylabel(f"largest area [{square}]")
    integral.set_ylabel(f"time integral [{square} ms]")
    for axes, useful in ((peak, areas.feasible.peak * area), (integral, areas.feasible.integral * area * 1e3)):
        axes.set_xlabel(f"frequency of the fastest drive [{unit.name}]")
        axes.axvline(feasibility.frequency * per_si, color="black", linewidth=0.8, alpha=0.6)
        axes.set_xscale("log")
        axes.grid(alpha=0.3, which="both")
        # The useful curve fills the picture, also where the others are far above it.
        axes.set_ylim(0, min(axes.get_ylim()[1], CURVES * float(useful.max())) if useful.max() > 0 else None)
        axes.set_xlim(across[0], across[-1])
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
    peak.set_ylim(top=1.45 * max(peak.get_ylim()[1], 1e-9))
    peak.legend(frameon=False, fontsize=8, loc="upper left")
