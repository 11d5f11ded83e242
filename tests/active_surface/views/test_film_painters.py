"""Both painters draw the same: what is seen, what is hidden, and the words on it."""

from dataclasses import replace

import numpy as np
import pytest
from made_runs import hill, made_run
from matplotlib.collections import PolyCollection
from PIL import Image

from active_surface.views.film.animation import animate, still
from active_surface.views.film.camera import CAMERAS
from active_surface.views.film.captions import Captions
from active_surface.views.film.frames import frames_of
from active_surface.views.film.layout import layout_of
from active_surface.views.film.look import Look
from active_surface.views.film.offscreen import prepare
from active_surface.views.film.pace import pace_of
from active_surface.views.film.painter import chosen, painter
from active_surface.views.film.stage import stage_of
from coupling.margins import MarginCurves
from particle import Event, EventKind, State

SIZE = (480, 270)
PATH = np.stack([np.linspace(-3e-4, 3e-4, 5), np.zeros(5)], axis=1)


@pytest.fixture(scope="module")
def refused():
    """Why pyvista cannot draw here."""
    return prepare()


@pytest.fixture(params=["matplotlib", "pyvista"])
def renderer(request, refused):
    if request.param == "pyvista" and refused is not None:
        pytest.skip(f"pyvista cannot draw here: {refused}")
    return request.param


def hilly(height=2e-4, **more):
    return made_run(PATH, lambda points: hill(points, height), **more)


def painted(run, renderer, camera="iso", time=2e-3, times=1.0):
    stage = stage_of(run)
    look = Look(stage, layout_of(stage, CAMERAS[camera], SIZE, times), stage.scale)
    (frame,) = frames_of(stage, np.array([time]))
    with painter(renderer, look) as painter_of_it:
        return look, frame, painter_of_it.paint(frame)


def reds(image):
    red, green, blue = np.moveaxis(image.astype(int), -1, 0)
    return (red > 100) & (red > 2 * green) & (red > 2 * blue)


@pytest.mark.parametrize(("camera", "state"), [*zip(CAMERAS, [*State, State.SLIP], strict=True)])
def test_the_part_is_where_it_should_be_in_the_colour_of_its_state(renderer, camera, state):
    above = 3e-4 if state is State.FLIGHT else 2e-4
    look, frame, image = painted(hilly(above=above, state=int(state)), renderer, camera)
    assert image.shape == (SIZE[1], SIZE[0], 3) and image.dtype == np.uint8
    x, y = np.rint(look.layout.pixels(look.part(frame)[0])).astype(int)
    red, _, blue = image[SIZE[1] - 1 - y, x].astype(int)
    assert {State.SLIP: red > 2 * blue, State.STICK: blue > 2 * red, State.FLIGHT: max(red, blue) < 150}[state]


@pytest.mark.slow
def test_the_trail_is_seen_before_a_hill_and_hidden_behind_it(renderer):
    before = made_run(PATH + [0, -3e-4], lambda points: hill(points, 5e-4))
    behind = made_run(PATH * [1 / 3, 1] + [0, 2.5e-4], lambda points: hill(points, 5e-4))
    counts = [reds(painted(run, renderer, "front", 4e-3)[2]).sum() for run in (before, behind)]
    assert counts[0] > 200 and counts[1] < 0.2 * counts[0]


def test_a_trail_over_a_surface_that_has_risen_is_not_swallowed(renderer):
    heights = np.stack([hill(hilly().points, 1e-4 * k) for k in range(5)])
    lifted = made_run(PATH, heights, above=2e-4)
    row = reds(painted(lifted, renderer, "top", 4e-3)[2]).any(axis=0)
    assert row.sum() > 0.28 * SIZE[1]  # the path is two thirds of a plate that fills 0.71 of the height


@pytest.mark.slow
def test_both_painters_draw_the_same_picture(refused):
    if refused is not None:
        pytest.skip(f"pyvista cannot draw here: {refused}")
    for camera in CAMERAS:
        images = [painted(hilly(), who, camera)[2].astype(float) for who in ("matplotlib", "pyvista")]
        apart = np.abs(images[0] - images[1]).mean(axis=2)
        assert apart.mean() < 6 and (apart > 60).mean() < 0.05


@pytest.mark.slow
def test_both_painters_draw_heights_far_before_and_behind(refused):
    if refused is not None:
        pytest.skip(f"pyvista cannot draw here: {refused}")
    for camera, exaggeration in (("top", 50.0), ("top", -50.0), ("iso", 50.0)):
        run = hilly(2e-4 * np.sign(exaggeration))
        images = [painted(run, who, camera, times=abs(exaggeration))[2] for who in ("matplotlib", "pyvista")]
        bare = [(image == 255).all(axis=2) for image in images]
        assert (bare[0] != bare[1]).mean() < 0.02


