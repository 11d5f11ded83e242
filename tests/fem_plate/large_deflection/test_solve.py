"""Reactions and deflections of stretching discs and annuli, against a second discretisation in one dimension."""

import axisymmetric_plates as radial
import numpy as np
import pytest

from fem_plate import Plate, PlateSection
from meshes import annulus, disc, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
C, S = "clamped", "simply-supported"
TWO = [(0.3, 0.1), (-0.25, -0.35)]


def difference(state, expected):
    """The largest difference of w from a radial plate's, over its largest."""
    r = np.linspace(expected.r[0] + 0.01, 0.99, 25)
    angle = np.linspace(0, 6, len(r))
    w = state.evaluate(np.column_stack([r * np.cos(angle), r * np.sin(angle)]))[0]
    return np.abs(w - radial.at_radii(expected, expected.w, r)).max() / np.abs(expected.w).max()


@pytest.mark.parametrize("support", [C, S])
@pytest.mark.parametrize("membrane", ["airy", "plane-stress"])
def test_the_reaction_of_a_held_centre(support, membrane):
    expected = radial.disc(height=1.0, support=support)
    state = Plate(disc(1.0, 0.15), UNIT, support).large_deflection([(0, 0)], membrane=membrane).solve([1.0])
    assert state.reactions == pytest.approx([expected.force], rel=1e-7 if membrane == "airy" else 1e-6)
    assert difference(state, expected) < 1e-6
    assert state.membrane == membrane


def test_a_movable_rim():
    expected = radial.disc(height=1.0, support=S, movable=True)
    state = Plate(disc(1.0, 0.15), UNIT, S).large_deflection([(0, 0)], "movable").solve([1.0])
    assert state.reactions == pytest.approx([expected.force], rel=1e-6)
    assert difference(state, expected) < 1e-6


@pytest.mark.slow
def test_pressure_and_a_force_together():
    expected = radial.disc(force=40.0, pressure=30.0, support=S)
    plate = Plate(disc(1.0, 0.15), UNIT, S)
    state = plate.large_deflection([(0, 0)], stiffness=0.0).solve([40.0], 30.0)
    assert difference(state, expected) < 1e-6
    assert state.reactions == pytest.approx([40.0])
    assert state.stretching_energy == pytest.approx(expected.stretching, rel=1e-6)
    assert state.energy == pytest.approx(expected.bending + expected.stretching, rel=1e-6)


@pytest.mark.parametrize("held", [True, False])
def test_an_annulus(held):
    """Both rims clamped and immovable; or the hole free to move and to bend."""
    pressure = 2000.0 if held else 100.0
    expected = radial.annulus(0.4, pressure=pressure, held=held)
    plate = Plate(annulus(0.4, 1.0, 0.15), UNIT, C if held else {"outer": C})
    state = plate.large_deflection([]).solve([], pressure)
    assert state.membrane == "plane-stress"
    assert 0.5 < np.abs(expected.w).max() < 1
    assert difference(state, expected) < (5e-5 if held else 2e-6)
    assert state.stretching_energy == pytest.approx(expected.stretching, rel=1e-3 if held else 1e-5)


def test_without_stretching_it_is_the_linear_plate():
    """To second order in the height."""
    plate, directions = Plate(disc(1.0, 0.25), UNIT), np.array([1, -0.6])
    large = plate.large_deflection(TWO)
    linear, small, larger = (large.solve(h * directions).reactions / h for h in (1e-4, 1e-2, 1e-1))
    assert linear == pytest.approx(plate.influence(TWO).stiffness @ directions, rel=1e-6)
    assert larger - linear == pytest.approx(100 * (small - linear), rel=2e-2)


def test_the_first_gain_of_stiffness():
    """P / P_linear - 1 over (height / t)^2, of the clamped disc."""
    large = Plate(disc(1.0, 0.2), UNIT).large_deflection([(0, 0)])
    height = 0.01
    gain = (large.solve([height]).reactions[0] / height / (16 * np.pi) - 1) / height**2
    assert gain == pytest.approx(0.444922, rel=2e-4)


@pytest.mark.slow
def test_springs_and_forces_are_rigid_actuators_elsewhere():
    plate, heights = Plate(disc(1.0, 0.4), UNIT), np.array([2.0, -1.0])
    rigid = plate.large_deflection(TWO).solve(heights)
    stiffness = np.array([50.0, 300.0])
    on_springs = plate.large_deflection(TWO, stiffness=stiffness).solve(heights + rigid.reactions / stiffness)
    forced = plate.large_deflection(TWO, stiffness=[0.0, np.inf]).solve([rigid.reactions[0], heights[1]])
    for state in (on_springs, forced):
        assert state.reactions == pytest.approx(rigid.reactions, rel=1e-7)
        assert state.evaluate(TWO)[0] == pytest.approx(heights, rel=1e-8)


