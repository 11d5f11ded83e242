"""Pages of runs as files: what is in them, and what the command says."""

import json
import re
from dataclasses import replace
from html import escape

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.tri import Triangulation
from page_files import CASE, FACED, NAME, numbers
from sweeps import PLATFORM

from active_surface.cli.program import main
from active_surface.views.pages.moments import heights_at, moments_of
from active_surface.views.pages.run_curves import MAX_POINTS as MAX_MOMENTS
from active_surface.views.pages.run_curves import _fewer, smooth_path
from active_surface.views.pages.run_data import MAX_POINTS, _planes, run_data
from active_surface.views.pages.run_page import motion, write_run_page
from coupling import read_case, report, run_case
from coupling.results.saved import read_run
from coupling.scene import lifts_of
from coupling.summary import summary_of
from particle import Event, EventKind, Footprint


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


def test_a_page_has_the_steps_of_its_run(run):
    data = run_data(run)
    surface = data["surface"]
    rank = len(surface["shapes"]["scales"])
    shapes = numbers(surface["shapes"]["rows"]).reshape(rank, -1) * np.array(surface["shapes"]["scales"])[:, None]
    heights = numbers(surface["amplitudes"]).reshape(-1, rank) @ shapes
    wanted = run.plate_field("deflection") * 1e6
    assert data["units"] == {"time": "ms", "length": "µm", "height": "µm", "speed": "mm/s"}
    assert rank == 1  # there is one actuator
    times = numbers(data["time"])
    steps = np.searchsorted(times, run.time * 1e3 * (1 - 1e-12))
    assert times[steps] == pytest.approx(run.time * 1e3, rel=1e-12)
    assert np.abs(heights[steps] - wanted).max() <= 2e-3 * np.abs(wanted).max()
    part = {name: numbers(data["part"][name])[steps] for name in ("x", "height", "z", "state")}
    assert part["x"] == pytest.approx(run.position[:, 0] * 1e6, rel=1e-5)
    assert part["height"] == pytest.approx(run.position[:, 2] * 1e6, rel=1e-6)
    assert part["z"] == pytest.approx(run.position[:, 2] * 1e6, abs=1.0)
    assert part["state"].tolist() == run.state.tolist()
    assert numbers(surface["actuators"]).tolist() == [0]


def test_a_page_has_margins_and_names_the_actuator_at_its_events(run, result):
    data = run_data(run)
    panels = {panel["label"]: panel for panel in data["curves"]["panels"]}
    assert {"Position", "Velocity", "Strokes", "Pull", "Friction"} < set(panels)
    curves = result.margin_curves
    assert numbers(data["curves"]["times"][panels["Pull"]["time"]]) == pytest.approx(curves.time)
    assert numbers(panels["Pull"]["lines"][0]["values"]) == pytest.approx(curves.slip, rel=1e-6, nan_ok=True)
    slips = [k for k, event in enumerate(run.events) if event.kind is EventKind.SLIPS]
    assert slips and all(data["events"][k]["by"] == "actuator 0 adds most to the pull" for k in slips)
    assert data["events"][slips[0]]["text"].startswith("slips at ") and data["lost"] == ""


@pytest.mark.compiled
def test_a_page_has_heading_and_pressure_of_a_part_with_a_face(tmp_path):
    (tmp_path / "faced.toml").write_text(FACED)
    result = run_case(read_case(tmp_path / "faced.toml"), tmp_path, picture=False)
    data = run_data(read_run(tmp_path / "faced"))
    wanted = result.trajectory.at(numbers(data["time"]) * 1e-3)
    assert np.ptp(wanted.heading) > 0.1
    assert numbers(data["part"]["heading"]) == pytest.approx(wanted.heading, abs=1e-9)
    curves = {}
    for panel in data["curves"]["panels"]:
        times = numbers(data["curves"]["times"][panel["time"]])
        curves[panel["label"]] = panel["unit"], times, numbers(panel["lines"][0]["values"])
    unit, times, heading = curves["Heading"]
    assert unit == "degrees" and np.radians(heading) == pytest.approx(result.trajectory.at(times).heading, rel=1e-6)
    unit, times, pressure = curves["Pressure"]  # without adhesion
    assert unit == "of mean" and pressure == pytest.approx(result.trajectory.at(times).pressure_margin, rel=1e-5)
    assert pressure.min() == pytest.approx(result.summary.least_pressure, rel=1e-6)


