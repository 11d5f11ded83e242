"""The pictures of a film: what is seen, what is hidden, and the words on it."""

from contextlib import closing
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from made_runs import hill, made_run
from matplotlib.collections import PolyCollection
from PIL import Image

from active_surface.views.film.animation import animate, still
from active_surface.views.film.captions import Captions
from active_surface.views.film.layout import CAMERAS, layout_of
from active_surface.views.film.pace import pace_of
from active_surface.views.film.painter import Painter
from active_surface.views.film.scene import scene_of
from coupling.margins import MarginCurves
from particle import Event, EventKind, State

SIZE = (480, 270)
PATH = np.stack([np.linspace(-3e-4, 3e-4, 5), np.zeros(5)], axis=1)


def hilly(height=2e-4, **more):
    return made_run(PATH, lambda points: hill(points, height), **more)


def layout(run, camera="iso", size=SIZE, times=1.0):
    return layout_of(scene_of(run), CAMERAS[camera], size, times)


def painted(run, camera="iso", time=2e-3, times=1.0):
    """The layout, the moment, and the picture of the surface, without words."""
    made = layout(run, camera, times=times)
    (moment,) = made.scene.moments(np.array([time]))
    try:
        with closing(Painter(made)) as painter:
            return made, moment, painter.paint(moment)
    except RuntimeError as error:
        pytest.skip(str(error))


def reds(image):
    red, green, blue = np.moveaxis(image.astype(int), -1, 0)
    return (red > 100) & (red > 2 * green) & (red > 2 * blue)


@pytest.mark.parametrize(("camera", "state"), [*zip(CAMERAS, [*State, State.SLIP], strict=True)])
def test_the_part_is_where_it_should_be_in_the_colour_of_its_state(camera, state):
    above = 3e-4 if state is State.FLIGHT else 2e-4
    made, moment, image = painted(hilly(above=above, state=int(state)), camera)
    wide, tall = np.ptp(made.box, axis=0)
    assert image.shape == (tall, wide, 3) and image.dtype == np.uint8
    place = made.places(moment.part[None, :2], moment.part[2:]) + [0, 0, 5 / made.scale]
    x, y = np.rint(made.pixels(place)[0] - made.box[0]).astype(int)
    red, _, blue = image[tall - 1 - y, x].astype(int)
    assert {State.SLIP: red > 2 * blue, State.STICK: blue > 2 * red, State.FLIGHT: max(red, blue) < 150}[state]


def test_a_part_with_a_face_is_drawn_with_its_corners_and_turns():
    part = {"footprint": "rectangle", "sides": (2e-4, 2e-4), "thickness": 5e-5}
    run = made_run(PATH, lambda points: hill(points, 0.0), state=int(State.SLIP))
    run = replace(run, part=part, rows=run.rows._replace(heading=np.linspace(0, np.pi / 4, len(PATH))))
    for time, corner in ((0.0, [0.9e-4, 0.9e-4]), (4e-3, [1.15e-4, 0.0])):  # of a square, and of one on its corner
        made, moment, image = painted(run, "top", time)
        around = np.array([corner, [-corner[0], corner[1]], [1.3e-4, 1.3e-4]])
        x, y = np.rint(made.pixels(made.places(moment.part[:2] + around, np.zeros(3))) - made.box[0]).astype(int).T
        assert reds(image)[image.shape[0] - 1 - y, x].tolist() == [True, True, False]


def test_the_surface_has_the_colours_of_its_heights():
    made, _, image = painted(hilly(), "top")
    place = made.places(np.array([[5e-5, -1.5e-4], [-4.5e-4, -4.5e-4]]), np.zeros(2))
    x, y = np.rint(made.pixels(place) - made.box[0]).astype(int).T
    hill_side, plain = image[image.shape[0] - 1 - y, x].astype(int)
    assert plain.min() > 235 and 20 < hill_side[2] - hill_side[0] < 120


