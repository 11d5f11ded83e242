"""Simply supported regular polygons of 3 to 36 sides, against harmonic expansions (`tests/reference/polygons.py`).

    .venv/bin/python benchmarks/polygons.py            all of them (about ten minutes)
    .venv/bin/python benchmarks/polygons.py 5 12 24    some

Prints the table of `docs/accuracy.md`: the largest error of w under a uniform pressure and under a central force, over
the estimate; the error of the first frequency; and the first of these without corner functions. Every error must be
below BOUND, and no estimate far below the error.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import numpy as np

from fem_plate import Plate, PlateSection
from meshes import regular_polygon

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "reference"))

import polygons  # noqa: E402

CELL = 0.15  # of the distance of a corner from the centre
BOUND = 2e-6
TOO_SMALL = 5.0  # errors over estimates
ROUNDING = 3e-9  # of which neither is more than rounding
UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)


def places(sides: int) -> np.ndarray:
    xy = np.random.default_rng(0).uniform(-1, 1, (1500, 2))
    xy = xy[np.hypot(*xy.T) < 0.99 * np.cos(np.pi / sides)]
    return np.concatenate([xy[np.hypot(*xy.T) > 0.02], [[1 - d, 0.0] for d in (0.1, 0.01, 1e-3, 1e-5)]])


def row(sides: int) -> str:
    xy = places(sides)
    with warnings.catch_warnings(action="ignore"):  # of what looks like a round rim
        plate, plain = (Plate(regular_polygon(sides, 1.0, CELL), UNIT, "simply-supported") for _ in range(2))
    plain.wedges = []
    cells = []
    for load in ("pressure", "force"):
        exact = polygons.Polygon(sides, load)
        w = exact.at(xy @ [1, 1j])
        error, before = (
            float(np.abs(found.evaluate(xy)[0] - w).max() / np.abs(w).max())
            for found in (_under(one, load) for one in (plate, plain))
        )
        estimate = _under(plate, load).error_estimate
        assert error < BOUND, f"{sides} sides, {load}: {error:.1e}"
        assert error < ROUNDING or error < TOO_SMALL * estimate, f"{sides} sides, {load}: {error:.1e}, {estimate:.1e}"
        cells += [f"{before:.0e}", f"{error:.0e}", f"{estimate:.0e}"]
    exact_frequency = polygons.first_frequency(sides)
    error, before = (abs(2 * np.pi * one.frequencies(1)[0] / exact_frequency - 1) for one in (plate, plain))
    assert error < BOUND, f"{sides} sides, frequency: {error:.1e}"
    cells += [f"{before:.0e}", f"{error:.0e}", f"{plate.modes(1).error_estimate[0]:.0e}"]
    return f"| {sides} | {plate.model().unknowns} | " + " | ".join(cells) + " |"


def _under(plate: Plate, load: str):
    return plate.pressure(1.0) if load == "pressure" else plate.deflection([[0.0, 0.0]], 1.0)


if __name__ == "__main__":
    print("| sides | unknowns | pressure: before | error | estimate | force: before | error | estimate | ", end="")
    print("first frequency: before | error | estimate |")
    print("|---:" * 11 + "|")
    for count in [int(number) for number in sys.argv[1:]] or range(3, 37):
        print(row(count), flush=True)
