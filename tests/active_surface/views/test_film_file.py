"""Films as files, and the command that makes them: complete under their name, or not there."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from active_surface.cli.program import main
from active_surface.views.film.film_file import ENCODERS, check_film, film_file, format_of
from coupling.case import Case, CoulombCase, PartCase, RunCase
from coupling.run import run_case

SIZE = (320, 240)
MOTION = {"x": {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}, "z": {"stroke": 3e-6, "frequency": 500.0}}
ROOT = Path(__file__).parents[3]


def shade(level, size=SIZE):
    return np.full((size[1], size[0], 3), level, np.uint8)


def frames_of(path):
    """The frames of a film, how many and of what size."""
    if path.suffix == ".mp4":
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        run = subprocess.run(command, capture_output=True, check=True)
        about = re.search(rb"h264.*yuv420p.* (\d+)x(\d+).* ([\d.]+) fps", run.stderr)
        width, height = int(about[1]), int(about[2])
        return list(np.frombuffer(run.stdout, np.uint8).reshape(-1, height, width, 3)), float(about[3])
    with Image.open(path) as film:
        frames, delays = [], []
        for k in range(film.n_frames):
            film.seek(k)
            delays.append(film.info["duration"])
            frames.append(np.asarray(film.convert("RGB")))
    return frames, 1000 * len(delays) / sum(delays)


@pytest.mark.parametrize("kind", ["mp4", "gif"])
def test_a_film_has_its_frames_at_its_pace(tmp_path, kind):
    path = tmp_path / f"film.{kind}"
    with film_file(path, kind, SIZE, 25.0) as film:
        for level in (20, 120, 220):
            film.add(shade(level))
    frames, fps = frames_of(path)
    assert fps == pytest.approx(25) and len(frames) == 3
    for frame, level in zip(frames, (20, 120, 220), strict=True):
        assert frame.shape == (SIZE[1], SIZE[0], 3) and np.abs(frame.astype(int) - level).max() < 6
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_numbered_pictures_replace_older_ones(tmp_path):
    path = tmp_path / "frames"
    for count in (3, 2):
        with film_file(path, "png", SIZE, 30.0) as film:
            for level in range(count):
                film.add(shade(level))
    assert sorted(file.name for file in path.iterdir()) == ["00001.png", "00002.png"]
    assert (np.asarray(Image.open(path / "00002.png")) == 1).all()
    assert [file.name for file in tmp_path.iterdir()] == ["frames"]


@pytest.mark.parametrize("kind", ["mp4", "gif", "png"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_film_that_is_broken_off_leaves_nothing_and_an_older_one_as_it_was(tmp_path, kind, error):
    path = tmp_path / (f"film.{kind}" if kind != "png" else "film")
    for older in (False, True):
        if older:
            with film_file(path, kind, SIZE, 10.0) as film:
                film.add(shade(5))
        before = sorted((file.name, file.stat().st_mtime_ns) for file in tmp_path.iterdir())
        with pytest.raises(error), film_file(path, kind, SIZE, 10.0) as film:
            film.add(shade(0))
            raise error
        assert sorted((file.name, file.stat().st_mtime_ns) for file in tmp_path.iterdir()) == before


@pytest.mark.parametrize("kind", ["mp4", "png"])
def test_a_film_by_way_of_a_link_is_where_that_leads(tmp_path, kind):
    link, path = (tmp_path / (name + ("" if kind == "png" else f".{kind}")) for name in ("link", "real"))
    with film_file(path, kind, SIZE, 10.0) as film:
        film.add(shade(5))
    link.symlink_to(path)
    before = path.stat().st_ino
    with film_file(link, kind, SIZE, 10.0) as film:
        film.add(shade(9))
    assert link.is_symlink() and path.exists() and path.stat().st_ino != before
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted([link.name, path.name])


def test_what_is_put_into_a_folder_of_frames_meanwhile_stays(tmp_path):
    path = tmp_path / "frames"
    with film_file(path, "png", SIZE, 10.0) as film:
        film.add(shade(5))
    with pytest.raises(OSError, match="something else than frames"), film_file(path, "png", SIZE, 10.0) as film:
        film.add(shade(9))
        (path / "thesis.tex").write_text("precious")
    assert sorted(file.name for file in path.iterdir()) == ["00001.png", "thesis.tex"]
    assert [file.name for file in tmp_path.iterdir()] == ["frames"]


@pytest.mark.parametrize("name", ["a:b.mp4", "-x.mp4", "100%d.gif"])
def test_names_that_ffmpeg_would_take_for_something_else(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with film_file(Path(name), name[-3:], SIZE, 10.0) as film:
        film.add(shade(5))
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_two_processes_that_make_a_film_of_one_name_leave_each_other_alone(tmp_path, monkeypatch):
    path = tmp_path / "film.mp4"
    with film_file(path, "mp4", SIZE, 10.0) as film:
        film.add(shade(5))
        with monkeypatch.context() as other:
            other.setattr(os, "getpid", lambda: 1)
            with film_file(path, "mp4", SIZE, 10.0) as second:
                second.add(shade(9))
    assert [file.name for file in tmp_path.iterdir()] == ["film.mp4"]


def test_a_film_that_ffmpeg_cannot_write_is_an_error_and_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setitem(ENCODERS, "mp4", ["-c:v", "no-such-codec"])
    wrong = pytest.raises(OSError, match="ffmpeg cannot write the film: .*no-such-codec")
    with wrong, film_file(tmp_path / "film.mp4", "mp4", SIZE, 10.0) as film:
        for _ in range(50):
            film.add(shade(0))
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
    with pytest.raises(ValueError, match="at most 50 for gif; got 60\n.*at most 600 frames of a gif; got 601"):
        check_film(tmp_path / "a.gif", "gif", (321, 240), 60.0, 601)
    with pytest.raises(ValueError, match="must be a file"):
        check_film(tmp_path, "mp4", SIZE, 30.0, 2)


def test_the_format_is_that_of_the_name_or_as_asked_for():
    assert [format_of(Path(name), None) for name in ("a.mp4", "b.GIF", "c.png")] == ["mp4", "gif", "png"]
    assert (format_of(None, None), format_of(None, "gif"), format_of(Path("folder"), "png")) == ("mp4", "gif", "png")
    for output, wanted in ((Path("a.avi"), None), (Path("a"), "mp4"), (Path("a.gif"), "mp4"), (None, "avi")):
        with pytest.raises(ValueError, match="Input (format|output) must"):
            format_of(output, wanted)


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """A shaken platform, run and written."""
    folder = tmp_path_factory.mktemp("ran")
    case = Case(
        plate={"shape": "platform", "motion": MOTION},
        part=PartCase(mass=2e-9, position=(1e-4, 0.0)),
        friction=CoulombCase(coefficient=0.3),
        run=RunCase(duration=6e-4, frames=11),
        name="run",
    )
    run_case(case, folder)
    return folder


def called(*arguments):
    return CliRunner().invoke(main, ["animate", *map(str, arguments)])


SMALL = ("--size", "320x240", "--renderer", "matplotlib", "--slow-motion", "800", "--fps", "10")


@pytest.mark.parametrize(("name", "made"), [("film.mp4", "film.mp4"), ("film.gif", "film.gif"), ("film.png", "film")])
def test_the_command_makes_a_film_of_a_platform(ran, tmp_path, name, made):
    answer = called(ran / "run", "-o", tmp_path / "new" / name, *SMALL)
    assert answer.exit_code == 0, answer.output
    path = tmp_path / "new" / made
    assert f"wrote       {path}" in answer.output and "by matplotlib" in answer.output
    assert "6 frames at 10 a second" in answer.output
    images = sorted(path.iterdir()) if path.is_dir() else frames_of(path)[0]
    assert len(images) == 6


def test_without_a_name_it_is_beside_the_result_and_told_as_json(ran, tmp_path):
    folder = Path(shutil.copytree(ran, tmp_path / "results"))
    answer = called(folder / "run.part.vtkhdf", "--json", *SMALL)
    told = json.loads(answer.output)
    assert told["file"] == str(folder / "run.mp4") and (folder / "run.mp4").exists()
    assert told["frames"] == 6 and told["renderer"] == "matplotlib" and told["exaggeration"] == 1
    assert called(folder / "run", "--quiet", "--format", "png", *SMALL).output == ""
    assert len(list((folder / "run.frames").iterdir())) == 6


def test_a_partial_result_makes_a_film_that_says_so(ran, tmp_path):
    for kind in ("plate", "part"):
        shutil.copy(ran / f"run.{kind}.vtkhdf", tmp_path / f"run.partial.{kind}.vtkhdf")
    answer = called(tmp_path / "run", *SMALL)
    assert answer.exit_code == 0 and "The result is partial" in answer.output
    assert (tmp_path / "run.mp4").exists()


def test_where_pyvista_cannot_draw_matplotlib_does_and_says_so(ran, tmp_path, monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkNoSuchWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    small = [word for word in SMALL if word not in ("--renderer", "matplotlib")]
    answer = called(ran / "run", "-o", tmp_path / "film.mp4", *small)
    assert answer.exit_code == 0 and "pyvista cannot draw here, so matplotlib has" in answer.output
    assert len(frames_of(tmp_path / "film.mp4")[0]) == 6


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--camera", "below"], "Input camera must be"),
        (["--size", "1280"], "Input size must be"),
        (["--fps", "0"], "Input fps must be a finite number above 0; got 0.0"),
        (["--slow-motion", "-1"], "Input slow-motion must be"),
        (["--exaggeration", "nan"], "Input exaggeration must be"),
        (["--output", "film.avi"], "Input output must end with"),
        (["--output", "film.gif", "--format", "mp4"], "Input format must be"),
    ],
)
def test_bad_options_are_refused_in_a_line(ran, options, said):
    answer = called(ran / "run", *options)
    assert answer.exit_code == 2 and said in answer.output and "Traceback" not in answer.output


def test_all_bad_options_are_said_at_once(ran):
    bad = ["--camera", "below", "--size", "1x1", "--fps", "0", "-x", "-1", "--slow-motion", "inf", "-o", "a.avi"]
    answer = called(ran / "none", *bad)
    assert answer.exit_code == 2 and answer.output.count("Input") == 7


def test_a_result_that_is_none_is_refused(tmp_path):
    answer = called(tmp_path / "none")
    assert answer.exit_code == 2 and "Input path must be" in answer.output


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("x.toml", "", "a case file: name the result, such as results/x"),
        ("x.toml", "[study]", "a study file: it is of a sweep, and `active-surface view`"),
        ("x.toml", "[aim]", "an aim file: name the result of the case file that `active-surface aim` writes"),
        ("x.toml", "[no TOML", "name the result"),
        ("x.nc", "", "of a sweep"),
    ],
)
def test_a_file_that_is_no_result_of_a_run_is_told_what_it_is(tmp_path, name, text, said):
    (tmp_path / name).write_text(text)
    answer = called(tmp_path / name)
    assert answer.exit_code == 2 and said in " ".join(answer.output.split()) and "vtkhdf" not in answer.output


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for another process")
def test_ctrl_c_leaves_no_half_film(ran, tmp_path):
    command = [sys.executable, "-m", "active_surface", "animate", str(ran / "run"), "-o", str(tmp_path / "film.mp4")]
    command += ["--renderer", "matplotlib", "--slow-motion", "500000"]
    with subprocess.Popen(command, cwd=ROOT, start_new_session=True, stderr=subprocess.PIPE, text=True) as child:
        deadline = time.monotonic() + 120
        while not list(tmp_path.iterdir()) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert list(tmp_path.iterdir()) and child.poll() is None
        os.killpg(child.pid, signal.SIGINT)
        _, said = child.communicate(timeout=120)
    assert child.returncode == 130 and "interrupted" in said
    assert list(tmp_path.iterdir()) == []
