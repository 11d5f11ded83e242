"""Beyond the paper: dead zones of an array with and without an active surface, over the pitch of its actuators.

Without: actuators move what they touch. A square part as large as the paper's contact, lying anywhere on a square
lattice, is in a dead zone where it touches none, or only one and so cannot be handed on.
With: a part anywhere around the middle one of nine actuators, nearer to that than to the others, is served if one of
a few drives of the middle one, the others held, brings it within NEAR.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.paper.bench import PLATE, STAYS, Bench, Ground
from active_surface.paper.picture import MICRO, RED, Curve, Found, Panel
from active_surface.paper.verdict import NEARLY_ALL, share_of
from coupling import surface_motion
from fem_plate import Plate
from meshes import rectangle
from particle import Drive

PITCHES: Final = 75e-6, 2.4e-3  # m
FREQUENCIES: Final = 150.0, 900.0  # Hz
STROKES: Final = (50e-6, 100e-6, 150e-6)  # m
NEAR: Final = 10e-6  # m
FEWER: Final = 3  # times fewer starts than elsewhere
CELLS: Final = 3.0  # of the mesh in a pitch
COARSE: Final = 1e-6  # tolerance of a plate of which only shares of starts are wanted
TOLERANCE: Final = 1e-6  # of paths


def dead_zones(bench: Bench) -> Found:
    """The shares of starts that are served, over the pitch."""
    p, effort = bench.parameters, bench.effort
    pitches = np.geomspace(*PITCHES, effort.pitches) if effort.pitches > 1 else np.array([150e-6])
    count = max(effort.starts // FEWER, 1)
    places = np.random.default_rng(p.seed).random((count, 2)) - 0.5  # in pitches, around the middle actuator
    reached = np.array([_reached(bench, pitch, pitch * places) for pitch in pitches.tolist()])
    one, two = np.array([touched(pitch, p.contact_side) for pitch in pitches.tolist()]).T
    shares = [share_of(row) for row in reached]
    widest = widest_served(pitches, reached)
    numbers = {
        "pitch": pitches.tolist(), "reached": shares, "touches_one": one.tolist(), "touches_two": two.tolist(),
        "widest_served": widest, "there": shares[int(np.argmin(np.abs(pitches - widest)))],
    }  # fmt: skip
    share = np.array([one.value for one in shares])
    low, high = np.array([one.interval for one in shares]).T
    black = {"color": "black", "marker": "o", "capsize": 3, "label": "active surface: brought to the nearest actuator"}
    bars = np.maximum(100 * np.stack([share - low, high - share]), 0.0)
    dashed, dotted = {"color": RED, "linestyle": "--"}, {"color": RED, "linestyle": ":"}
    curves = [
        Curve(MICRO * pitches, 100 * share, black, bars),
        Curve(MICRO * pitches, 100 * one, dashed | {"label": "without: touches an actuator"}),
        Curve(MICRO * pitches, 100 * two, dotted | {"label": "without: touches two or more"}),
    ]
    title = f"part of {MICRO * p.contact_side:g} µm"
    settings = {"xscale": "log", "ylim": (0, 105)}
    return {"beyond: dead zones": {PLATE: numbers}}, [
        [Panel("pitch [µm]", "share of the starts [%]", curves, title, settings=settings)]
    ]


def touched(pitch: float, side: float) -> tuple[float, float]:
    """The shares of places where a square part touches one or more, two or more points of a lattice parallel to it."""
    whole, rest = divmod(side / pitch, 1.0)
    counts = {int(whole): 1 - rest, int(whole) + 1: rest}  # of columns, and likewise of rows
    none_or_one = [0.0, 0.0]
    for columns, share in counts.items():
        for rows, other in counts.items():
            if columns * rows <= 1:
                none_or_one[columns * rows] += share * other
    return max(1 - none_or_one[0], 0.0), max(1 - sum(none_or_one), 0.0)


def nine(bench: Bench, pitch: float) -> Ground:
    """Nine actuators on a clamped square plate that reaches one pitch farther, the middle one at (0, 0)."""
    points = [(x, y) for x in (-pitch, 0.0, pitch) for y in (-pitch, 0.0, pitch)]
    plate = Plate(rectangle(4 * pitch, 4 * pitch, pitch / CELLS), bench.parameters.section, tolerance=COARSE)
    shapes = plate.influence(points)
    return Ground(surface_motion(shapes, [Drive(0.0, 1.0)] * len(points), 1e-6), shapes.outline, np.zeros(2))


def _reached(bench: Bench, pitch: float, starts: FloatArray) -> BoolArray:
    """Whether (n,) parts from starts (n, 2) [m] around the middle actuator end next to it with one of the drives."""
    ground, reached = nine(bench, pitch), np.zeros(len(starts), dtype=bool)
    for stroke in STROKES:
        for frequency in np.geomspace(*FREQUENCIES, bench.effort.candidates).tolist():
            left, drives = np.flatnonzero(~reached), [Drive(0.0, 1.0)] * 9
            drives[4] = bench.drive(frequency, stroke)
            if len(left):
                end = bench.parameters.cycles / frequency
                paths = bench.paths(PLATE, drives, starts[left], end, ground=ground, tolerance=TOLERANCE)
                reached[left] = [path.end == STAYS and path.away()[-1] <= NEAR for path in paths]
    return reached


def widest_served(pitches: FloatArray, reached: BoolArray) -> float:
    """The largest pitch [m] of (P,) up to which NEARLY_ALL of the starts (P, n) are served at each; 0: none."""
    order = np.argsort(pitches)
    served = np.cumprod(reached[order].mean(axis=1) >= NEARLY_ALL) > 0
    return float(pitches[order][served].max(initial=0.0))
