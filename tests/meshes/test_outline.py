"""Outline: distances, sides, reflections and boxes of true rims, against closed forms and brute force."""

import tracemalloc

import numpy as np
import pytest
from scipy.spatial import cKDTree

from meshes import Circle, Ellipse, Outline, Parabolas, annulus, disc, polygon, rectangle
from meshes.outline import straight

RNG = np.random.default_rng(7)
L_SHAPE = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], dtype=float)


def along(edges, count=2001):
    """Points (k count, 2) of quadratic edges (k, 3, 2) by their Lagrange polynomials."""
    t = np.linspace(0, 1, count)
    weights = np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    return np.einsum("jt,kjd->ktd", weights, edges).reshape(-1, 2)


def flower(count, petals=7):
    """The quadratic edges of r = 1 + 0.3 cos(petals angle)."""
    angle = np.linspace(0, 2 * np.pi, 2 * count + 1)
    xy = (1 + 0.3 * np.cos(petals * angle))[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    xy[-1] = xy[0]
    return np.stack([xy[:-1:2], xy[1::2], xy[2::2]], axis=1)


@pytest.mark.parametrize("axes", [(5.0, 1.0), (1.0, 3.0), (1.0, 1.0 + 1e-9), (1e-4, 9e-5)])
def test_ellipse_projects_to_the_nearest_point_also_on_the_axes(axes):
    a, b = axes
    evolute = abs(a * a - b * b) / max(a, b)
    special = [[0, 0], [a, 0], [0, -b], [a / 2, 0], [0, b / 2], [evolute, 0], [0, evolute], [a / 3, 1e-200]]
    xy = np.concatenate([RNG.uniform(-2, 2, (300, 2)) * max(axes), special])
    foot = Ellipse(a, b).project(xy)
    assert np.hypot(foot[:, 0] / a, foot[:, 1] / b) == pytest.approx(np.ones(len(xy)), rel=4e-16)
    angle = np.linspace(0, 2 * np.pi, 400_001)
    rim = np.stack([a * np.cos(angle), b * np.sin(angle)], axis=1)
    brute, _ = cKDTree(rim).query(xy)
    distance = np.hypot(*(foot - xy).T)
    # The nearest of finitely many points is never nearer than the nearest of all.
    assert (distance - brute).max() < 1e-15 * max(axes)
    assert (brute**2 - distance**2).max() < 1e-9 * max(axes) ** 2


def test_gap_of_an_ellipse_has_the_sign_of_its_side():
    outline = Outline(conics=np.array([[1.0, -2.0, 3.0, 0.5]]))
    assert outline.gap([[1.0, -2.0], [1.0, -1.0], [4.5, -2.0]]) == pytest.approx([0.5, -0.5, -0.5], abs=1e-15)


def test_parabolic_edges_from_straight_to_strongly_bent_against_brute_force():
    edges = RNG.normal(size=(200, 3, 2))
    edges[:60, 1] = edges[:60, [0, 2]].mean(axis=1)
    edges[60:150, 1] = edges[60:150, [0, 2]].mean(axis=1) + 10 ** RNG.uniform(-15, -1, (90, 1)) * RNG.normal(
        size=(90, 2)
    )
    for edge in edges[:, None]:
        xy = RNG.normal(size=(20, 2))
        foot = Parabolas(edge).project(xy)
        brute, _ = cKDTree(along(edge)).query(xy)
        distance = np.hypot(*(foot - xy).T)
        assert (distance - brute).max() < 1e-14
        assert (brute**2 - distance**2).max() < 1e-4


def test_parabola_from_the_centre_of_curvature_and_from_its_axis():
    edge = np.array([[[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]]])  # y = x^2
    foot = Parabolas(edge).project([[0.0, 0.5], [0.0, 0.25], [0.0, -3.0], [0.0, 1.0], [5.0, 1.0]])
    assert foot[[0, 1, 2, 4]] == pytest.approx(np.array([[0, 0], [0, 0], [0, 0], [1, 1]]), abs=1e-7)
    assert (abs(foot[3, 0]), foot[3, 1]) == pytest.approx((np.sqrt(0.5), 0.5))


def test_gap_of_many_edges_is_that_to_the_nearest_of_all_of_them():
    outline, xy = Outline(edges=flower(200)), RNG.uniform(-1.5, 1.5, (2000, 2))
    brute, _ = cKDTree(along(outline.edges)).query(xy)
    distance = np.abs(outline.gap(xy))
    assert (distance - brute).max() < 1e-15
    assert (brute**2 - distance**2).max() < 1e-9


def test_sides_follow_the_curve_and_not_its_chord():
    outline = Outline(edges=flower(60))
    on_rim = along(outline.edges, 41)
    # Towards and away from the centre, around which the flower is star-shaped; some of these are behind the chord.
    assert (outline.gap(on_rim * (1 - 1e-9)) > 0).all()
    assert (outline.gap(on_rim * (1 + 1e-9)) < 0).all()
    assert np.abs(outline.gap(on_rim)).max() < 1e-15
    assert np.array_equal(outline.inside(on_rim * (1 - 1e-9)), np.ones(len(on_rim), dtype=bool))


@pytest.mark.parametrize("x", [-0.5, 0.5, 2.5])
def test_rays_through_vertices_and_along_edges_count_right(x):
    y = np.array([0.0, 1.0, 2.0, 0.5, 1.5])
    gap = polygon(L_SHAPE, 0.5).outline.gap(np.stack([np.full(5, x), y], axis=1))
    expected = {
        -0.5: [-0.5] * 5,
        0.5: [0, 0.5, 0, 0.5, 0.5],
        2.5: [-0.5, -0.5, -np.hypot(0.5, 1), -0.5, -np.hypot(0.5, 0.5)],
    }
    assert gap == pytest.approx(expected[x], abs=1e-15)


def test_a_ray_through_the_top_of_a_parabola_counts_right():
    edges = np.array([[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]], [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]])  # y = 1 - x^2
    outline = Outline(edges=edges)
    y = np.array([1.0, 1 - 1e-12, 1 + 1e-12])
    assert outline.gap(np.stack([np.full(3, -2.0), y], axis=1)).max() < -1
    assert np.sign(outline.gap([[0.0, 1 - 1e-12], [0.0, 1 + 1e-12], [0.6, 0.63], [0.6, 0.65]])).tolist() == [
        1,
        -1,
        1,
        -1,
    ]