def test_a_face_lies_on_the_plane_through_the_surface_under_its_outline():
    sides = np.linspace(-1.0, 1.0, 81)
    x, y = (axis.ravel() for axis in np.meshgrid(sides, sides))
    triangles = Triangulation(x, y).triangles
    places, face = np.array([[0.3, -0.2], [-0.4, 0.1]]), Footprint.rectangle(0.4, 0.2)
    heights = np.stack([3 + 0.5 * x - 2 * y, x**2])  # of which the second has the slope 2 x under a symmetrical face
    tilted, bowl = _planes(np.column_stack([x, y]), triangles, heights, places, face.outline(places, [0.5, 0.0]))
    assert tilted == pytest.approx([3 + 0.5 * 0.3 + 2 * 0.2, 0.5, -2])
    assert bowl == pytest.approx([0.4**2 + 0.2**2, -0.8, 0], abs=1e-3)  # its corners are .2 away


def test_actuators_of_slips_are_counted(run):
    slips = [Event(EventKind.SLIPS, (n + 1) * 1e-3, (0.0, 0.0), 0.0, 0.0) for n in range(9)]
    ends = Event(EventKind.STOPS, 0.02, (0.0, 0.0), 0.0, 0.0)

    def told(events, *actuators):
        return " ".join(motion(replace(run, events=events, event_actuators=np.array(actuators, dtype=int))))

    assert told([]) == told([ends], -1) == ""
    assert told(slips[:1], -1) == "It begins to slip once, at 1 ms."
    by = "Actuator 3 adds most to the pull that makes it slip."
    assert told([ends, *slips[:1]], -1, 3) == f"It begins to slip once, at 1 ms. {by}"
    assert told([*slips, ends], 4, 5, 5, 6, 5, 6, 7, 8, 4, -1) == (
        "It begins to slip 9 times, first at 1 ms, and stops last at 20 ms. "
        "Actuator 5 adds most to the pull in 3 of these slips, actuator 4 in 2, actuator 6 in 2, others in 2."
    )


def test_a_page_of_a_lost_part_says_so(run):
    off = Event(EventKind.DETACHES, float(run.time[-1]), (0.0, 0.0), 0.0, 0.0)
    lost = replace(run, events=[*run.events, off], summary=run.summary | {"outcome": "detached"})
    assert run_data(lost)["lost"] == "came off"
    assert f"and is lost at {run.time[-1] * 1e3:.4g} ms." in " ".join(motion(lost))


def test_curves_of_many_points_keep_their_extremes():
    times = np.linspace(0, 1, 100_003)
    values = np.sin(3e4 * times)
    values[[70_001, 90_000]] = 5.0, np.nan
    fewer, kept = _fewer(times, {"": values})
    assert len(fewer) == len(kept[""]) <= MAX_MOMENTS + 2 and (np.diff(fewer) >= 0).all()
    assert np.nanmax(kept[""]) == 5.0 and np.nanmin(kept[""]) == np.nanmin(values)


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
    monkeypatch.setattr("active_surface.views.pages.moments.MAX_MOMENTS", 6)
    data = run_data(run)
    events = sum(event.time not in run.time for event in run.events)
    assert data["steps"] == {"shown": 6 - events, "stored": 11, "events": events}
    assert len(numbers(data["time"])) == 6
    assert numbers(data["time"])[[0, -1]] == pytest.approx(run.time[[0, -1]] * 1e3)


