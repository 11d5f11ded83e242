"""Figures 5 and 6: the feasible area over frequency, its peak and its time integral.

At rest the paper's conditions and ours are the same, so that there are two surfaces to compare and no schemes.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.paper.bench import CLOSED, PLATE, Bench
from active_surface.paper.picture import COLOURS, GOLD, GREEN, GREY, MICRO, Curve, Found, Panel, dots
from active_surface.paper.statements import BEGINS, LARGEST, RANGE
from active_surface.studies.feasibility import Feasible, find_feasible
from particle import Micropart

LOWEST, HIGHEST = 50.0, 2500.0  # Hz
FINER: Final = 40  # frequencies between two, in the search for the onset
STEADY: Final = 0.95  # of the largest value so far: a curve that grows falls back no farther, as places are a grid


class Curved(NamedTuple):
    """What an area does over frequency."""

    top: float  # Hz, where it is largest
    grows: bool  # up to there
    falls: bool  # from there on
    half: tuple[float, float]  # Hz, between which it is at least half as large


def feasible_area(bench: Bench) -> Found:
    """Both figures, with both meanings of the feasible area: never coming off, and (dashed) attached at a moment."""
    p = bench.parameters
    factors = np.geomspace(1.0, HIGHEST / LOWEST, bench.effort.frequencies)
    frequency = LOWEST * factors
    numbers: dict[str, dict[str, Any]] = {"5": {}, "6": {}, "5, 6 (range)": {}}
    peaks: list[Curve] = []
    integrals: list[Curve] = []
    for model in (CLOSED, PLATE):
        rows = [areas(bench, model, stroke, factors) for stroke in p.slipping]
        never = [curve_of(frequency, row.feasible.peak) for row in rows]
        whole = [curve_of(frequency, row.feasible.integral) for row in rows]
        off = [row.lost_area[np.argmax(row.feasible.peak) :].max() > 0 for row in rows]
        numbers["5"][model] = {
            "onset": [onset(bench, model, stroke) for stroke in p.slipping],
            "peaks": [one.top for one in never],
            "peaks_when_attached": [curve_of(frequency, row.slipping.peak).top for row in rows],
            "grows": all(one.grows for one in never),
            "falls": all(one.falls and own for one, own in zip(never, off, strict=True)),
        }
        numbers["6"][model] = {"largest": [one.top for one in whole]}
        numbers["5, 6 (range)"][model] = {"halves": [one.half for one in whole]}
        for stroke, row, colour in zip(p.slipping, rows, COLOURS, strict=False):
            said = f"{MICRO * stroke:g} µm" if model == CLOSED else ""
            solid = {"color": colour, "label": said} if said else dots("x", colour)
            peaks.append(Curve(frequency, 1e12 * row.feasible.peak, solid))
            integrals.append(Curve(frequency, 1e15 * row.feasible.integral, solid))
            if model == CLOSED:
                dashed = {"color": colour, "linestyle": "--", "linewidth": 0.8}
                peaks.append(Curve(frequency, 1e12 * row.slipping.peak, dashed))
                integrals.append(Curve(frequency, 1e15 * row.slipping.integral, dashed))
    dashed = {"color": "black", "linestyle": "--", "linewidth": 0.8}
    peaks.append(Curve([], [], dashed | {"label": "counting places where it comes off later"}))
    peaks.append(Curve([], [], dots("x", "black", "finite elements")))
    grey = [("x", end, end, GREY) for end in RANGE]
    panels = [
        Panel("frequency [Hz]", "largest feasible area [µm²]", peaks, "figure 5", [("x", *BEGINS, GOLD)],
              settings={"ylim": (0, 1.4 * max(np.max(curve.y, initial=0.0) for curve in peaks))}),
        Panel("frequency [Hz]", "time integral [µm² ms]", integrals, "figure 6", [("x", *LARGEST, GREEN), *grey]),
    ]  # fmt: skip
    return numbers, [panels]


def areas(bench: Bench, model: str, stroke: float, factors: FloatArray) -> Feasible:
    """The feasible areas of one actuator with a stroke [m], at factors (F,) of LOWEST."""
    p, ground, drive = bench.parameters, bench.ground(model), bench.drive(LOWEST, stroke)
    part, surface, window = Micropart(p.mass, (0.0, 0.0)), ground.surface.driven_by([drive]), 1 / drive.frequency
    return find_feasible(surface, ground.outline, part, p.friction, window, factors, p.gravity, bench.effort.across)


def onset(bench: Bench, model: str, stroke: float) -> float:
    """The lowest frequency [Hz] at which a part at rest slips anywhere, to some 0.3 %; nan: there is none."""
    factors = np.geomspace(1.0, HIGHEST / LOWEST, FINER)
    for _ in range(2):
        moves = np.flatnonzero(areas(bench, model, stroke, factors).slipping.peak > 0)
        if not len(moves):
            return float("nan")
        before, first = float(factors[max(moves[0] - 1, 0)]), float(factors[moves[0]])
        factors = np.geomspace(before, first, FINER)
    return float(LOWEST * factors[-1])


def curve_of(frequencies: FloatArray, area: FloatArray) -> Curved:
    """What an area over frequencies (F,) [Hz] does."""
    k = int(area.argmax())
    up, down = area[: k + 1], area[k:]
    wide = frequencies[np.flatnonzero(area >= area[k] / 2)[[0, -1]]]
    grows = bool((up >= STEADY * np.maximum.accumulate(up)).all())
    falls = k + 1 < len(area) and bool((down <= np.minimum.accumulate(down) / STEADY).all())
    return Curved(float(frequencies[k]), grows, falls, (float(wide[0]), float(wide[1])))