def test_the_words_of_a_film_are_there_and_follow_it(renderer):
    stage = stage_of(hilly(state=[0, 0, 1, 1, 2]))
    layout = layout_of(stage, CAMERAS["iso"], SIZE, 3.0)
    captions = Captions(stage, layout, pace_of(stage.run.time, 30.0, None))
    words = [text.get_text() for text in captions._figure.findobj(lambda artist: hasattr(artist, "get_text"))]
    assert "height [µm]" in words and "made" in words and "actuator" in words
    assert any("heights drawn 3 times larger" in text and "2000 times slower" in text for text in words)
    assert any(text.endswith("µm (×3)") for text in words)
    blank, seen = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8), []
    for frame in frames_of(stage, np.array([0.0, 2e-3, 4e-3])):
        seen.append(captions.put_on(blank, frame))
        assert f"{frame.time * 1e3:.2f} ms" == captions._clock.get_text()
    assert (blank == 255).all()
    assert [captions._state.get_text()[:9]] == ["part in f"]
    for one, other in zip(seen, seen[1:], strict=False):
        assert (one != other).any()
    assert (seen[0][SIZE[1] // 2, : SIZE[0] // 2] == 255).all()


def test_a_lost_part_is_said_to_be_off_at_the_end_and_a_stuck_one_how_hard_it_is_pulled():
    times = 1e-3 * np.arange(5)
    lost = Event(EventKind.DETACHES, 4e-3, (0.0, 0.0), 0.0, 0.0)
    curves = MarginCurves(times, np.array([0.2, 0.4, np.nan, np.nan, np.nan]), np.full(5, np.nan))
    run = replace(hilly(state=[0, 0, 1, 1, 1]), events=[lost], summary={"outcome": "detached"}, margins=curves)
    stage = stage_of(run)
    words = Captions(stage, layout_of(stage, CAMERAS["side"], SIZE, 3.0), None)
    blank, seen = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8), []
    for frame in frames_of(stage, np.array([0.5e-3, 3e-3, 4e-3])):
        words.put_on(blank, frame)
        seen.append(words._state.get_text())
    assert seen == ["part stuck, pull 0.30 of what friction holds", "part slipping", "part came off"]
    texts = [text.get_text() for text in words._figure.findobj(lambda artist: hasattr(artist, "get_text"))]
    assert "height [µm] (×3)" in texts  # an axis, seen from the side


def test_the_time_line_has_the_stretches_that_the_integrator_found():
    run = hilly(state=1)
    rows = run.rows._replace(
        time=np.array([0.0, 1.2e-3, 1.3e-3, 2.5e-3, 2.6e-3, 9e-3]),
        position=np.zeros((6, 2)),
        state=np.array([1, 2, 1, 0, 1, 2]),
    )
    stage = stage_of(replace(run, rows=rows))
    captions = Captions(stage, layout_of(stage, CAMERAS["iso"], SIZE, 1.0), None)
    drawn = [patch for patch in captions._figure.findobj(PolyCollection) if len(patch.get_paths()) == 1]
    spans = sorted(tuple(patch.get_paths()[0].vertices[[0, 2], 0].round(6)) for patch in drawn)
    assert spans == [(1.2, 1.3), (2.5, 2.6)]


@pytest.mark.parametrize(("height", "level"), [(0.0, 0.0), (2e-12, 0.0), (-2e-12, 0.0), (5e-12, 1e-6), (1e-9, 1e-3)])
def test_a_flat_surface_has_no_bar_of_heights(height, level):
    stage = stage_of(made_run(PATH, lambda points: hill(points, height) + level))
    captions = Captions(stage, layout_of(stage, CAMERAS["iso"], SIZE, stage.exaggeration), None)
    assert stage.flat and not any("height" in axes.get_title() for axes in captions._figure.axes)


@pytest.mark.parametrize(("height", "level"), [(2e-11, 0.0), (2e-11, 1e-6), (1e-4, 0.0)])
def test_ticks_of_the_bar_can_be_told_apart(height, level):
    stage = stage_of(made_run(PATH, lambda points: hill(points, height) + level))
    captions = Captions(stage, layout_of(stage, CAMERAS["iso"], SIZE, stage.exaggeration), None)
    (bar,) = (axes for axes in captions._figure.axes if "height" in axes.get_title())
    words = [label.get_text() for label in bar.get_yticklabels()]
    assert len(words) > 2 and len(set(words)) == len(words)


@pytest.mark.parametrize(("size", "state"), [((320, 240), 2), ((1280, 720), 0), ((330, 900), 2), ((1000, 320), 0)])
def test_no_word_is_clipped(size, state):
    stage = stage_of(hilly(1e-7, state=state, above=1e-4))
    captions = Captions(
        stage, layout_of(stage, CAMERAS["iso"], size, stage.exaggeration), pace_of(stage.run.time, 30.0, None)
    )
    (frame,) = frames_of(stage, np.array([4e-3]))
    captions.put_on(np.full((size[1], size[0], 3), 255, np.uint8), frame)
    box = captions._figure.get_tightbbox().padded(-0.02).transformed(captions._figure.dpi_scale_trans)
    assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= size[0] and box.y1 <= size[1]


@pytest.mark.slow
def test_a_film_of_one_step_is_a_frame(renderer, tmp_path):
    made = animate(made_run([[0.0, 0.0]], lambda points: hill(points, 1e-5)), tmp_path / "f.gif", renderer=renderer)
    with Image.open(made.file) as film:
        assert made.frames == film.n_frames == 1
    assert made.renderer == renderer and made.exaggeration == 20 and made.warnings == ()


def test_a_still_is_the_frame_of_its_time(refused):
    early, late = (still(hilly(), time, size=SIZE, renderer="matplotlib") for time in (0.0, 4e-3))
    assert early.shape == (SIZE[1], SIZE[0], 3) and (early != late).any()
    with pytest.raises(ValueError, match="Input time must be from 0 to 0.004 s; got 1.0"):
        still(hilly(), 1.0, size=SIZE)


@pytest.mark.slow
def test_a_window_that_vtk_has_not_is_found_out_and_harms_nothing(monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkNoSuchWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    assert prepare()
    assert chosen("auto")[0] == "matplotlib"
    with pytest.raises(ValueError, match="pyvista cannot draw here"):
        chosen("pyvista")
    with pytest.raises(ValueError, match="Input renderer must be auto, pyvista, matplotlib; got 'gl'"):
        chosen("gl")