def test_at_an_event_the_part_is_as_the_run_has_it(run, result):
    moments = moments_of(run)
    slips = next(event for event in run.events if event.kind is EventKind.SLIPS)
    (here,) = np.flatnonzero(moments.time == slips.time)
    truth = result.trajectory.at([slips.time])
    assert moments.at_event[here] and moments.state[here] == 1
    assert moments.position[here] == pytest.approx([*truth.position[0], truth.height[0]], rel=1e-12)
    data = run_data(run)
    assert data["events"][0]["time"] == numbers(data["time"])[here]  # the page finds it by this
    whole = heights_at(run, moments, np.arange(len(run.points)))
    stroke = lifts_of(result.case)[0].evaluate(slips.time)[0]
    assert whole[here, 0] == pytest.approx(stroke, rel=0.02)  # a cubic through 11 steps of a drive of 300 Hz


def test_velocities_are_drawn_as_the_integrator_has_them(run, result):
    times, position, velocity = smooth_path(run)
    assert (np.diff(times) >= 0).all()
    middles = (times[1:] + times[:-1]) / 2
    truth = result.trajectory.at(middles)
    largest = np.abs(truth.velocity).max()
    for axis in (0, 1):
        drawn = np.interp(middles, times, velocity[:, axis])
        stored = np.interp(middles, run.time, run.velocity[:, axis])
        assert np.abs(drawn - truth.velocity[:, axis]).max() < 5e-3 * largest
        assert np.abs(stored - truth.velocity[:, axis]).max() > 2e-2 * largest  # which looks jagged
    assert position[-1] == pytest.approx(run.position[-1, :2], rel=1e-12)


def test_the_smallest_margins_are_marked_on_their_curves(run):
    data = run_data(run)["curves"]
    margins = summary_of(run.summary).margins
    marked = {panel["label"]: panel for panel in data["panels"] if "least" in panel}
    assert marked["Pull"]["least"]["time"] == margins.slip.time and marked["Pull"]["least"]["name"] == "first slip"
    assert "actuator 0 adds most to the pull" in marked["Pull"]["least"]["text"]
    for panel in marked.values():
        times, values = numbers(data["times"][panel["time"]]), numbers(panel["lines"][0]["values"])
        known = np.isfinite(values)
        assert panel["least"]["value"] == pytest.approx(np.interp(panel["least"]["time"], times[known], values[known]))


@pytest.mark.slow
def test_a_page_says_what_the_device_is_and_how_far_to_trust_it(run, tmp_path):
    text = write_run_page(run, tmp_path / "page.html").read_text(encoding="utf-8")
    assert f"<h1>{report.device(run.case)}</h1>" in text.replace("&#x27;", "'")
    warnings = report.warnings(summary_of(run.summary))
    assert f"Trust: {len(warnings)} warnings." in text and "the energy ledger closes to" in text
    assert warnings and all(f"<li>{escape(warning)}</li>" in text for warning in warnings)
    ours = (
        text[text.index("<body>") : text.index("<details")] + text[text.index("</details>") : text.index("<noscript")]
    )
    assert "µm" in ours and not re.search(r"\bum\b|\d u[mNsg]\b", ours)


def test_a_platform_is_flat_and_positions_are_counted_from_it(tmp_path):
    (tmp_path / "shaken.toml").write_text(PLATFORM.replace("2 ms", "10 ms"))
    run_case(read_case(tmp_path / "shaken.toml"), tmp_path)
    data = run_data(read_run(tmp_path / "shaken"))
    low, high = data["surface"]["range"]
    assert low == high == 0 and data["exaggeration"][0] == 1
    assert data["counted"] == " on the platform"
    assert len(numbers(data["surface"]["lines"][0]["ends"])) > 10
    assert len(numbers(data["trail"]["step"])) > 5


