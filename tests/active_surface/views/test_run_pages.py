"""Pages of runs as files: what is in them, and what the command says."""

import json
import re

import numpy as np
import pytest
from click.testing import CliRunner
from page_files import CASE, NAME, numbers

from active_surface.cli.program import main
from active_surface.views.pages.run_data import MAX_POINTS, run_data
from active_surface.views.pages.run_page import write_run_page
from coupling import read_case, report, run_case
from coupling.results.saved import read_run
from coupling.summary import summary_of


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("pages")


@pytest.fixture(scope="module")
def result(folder):
    (folder / f"{NAME}.toml").write_text(CASE)
    return run_case(read_case(folder / f"{NAME}.toml"), folder)


@pytest.fixture(scope="module")
def run(folder, result):
    return read_run(folder / NAME)


def test_the_summary_of_a_file_is_that_of_the_run(run, result):
    assert report.lines(summary_of(run.summary)) == report.lines(result.summary)
    assert report.warnings(summary_of(run.summary)) == report.warnings(result.summary)


def test_a_page_has_the_steps_of_its_run(run):
    data = run_data(run)
    surface = data["surface"]
    rank = len(surface["shapes"]["scales"])
    shapes = numbers(surface["shapes"]["rows"]).reshape(rank, -1) * np.array(surface["shapes"]["scales"])[:, None]
    heights = numbers(surface["amplitudes"]).reshape(-1, rank) @ shapes
    wanted = run.plate_field("deflection") * 1e6
    assert data["units"] == {"time": "ms", "length": "µm", "height": "µm"}
    assert rank == 1  # there is one actuator
    assert np.abs(heights - wanted).max() <= 2e-3 * np.abs(wanted).max()
    assert numbers(data["time"]) == pytest.approx(run.time * 1e3, rel=1e-6)
    assert numbers(data["part"]["x"]) == pytest.approx(run.position[:, 0] * 1e6, rel=1e-5)
    assert numbers(data["part"]["height"]) == pytest.approx(run.position[:, 2] * 1e6, rel=1e-6)
    assert numbers(data["part"]["z"]) == pytest.approx(run.position[:, 2] * 1e6, abs=1.0)
    assert numbers(data["part"]["state"]).tolist() == run.state.tolist()
    assert numbers(surface["actuators"]).tolist() == [0]


def test_stretches_of_rest_are_those_of_the_integrator(run, result):
    events = [event.time * 1e3 for event in result.trajectory.events]
    ends = numbers(run_data(run)["stretches"]["stuck"])
    assert ends[0] == 0 and ends[1] == pytest.approx(events[0], rel=1e-6)


def test_the_page_of_a_run_is_safe_small_and_alone(folder, run):
    page = write_run_page(run, folder / "safe.html")
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < 6e6
    ours = text.replace(re.search(r"<script>\n/\*\*\n\* plotly.*?</script>", text, re.DOTALL).group(0), "")
    assert "<script>alert" not in ours and "&lt;script&gt;alert(1)&lt;b&gt;&amp;" in ours
    assert not re.search(r"https?://|<link(?! rel=\"icon\" href=\"data:)|@import|\bsrc=", ours)
    assert "default-src 'none'" in ours
    assert ours.count("<script") == ours.count("</script>")


def test_of_a_large_surface_that_around_the_path_is_shown(run, monkeypatch):
    monkeypatch.setattr("active_surface.views.pages.run_data.MAX_POINTS", 200)
    data = run_data(run)
    assert not data["surface"]["whole"]
    assert 100 < len(numbers(data["surface"]["x"])) < 260
    middle = run.position[:, :2].mean(axis=0) * 1e6
    for axis, centre in zip("xy", middle, strict=True):
        values = numbers(data["surface"][axis])
        assert values.min() < centre < values.max()
    assert MAX_POINTS < 65536  # numbers of points are packed as 16 bits


def test_of_many_steps_as_many_are_shown_as_fit(run, monkeypatch):
    monkeypatch.setattr("active_surface.views.pages.run_data.MAX_STEPS", 5)
    data = run_data(run)
    assert data["steps"] == {"shown": 5, "stored": 11}
    assert numbers(data["time"])[[0, -1]] == pytest.approx(run.time[[0, -1]] * 1e3)


PLATFORM = """\
[plate]
shape = "platform"

[plate.motion.x]
stroke = "40 um"
frequency = "100 Hz"

[part]
mass = "2e-9 kg"
position = ["0 um", "0 um"]

[friction]
model = "constant"
limit = "10 nN"

[run]
duration = "10 ms"
frames = 21
"""


def test_a_platform_is_flat_and_positions_are_counted_from_it(tmp_path):
    (tmp_path / "shaken.toml").write_text(PLATFORM)
    run_case(read_case(tmp_path / "shaken.toml"), tmp_path)
    data = run_data(read_run(tmp_path / "shaken"))
    low, high = data["surface"]["range"]
    assert low == high == 0 and data["exaggeration"][0] == 1
    assert data["counted"] == " on the platform"
    assert len(numbers(data["surface"]["lines"][0]["ends"])) > 10
    assert len(numbers(data["trail"]["step"])) > 5


