"""Small cells at corners that move: unknowns counted from the corner's plane keep rounding out of their stiffness."""

from __future__ import annotations

import numpy as np

from fem_plate import Plate, PlateSection
from meshes import rectangle

UNIT = PlateSection(12 * (1 - 0.3**2), 0.3, 1.0)


def test_rigid_motions_have_no_energy():
    space = Plate(rectangle(2.0, 2.0, 0.075), UNIT, "free").model().space
    motions = space.linear()
    assert np.abs(motions.T @ (space.stiffness(UNIT.law) @ motions)).max() < 5e-8


def test_a_cantilever_bends_alike_on_coarse_and_fine_cells():
    """Halving the cells to 0.075 once took 1e-6 away."""
    tips = []
    for cell in (0.3, 0.15, 0.075):
        plate = Plate(rectangle(2.0, 2.0, cell), UNIT, {"bottom": "clamped"})
        tips.append(plate.deflection([(0.37, 0.21)], [1.0]).evaluate([(0.9, 0.9)])[0][0])
    assert np.ptp(tips) < 5e-8 * tips[0]
