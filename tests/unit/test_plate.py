"""Plate and Deflection: supports, refinement, forces."""

from dataclasses import replace

import numpy as np
import pytest

from fem_plate import Plate
from meshes import disc


@pytest.fixture(scope="module")
def plate(section, radius):
    return Plate(disc(radius, radius / 4), section)


@pytest.mark.parametrize("supports", ["free", "Clamped", ""])
def test_other_supports_are_refused(section, supports):
    with pytest.raises(ValueError, match=f"^Input supports of Plate must be 'clamped'; got {supports!r}$"):
        Plate(disc(1.0, 0.5), section, supports)


def test_the_finer_plate_has_four_times_the_cells_and_is_made_once(plate):
    assert len(plate.finer.mesh.triangles) == 4 * len(plate.mesh.triangles)
    assert plate.finer is plate.finer


def test_forces_superpose(plate, layout, spots):
    one, other = np.array([1e-3, 0.0]), np.array([0.0, -3e-3])
    both = plate.deflection(layout, one + other).evaluate(spots)
    parts = [plate.deflection(layout, force).evaluate(spots) for force in (one, other)]
    for total, a, b in zip(both, *parts, strict=True):
        assert np.abs(total - a - b).max() < 1e-12 * np.abs(total).max()


def test_poissons_ratio_enters_only_through_the_rigidity(section, radius, layout, spots):
    """On a clamped plate; so the bending energy and the Nitsche rim must agree about it."""
    mesh = disc(radius, radius / 8)
    found = [Plate(mesh, replace(section, poisson_ratio=nu)).influence(layout).evaluate(spots) for nu in (0.0, 0.45)]
    assert np.abs(found[0][0] - found[1][0]).max() < 1e-7


@pytest.mark.parametrize("forces", [[1.0], [1.0, 2.0, 3.0], [[1.0, 2.0]]])
def test_there_must_be_one_force_a_point(plate, layout, forces):
    with pytest.raises(ValueError, match="^Input forces of deflection must be one a point, 2; got shape"):
        plate.deflection(layout, forces)


def test_deflection_refuses_misplaced_points(plate):
    with pytest.raises(ValueError, match="must lie inside the rim"):
        plate.deflection([[1.0, 0.0]], [1.0])
