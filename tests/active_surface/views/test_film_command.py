"""`active-surface animate`: the command that makes films, and what it refuses."""

import json
import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from films import frames_of

from active_surface.cli.program import main
from active_surface.views.film.layout import CAMERAS, layout_of
from active_surface.views.film.painter import Painter
from active_surface.views.film.scene import scene_of
from coupling import read_run, silent
from coupling.case import Case, CoulombCase, PartCase, RunCase
from coupling.run import run_case
from coupling.scene import platform_scene

MOTION = {"x": {"stroke": 20e-6, "frequency": 400.0, "cycle": "sine"}, "z": {"stroke": 3e-6, "frequency": 500.0}}


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


SMALL = ("--size", "320x240", "--slow-motion", "800", "--fps", "10")


@pytest.mark.parametrize(("name", "made"), [("film.mp4", "film.mp4"), ("film.gif", "film.gif"), ("film.png", "film")])
def test_the_command_makes_a_film_of_a_platform(ran, tmp_path, name, made):
    answer = called(ran / "run", "-o", tmp_path / "new" / name, *SMALL)
    assert answer.exit_code == 0, answer.output
    path = tmp_path / "new" / made
    assert f"wrote       {path}" in answer.output
    assert "6 frames at 10 a second" in answer.output
    images = sorted(path.iterdir()) if path.is_dir() else frames_of(path)[0]
    assert len(images) == 6


@pytest.mark.compiled
def test_a_platform_and_the_part_on_it_are_where_its_drives_have_brought_them(ran):
    run = read_run(ran / "run")
    scene = scene_of(run)
    base = platform_scene(run.case.plate, silent).base
    layout = layout_of(scene, CAMERAS["top"], (640, 360), 1.0)
    moments = scene.moments(run.time)
    expected = np.stack([drive.evaluate(run.time)[0] for drive in base], axis=1)
    assert np.ptp(expected, axis=0).max() > 0.01 * scene.size
    assert np.array([moment.shift for moment in moments]) == pytest.approx(expected, abs=1e-12)
    assert np.array([moment.part[:2] for moment in moments]) == pytest.approx(run.position[:, :2], abs=1e-9)
    corners = scene.surface.points[:, :2] * scene.size + scene.frame.mean(axis=0)
    for moment in moments:  # all of it is in the picture
        seen = layout.pixels(layout.places(corners + moment.shift, np.zeros(len(corners))))
        assert (seen >= layout.box[0]).all() and (seen <= layout.box[1]).all()
    with closing(Painter(layout)) as painter:
        pictures = [painter.paint(moments[k]) for k in (expected[:, 0].argmin(), expected[:, 0].argmax())]
    left, right = (np.flatnonzero((picture < 128).any(axis=(0, 2)))[0] for picture in pictures)
    assert right - left == pytest.approx(np.ptp(expected[:, 0]) / scene.size * layout.scale, abs=1.5)


def test_without_a_name_it_is_beside_the_result_and_told_as_json(ran, tmp_path):
    folder = Path(shutil.copytree(ran, tmp_path / "results"))
    answer = called(folder / "run.part.vtkhdf", "--json", *SMALL)
    told = json.loads(answer.output)
    assert told["file"] == str(folder / "run.mp4") and (folder / "run.mp4").exists()
    assert told["frames"] == 6 and told["exaggeration"] == 1
    assert called(folder / "run", "--quiet", "--format", "png", *SMALL).output == ""
    assert len(list((folder / "run.frames").iterdir())) == 6


def test_a_partial_result_makes_a_film_that_says_so(ran, tmp_path):
    for kind in ("plate", "part"):
        shutil.copy(ran / f"run.{kind}.vtkhdf", tmp_path / f"run.partial.{kind}.vtkhdf")
    answer = called(tmp_path / "run", *SMALL)
    assert answer.exit_code == 0 and "The result is partial" in answer.output
    assert (tmp_path / "run.mp4").exists()


@pytest.mark.parametrize(
    ("bad", "name"),
    [
        (("--camera", "below"), "camera"),
        (("--size", "1x1"), "size"),
        (("--fps", "0"), "fps"),
        (("-x", "-1"), "exaggeration"),
        (("--slow-motion", "inf"), "slow-motion"),
        (("-o", "a.avi"), "output"),
    ],
)
def test_bad_options_are_named(ran, bad, name):
    answer = called(ran / "run", *bad)
    assert answer.exit_code == 2 and name in answer.output and " must " in answer.output
