"""The rim as the part sees it: distances of every kind of boundary, and paths that end where they first leave."""

import math
from dataclasses import replace

import numpy as np
import pytest

from coupling.display import onto_plate
from meshes import Outline, rim_curves
from particle import ConstantFriction, EventKind, Micropart, Outcome, polynomial_surface, simulate
from particle.surface.rim import ellipse_gap, rim_gap

NO_CONICS, NO_EDGES = np.zeros((0, 4)), np.zeros((0, 3, 2))


def straight(*corners):
    start = np.array(corners, dtype=float)
    end = np.roll(start, -1, axis=0)
    return np.stack([start, (start + end) / 2, end], axis=1)


def bent(count, swell, turn=0.0):
    """A closed curve of `count` parabolas whose middles stand out (or in) by `swell`."""
    angle = 2 * np.pi * np.arange(2 * count + 1) / (2 * count) + turn
    radius = np.where(np.arange(2 * count + 1) % 2, 1 + swell, 1.0)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    return np.stack([points[0:-2:2], points[1:-1:2], points[2::2]], axis=1)


L_SHAPE = straight((-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1))
OUTLINES = {
    "disc": Outline(np.array([[0.1, -0.2, 0.9, 0.9]])),
    "annulus": Outline(np.array([[0, 0, 1.0, 1.0], [0, 0, 0.4, 0.4]])),
    "ellipse": Outline(np.array([[0.1, 0, 1.2, 0.3]])),
    "upright ellipse": Outline(np.array([[0, 0.2, 0.3, 1.1]])),
    "L": Outline(edges=L_SHAPE),
    "L with a hole": Outline(np.array([[-0.5, -0.5, 0.2, 0.2]]), L_SHAPE),
    "parabolas outwards": Outline(edges=bent(7, 0.1, 0.2)),
    "parabolas inwards": Outline(edges=bent(5, -0.45)),
    "parabola with its points on the axes": Outline(edges=bent(2, 0.0)),
}


def flat(outline):
    return replace(polynomial_surface([[0.0]]), conics=outline.conics, edges=outline.edges)


def gaps(outline, xy):
    surface = flat(outline)
    return np.array([rim_gap(surface.record, *map(float, point)) for point in xy])


def winding(outline, xy, spacing=1e-3):
    """Whether an odd number of the finely drawn boundaries encloses the points, with no ray of its own."""
    total = np.zeros(len(xy))
    for curve in rim_curves(outline, spacing):
        angle = np.unwrap(np.arctan2(*(curve[:, None] - xy).T[::-1]), axis=1)
        total += angle[:, -1] - angle[:, 0]
    return np.round(total / (2 * np.pi)) % 2 == 1


@pytest.mark.parametrize("name", OUTLINES)
def test_the_gap_is_the_distance_from_the_finely_drawn_rim(name):
    outline, spacing = OUTLINES[name], 1e-3
    xy = np.random.default_rng(3).uniform(-1.4, 1.4, (150, 2))
    rim = np.concatenate(rim_curves(outline, spacing))
    found, drawn = gaps(outline, xy), np.linalg.norm(xy[:, None] - rim, axis=2).min(axis=1)
    assert ((np.abs(found) <= drawn + 1e-15) & (drawn**2 <= found**2 + (2 * spacing) ** 2)).all()
    clear = drawn > 3 * spacing
    inside = winding(outline, xy)
    if name in ("annulus", "L with a hole"):  # boundaries that run one way round add up
        inside = gaps(outline, xy) > 0
        assert np.array_equal(inside, outline.inside(xy))
    assert np.array_equal(found[clear] > 0, inside[clear])


@pytest.mark.parametrize("name", OUTLINES)
def test_it_is_the_mesh_outlines_gap(name):
    outline = OUTLINES[name]
    xy = np.random.default_rng(4).uniform(-1.4, 1.4, (300, 2))
    assert gaps(outline, xy) == pytest.approx(outline.gap(xy), rel=0, abs=1e-14)


@pytest.mark.parametrize("name", OUTLINES)
def test_points_on_the_axes_through_the_vertices_are_sided_right(name):
    """Rays that meet vertices, chords and horizontal edges."""
    outline = OUTLINES[name]
    line = np.linspace(-1.33, 1.33, 40)
    xy = np.concatenate([[(x, y), (y, x)] for x in line for y in (0.0, 1.0, -1.0, 0.5)])
    xy = xy[np.abs(outline.gap(xy)) > 1e-9]
    aside = np.array([1.7e-11, 1.3e-11])
    assert np.array_equal(gaps(outline, xy) > 0, outline.inside(xy + aside))


def test_known_distances():
    assert gaps(OUTLINES["annulus"], [(0, 0), (0.5, 0), (0, -0.9), (0, 1.5)]) == pytest.approx([-0.4, 0.1, 0.1, -0.5])
    assert gaps(OUTLINES["L"], [(0.3, 0.4), (-0.3, -0.4), (2, -2)]) == pytest.approx([-0.3, 0.5, -math.sqrt(2)])
    # On the long axis of an ellipse the end is nearest as far as its centre of curvature, a - b^2/a.
    assert ellipse_gap(1.2, 0.0, 2.0, 1.0) == pytest.approx(math.sqrt(1 - 1.2**2 / 3), rel=1e-14)
    assert ellipse_gap(1.6, 0.0, 2.0, 1.0) == pytest.approx(0.4, rel=1e-14)
    assert ellipse_gap(0.0, -1.6, 1.0, 2.0) == pytest.approx(0.4, rel=1e-14)
    assert ellipse_gap(0.0, 0.0, 2.0, 1.0) == pytest.approx(1.0, rel=1e-14)


