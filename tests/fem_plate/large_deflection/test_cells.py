"""Which cells a plate gets that stretches."""

import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from fem_plate.large_deflection.discrete import level_of, refined_for
from meshes import disc

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0)


@pytest.mark.parametrize(
    "thicknesses, level", [(0.0, 0), (5.0, 0), (5 * (1 + 1e-9), 0), (5.1, 1), (15.0, 1), (30.0, 2)]
)
def test_levels(thicknesses, level):
    """Rounding of a largest deflection does not change the cells."""
    assert level_of(thicknesses) == level


@pytest.mark.parametrize("level, halvings", [(0, 2), (1, 3), (2, 4)])
def test_cells_at_an_actuator_are_halved(level, halvings):
    mesh, point = disc(1.0, 0.3), np.array([[0.31, 0.07]])
    refined = refined_for(mesh, point, 1.0, level)

    def size_at_point(mesh):
        centres = mesh.points[mesh.triangles].mean(axis=1)
        return mesh.cell_sizes[np.argmin(np.hypot(*(centres - point).T))]

    assert size_at_point(refined) == pytest.approx(size_at_point(mesh) / 2**halvings, rel=0.35)


def test_the_level_follows_the_deflection_that_comes_out():
    """A pressure, and a spring whose stroke is far above what the plate does."""
    plate = Plate(disc(1.0, 0.4), UNIT)
    large = plate.large_deflection([])
    assert large.solve([], 100.0).unknowns < large.solve([], 1e5).unknowns
    soft = plate.large_deflection([(0, 0)], stiffness=1e-3).solve([100.0])
    assert soft.unknowns == plate.large_deflection([(0, 0)]).solve([0.1]).unknowns
