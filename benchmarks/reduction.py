"""The reduced model of a stretching plate: full solutions, shapes, error and time, for two actuators at some heights.

python benchmarks/reduction.py
"""

from __future__ import annotations

import time

import numpy as np

from coupling.stretch.making import training
from fem_plate import Plate, PlateSection
from fem_plate.large_deflection import level_of, reduce, reduced_equilibrium
from meshes import disc
from particle import Drive

RADIUS, THICKNESS, TOLERANCE, END = 500e-6, 5e-6, 1e-5, 20e-3
POINTS = RADIUS * np.array([[0.3, 0.1], [-0.25, -0.35]])


def main() -> None:
    plate = Plate(disc(RADIUS, RADIUS / 4), PlateSection(169e9, 0.3, THICKNESS))
    large = plate.large_deflection(POINTS)
    print(
        "height / t   solutions   corrections   N_r   U_m   error held out   model over a full solution   over an online one"
    )
    for scale in (1.0, 3.0, 10.0):
        drives = [Drive(scale * THICKNESS, frequency, "up-down") for frequency in (300.0, 400.0)]
        heights, discrete = training([drives], END), large.discrete(level_of(scale), 0)
        start = time.perf_counter()
        model = reduce(discrete, heights / THICKNESS, TOLERANCE)
        offline = time.perf_counter() - start
        assert model.error < TOLERANCE
        start = time.perf_counter()
        large.solved(heights[1], 0.0, level_of(scale), 0)
        full = time.perf_counter() - start
        start = time.perf_counter()
        for row in heights:
            reduced_equilibrium(model.plate, row / THICKNESS)
        online = (time.perf_counter() - start) / len(heights)
        sizes = len(model.plate.stiffness), len(model.plate.membrane), model.motions.shape[1]
        print(
            f"{scale:10.0f} {model.solutions:11d} {sizes[0]:13d} {sizes[1]:5d} {sizes[2]:5d} {model.error:16.1e} "
            f"{offline / full:28.0f} {full / online:20.0f}"
        )


if __name__ == "__main__":
    main()