def test_the_foot_on_an_ellipse_is_found_next_to_its_long_axis_and_far_away():
    for along, across in ((1.2, 1e-14), (1.5, 1e-9), (1.5, 1e-200), (1e6, 1e6), (1e-300, 0.3)):
        gap = ellipse_gap(along, across, 2.0, 1.0)
        angle = np.linspace(0, np.pi / 2, 200001)
        drawn = np.hypot(2 * np.cos(angle) - along, np.sin(angle) - across).min()
        assert abs(gap) == pytest.approx(drawn, rel=1e-9)


def test_no_rim_is_as_far_as_the_surface_is_large():
    assert rim_gap(polynomial_surface([[0.0]], size=3.0).record, 1e9, 0.0) == 3.0


def test_a_point_past_the_rim_is_put_on_it_and_others_stay():
    xy = np.array([[0.2, 0.0], [0.5, 0.0], [0.0, 1.5]])
    assert onto_plate(OUTLINES["annulus"], xy) == pytest.approx(np.array([[0.4, 0.0], [0.5, 0.0], [0.0, 1.0]]))


def slide(outline, start, velocity, brake=1e-3, duration=10.0):
    """A part of 1 kg on a flat plate, braked by `brake` [m/s^2]."""
    return simulate(flat(outline), Micropart(1.0, start, velocity), ConstantFriction(brake), duration, gravity=0.0)


def test_a_part_leaves_through_the_inner_rim_of_an_annulus():
    trajectory = slide(OUTLINES["annulus"], (-0.9, 0.1), (0.5, 0.0))
    assert trajectory.outcome is Outcome.LEFT_PLATE
    assert [event.kind for event in trajectory.events] == [EventKind.LEAVES_PLATE]
    assert trajectory.position[-1] == pytest.approx([-math.sqrt(0.15), 0.1], abs=1e-9)


def test_a_path_that_would_cross_a_hole_in_one_step_ends_at_it():
    """A hole of 2 mm on a way of 2 m: the integrator's own steps are longer."""
    outline = Outline(np.array([[0, 0, 1.0, 1.0], [0.3, 0.0, 1e-3, 1e-3]]))
    trajectory = slide(outline, (-0.9, 0.0), (0.5, 0.0))
    assert trajectory.outcome is Outcome.LEFT_PLATE
    assert trajectory.position[-1] == pytest.approx([0.299, 0.0], abs=1e-9)


def test_a_path_that_clips_a_reentrant_corner_ends_there():
    """From the lower right of the L over its inner corner to the upper left, and the same way 1 cm beside it."""
    inner = slide(OUTLINES["L"], (0.91, -0.8), (-1.0, 1.0), brake=1e-6)
    assert inner.outcome is Outcome.LEFT_PLATE
    assert inner.position[-1] == pytest.approx([0.11, 0.0], abs=1e-6)
    trajectory = slide(OUTLINES["L"], (0.79, -0.8), (-1.0, 1.0), brake=1e-6)
    assert trajectory.outcome is Outcome.LEFT_PLATE
    assert trajectory.position[-1] == pytest.approx([-1.0, 0.99], abs=1e-5)


@pytest.mark.parametrize("room, outcome", [(1.01, Outcome.STUCK), (0.99, Outcome.LEFT_PLATE)])
def test_a_part_does_not_come_to_rest_beyond_the_rim(room, outcome):
    """It would stop after u^2/2Q, which the integrator knows in closed form from the start."""
    trajectory = slide(Outline(np.array([[0, 0, room, room]])), (0.0, 0.0), (1.0, 0.0), brake=0.5)
    assert trajectory.outcome is outcome
    assert trajectory.position[-1, 0] == pytest.approx(min(1.0, room), abs=1e-9)
    assert EventKind.STOPS in [event.kind for event in trajectory.events] or outcome is Outcome.LEFT_PLATE


def test_a_part_does_not_stop_on_the_other_side_of_a_hole():
    outline = Outline(np.array([[0, 0, 2.0, 2.0], [0.5, 0.0, 0.1, 0.1]]))
    trajectory = slide(outline, (0.0, 0.0), (1.0, 0.0), brake=0.5)
    assert trajectory.outcome is Outcome.LEFT_PLATE
    assert trajectory.position[-1] == pytest.approx([0.4, 0.0], abs=1e-9)
    assert trajectory.velocity[-1, 0] == pytest.approx(math.sqrt(1 - 0.4), rel=1e-6)


def test_a_part_may_slide_along_close_to_an_edge():
    """1 um beside a straight side of 2 m."""
    trajectory = slide(OUTLINES["L"], (-0.9, -1 + 1e-6), (1.0, 0.0), duration=1.5)
    assert trajectory.outcome is Outcome.MOVING
    assert trajectory.position[-1] == pytest.approx([0.6, -1 + 1e-6], abs=2e-3)