def test_the_trail_is_seen_before_a_hill_and_hidden_behind_it():
    before = made_run(PATH + [0, -3e-4], lambda points: hill(points, 5e-4))
    behind = made_run(PATH * [1 / 3, 1] + [0, 2.5e-4], lambda points: hill(points, 5e-4))
    counts = [reds(painted(run, "front", 4e-3)[2]).sum() for run in (before, behind)]
    assert counts[0] > 200 and counts[1] < 0.2 * counts[0]


def test_a_trail_over_a_surface_that_has_risen_is_not_swallowed():
    heights = np.stack([hill(hilly().points, 1e-4 * k) for k in range(5)])
    lifted = made_run(PATH, heights, above=2e-4)
    row = reds(painted(lifted, "top", 4e-3)[2]).any(axis=0)
    assert row.sum() > 0.28 * SIZE[1]  # the path is two thirds of a plate that fills 0.71 of the height


def test_the_trail_ends_at_the_part():
    counts = [reds(painted(hilly(), "top", time)[2]).sum() for time in (0.0, 2e-3, 4e-3)]
    assert counts[0] < counts[1] < counts[2]


@pytest.mark.parametrize(("camera", "times"), [("top", 50.0), ("iso", 50.0)])
def test_heights_far_before_and_behind_are_drawn(camera, times):
    for sign in (-1, 1):
        image = painted(hilly(sign * 2e-4), camera, times=times)[2]
        assert (image < 250).any(axis=2).mean() > 0.02