@pytest.mark.slow
def test_a_part_in_flight_is_above_the_surface(tmp_path):
    text = CASE.replace(
        'model = "constant"\nlimit = "41.8 nN"', 'model = "coulomb"\ncoefficient = 0.3\nadhesion = "0.05 uN"'
    )
    (tmp_path / "flies.toml").write_text(text.replace("[run]", '[run]\nafter_detachment = "fly"'))
    run_case(read_case(tmp_path / "flies.toml"), tmp_path)
    run = read_run(tmp_path / "flies")
    assert (run.state == 2).sum() > 3
    data = run_data(run)
    steps = np.searchsorted(numbers(data["time"]), run.time * 1e3 * (1 - 1e-12))
    assert numbers(data["part"]["height"])[steps] == pytest.approx(run.position[:, 2] * 1e6, rel=1e-6)
    assert numbers(data["part"]["z"])[steps] == pytest.approx(run.position[:, 2] * 1e6, abs=1.0)
    near = np.hypot(*(run.points - run.position[-1, :2]).T).argmin()
    assert numbers(data["part"]["z"])[-1] > run.plate_field("deflection")[-1, near] * 1e6 + 5
    begin, end = numbers(data["stretches"]["flying"])
    assert 0 < begin < end == pytest.approx(2.0)


@pytest.mark.slow
def test_a_part_that_stays_has_no_trail(tmp_path):
    (tmp_path / "stays.toml").write_text(CASE.replace("41.8 nN", "9 N"))
    run_case(read_case(tmp_path / "stays.toml"), tmp_path)
    data = run_data(read_run(tmp_path / "stays"))
    assert len(numbers(data["trail"]["step"])) == 0
    assert numbers(data["stretches"]["stuck"]) == pytest.approx([0.0, 2.0])


@pytest.mark.slow
def test_a_partial_result_is_shown_and_said_to_be_one(folder, result, tmp_path):
    for kind in ("plate", "part"):
        (tmp_path / f"cut.partial.{kind}.vtkhdf").write_bytes((folder / f"{NAME}.{kind}.vtkhdf").read_bytes())
    said = CliRunner().invoke(main, ["view", str(tmp_path / "cut.partial.part.vtkhdf")])
    assert said.exit_code == 0 and "partial" in said.output
    text = (tmp_path / "cut.html").read_text(encoding="utf-8")
    assert "not written to their end" in text
    assert f'<p class="sentence">{result.summary.sentence}' in text  # the summary is whole, whatever was written


@pytest.mark.slow
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


@pytest.mark.slow
def test_view_writes_beside_the_result_or_where_it_is_told(folder, result, tmp_path):
    for ending in ("", ".part.vtkhdf"):
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


NO_RESULTS = [
    ("gone", None, "there is no"),
    ("gone.nc", None, "there is no such file"),
    ("text.nc", "no netCDF", "which is something else"),
    ("text.plate.vtkhdf", "no HDF5", "no"),
    ("broken.toml", "[plate", "broken.toml"),
    ("case.toml", "[plate]\n", "active-surface run"),
    ("study.toml", "[study]\n", "active-surface sweep"),
    ("aim.toml", "[aim]\n", "whose table [aim] is for `active-surface aim`"),
]


def test_what_is_no_result_is_refused(tmp_path):
    for name, text, said in NO_RESULTS:
        if text is not None:
            (tmp_path / name).write_text(text)
        answer = CliRunner().invoke(main, ["view", str(tmp_path / name)])
        assert answer.exit_code == 2 and said in answer.output and "Traceback" not in answer.output
    assert CliRunner().invoke(main, ["view", str(tmp_path / "no" / name)]).exit_code == 2
    assert not (tmp_path / "no").exists() and not list(tmp_path.glob("*.html"))


def test_paths_are_of_sweeps_only(folder, result):
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "--paths", "3"])
    assert answer.exit_code == 2 and "--paths" in answer.output


def test_an_output_that_is_no_page_is_told_with_its_option(folder, result):
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "-o", "page.pdf"])
    assert answer.exit_code == 2 and "  --output must end in .html; got page.pdf\n" in answer.stderr
    answer = CliRunner().invoke(main, ["view", str(folder / NAME), "-o", "page.pdf", "--json"])
    told = {"file": None, "line": None, "field": "--output", "message": "must end in .html; got page.pdf"}
    assert json.loads(answer.stdout) == {"mistakes": [told]}
