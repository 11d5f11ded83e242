"""What a path over a plate with inertia costs, over the same plate without, at three drive frequencies.

    .venv/bin/python benchmarks/inertia.py               writes a table for benchmarks/RESULTS.md
    .venv/bin/python benchmarks/inertia.py --count 2     only so many actuators; writes nothing

A clamped disc of silicon under 2 and 25 actuators, strokes up and down for 20 ms at one frequency, each with a delay
of its own, damping ratio 0.02. Friction grows with the square of the frequency, so that the part slips alike. The last
rows are of plates that stretch, with inertia and without. First the surface must be the sum of its shapes.
"""

from __future__ import annotations

import argparse
from statistics import median
from time import process_time

import numpy as np
import report

from coupling import Case, build_friction, build_scene, follow_part
from coupling.scene import PlateScene

RADIUS, THICKNESS, DURATION, STROKE, MASS, HEIGHT = 1e-3, 20e-6, 20e-3, 2e-6, 2e-9, 45e-6  # m, m, s, m, kg, m
RATIOS, COUNTS, REPEATS = (0.003, 0.01, 0.1), (2, 25), 3
STRETCHING = 0.003  # the only ratio of plates that stretch
SHARE = 0.3  # of the pull on the part that friction holds, about
AGREEMENT = 1e-6  # of a stroke


def case_of(count: int, frequency: float, inertia: bool, theory: str = "linear") -> Case:
    """The case with so many actuators, the fastest at a frequency [Hz]."""
    rng, side = np.random.default_rng(count), int(np.ceil(np.sqrt(count)))
    grid = (np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)[:count] + 0.5) / side - 0.5
    places = 1.1 * RADIUS * grid + rng.uniform(-20e-6, 20e-6, (count, 2))
    delays = rng.uniform(0, 1, count) / frequency
    pull = MASS * (HEIGHT + THICKNESS / 2) * 4 * STROKE / RADIUS * 5.77 * (2 * frequency) ** 2
    plate = {
        "shape": "disc",
        "radius": RADIUS,
        "youngs_modulus": 169e9,
        "poisson_ratio": 0.3,
        "thickness": THICKNESS,
        "density": 2330.0,
        "inertia": inertia,
        "theory": theory,
    }
    return Case.model_validate(
        {
            "plate": plate,
            "actuators": [
                {"position": tuple(place), "stroke": STROKE, "frequency": frequency, "delay": delay}
                for place, delay in zip(places.tolist(), delays.tolist(), strict=True)
            ],
            "part": {"mass": MASS, "position": (100e-6, 50e-6), "centre_height": HEIGHT},
            "friction": {"model": "constant", "limit": SHARE * pull},
            "run": {"duration": DURATION},
        }
    )


def row(count: int, frequency: float, name: str, theory: str = "linear") -> str:
    """A row of the table, with the drives' frequency [Hz]."""
    cases = [case_of(count, frequency, inertia, theory) for inertia in (False, True)]
    scenes = [build_scene(case) for case in cases]
    check(scenes[1])
    modes = (scenes[1].stretch or scenes[1].vibration).model.chosen
    times, paths = np.zeros((REPEATS + 1, 2)), [None, None]
    for repeat in range(REPEATS + 1):
        for k, (case, scene) in enumerate(zip(cases, scenes, strict=True)):
            begun = process_time()
            paths[k] = follow_part(case, scene.surface, build_friction(case))
            times[repeat, k] = process_time() - begun
    cost = median(times[1:, 1] / times[1:, 0])
    more = paths[1].evaluations / paths[0].evaluations
    pieces = max(len(drive.segments().start) for drive in scenes[1].moving_drives)
    return f"| {name} | {len(modes.modes.omega)} | {modes.error:.1e} | {pieces} | {more:.2f} | {cost:.1f} |"


def check(scene: PlateScene) -> None:
    """The surface is the sum of its shapes."""
    shapes, drives = scene.moving_shapes, scene.moving_drives
    rng = np.random.default_rng(1)
    for time in rng.uniform(0, DURATION, 20).tolist():
        xy = rng.uniform(-0.5, 0.5, (1, 2)) * RADIUS
        off = scene.surface.evaluate(xy[0], time).w[0] - shapes.values(xy)[0] @ [d.evaluate(time)[0] for d in drives]
        assert abs(off) < AGREEMENT * STROKE, f"the surface is off by {off:.1e} m"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, help="only so many actuators")
    only = parser.parse_args().count
    lines = [
        "| actuators | drive / first frequency | modes | their error | pieces | evaluations, ratio | time, ratio |",
        "|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for count in COUNTS if only is None else (only,):
        still = build_scene(case_of(count, 1.0, False))
        first = float(still.plate.frequencies(1, still.shapes.points)[0])
        for ratio in RATIOS if count < max(COUNTS) else RATIOS[:2]:  # the last takes 25 actuators half an hour
            lines.append(row(count, ratio * first, f"{count} | {ratio:g}"))
            print(lines[-1], flush=True)
        lines.append(row(count, STRETCHING * first, f"{count}, stretching | {STRETCHING:g}", "von-karman"))
        print(lines[-1], flush=True)
    if only is None:
        report.write("inertia", lines)


if __name__ == "__main__":
    main()
