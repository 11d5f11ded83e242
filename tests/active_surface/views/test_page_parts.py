"""What pages are made of: modes, spots on triangles, thinned lines, packed numbers, and what a file stands for."""

import base64

import numpy as np
import pytest
from scipy.spatial import Delaunay

from active_surface.views.geometry import (
    coarse,
    exaggeration,
    inside,
    outer_edges,
    round_above,
    round_below,
    spots_of,
    thinned,
)
from active_surface.views.modes import SEEN, modes_of
from active_surface.views.pages.packed import packed, packed_rows
from active_surface.views.pages.page_file import trust_of, write_page
from active_surface.views.pages.run_data import _around
from active_surface.views.pages.sweep_paths import spread
from active_surface.views.result_file import result_of
from coupling.report import with_micro_signs

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def numbers(array):
    return np.frombuffer(base64.b64decode(array["bytes"]), "<" + array["kind"])


@pytest.mark.parametrize("shape", [(1, 7), (7, 1), (40, 9), (9, 40)])
def test_modes_give_the_field_and_are_few_where_it_has_few(shape):
    rng = np.random.default_rng(3)
    field = rng.normal(size=(shape[0], 2)) @ rng.normal(size=(2, shape[1]))
    modes = modes_of(field)
    assert len(modes.shapes) <= min(2, *shape)
    largest = np.abs(field).max()
    assert np.abs(modes.amplitudes @ modes.shapes - field).max() == pytest.approx(modes.error, abs=1e-12)
    assert modes.error <= SEEN * largest


def test_modes_follow_a_field_that_has_many():
    field = np.random.default_rng(4).normal(size=(30, 30))
    modes = modes_of(field)
    assert np.abs(modes.amplitudes @ modes.shapes - field).max() <= SEEN * np.abs(field).max() * (1 + 1e-9)


def test_modes_follow_small_heights_that_are_looked_at_closely():
    rng = np.random.default_rng(6)
    field = rng.normal(size=(30, 1)) @ rng.normal(size=(1, 50))
    field[:, 20:30] *= 1e-5
    field[:, 20:30] += 1e-5 * rng.normal(size=(30, 2)) @ rng.normal(size=(2, 10))
    close = np.isin(np.arange(50), np.arange(20, 30))
    modes = modes_of(field, close)
    shapes = packed_rows(modes.shapes, exact=True)
    found = modes.amplitudes @ numbers(shapes["rows"]).reshape(-1, 50)
    assert len(modes.shapes) <= 3
    assert np.abs(found - field).max() <= SEEN * np.abs(field).max()
    assert np.abs(found - field)[:, close].max() <= SEEN * np.abs(field[:, close]).max()


def test_modes_of_a_plate_at_rest():
    modes = modes_of(np.zeros((5, 8), np.float32))
    assert modes.error == 0 and not (modes.amplitudes @ modes.shapes).any()


def test_spots_are_where_they_were_also_outside():
    places = np.array([[0.25, 0.5], [0.9, 0.2], [0.0, 0.0], [1.0, 1.0]])
    spots = spots_of(SQUARE, HALVES, places)
    back = (SQUARE[spots.corners] * spots.weights[..., None]).sum(axis=1)
    assert back == pytest.approx(places, abs=1e-12)
    z = np.tile(3 * SQUARE[:, 0] - SQUARE[:, 1] + 2, (4, 1))
    assert spots.heights(z) == pytest.approx(3 * places[:, 0] - places[:, 1] + 2)
    outside = spots_of(SQUARE, HALVES, np.array([[7.0, 8.0]]))
    assert outside.heights(z[:1]) == pytest.approx(15.0)
    assert (SQUARE[outside.corners] * outside.weights[..., None]).sum(axis=1)[0] == pytest.approx([7.0, 8.0])
    assert inside(SQUARE, HALVES, np.array([[0.5, 0.4], [2.0, 0.5]])).tolist() == [True, False]


