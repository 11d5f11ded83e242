"""What a path over a plate with inertia costs, over the same plate without, at three drive frequencies.

    .venv/bin/python benchmarks/inertia.py       writes a table for docs/benchmarks.md

A clamped disc of silicon under 2 and 25 actuators, strokes up and down for 20 ms, damping ratio 0.02. First the surface
must agree with its modes summed outside the kernels.
"""

from __future__ import annotations

from statistics import median
from time import process_time

import numpy as np
import report

from coupling import silent
from coupling.case import Case
from coupling.scene import plate_scene
from particle import ConstantFriction, Micropart, simulate

RADIUS, THICKNESS, DURATION = 1e-3, 20e-6, 20e-3  # m, m, s
RATIOS, COUNTS, REPEATS = (0.003, 0.01, 0.1), (2, 25), 3
AGREEMENT = 1e-6  # of the largest w
PART, FRICTION = Micropart(2e-9, (100e-6, 50e-6), centre_height=45e-6), ConstantFriction(2e-10)


def case_of(count: int, frequency: float, inertia: bool) -> Case:
    """The case with so many actuators, the fastest at a frequency [Hz]."""
    rng = np.random.default_rng(count)
    side = int(np.ceil(np.sqrt(count)))
    grid = (np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)[:count] + 0.5) / side - 0.5
    places = grid * 1.1 * RADIUS + rng.uniform(-20e-6, 20e-6, (count, 2))
    actuators = [
        {"position": tuple(place), "stroke": 2e-6, "frequency": frequency * (0.75 + 0.25 * k / max(count - 1, 1))}
        for k, place in enumerate(places.tolist())
    ]
    plate = {
        "shape": "disc",
        "radius": RADIUS,
        "youngs_modulus": 169e9,
        "poisson_ratio": 0.3,
        "thickness": THICKNESS,
        "density": 2330.0,
        "inertia": inertia,
    }
    return Case.model_validate(
        {
            "plate": plate,
            "actuators": actuators,
            "part": {"mass": 2e-9, "position": (100e-6, 50e-6)},
            "friction": {"model": "coulomb", "coefficient": 0.05, "adhesion": 1e-3},
            "run": {"duration": DURATION},
        }
    )


def main() -> None:
    """Print the table."""
    rows = []
    for count in COUNTS:
        first = None
        for ratio in RATIOS:
            if first is None:
                still = plate_scene(case_of(count, 1.0, False), case_of(count, 1.0, False).plate, silent)
                first = float(still.plate.frequencies(1, still.shapes.points)[0])
            times = {False: [], True: []}
            scenes = {}
            for inertia in (False, True):
                case = case_of(count, ratio * first, inertia)
                scenes[inertia] = plate_scene(case, case.plate, silent)
            vibration = scenes[True].vibration
            check(scenes[True])
            ends = {}
            for _ in range(REPEATS + 1):
                for inertia, scene in scenes.items():
                    begun = process_time()
                    path = simulate(scene.surface, PART, FRICTION, DURATION)
                    times[inertia].append(process_time() - begun)
                    ends[inertia] = path
            cost = median(a / b for a, b in zip(times[True][1:], times[False][1:], strict=True))
            pieces = len(vibration.modal_drives[0].pieces.start)
            longer = ends[True].evaluations / ends[False].evaluations
            rows.append((count, ratio, len(vibration.frequencies), pieces, longer, cost))
            print(rows[-1], vibration.model.chosen.error, flush=True)
    head = ["actuators", "f / f1", "modes", "pieces", "evaluations, ratio", "time, ratio"]
    report.table("A path with inertia over one without", head, [[f"{v:.3g}" for v in row] for row in rows])


def check(scene) -> None:
    """Assert that the surface is the sum of its shapes."""
    shapes, drives = scene.moving_shapes, scene.moving_drives
    rng = np.random.default_rng(1)
    for time in rng.uniform(0, DURATION, 20):
        xy = rng.uniform(-0.5, 0.5, (1, 2)) * RADIUS
        w = shapes.values(xy)[0] @ [drive.evaluate(time)[0] for drive in drives]
        assert abs(scene.surface.evaluate(xy[0], float(time)).w[0] - w) < AGREEMENT * 2e-6


if __name__ == "__main__":
    main()