def test_a_part_in_flight_is_above_the_surface(tmp_path):
    text = CASE.replace(
        'model = "constant"\nlimit = "41.8 nN"', 'model = "coulomb"\ncoefficient = 0.3\nadhesion = "0.05 uN"'
    )
    (tmp_path / "flies.toml").write_text(text.replace("[run]", '[run]\nafter_detachment = "fly"'))
    run_case(read_case(tmp_path / "flies.toml"), tmp_path)
    run = read_run(tmp_path / "flies")
    assert (run.state == 2).sum() > 3
    data = run_data(run)
    assert numbers(data["part"]["height"]) == pytest.approx(run.position[:, 2] * 1e6, rel=1e-6)
    assert numbers(data["part"]["z"]) == pytest.approx(run.position[:, 2] * 1e6, abs=1.0)
    near = np.hypot(*(run.points - run.position[-1, :2]).T).argmin()
    assert numbers(data["part"]["z"])[-1] > run.plate_field("deflection")[-1, near] * 1e6 + 5
    begin, end = numbers(data["stretches"]["flying"])
    assert 0 < begin < end == pytest.approx(2.0)


def test_a_part_that_stays_has_no_trail(tmp_path):
    (tmp_path / "stays.toml").write_text(CASE.replace("41.8 nN", "9 N"))
    run_case(read_case(tmp_path / "stays.toml"), tmp_path)
    data = run_data(read_run(tmp_path / "stays"))
    assert len(numbers(data["trail"]["step"])) == 0
    assert numbers(data["stretches"]["stuck"]) == pytest.approx([0.0, 2.0])


def test_a_partial_result_is_shown_and_said_to_be_one(folder, result, tmp_path):
    for kind in ("plate", "part"):
        (tmp_path / f"cut.partial.{kind}.vtkhdf").write_bytes((folder / f"{NAME}.{kind}.vtkhdf").read_bytes())
    said = CliRunner().invoke(main, ["view", str(tmp_path / "cut.partial.part.vtkhdf")])
    assert said.exit_code == 0 and "partial" in said.output
    text = (tmp_path / "cut.html").read_text(encoding="utf-8")
    assert "not written to their end" in text
    assert f'<p class="sentence">{result.summary.sentence}</p>' in text  # the summary is whole, whatever was written


def test_a_case_that_is_not_that_of_its_result_is_told_of(folder, result, tmp_path):
    for kind in ("plate", "part"):
        (tmp_path / f"one.{kind}.vtkhdf").write_bytes((folder / f"{NAME}.{kind}.vtkhdf").read_bytes())
    for text, told in ((CASE, False), (CASE.replace("300 Hz", "310 Hz"), True)):
        (tmp_path / "one.toml").write_text(text)
        said = CliRunner().invoke(main, ["view", str(tmp_path / "one.toml")])
        assert said.exit_code == 0
        assert ("of another case" in said.output) == told


def test_open_opens_the_page(folder, result, monkeypatch):
    opened = []
    monkeypatch.setattr("click.launch", opened.append)
    assert CliRunner().invoke(main, ["view", str(folder / NAME), "--open", "-q"]).exit_code == 0
    assert opened == [(folder / f"{NAME}.html").as_uri()]


def test_view_writes_beside_the_result_or_where_it_is_told(folder, result, tmp_path):
    for ending in ("", ".plate.vtkhdf", ".part.vtkhdf"):
        (folder / f"{NAME}.html").unlink(missing_ok=True)
        said = CliRunner().invoke(main, ["view", str(folder / f"{NAME}{ending}")])
        assert said.exit_code == 0 and f"{NAME}.html" in said.output
        assert (folder / f"{NAME}.html").is_file()
    said = CliRunner().invoke(main, ["view", str(folder / NAME), "-q", "-o", str(tmp_path / "new" / "x.html")])
    assert (said.exit_code, said.output) == (0, "")
    page = tmp_path / "new" / "x.html"
    assert list(page.parent.iterdir()) == [page]
    said = CliRunner().invoke(main, ["view", str(folder / NAME), "--json", "-o", str(page)])
    assert json.loads(said.output) == {"warnings": [], "files": [str(page)], "bytes": page.stat().st_size}


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("gone", None, "there is no"),
        ("gone.nc", None, "there is no such file"),
        ("text.nc", "no netCDF", "which is something else"),
        ("text.plate.vtkhdf", "no HDF5", "no"),
        ("broken.toml", "[plate", "broken.toml"),
        ("case.toml", "[plate]\n", "active-surface run"),
        ("study.toml", "[study]\n", "active-surface sweep"),
        ("aim.toml", "[aim]\n", "whose table [aim] is for `active-surface aim`"),
    ],
)
def test_what_is_no_result_is_refused(tmp_path, name, text, said):
    if text is not None:
        (tmp_path / name).write_text(text)
    answer = CliRunner().invoke(main, ["view", str(tmp_path / name)])
    assert answer.exit_code == 2 and said in answer.output and "Traceback" not in answer.output
    assert not list(tmp_path.glob("*.html"))


def test_paths_are_of_sweeps_only(folder, result):
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "--paths", "3"])
    assert answer.exit_code == 2 and "--paths" in answer.output


def test_an_output_that_is_no_page_is_told_with_its_option(folder, result):
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "-o", "page.pdf"])
    assert answer.exit_code == 2 and "  --output must end in .html; got page.pdf\n" in answer.stderr
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "-o", "page.pdf", "--json"])
    told = {"file": None, "line": None, "field": "--output", "message": "must end in .html; got page.pdf"}
    assert json.loads(answer.stdout) == {"mistakes": [told]}
