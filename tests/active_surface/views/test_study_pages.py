"""Pages of sweeps as files: what is in them, and what the command says."""

from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from page_files import CASE, FACED, STUDY, TURNS, data_of, numbers

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study
from active_surface.studies.engine import Engine
from active_surface.studies.pictures.selection import Findings, Selection
from active_surface.studies.read import read_sweep
from active_surface.views.pages.study_data import study_data
from active_surface.views.pages.study_page import write_study_page
from active_surface.views.pages.sweep_paths import Paths
from coupling import read_case, run_case

CORNERS = """
[[axes]]
field = "part.corners.0.0"
name = "corner"
values = ["0 um"]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def sweep(folder):
    (folder / "base.toml").write_text(CASE)
    (folder / "many.toml").write_text(STUDY)
    with run_study(read_study(folder / "many.toml"), folder).dataset as dataset:
        yield dataset.load()


def test_a_sweep_is_read_back_from_its_results(folder, sweep):
    study, dataset = read_sweep(folder / "many.nc")
    with dataset:
        assert study.traits == read_study(folder / "many.toml").traits
        assert study.case.actuators == read_case(folder / "base.toml").actuators
        assert study.name == "many" and study.threshold is not None


def test_a_study_whose_results_are_others_is_refused(folder, sweep, tmp_path):
    (tmp_path / "base.toml").write_text(CASE)
    (tmp_path / "many.toml").write_text(STUDY.replace("350 Hz", "360 Hz"))
    with pytest.raises(ValueError, match="of other points"):
        read_sweep(folder / "many.nc", read_study(tmp_path / "many.toml"))


def test_followed_paths_are_those_of_the_sweep(folder, sweep):
    study = read_study(folder / "many.toml")
    ends = {}
    Engine(study).follow([0, 1, 2, 4, 7], lambda number, path: ends.update({number: path.position[-1].tolist()}))
    assert sorted(ends) == [0, 1, 4, 7]  # 2 starts beyond the rim
    for number, end in ends.items():
        assert end == [sweep[f"end_{c}"].values.ravel()[number] for c in "xy"]


def test_the_page_of_a_sweep_has_its_map_and_its_paths(folder, sweep):
    study = read_study(folder / "many.toml")
    data = data_of(write_study_page(study, sweep, folder / "map.html"))
    assert data["kind"] == "map" and [axis["name"] for axis in data["axes"]] == ["frequency", "x"]
    distance = numbers(data["distance"]).reshape(3, 3)
    scale = {"m": 1, "mm": 1e3, "µm": 1e6, "nm": 1e9}[data["units"]["distance"]]
    assert distance == pytest.approx(sweep["distance"].values * scale, rel=1e-6, nan_ok=True)
    cells = numbers(data["paths"]["cells"]).tolist()
    assert cells == [0, 1, 3, 4, 6, 7]
    stops, rows = numbers(data["paths"]["stops"]), data["paths"]["points"]
    x = numbers(rows["rows"]).reshape(2, -1)[0] * rows["scales"][0]
    ends = numbers(data["ends"]).reshape(9, 2)[:, 0]
    assert x[stops - 1] == pytest.approx(ends[cells], abs=1e-2)
    assert data["outline"] and data["threshold"]


@pytest.mark.compiled
@pytest.mark.parametrize(("axis", "drawn"), [("", True), (CORNERS, False)])
def test_of_a_part_with_a_face_the_page_has_headings_and_its_outline_unless_the_axes_change_it(tmp_path, axis, drawn):
    (tmp_path / "faced.toml").write_text(FACED)
    (tmp_path / "turns.toml").write_text(TURNS + axis)
    study = read_study(tmp_path / "turns.toml")
    data = data_of(write_study_page(study, run_study(study).dataset, tmp_path / "turns.html"))
    ends = [run_case(study.case.vary({"part.heading": text})).trajectory.heading[-1] for text in ("-75 deg", "30 deg")]
    headings = numbers(data["paths"]["headings"]).reshape(2, 2)
    assert headings == pytest.approx(np.column_stack([np.radians([-75, 30]), ends]), rel=1e-6)
    assert ("face" in data["drawing"]) is drawn


@pytest.mark.parametrize(("count", "cells"), [(0, []), (4, [0, 1, 3, 4, 6, 7]), (1, [4])])
def test_a_page_has_no_more_paths_than_asked(folder, sweep, count, cells):
    found = data_of(write_study_page(read_study(folder / "many.toml"), sweep, folder / "few.html", count))
    kept = numbers(found["paths"]["cells"]).tolist()
    assert len(kept) <= count and set(kept) <= set(cells)


def test_of_many_ends_the_first_are_kept_and_the_repeats_stated(folder, sweep, monkeypatch):
    study = read_study(folder / "many.toml")
    shown = Selection.of(Findings.of(study.name, sweep, study.threshold))
    shown = replace(shown, end=np.repeat(shown.end, 3, axis=-2))
    for most, kept in ((27, 3), (26, 1)):
        monkeypatch.setattr("active_surface.views.pages.study_data.MAX_ENDS", most)
        data = study_data(study, shown, np.zeros((3, 3, 2)), Paths({}, 0, {}))
        assert (data["repeats"], data["kept"], len(numbers(data["ends"]))) == (3, kept, 18 * kept)


def test_paths_that_end_elsewhere_are_told_of(folder, sweep):
    other = sweep.copy(deep=True)
    other["end_x"][0, 0] += 5e-6
    page = write_study_page(read_study(folder / "many.toml"), other, folder / "other.html")
    assert "1 of the 6 paths, found once more for this page, end elsewhere" in page.read_text(encoding="utf-8")


def test_view_of_a_study_file_finds_its_results(folder, sweep):
    said = CliRunner().invoke(main, ["view", str(folder / "many.toml"), "--paths", "2"])
    assert said.exit_code == 0 and "many.sweep.html" in said.output
