"""The problem by this project."""

from __future__ import annotations

from problem import ACTUATORS, STROKES, Run, Solution

from fem_plate import Plate, PlateSection
from meshes import PlateMesh, disc

POISSON_RATIO = 0.3
SECTION = PlateSection(youngs_modulus=12 * (1 - POISSON_RATIO**2), poisson_ratio=POISSON_RATIO, thickness=1.0)
# Cells from the centre to the rim, and the bound on the Hessian's error.
MESHES = [(2, 5e-2), (3, 1e-2), (4, 5e-3), (6, 1e-3), (8, 2e-4), (12, 3e-5), (16, 1e-5), (24, 3e-6)]
UNIT = 4  # the run that times are given in


def solve(mesh: PlateMesh) -> Solution:
    shapes = Plate(mesh, SECTION, "clamped").influence(ACTUATORS)
    return Solution(shapes.unknowns, lambda xy: shapes.evaluate(xy, STROKES))


def runs() -> list[Run]:
    return [Run("active-surface", lambda n=cells: disc(1.0, 1 / n), solve, bound) for cells, bound in MESHES]
