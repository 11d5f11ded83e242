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

from coupling import surface_motion
from fem_plate import Plate, PlateSection
from meshes import rectangle
from paper.found import MICRO, Found, finish, percent
from paper.models import Bench, FloatArray
from paper.parameters import Effort
from paper.verdict import FEW, MOST, Verdict, of_checks
from particle import Drive, Micropart, SurfaceMotion, simulate_many

NAMES = ("deadzones",)
PART: Final = 100e-6  # m, side of the part: the paper's contact area is 100 um x 100 um
PITCHES: Final = 75e-6, 2.4e-3  # m
FREQUENCIES: Final = 150.0, 900.0  # Hz
STROKES: Final = (50e-6, 100e-6, 150e-6)  # m
NEAR: Final = 10e-6  # m
FEWER: Final = 3  # times fewer starts than elsewhere
CELLS: Final = 3.0  # of the mesh in a pitch
PLATE_TOLERANCE: Final = 1e-6
TOLERANCE: Final = 1e-6  # of paths


def find(bench: Bench, effort: Effort) -> Found:
    """The shares of starts that are served, over the pitch."""
    pitches = np.geomspace(*PITCHES, effort.pitches) if effort.pitches > 1 else np.array([150e-6])
    count = max(effort.starts // FEWER, 1)
    random = np.random.default_rng(bench.parameters.seed)
    places = random.random((count, 2)) - 0.5  # in pitches, around the middle actuator: the nearest one
    reached = np.array([_reached(bench, effort, pitch, pitch * places) for pitch in pitches.tolist()])
    touching = np.array([touched(pitch, PART) for pitch in pitches.tolist()])

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        share = reached.mean(axis=1)
        spread = np.sqrt(share * (1 - share) / count)
        axes.errorbar(MICRO * pitches, 100 * share, 100 * spread, color="black", marker="o", capsize=3,
                      label="active surface: brought to the nearest actuator")  # fmt: skip
        axes.plot(MICRO * pitches, 100 * touching[:, 0], "--", color="#c8371b", label="without: touches an actuator")
        axes.plot(MICRO * pitches, 100 * touching[:, 1], ":", color="#c8371b", label="without: touches two or more")
        axes.set_ylim(0, 105)
        axes.set_xscale("log")
        axes.set_xticks(MICRO * pitches, [f"{MICRO * pitch:.0f}" for pitch in pitches])
        axes.minorticks_off()
        finish(axes, "pitch [µm]", "share of the starts [%]", f"part of {MICRO * PART:g} µm")

    data: dict[str, Any] = {"pitch": pitches.tolist(), "reached": reached.tolist(), "touching": touching.tolist()}
    verdict = _verdict(pitches, reached, touching, bench.parameters.cycles)
    return Found("deadzones", "Dead zones (beyond the paper)", (verdict,), data, draw, (7.5, 4.6),
                 "Share of starts from which the part is brought to its nearest actuator, and of places where a part "
                 "would touch actuators; bars: one standard deviation of so many starts.")  # fmt: skip


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
    plate = Plate(rectangle(4 * pitch, 4 * pitch, pitch / CELLS), section, tolerance=PLATE_TOLERANCE)
    return surface_motion(plate.influence(points), [Drive(0.0, 1.0)] * len(points), 1e-6)


def _reached(bench: Bench, effort: Effort, pitch: float, starts: FloatArray) -> FloatArray:
    """Whether (n,) parts from starts (n, 2) [m] around the middle actuator end next to it with one of the drives."""
    p = bench.parameters
    surface = nine(bench, pitch)
    middle, reached = 4, np.zeros(len(starts), dtype=bool)
    for stroke in STROKES:
        for frequency in np.geomspace(*FREQUENCIES, effort.candidates).tolist():
            left = np.flatnonzero(~reached)
            drives = [Drive(stroke if k == middle else 0.0, frequency) for k in range(9)]
            parts = [Micropart(p.mass, (float(x), float(y))) for x, y in starts[left]]
            duration = p.cycles / frequency
            found = simulate_many(surface.driven_by(drives), parts, p.friction, duration, p.gravity, TOLERANCE)
            for k, path in zip(left, found, strict=True):
                reached[k] = path.outcome.value in ("stuck", "moving") and np.hypot(*path.position[-1]) <= NEAR
    return reached


def _verdict(pitches: FloatArray, reached: FloatArray, touching: FloatArray, cycles: int) -> Verdict:
    served, beyond = reached.mean(axis=1) >= MOST, touching[:, 1] < FEW
    widest = float(pitches[served].max(initial=0.0))
    first = float(pitches[beyond].min(initial=np.inf))
    share = float(reached[pitches <= widest].mean()) if served.any() else 0.0
    text = f"pitches up to {MICRO * widest:.0f} um are served ({percent(share)} of the starts); touching two actuators "
    text += f"ends below {MICRO * first:.0f} um"
    numbers = {
        "pitch": pitches.tolist(), "reached": reached.mean(axis=1).tolist(),
        "touches_one": touching[:, 0].tolist(), "touches_two": touching[:, 1].tolist(), "widest_served": widest,
    }  # fmt: skip
    return Verdict(
        "beyond: dead zones", "An active surface moves parts smaller than the spacing of its actuators, where discrete "
        "actuators leave dead zones.",
        {"plate": of_checks(text, [widest > PART])},
        f"A part of {MICRO * PART:g} um; served: at least {100 * MOST:.0f} %. Drives of the nearest actuator alone, "
        f"within {MICRO * NEAR:g} um of which the part must end: strokes of "
        f"{', '.join(f'{MICRO * s:g}' for s in STROKES)} um, {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g} Hz, "
        f"{cycles} cycles.",
        numbers,
    )  # fmt: skip
