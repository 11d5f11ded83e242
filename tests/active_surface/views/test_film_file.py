"""Films as files: complete under their name, or not there."""

import os
from pathlib import Path

import numpy as np
import pytest
from films import frames_of
from PIL import Image

from active_surface.views.film.film_file import ENCODERS, check_film, film_file, format_of

SIZE = (320, 240)


def shade(level, size=SIZE):
    return np.full((size[1], size[0], 3), level, np.uint8)


@pytest.mark.parametrize("kind", ["mp4", "gif"])
def test_a_film_has_its_frames_at_its_pace(tmp_path, kind):
    path = tmp_path / f"film.{kind}"
    with film_file(path, kind, SIZE, 25.0) as add:
        for level in (20, 120, 220):
            add(shade(level))
    frames, fps = frames_of(path)
    assert fps == pytest.approx(25) and len(frames) == 3
    for frame, level in zip(frames, (20, 120, 220), strict=True):
        assert frame.shape == (SIZE[1], SIZE[0], 3) and np.abs(frame.astype(int) - level).max() < 6
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_numbered_pictures_replace_older_ones(tmp_path):
    path = tmp_path / "frames"
    for count in (3, 2):
        with film_file(path, "png", SIZE, 30.0) as add:
            for level in range(count):
                add(shade(level))
    assert sorted(file.name for file in path.iterdir()) == ["00001.png", "00002.png"]
    assert (np.asarray(Image.open(path / "00002.png")) == 1).all()
    assert [file.name for file in tmp_path.iterdir()] == ["frames"]


@pytest.mark.parametrize(("kind", "error"), [("mp4", KeyboardInterrupt), ("gif", ValueError), ("png", ValueError)])
def test_a_film_that_is_broken_off_leaves_nothing_and_an_older_one_as_it_was(tmp_path, kind, error):
    path = tmp_path / (f"film.{kind}" if kind != "png" else "film")
    for older in (False, True):
        if older:
            with film_file(path, kind, SIZE, 10.0) as add:
                add(shade(5))
        before = sorted((file.name, file.stat().st_mtime_ns) for file in tmp_path.iterdir())
        with pytest.raises(error), film_file(path, kind, SIZE, 10.0) as add:
            add(shade(0))
            raise error
        assert sorted((file.name, file.stat().st_mtime_ns) for file in tmp_path.iterdir()) == before


@pytest.mark.parametrize("kind", ["mp4", "png"])
def test_a_film_by_way_of_a_link_is_where_that_leads(tmp_path, kind):
    link, path = (tmp_path / (name + ("" if kind == "png" else f".{kind}")) for name in ("link", "real"))
    with film_file(path, kind, SIZE, 10.0) as add:
        add(shade(5))
    link.symlink_to(path)
    before = path.stat().st_ino
    with film_file(link, kind, SIZE, 10.0) as add:
        add(shade(9))
    assert link.is_symlink() and path.exists() and path.stat().st_ino != before
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted([link.name, path.name])


def test_what_is_put_into_a_folder_of_frames_meanwhile_stays(tmp_path):
    path = tmp_path / "frames"
    with film_file(path, "png", SIZE, 10.0) as add:
        add(shade(5))
    with pytest.raises(OSError, match="something else than frames"), film_file(path, "png", SIZE, 10.0) as add:
        add(shade(9))
        (path / "thesis.tex").write_text("precious")
    assert sorted(file.name for file in path.iterdir()) == ["00001.png", "thesis.tex"]
    assert [file.name for file in tmp_path.iterdir()] == ["frames"]


def test_names_that_ffmpeg_would_take_for_something_else(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a:b.mp4", "-x.mp4", "100%d.gif"):
        with film_file(Path(name), name[-3:], SIZE, 10.0) as add:
            add(shade(5))
        assert [file.name for file in tmp_path.iterdir()] == [name]
        (tmp_path / name).unlink()


def test_two_processes_that_make_a_film_of_one_name_leave_each_other_alone(tmp_path, monkeypatch):
    path = tmp_path / "film.mp4"
    with film_file(path, "mp4", SIZE, 10.0) as add:
        add(shade(5))
        with monkeypatch.context() as other:
            other.setattr(os, "getpid", lambda: 1)
            with film_file(path, "mp4", SIZE, 10.0) as second:
                second(shade(9))
    assert [file.name for file in tmp_path.iterdir()] == ["film.mp4"]


def test_a_film_that_ffmpeg_cannot_write_is_an_error_and_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setitem(ENCODERS, "mp4", ["-c:v", "no-such-codec"])
    wrong = pytest.raises(OSError, match="ffmpeg cannot write the film: .*no-such-codec")
    with wrong, film_file(tmp_path / "film.mp4", "mp4", SIZE, 10.0) as add:
        for _ in range(50):
            add(shade(0))
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_something_else_is_not_replaced(tmp_path):
    (tmp_path / "00001.png").write_bytes(b"")
    check_film(tmp_path, "png", SIZE, 30.0, 2)
    (tmp_path / "thesis.tex").write_text("precious")
    with pytest.raises(ValueError, match="Input output must be a new folder or one of frames"):
        check_film(tmp_path, "png", SIZE, 30.0, 2)


def test_what_a_format_cannot_do_is_refused_at_once(tmp_path):
    with pytest.raises(ValueError, match="even numbers for mp4; got 321x240"):
        check_film(tmp_path / "a.mp4", "mp4", (321, 240), 30.0, 2)
    with pytest.raises(ValueError, match="at most 50 for gif; got 60"):
        check_film(tmp_path / "a.gif", "gif", (321, 240), 60.0, 601)
    with pytest.raises(ValueError, match="at most 600 frames of a gif; got 601"):
        check_film(tmp_path / "a.gif", "gif", (321, 240), 50.0, 601)
    with pytest.raises(ValueError, match="must be a file"):
        check_film(tmp_path, "mp4", SIZE, 30.0, 2)


def test_the_format_is_that_of_the_name_or_as_asked_for():
    assert [format_of(Path(name), None) for name in ("a.mp4", "b.GIF", "c.png")] == ["mp4", "gif", "png"]
    assert (format_of(None, None), format_of(None, "gif"), format_of(Path("folder"), "png")) == ("mp4", "gif", "png")
    for output, wanted in ((Path("a.avi"), None), (Path("a"), "mp4"), (Path("a.gif"), "mp4"), (None, "avi")):
        with pytest.raises(ValueError, match="Input (format|output) must"):
            format_of(output, wanted)
