"""`active-surface animate`: the command that makes films, and what it refuses."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from films import frames_of

from active_surface.cli.program import main
from active_surface.views.film.camera import CAMERAS
from active_surface.views.film.frames import frames_of as frames_shown
from active_surface.views.film.layout import layout_of
from active_surface.views.film.look import Look
from active_surface.views.film.stage import stage_of
from coupling import read_run, silent
from coupling.case import Case, CoulombCase, PartCase, RunCase
from coupling.run import run_case
from coupling.scene import platform_scene

MOTION = {"x": {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}, "z": {"stroke": 3e-6, "frequency": 500.0}}
ROOT = Path(__file__).parents[3]


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


@pytest.mark.compiled
def test_a_platform_and_the_part_on_it_are_where_its_drives_have_brought_them(ran):
    run = read_run(ran / "run")
    stage = stage_of(run)
    base = platform_scene(run.case.plate, silent).base
    layout = layout_of(stage, CAMERAS["top"], (640, 360), 1.0)
    look = Look(stage, layout, stage.scale)
    frames = list(frames_shown(stage, run.time))
    expected = np.stack([drive.evaluate(run.time)[0] for drive in base], axis=1) / layout.size
    moved = np.array([look.surface(frame)[0, :2] - look.surface(frames[0])[0, :2] for frame in frames])
    assert np.ptp(expected, axis=0).max() > 0.01
    assert moved == pytest.approx(expected - expected[0], abs=1e-12)
    part = np.array([look.part(frame)[0][:2] for frame in frames])
    path = expected + run.position[:, :2] / layout.size
    assert part - part[0] == pytest.approx(path - path[0], abs=1e-9)
    for frame in frames:  # all of it is in the picture
        seen = layout.pixels(look.surface(frame))
        assert (seen >= 0).all() and (seen <= (640, 360)).all()


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


@pytest.mark.slow
def test_where_pyvista_cannot_draw_matplotlib_does_and_says_so(ran, tmp_path, monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkNoSuchWindow")
    monkeypatch.delenv("DISPLAY", raising=False)
    small = [word for word in SMALL if word not in ("--renderer", "matplotlib")]
    answer = called(ran / "run", "-o", tmp_path / "film.mp4", *small)
    assert answer.exit_code == 0 and "pyvista cannot draw here, so matplotlib has" in answer.output
    assert len(frames_of(tmp_path / "film.mp4")[0]) == 6


def test_all_bad_options_are_said_at_once(ran):
    bad = ["--camera", "below", "--size", "1x1", "--fps", "0", "-x", "-1", "--slow-motion", "inf", "-o", "a.avi"]
    answer = called(ran / "none", *bad)
    assert answer.exit_code == 2 and answer.output.count(" must be ") + answer.output.count(" must end ") == 7


def test_a_result_that_is_none_is_refused(tmp_path):
    answer = called(tmp_path / "none")
    assert answer.exit_code == 2 and "RESULT must be a result of" in answer.output


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for another process")
def test_ctrl_c_leaves_no_half_film(ran, tmp_path):
    command = [sys.executable, "-m", "active_surface", "animate", str(ran / "run"), "-o", str(tmp_path / "film.mp4")]
    command += ["--renderer", "matplotlib", "--slow-motion", "500000"]
    with subprocess.Popen(command, cwd=ROOT, start_new_session=True, stderr=subprocess.PIPE, text=True) as child:
        deadline = time.monotonic() + 600
        while not list(tmp_path.iterdir()) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert list(tmp_path.iterdir()) and child.poll() is None
        os.killpg(child.pid, signal.SIGINT)
        _, said = child.communicate(timeout=600)
    assert child.returncode == 130 and "interrupted" in said
    assert list(tmp_path.iterdir()) == []