def test_holes_are_off_the_plate():
    outline = annulus(1.0, 3.0, 0.5).outline
    assert outline.gap([[0.0, 0.5], [0.0, 1.25], [2.9, 0.0], [0.0, -4.0]]) == pytest.approx([-0.5, 0.25, 0.1, -1.0])
    holed = Outline(conics=np.array([[1.0, 1.0, 0.5, 0.5]]), edges=rectangle(4, 4, 1).outline.edges)
    assert holed.gap([[1.0, 1.0], [1.0, 1.75], [-1.5, 0.0], [3.0, 0.0]]) == pytest.approx([-0.5, 0.25, 0.5, -1.0])
    assert holed.project([[1.0, 1.75], [-1.5, 0.25]]) == pytest.approx(np.array([[1.0, 1.5], [-2.0, 0.25]]))


def test_gap_keeps_the_shape_of_its_points():
    outline = rectangle(2, 1, 0.5).outline
    assert outline.gap(np.zeros((3, 4, 2))).shape == (3, 4)
    assert outline.gap([0.0, 0.0]) == pytest.approx(0.5)
    assert np.isnan(outline.gap([np.nan, 0.0]))


def test_boxes_hold_bent_edges_and_touch_them():
    edges = flower(50)
    xy = along(edges)
    assert Outline(edges=edges).box == pytest.approx(np.stack([xy.min(axis=0), xy.max(axis=0)]), abs=1e-7)
    assert (Outline(edges=edges).box[0] <= xy.min(axis=0) + 1e-15).all()
    conics = np.array([[1.0, 2.0, 3.0, 0.5], [0.0, 0.0, 1.0, 2.0]])
    assert Outline(conics).box.tolist() == [[-2.0, -2.0], [4.0, 2.5]]