def test_no_spots_are_no_spots():
    assert spots_of(SQUARE, HALVES, np.empty((0, 2))).corners.shape == (0, 3)


@pytest.mark.parametrize("hole", [0.0, 0.3])
def test_a_coarse_surface_covers_the_same_with_fewer_points(hole):
    x, y = np.meshgrid(np.linspace(-1, 1, 60), np.linspace(-1, 1, 60))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    triangles = Delaunay(points).simplices.astype(np.int64)
    triangles = triangles[np.hypot(*points[triangles].mean(axis=1).T) > hole]
    few = coarse(points, triangles, 400)
    assert 200 < len(np.unique(few)) <= 400
    places = np.random.default_rng(5).uniform(-1, 1, (500, 2))
    far = np.abs(np.hypot(*places.T) - hole) > 0.12
    assert (inside(points, few, places) == inside(points, triangles, places))[far].mean() > 0.99


@pytest.mark.parametrize("ends", [[(-0.9, -0.8), (0.9, 0.8)], [(0.5, 0.5), (0.52, 0.5)], [(0.999, -0.9), (0.999, 0.9)]])
def test_a_large_surface_is_shown_around_the_whole_path(monkeypatch, ends):
    monkeypatch.setattr("active_surface.views.pages.run_data.MAX_POINTS", 300)
    x, y = np.meshgrid(np.linspace(-1, 1, 60), np.linspace(-1, 1, 60))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    triangles = Delaunay(points).simplices.astype(np.int64)
    path = np.linspace(*ends, 50)
    used, drawn = _around(points, triangles, path)
    assert 100 < len(used) <= 300
    assert inside(points[used], drawn, path).all()


def test_outer_edges_are_those_of_one_triangle():
    assert outer_edges(HALVES).tolist() == [[0, 1], [0, 3], [1, 2], [2, 3]]


def test_a_thinned_line_passes_all_points_and_keeps_its_ends():
    angle = np.linspace(0, 2 * np.pi, 400)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    few = thinned(circle, 0.01)
    assert 10 < len(few) < 60
    assert few[0].tolist() == circle[0].tolist() and few[-1].tolist() == circle[-1].tolist()
    assert np.abs(1 - np.hypot(*((few[1:] + few[:-1]) / 2).T)).max() <= 0.0101


def test_a_line_that_stays_is_two_points():
    assert len(thinned(np.zeros((50, 2)), 1e-9)) == 2
    assert len(thinned(np.zeros((1, 2)), 1e-9)) == 1


def test_packed_numbers_are_unpacked_the_same():
    assert numbers(packed([1, 70000], "u4")).tolist() == [1, 70000]
    rows = np.array([[1e-7, -3e-7, 2e-7], [0.0, 0.0, 0.0], [5.0, 0.001, -5.0]])
    found = packed_rows(rows)
    back = numbers(found["rows"]).reshape(3, 3) * np.array(found["scales"])[:, None]
    assert np.abs(back - rows).max(axis=1) == pytest.approx([0, 0, 0], abs=1.6e-5 * 5)
    assert np.abs(back - rows)[0].max() <= 1.6e-5 * 3e-7


@pytest.mark.parametrize(
    ("value", "below", "above"),
    [
        (1.0, 1, 1),
        (1.9, 1, 2),
        (4.99, 2, 5),
        (5.0, 5, 5),
        (0.073, 0.05, 0.1),
        (3 * 0.1 / 0.6, 0.5, 0.5),
        (7e3, 5e3, 1e4),
    ],
)
def test_numbers_are_made_round(value, below, above):
    assert round_below(value) == pytest.approx(below)
    assert round_above(value) == pytest.approx(above)


@pytest.mark.parametrize(
    ("height", "length", "factor"),
    [(0.0, 1.0, 1), (0.5, 1.0, 1), (0.14, 1.0, 1), (0.1, 1.0, 2), (0.05, 1.0, 5), (1.01e-4, 1.0, 2000)],
)
def test_low_heights_are_drawn_larger_by_a_round_factor(height, length, factor):
    assert exaggeration(height, length) == factor