@pytest.mark.slow
def test_metres_and_newtons():
    """The same plate in other units."""
    a, t = 300e-6, 5e-6
    section = PlateSection(youngs_modulus=169e9, poisson_ratio=0.3, thickness=t)
    unit = Plate(disc(1.0, 0.4), UNIT).large_deflection(TWO)
    silicon = Plate(disc(a, 0.4 * a), section).large_deflection(a * np.array(TWO))
    force = section.rigidity * t / a**2
    one, two = unit.solve([1.0, 0.5], 20.0), silicon.solve([t, 0.5 * t], 20.0 * force / a**2)
    assert two.reactions == pytest.approx(one.reactions * force, rel=1e-8)
    assert two.energy == pytest.approx(one.energy * force * t, rel=1e-8)
    assert two.in_plane([(0.1 * a, 0.2 * a)]) == pytest.approx(one.in_plane([(0.1, 0.2)]) * t**2 / a, rel=1e-7)
    ratio = section.rigidity / a**2
    assert two.membrane_force([(0.1 * a, 0.2 * a)]) == pytest.approx(one.membrane_force([(0.1, 0.2)]) * ratio, rel=1e-7)


@pytest.mark.parametrize("points, held", [([], 0), ([(0, 0)], 1), ([(0, 0), (0.1, 0.1), (0.2, 0.2)], 3)])
def test_a_plate_that_is_left_a_rigid_motion_is_refused(points, held):
    plate = Plate(disc(1.0, 0.4), UNIT, "free")
    expected = f"^Input points of large_deflection leave the plate a rigid motion: .* hold it, {held}, must fix three"
    with pytest.raises(ValueError, match=expected):
        plate.large_deflection(points)


def test_a_force_holds_nothing():
    plate = Plate(disc(1.0, 0.4), UNIT, "free")
    with pytest.raises(ValueError, match=r"hold it, 2, must fix three points"):
        plate.large_deflection([(0, 0), (0.1, 0.2), (0.3, 0)], stiffness=[np.inf, 1.0, 0.0])


@pytest.mark.parametrize(
    "options, message",
    [
        ({"in_plane_supports": "glued"}, "the support of 'the rim' must be 'immovable' or 'movable'; got 'glued'"),
        ({"in_plane_supports": {"rim": "movable", "hole": "movable"}}, "boundary 'hole' is not one of the mesh's, "),
        ({"in_plane_supports": 3}, "must be one name or a mapping from boundaries; got 3"),
        ({"membrane": "Airy"}, "Input membrane of large_deflection must be 'plane-stress' or, .*; got 'Airy'"),
        ({"stiffness": -1.0}, "Input stiffness of large_deflection must be 0 or more; got -1.0 N/m for point 0"),
    ],
)
def test_options_that_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        Plate(disc(1.0, 0.4), UNIT).large_deflection([(0, 0)], **options)


@pytest.mark.parametrize(
    "plate, in_plane",
    [
        (Plate(annulus(0.4, 1.0, 0.3), UNIT), "immovable"),
        (Plate(disc(1.0, 0.4), UNIT, S), "movable"),
        (Plate(rectangle(1.0, 1.0, 0.3), UNIT), {"left": "immovable"}),
    ],
)
def test_airy_is_refused_where_it_does_not_apply(plate, in_plane):
    with pytest.raises(ValueError, match="plates without holes whose rim is immovable, or movable and clamped"):
        plate.large_deflection([(0.6, 0) if "inner" in plate.supports else (0, 0)], in_plane, membrane="airy")


@pytest.mark.parametrize("heights, pressure", [([1.0, 2.0, 3.0], 0.0), ([np.nan, 1.0], 0.0), ([1.0, 1.0], np.inf)])
def test_loads_that_are_refused(heights, pressure):
    large = Plate(disc(1.0, 0.4), UNIT).large_deflection(TWO)
    with pytest.raises(ValueError, match="^Input heights"):
        large.solve(heights, pressure)


def test_a_point_beyond_the_rim_is_refused():
    with pytest.raises(ValueError, match="^Input points of large_deflection: point 0 .* must lie inside the rim"):
        Plate(disc(1.0, 0.4), UNIT).large_deflection([(1.2, 0)])