def test_the_words_of_a_film_are_there_and_follow_it():
    made = layout(hilly(state=[0, 0, 1, 1, 2]), times=3.0)
    captions = Captions(made, pace_of(made.scene.run.time, 30.0, None))
    words = texts_of(captions)
    assert "height [µm]" in words and "made" in words and "actuator" in words
    assert any("heights drawn 3 times larger" in text and "2000 times slower" in text for text in words)
    assert any(text.endswith("µm (×3)") for text in words)
    wide, tall = np.ptp(made.box, axis=0)
    blank = np.full((tall, wide, 3), 255, np.uint8)
    seen = [captions.picture(blank, moment) for moment in made.scene.moments(np.array([0.0, 2e-3, 4e-3]))]
    assert (blank == 255).all()
    for one, other in pairwise(seen):
        assert (one[: SIZE[1] // 5] != other[: SIZE[1] // 5]).any()  # clock and state
        assert (one[-SIZE[1] // 6 :] != other[-SIZE[1] // 6 :]).any()  # the time line's hand
        assert (one[SIZE[1] // 4 : -SIZE[1] // 6] == other[SIZE[1] // 4 : -SIZE[1] // 6]).all()
    assert (seen[0][SIZE[1] // 2, : SIZE[0] // 2] == 255).all()


def texts_of(captions):
    return [text.get_text() for text in captions._figure.findobj(lambda artist: hasattr(artist, "get_text"))]


def test_a_lost_part_is_said_to_be_off_at_the_end_and_a_stuck_one_how_hard_it_is_pulled():
    times = 1e-3 * np.arange(5)
    lost = Event(EventKind.DETACHES, 4e-3, (0.0, 0.0), 0.0, 0.0)
    curves = MarginCurves(times, np.array([0.2, 0.4, np.nan, np.nan, np.nan]), np.full(5, np.nan))
    run = replace(hilly(state=[0, 0, 1, 1, 1]), events=[lost], summary={"outcome": "detached"}, margins=curves)
    made = layout(run, "side", times=3.0)
    captions = Captions(made, None)
    seen = [captions._words(moment) for moment in made.scene.moments(np.array([0.5e-3, 3e-3, 4e-3]))]
    assert seen == ["part stuck, pull 0.30 of the friction limit", "part slipping", "part came off"]
    assert "height [µm] (×3)" in texts_of(captions)  # an axis, seen from the side


def test_the_time_line_has_the_stretches_that_the_integrator_found():
    run = hilly(state=1)
    rows = run.rows._replace(
        time=np.array([0.0, 1.2e-3, 1.3e-3, 2.5e-3, 2.6e-3, 9e-3]),
        position=np.zeros((6, 2)),
        state=np.array([1, 2, 1, 0, 1, 2]),
    )
    captions = Captions(layout(replace(run, rows=rows)), None)
    drawn = [patch for patch in captions._figure.findobj(PolyCollection) if len(patch.get_paths()) == 1]
    spans = sorted(tuple(patch.get_paths()[0].vertices[[0, 2], 0].round(6)) for patch in drawn)
    assert spans == [(1.2, 1.3), (2.5, 2.6)]


@pytest.mark.parametrize(("height", "level"), [(0.0, 0.0), (2e-12, 0.0), (-2e-12, 0.0), (5e-12, 1e-6), (1e-9, 1e-3)])
def test_a_flat_surface_has_no_bar_of_heights(height, level):
    made = layout(made_run(PATH, lambda points: hill(points, height) + level))
    captions = Captions(made, None)
    assert made.scene.flat and not any("height" in axes.get_title() for axes in captions._figure.axes)


@pytest.mark.parametrize(("height", "level"), [(2e-11, 0.0), (2e-11, 1e-6), (1e-4, 0.0)])
def test_ticks_of_the_bar_can_be_told_apart(height, level):
    captions = Captions(layout(made_run(PATH, lambda points: hill(points, height) + level)), None)
    (bar,) = (axes for axes in captions._figure.axes if "height" in axes.get_title())
    words = [label.get_text() for label in bar.get_yticklabels()]
    assert len(words) > 2 and len(set(words)) == len(words)


@pytest.mark.parametrize(("size", "state"), [((320, 240), 2), ((1280, 720), 0), ((330, 900), 2), ((1000, 320), 0)])
def test_no_word_is_clipped(size, state):
    run = hilly(1e-7, state=state, above=1e-4)
    made = layout(run, size=size, times=scene_of(run).exaggeration)
    captions = Captions(made, pace_of(run.time, 30.0, None))
    box = captions._figure.get_tightbbox().padded(-0.02).transformed(captions._figure.dpi_scale_trans)
    assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= size[0] and box.y1 <= size[1]
    (moment,) = made.scene.moments(np.array([4e-3]))
    wide, tall = np.ptp(made.box, axis=0)
    image = captions.picture(np.full((tall, wide, 3), 255, np.uint8), moment)
    assert (image[:, -2:] == 255).all() and (image[:2] == 255).all()


def test_a_film_of_one_step_is_a_frame(tmp_path):
    painted(hilly())  # or skip
    made = animate(made_run([[0.0, 0.0]], lambda points: hill(points, 1e-5)), tmp_path / "f.gif")
    with Image.open(made.file) as film:
        assert made.frames == film.n_frames == 1
    assert made.exaggeration == 20 and made.warnings == ()


def test_a_still_is_the_frame_of_its_time():
    painted(hilly())
    early, late = (still(hilly(), time, size=SIZE) for time in (0.0, 4e-3))
    assert early.shape == (SIZE[1], SIZE[0], 3) and (early != late).any()
    with pytest.raises(ValueError, match="Input time must be from 0 to 0.004 s; got 1.0"):
        still(hilly(), 1.0, size=SIZE)


def test_without_opengl_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr("pyvista.Plotter", lambda **_: NoWindow())
    with pytest.raises(RuntimeError, match="apt-get install libegl1 libgl1-mesa-dri"):
        animate(hilly(), tmp_path / "f.mp4", size=SIZE)
    assert list(tmp_path.iterdir()) == []


class NoWindow:
    """A plotter of pyvista whose window cannot be opened."""

    render_window = property(lambda self: self)
    initialized = False

    def Initialize(self):  # noqa: N802
        """As VTK does: no error."""
