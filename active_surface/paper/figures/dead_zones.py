"""Beyond the paper: dead zones of an array with and without an active surface, over the pitch of its actuators.

Without: actuators move what they touch. A square part as large as the paper's contact, lying anywhere on a square
lattice, is in a dead zone where it touches none, or only one and so cannot be handed on.
With: a part anywhere around the middle one of nine actuators, nearer to that than to the others, is served if one of
a few drives of the middle one, the others held, brings it within NEAR.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from active_surface.arrays import FloatArray
from active_surface.paper.figure_result import MICRO, FigureResult, finish
from active_surface.paper.models import PLATE, Bench
from active_surface.paper.parameters import Effort
from active_surface.paper.share import HARDLY_ANY, NEARLY_ALL, share_of
from active_surface.paper.verdict import Answer, Verdict
from coupling import surface_motion
from fem_plate import Plate, PlateSection
from meshes import rectangle
from particle import Drive, Micropart, SurfaceMotion, simulate_many

PITCHES: Final = 75e-6, 2.4e-3  # m
FREQUENCIES: Final = 150.0, 900.0  # Hz
STROKES: Final = (50e-6, 100e-6, 150e-6)  # m
NEAR: Final = 10e-6  # m
FEWER: Final = 3  # times fewer starts than elsewhere
CELLS: Final = 3.0  # of the mesh in a pitch
COARSE: Final = 1e-6  # tolerance of a plate of which only shares of starts are wanted
TOLERANCE: Final = 1e-6  # of paths


def find(bench: Bench, effort: Effort) -> FigureResult:
    """The shares of starts that are served, over the pitch."""
    pitches = np.geomspace(*PITCHES, effort.pitches) if effort.pitches > 1 else np.array([150e-6])
    count = max(effort.starts // FEWER, 1)
    random = np.random.default_rng(bench.parameters.seed)
    places = random.random((count, 2)) - 0.5  # in pitches, around the middle actuator: the nearest one
    reached = np.array([_reached(bench, effort, pitch, pitch * places) for pitch in pitches.tolist()])
    touching = np.array([touched(pitch, bench.parameters.contact_side) for pitch in pitches.tolist()])

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        share = reached.mean(axis=1)
        low, high = np.array([share_of(row).interval for row in reached]).T
        axes.errorbar(MICRO * pitches, 100 * share, 100 * np.stack([share - low, high - share]), color="black",
                      marker="o", capsize=3, label="active surface: brought to the nearest actuator")  # fmt: skip
        axes.plot(MICRO * pitches, 100 * touching[:, 0], "--", color="#c8371b", label="without: touches an actuator")
        axes.plot(MICRO * pitches, 100 * touching[:, 1], ":", color="#c8371b", label="without: touches two or more")
        axes.set_ylim(0, 105)
        axes.set_xscale("log")
        axes.set_xticks(MICRO * pitches, [f"{MICRO * pitch:.0f}" for pitch in pitches])
        axes.minorticks_off()
        finish(axes, "pitch [µm]", "share of the starts [%]", f"part of {MICRO * bench.parameters.contact_side:g} µm")

    data: dict[str, Any] = {"pitch": pitches.tolist(), "reached": reached.tolist(), "touching": touching.tolist()}
    verdict = _verdict(bench, pitches, reached, touching)
    return FigureResult("deadzones", "Dead zones (beyond the paper)", (verdict,), data, draw, (7.5, 4.6),
                 "Share of starts from which the part is brought to its nearest actuator, and of places where a part "
                 "would touch actuators; bars: 95 % intervals of so many starts.")  # fmt: skip


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


def nine(bench: Bench, pitch: float) -> SurfaceMotion:
    """Nine actuators on a clamped square plate that reaches one pitch farther."""
    p = bench.parameters
    side = [-pitch, 0.0, pitch]
    points = [(x, y) for x in side for y in side]
    section = PlateSection(p.youngs_modulus, p.poisson_ratio, p.thickness, 2330.0)
    plate = Plate(rectangle(4 * pitch, 4 * pitch, pitch / CELLS), section, tolerance=COARSE)
    return surface_motion(plate.influence(points), [Drive(0.0, 1.0)] * len(points), 1e-6)


def _reached(bench: Bench, effort: Effort, pitch: float, starts: FloatArray) -> FloatArray:
    """Whether (n,) parts from starts (n, 2) [m] around the middle actuator end next to it with one of the drives."""
    p = bench.parameters
    surface = nine(bench, pitch)
    middle, reached = 4, np.zeros(len(starts), dtype=bool)
    for stroke in STROKES:
        for frequency in np.geomspace(*FREQUENCIES, effort.candidates).tolist():
            left = np.flatnonzero(~reached)
            drive = bench.drive(frequency, stroke)
            drives = [drive if k == middle else Drive(0.0, 1.0) for k in range(9)]
            parts = [Micropart(p.mass, (float(x), float(y))) for x, y in starts[left]]
            duration = bench.duration(drive)
            results = simulate_many(surface.driven_by(drives), parts, p.friction, duration, p.gravity, TOLERANCE)
            for k, path in zip(left, results, strict=True):
                reached[k] = path.outcome.value in ("stuck", "moving") and np.hypot(*path.position[-1]) <= NEAR
    return reached


def widest_served(pitches: FloatArray, reached: FloatArray) -> float:
    """The largest pitch [m] of (P,) up to which NEARLY_ALL of the starts (P, n) are served at each; 0: none."""
    order = np.argsort(pitches)
    served = np.cumprod(reached[order].mean(axis=1) >= NEARLY_ALL) > 0
    return float(pitches[order][served].max(initial=0.0))


def _verdict(bench: Bench, pitches: FloatArray, reached: FloatArray, touching: FloatArray) -> Verdict:
    p, widest = bench.parameters, widest_served(pitches, reached)
    alone = pitches[touching[:, 1] < HARDLY_ANY]
    numbers = {
        "pitch": pitches.tolist(), "reached": reached.mean(axis=1).tolist(),
        "touches_one": touching[:, 0].tolist(), "touches_two": touching[:, 1].tolist(), "widest_served": widest,
    }  # fmt: skip
    row = int(np.argmin(np.abs(pitches - widest)))
    text = f"at least {100 * NEARLY_ALL:.0f} % of the starts at every pitch up to {MICRO * widest:.0f} um"
    text = f"{text}, there {share_of(reached[row])}" if widest else "at no pitch looked at"
    text += f"; without an active surface fewer than {100 * HARDLY_ANY:.0f} % of the places touch two actuators or "
    text += f"more from {MICRO * alone.min():.0f} um on" if len(alone) else "more at no pitch looked at"
    return Verdict(
        "beyond: dead zones", "From how many places around an actuator a part is brought to it. The paper claims that "
        "there are no dead zones, and gives no number.", {PLATE: Answer(text, 0.0)},
        f"A part of {MICRO * p.contact_side:g} um. The two numbers are not of one kind: being brought to the nearest "
        "actuator is less than being handed on to another one, which is what touching two is for. Drives of the "
        f"nearest actuator alone, within {MICRO * NEAR:g} um of which the part must end: strokes of "
        f"{', '.join(f'{MICRO * s:g}' for s in STROKES)} um, {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g} Hz, "
        f"{p.cycles} cycles; {reached.shape[1]} starts.", numbers, beyond=True,
    )  # fmt: skip