@pytest.mark.parametrize(("shape", "count"), [((41, 41), 500), ((7,), 3), ((5, 5), 100), ((100, 2), 9), ((3, 3), 1)])
def test_chosen_cells_are_spread_and_no_more_than_asked(shape, count):
    chosen = spread(shape, count)
    assert 0 < chosen.sum() <= count
    assert chosen.all() == (count >= chosen.size)


def test_no_cells_are_chosen_where_none_are_wanted():
    assert not spread((4, 4), 0).any()


def test_trust_is_one_line_and_the_warnings():
    assert "<strong>Trust: no warnings.</strong> It moves by 2 µm." in trust_of("it moves by 2 um", [])
    warned = trust_of("it holds", ["<b> 3 uN", "more"])
    assert "Trust: 2 warnings." in warned and "<li>&lt;b&gt; 3 µN</li>" in warned


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("(1, -2) um at 3 us", "(1, -2) µm at 3 µs"),
        ("pull 1.5 uN of 2 ug", "pull 1.5 µN of 2 µg"),
        ("30 um/s", "30 µm/s"),
        ("8 unknowns, 3 units", "8 unknowns, 3 units"),
        ("a minimum; the sum of 4", "a minimum; the sum of 4"),
    ],
)
def test_pages_have_micro_signs(text, said):
    assert with_micro_signs(text) == said


def test_a_page_is_whole_or_not_there(tmp_path, monkeypatch):
    with pytest.raises(KeyError):  # a text is missing
        write_page(tmp_path / "page.html", "t", "run.html", {}, {}, ["run.js"])
    with pytest.raises(ValueError, match="JSON"):
        texts = dict.fromkeys(("name", "device", "sentence", "trust", "views", "rows", "case"), "")
        write_page(tmp_path / "page.html", "t", "run.html", texts, {"x": float("nan")}, ["run.js"])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("given", "page"),
    [
        ("r/one.plate.vtkhdf", "r/one.html"),
        ("r/one.part.vtkhdf", "r/one.html"),
        ("r/one.partial.part.vtkhdf", "r/one.html"),
        ("r/one.partial.plate.vtkhdf", "r/one.html"),
        ("r/one", "r/one.html"),
        ("r/1.5 mm", "r/1.5 mm.html"),
        ("r/one.nc", "r/one.sweep.html"),
    ],
)
def test_a_result_stands_for_itself(tmp_path, given, page):
    found = result_of(tmp_path / given, tmp_path)
    assert (found.path, found.page) == (tmp_path / given, tmp_path / page)


def test_the_name_of_a_sweep_stands_for_its_file(tmp_path):
    (tmp_path / "many.nc").touch()
    assert result_of(tmp_path / "many", tmp_path)[:3] == (tmp_path / "many.nc", tmp_path / "many.sweep.html", True)
    (tmp_path / "many.part.vtkhdf").touch()
    assert not result_of(tmp_path / "many", tmp_path).is_sweep


def test_a_case_or_study_file_stands_for_its_result(tmp_path):
    results = tmp_path / "results"
    results.mkdir()
    (tmp_path / "one.toml").write_text('[plate]\nshape = "disc"\n')
    (tmp_path / "many.toml").write_text('[study]\ncase = "one.toml"\n')
    with pytest.raises(ValueError, match=r"got .*one.toml.*`active-surface run .*one.toml` makes it"):
        result_of(tmp_path / "one.toml", results)
    with pytest.raises(ValueError, match=r"many.nc is there: `active-surface sweep"):
        result_of(tmp_path / "many.toml", results)
    (results / "one.partial.part.vtkhdf").touch()
    (tmp_path / "many.nc").touch()
    found = result_of(tmp_path / "one.toml", results)
    assert (found.path, found.page) == (results / "one", results / "one.html")  # of which either file may be partial
    assert result_of(tmp_path / "many.toml", results)[:3] == (tmp_path / "many.nc", tmp_path / "many.sweep.html", True)
