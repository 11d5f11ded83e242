"""What the top face and the height of the centre of mass add to the pull on a part, and what they cost.

    .venv/bin/python benchmarks/top_face.py       writes tables for benchmarks/RESULTS.md

The pull is that on a glued part on a clamped disc, over a cycle of its central actuator. The cost is that of paths over
25 actuators; first a height of 1e-12 m must leave the path as it is without.
"""

from __future__ import annotations

from dataclasses import replace
from statistics import median
from time import process_time

import numpy as np
import report

from coupling import surface_motion
from fem_plate import DiscShapes, Plate, PlateSection
from meshes import rectangle
from particle import ConstantFriction, Drive, Micropart, SurfaceMotion, Trajectory, simulate

RADIUS, THICKNESS, FREQUENCY = 1e-3, 100e-6, 2e3  # m, m, Hz
DEFLECTIONS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)  # thicknesses
HEIGHTS = (0.0, 10e-6, 20e-6, 50e-6)  # m, of the centre of mass over the top face
START, MASS, GLUED = (300e-6, 200e-6), 2e-9, 1.0  # m, kg, N
SIDE, PITCH, LIMIT, DURATION = 5, 150e-6, 4e-9, 40e-3  # of the array; m, N, s
ROUNDS, REPEATS, BARELY, AGREEMENT = 9, 40, 1e-12, 1e-6


def share(deflection: float, height: float) -> float:
    """What the heights add to the pull over the pull on a point of the mid-plane, root mean squares over a cycle."""
    surface = surface_motion(DiscShapes([[0.0, 0.0]], RADIUS), [Drive(deflection * THICKNESS, FREQUENCY)])
    surface = replace(surface, half_thickness=THICKNESS / 2)
    path = simulate(surface, Micropart(MASS, START, centre_height=height), ConstantFriction(GLUED), 1 / FREQUENCY)
    contact = path.contact_at(np.linspace(0.0, 1 / FREQUENCY, 401))
    return float(np.sqrt((contact.added_pull**2).mean() / (contact.point_pull**2).mean()))


def array() -> SurfaceMotion:
    """A wave over a square lattice of actuators, as in examples/array_10x10.toml."""
    x, y = np.meshgrid(*(PITCH * (np.arange(SIDE) - (SIDE - 1) / 2),) * 2)
    points, width = np.column_stack([x.ravel(), y.ravel()]), (SIDE + 2) * PITCH
    plate = Plate(rectangle(width, width, PITCH / 2), PlateSection(169e9, 0.3, THICKNESS), "clamped")
    delays = [((row + column) % 6) / 6 / 1.6e3 for row in range(SIDE) for column in range(SIDE)]
    return surface_motion(plate.influence(points), [Drive(18e-6, 1.6e3, delay=delay) for delay in delays])


def path(surface: SurfaceMotion, half_thickness: float, height: float = 0.0) -> Trajectory:
    """A path over the array."""
    part = Micropart(MASS, (20e-6, -35e-6), centre_height=height)
    return simulate(replace(surface, half_thickness=half_thickness), part, ConstantFriction(LIMIT), DURATION)


def costs(surface: SurfaceMotion) -> list[tuple[str, int, float, float]]:
    """Name, evaluations, time of a path and time of an evaluation, both over those on the mid-plane."""
    cases = {
        "mid-plane": (0.0, 0.0),
        "height 1e-12 m": (BARELY, 0.0),
        "top face": (THICKNESS / 2, 0.0),
        "top face, centre of mass 30 um above": (THICKNESS / 2, 30e-6),
    }
    plain, barely = path(surface, 0.0), path(surface, BARELY)
    off = np.abs(plain.position[-1] - barely.position[-1]).max() / plain.path_length
    assert off < AGREEMENT, f"a height of {BARELY} m moves the end by {off:.1e} of the path"
    counts = {name: path(surface, *heights).evaluations for name, heights in cases.items()}
    times: dict[str, list[float]] = {name: [] for name in cases}
    for _ in range(ROUNDS):
        for name, heights in cases.items():
            begin = process_time()
            for _ in range(REPEATS):
                path(surface, *heights)
            times[name].append(process_time() - begin)
    unit = times["mid-plane"]
    ratios = {name: median(t / u for t, u in zip(row, unit, strict=True)) for name, row in times.items()}
    plain_count = counts["mid-plane"]
    return [(name, counts[name], ratios[name], ratios[name] * plain_count / counts[name]) for name in cases]


def main() -> None:
    lines = ["| deflection / thickness | " + " | ".join(f"{h * 1e6:g} um" for h in HEIGHTS) + " |"]
    lines.append("|---|" + "---:|" * len(HEIGHTS))
    for deflection in DEFLECTIONS:
        lines.append(f"| {deflection:g} | " + " | ".join(f"{share(deflection, h):.3g}" for h in HEIGHTS) + " |")
    costs_lines = ["| part | evaluations | time of the path | time of an evaluation |", "|---|---:|---:|---:|"]
    costs_lines += [f"| {name} | {n} | {total:.2f} | {each:.2f} |" for name, n, total, each in costs(array())]
    print("\n".join([*lines, "", *costs_lines]))
    report.write("top face", lines)
    report.write("cost of the top face", costs_lines)


if __name__ == "__main__":
    main()
