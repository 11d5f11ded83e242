"""Simply supported regular polygons of 3 to 36 sides, against harmonic expansions (`tests/reference/polygons.py`).

    .venv/bin/python benchmarks/polygons.py            all of them (about five minutes)
    .venv/bin/python benchmarks/polygons.py 5 12 24    some
    .venv/bin/python benchmarks/polygons.py --force    under a central force

Prints the table of `benchmarks/RESULTS.md`: the largest error of w under a uniform pressure, its estimate, and the
error of the first frequency. Fails where an error exceeds BOUND, or TOO_SMALL times its estimate.
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
BOUND = 1e-6
TOLERANCES = {4: BOUND}  # the square's estimate on these cells, 1.4e-6, says that it needs one
TOO_SMALL = 3.0  # errors over estimates
ROUNDING = 3e-9  # of which neither is more than rounding
UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)


def places(sides: int) -> np.ndarray:
    xy = np.random.default_rng(0).uniform(-1, 1, (1500, 2))
    xy = xy[np.hypot(*xy.T) < 0.99 * np.cos(np.pi / sides)]
    return np.concatenate([xy[np.hypot(*xy.T) > 0.02], [[1 - d, 0.0] for d in (0.1, 0.01, 1e-3, 1e-5)]])


def row(sides: int, load: str) -> tuple[str, list[str]]:
    """A row of the table, and what in it breaks a bound."""
    xy = places(sides)
    exact = polygons.Polygon(sides, load).at(xy @ [1, 1j])
    with warnings.catch_warnings(action="ignore"):  # of what looks like a round rim
        plate = Plate(regular_polygon(sides, 1.0, CELL), UNIT, "simply-supported", tolerance=TOLERANCES.get(sides))
    found = plate.pressure(1.0) if load == "pressure" else plate.deflection([[0.0, 0.0]], 1.0)
    error = float(np.abs(found.evaluate(xy)[0] - exact).max() / np.abs(exact).max())
    estimate = found.error_estimate
    off = abs(2 * np.pi * plate.frequencies(1)[0] / polygons.first_frequency(sides) - 1)
    broken = []
    if error > BOUND or (error > ROUNDING and error > TOO_SMALL * estimate):
        broken.append(f"{sides} sides, {load}: error {error:.1e}, estimate {estimate:.1e}")
    if off > BOUND:
        broken.append(f"{sides} sides, first frequency: error {off:.1e}")
    return f"| {sides} | {found.unknowns} | {error:.1e} | {estimate:.1e} | {off:.1e} |", broken


if __name__ == "__main__":
    load = "force" if "--force" in sys.argv else "pressure"
    print("| sides | unknowns | error | estimate | first frequency: error |")
    print("|---:" * 5 + "|")
    broken = []
    for count in [int(number) for number in sys.argv[1:] if number.isdigit()] or range(3, 37):
        line, more = row(count, load)
        print(line, flush=True)
        broken += more
    sys.exit("\n".join(broken) or None)