def test_standard_outlines_have_one_piece_a_side():
    assert disc(2.0, 0.5).outline.conics.tolist() == [[0, 0, 2, 2]]
    assert annulus(1.0, 2.0, 0.5).outline.conics.tolist() == [[0, 0, 1, 1], [0, 0, 2, 2]]
    assert len(rectangle(2, 1, 0.1).outline.edges) == 4
    assert np.array_equal(polygon(L_SHAPE, 0.3).outline.edges, straight(L_SHAPE, np.roll(L_SHAPE, -1, axis=0)))


def test_reflections_at_a_circle_are_twice_the_foot_less_the_point():
    xy = np.array([[0.0, 0.0], [0.3, 0.4], [-1.5, 0.1]])
    np.testing.assert_allclose(disc(2.0, 0.5).mirrored(xy), 2 * Circle(2.0).project(xy) - xy, rtol=1e-15)


def test_reflections_in_a_rectangle_are_the_four_images():
    images = rectangle(4, 2, 0.5).mirrored([[1.0, 0.5]])
    assert sorted(images.tolist()) == [[-5.0, 0.5], [1.0, -2.5], [1.0, 1.5], [3.0, 0.5]]


def test_no_reflection_falls_on_the_plate():
    slotted = polygon([(0, 0), (4, 0), (4, 4), (2.1, 4), (2.1, 1), (1.9, 1), (1.9, 4), (0, 4)], 0.5)
    for mesh in (slotted, polygon(L_SHAPE, 0.3), annulus(0.2, 2.0, 0.5)):
        box = mesh.outline.box
        xy = RNG.uniform(box[0], box[1], (200, 2))
        xy = xy[mesh.outline.gap(xy) > 1e-3]
        assert mesh.outline.gap(mesh.mirrored(xy)).max() <= 0
    # Across the slot there is one all the same, between its sides.
    images = slotted.mirrored([[1.5, 2.0]])
    assert ((images[:, 0] > 1.9) & (images[:, 0] < 2.1) & (images[:, 1] == 2.0)).any()


def test_of_many_edges_the_nearest_ones_reflect():
    outline, xy = Outline(edges=flower(100)), np.array([[0.9, 0.05], [0.2, -0.3]])
    images = outline.mirrored(xy)
    assert len(images) <= 2 * 16
    nearest = 2 * outline.project(xy) - xy
    assert np.linalg.norm(images[:, None] - nearest, axis=-1).min(axis=0) == pytest.approx(0, abs=1e-14)


def test_memory_stays_bounded_for_many_points_and_edges():
    outline, xy = Outline(edges=flower(2000)), RNG.uniform(-1.5, 1.5, (4000, 2))
    tracemalloc.start()
    outline.gap(xy)
    outline.gap(1e-6 * xy)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 200e6


def test_arcs_of_an_ellipse_lie_on_it_and_their_derivative_is_the_difference_quotients():
    curve, angle, s = Ellipse(3.0, 0.7), np.array([[3.0, -3.0], [0.2, 0.5]]), np.linspace(0, 1, 2001)
    ends = [np.stack([3.0 * np.cos(a), 0.7 * np.sin(a)], axis=1) for a in angle.T]
    points, tangents = curve.arc(*ends, s)
    assert np.abs(curve.gap(points)).max() < 2e-15
    assert points[:, [0, -1]] == pytest.approx(np.stack(ends, axis=1), abs=1e-15)
    assert tangents[:, 1:-1] == pytest.approx((points[:, 2:] - points[:, :-2]) / (s[2] - s[0]), abs=1e-6)


def test_arcs_of_parabolas_run_between_points_of_the_same_edge():
    edges, s = flower(20), np.linspace(0, 1, 1001)
    curve = Parabolas(edges)
    middle = along(edges, 5).reshape(-1, 5, 2)
    start, end = np.concatenate([edges[:, 0], middle[:, 1]]), np.concatenate([middle[:, 1], edges[:, 2]])
    points, tangents = curve.arc(start, end, s)
    assert points[:, 0] == pytest.approx(start, abs=1e-14) and points[:, -1] == pytest.approx(end, abs=1e-14)
    assert points[20:, 333] == pytest.approx(along(edges, 4001).reshape(-1, 4001, 2)[:, 1000 + 999], abs=1e-14)
    assert tangents[:, 1:-1] == pytest.approx((points[:, 2:] - points[:, :-2]) / (s[2] - s[0]), abs=1e-12)
