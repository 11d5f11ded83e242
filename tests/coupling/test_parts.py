"""Many parts over one surface: their cases, paths, files, and where they overlap."""

from __future__ import annotations

import base64
import csv
import json
import math
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner, Result

from active_surface.cli.program import main
from active_surface.views.pages.run_data import run_data
from coupling import Case, CaseError, InputError, read_case, read_parts, read_run, report, rerun, run_case, run_parts
from coupling.part import build_friction
from coupling.parts import first_overlap, overlapping
from coupling.results import read_runs
from coupling.run import build_scene, follow_part
from particle import Footprint, Trajectory

G = 9.80665
BLOCK = 'thickness = "10 um"\ndensity = "2330 kg/m^3"'
SQUARE = f'name = "square"\nfootprint = "rectangle"\nsides = ["100 um", "100 um"]\n{BLOCK}'
DISC = f'name = "disc"\nfootprint = "disc"\nradius = "50 um"\n{BLOCK}'
ALONE = 'mass = "1 ug"\nposition = ["0 um", "0 um"]'
POINT = 'name = "point"\nmass = "1 ug"'
LAW = '[friction]\nmodel = "coulomb"\ncoefficient = 0.3\n[run]\nframes = 20\nduration = "{}"\n'
RUN, LONGER = LAW.format("1 ms"), LAW.format("4 ms")
STILL = '[plate]\nshape = "platform"\n'
SHAKEN = f'{STILL}motion.x = {{ stroke = "60 um", frequency = "400 Hz", cycle = "sine" }}\n'
PLATE = """
plate = { shape = "disc", radius = "300 um", youngs_modulus = "169 GPa", poisson_ratio = 0.3, thickness = "20 um" }
actuators = [{ position = ["-80 um", "20 um"], stroke = "2 um", frequency = "5 kHz" }]
"""
THREE = (
    f'[[parts]]\n{SQUARE}\nheading = "20 deg"\nposition = ["-200 um", "0 um"]\n'
    f'[[parts]]\n{DISC}\nposition = ["0 um", "0 um"]\n'
    f'[[parts]]\nmass = "1 ug"\nposition = ["200 um", "30 um"]\nvelocity = ["0 m/s", "0.01 m/s"]\n'
)


def file_of(folder: Path, *texts: str) -> Path:
    path = folder / "many.toml"
    path.write_text("".join(texts))
    return path


def path_of(case: Case) -> Trajectory:
    return follow_part(case, build_scene(case).surface, build_friction(case))


def command(*words: object) -> Result:
    return CliRunner().invoke(main, [*map(str, words)])


def meeting(folder: Path, left: str, right: str) -> float | None:
    """When two parts overlap that slide towards each other along x at .05 m/s, from 150 um to the left and right."""
    start = '[[parts]]\n{}\nposition = ["{}150 um", "0 um"]\nvelocity = ["{}0.05 m/s", "0 m/s"]\n'
    texts = [start.format(left, "-", ""), start.format(right.replace('name = "', 'name = "other-'), "", "-")]
    result = run_parts(read_parts(file_of(folder, STILL, *texts, LONGER)))
    (overlap,) = result.overlaps
    assert result.plot().axes and overlap.parts == tuple(result.results)
    return overlap.time


def expected(reach: float) -> float:
    """When both have come from 150 um to `reach` [m] apart in all: x = v t - mu g t^2 / 2 of each."""
    way, speed, rate = (300e-6 - reach) / 2, 0.05, 0.3 * G
    return (speed - math.sqrt(speed**2 - 2 * rate * way)) / rate


def test_each_path_has_the_bits_of_a_single_run(tmp_path: Path) -> None:
    points = "".join(f'[[parts]]\nmass = "1 ug"\nposition = ["{x} um", "{40 * x / 50} um"]\n' for x in (-120, 10, 60))
    for texts in ((SHAKEN, THREE), (PLATE, points)):
        cases = read_parts(file_of(tmp_path, *texts, RUN))
        many = run_parts(cases)
        assert len(many.results) == 3
        for case in cases:
            alone, together = path_of(case), many.results[case.name].trajectory
            for name in ("time", "position", "velocity", "heading", "spin", "state", "friction_force"):
                assert np.array_equal(getattr(alone, name), getattr(together, name)), name
        ways = [result.summary.path_length for result in many.results.values()]
        assert min(ways) > 0 and len({*ways}) == 3


@pytest.mark.parametrize(
    ("left", "right", "reach"),
    [
        (SQUARE, SQUARE, 100e-6),
        (f'{SQUARE}\nheading = "45 deg"', SQUARE, (math.sqrt(0.5) + 0.5) * 1e-4),
        (DISC, DISC, 100e-6),
        (DISC, f'{SQUARE}\nheading = "45 deg"', (math.sqrt(0.5) + 0.5) * 1e-4),
        (POINT, DISC, 50e-6),
        (SQUARE, POINT, 50e-6),
    ],
)
def test_two_that_slide_towards_each_other_overlap_when_they_meet(
    tmp_path: Path, left: str, right: str, reach: float
) -> None:
    assert meeting(tmp_path, left, right) == pytest.approx(expected(reach), rel=1e-9)


def test_points_do_not_meet_and_parts_that_begin_together_overlap_from_the_start(tmp_path: Path) -> None:
    two = f'[[parts]]\n{POINT}\nposition = ["0 um", "0 um"]\n[[parts]]\n{{}}\nposition = ["10 um", "0 um"]\n'
    assert run_parts(read_parts(file_of(tmp_path, STILL, two.format('mass = "1 ug"'), RUN))).overlaps == ()
    (overlap,) = run_parts(read_parts(file_of(tmp_path, STILL, two.format(DISC), RUN))).overlaps
    assert overlap.sentence == "Parts point and disc overlap from the start: contact between parts is not modelled."


def test_outlines_overlap_where_their_areas_do() -> None:
    quarter = np.array([(-3, -1), (-1, -1), (-1, -3)])
    turns = [np.array([[1, 0], [0, 1]]), np.array([[0, 1], [-1, 0]]), -np.eye(2), np.array([[0, -1], [1, 0]])]
    plus = Footprint.polygon(np.concatenate([quarter @ turn for turn in turns]))
    bar = Footprint.rectangle(6.0, 1.0)
    random = np.random.default_rng(1)
    places, headings = random.uniform(-5, 5, (400, 2)), random.uniform(0, 2 * math.pi, (400, 2))
    first = plus.outline(np.zeros((400, 2)), headings[:, 0])
    found = overlapping((first, 0.0), (bar.outline(places, headings[:, 1]), 0.0))
    x, y = np.meshgrid(*(np.arange(-size + 0.05, size, 0.1) for size in (3.0, 0.5)))
    for k, (dx, dy) in enumerate(places):
        cos, sin = math.cos(headings[k, 1]), math.sin(headings[k, 1])
        grid = np.stack([dx + cos * x - sin * y, dy + sin * x + cos * y])
        c, s = math.cos(headings[k, 0]), math.sin(headings[k, 0])
        u, v = np.abs(c * grid[0] + s * grid[1]), np.abs(c * grid[1] - s * grid[0])
        depth = np.minimum(np.maximum(3 - u, 1 - v), 3)
        inside = (np.maximum(u, v) < 3) & (np.minimum(u, v) < 1)
        if inside.any():
            assert found[k]
        elif found[k]:  # by less than a spacing of the grid
            near = (np.maximum(u, v) < 3.1) & (np.minimum(u, v) < 1.1)
            assert near.any() and depth.size
    assert 100 < found.sum() < 300
    cos, sin = np.cos(headings[:, 0]), np.sin(headings[:, 0])
    u, v = np.abs(cos * places[:, 0] + sin * places[:, 1]), np.abs(cos * places[:, 1] - sin * places[:, 0])
    inside = (np.maximum(u, v) < 3) & (np.minimum(u, v) < 1)
    assert np.array_equal(overlapping((first, 0.0), (places[:, None], 0.0)), inside)
    small = overlapping((places[:, None], 0.1), (first, 0.0))
    assert small[inside].all() and not small[(np.maximum(u, v) > 3.1) | (np.minimum(u, v) > 1.1)].any()
    around, radius = np.zeros((400, 1, 2)), 1.5
    beyond = np.linalg.norm(places, axis=1) - radius
    discs = overlapping((around, radius), (places[:, None], 0.0))
    assert np.array_equal(discs, beyond < 0)


def test_files_of_many_parts(tmp_path: Path) -> None:
    path, out = file_of(tmp_path, SHAKEN, THREE, RUN), tmp_path / "out"
    done = command("run", path, "-o", out, "--csv", "--json")
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    names = ["square", "disc", "2"]
    assert list(said["parts"]) == names and said["overlaps"] == []
    files = ["plate.vtkhdf", *(f"{name}.part.vtkhdf" for name in names), "png", *(f"{name}.csv" for name in names)]
    assert [Path(file).name for file in said["files"]] == [f"many.{file}" for file in files]
    assert {file.name for file in out.iterdir()} == {f"many.{file}" for file in files}
    runs = read_runs(out / "many")
    assert [run.name for run in runs] == [f"many.{name}" for name in names]
    assert len(read_runs(out / "many.plate.vtkhdf")) == 3 and len(read_runs(out / "many.disc")) == 1
    for run, case, name in zip(runs, read_parts(path), names, strict=True):
        assert run.complete and run.case.part == case.part and run.summary == said["parts"][name]
        alone = path_of(case).at(run.time)
        assert np.array_equal(alone.position, run.position[:, :2])
        with (out / f"many.{name}.csv").open() as file:
            assert list(csv.reader(file))[-1][1] == str(run.position[-1, 0])
    assert rerun(read_run(out / "many.disc.part.vtkhdf"), tmp_path / "again").same_end
    with pytest.raises(ValueError, match=r"result of .* of one part; got .*many, of 3: name .*many.square or .*many.2"):
        read_run(out / "many")
    shutil.copy(path, out)
    done = command("view", out / path.name, "-o", out / "all.html")
    assert done.exit_code == 0 and "is of another case" not in done.output, done.output
    page = (out / "all.html").read_text()
    assert "a part of" not in page and all(f">{name}</td>" in page for name in names)
    data = run_data(runs[0], runs[1:])
    times = np.frombuffer(base64.b64decode(data["time"]["bytes"])) / 1e3
    assert data["name"] == "square" and [one["name"] for one in data["others"]] == names[1:]
    for one, run in zip(data["others"], runs[1:], strict=True):
        x = np.frombuffer(base64.b64decode(one["x"]["bytes"]), "<f4") * 1e-6
        there = path_of(run.case).at(times)
        assert x == pytest.approx(there.position[:, 0], abs=1e-8)
        assert ("face" in one) is (run.case.part.face is not None)
        if "face" in one:
            heading = np.frombuffer(base64.b64decode(one["heading"]["bytes"]))
            assert heading == pytest.approx(there.heading, abs=1e-6) and np.hypot(*one["face"][0]) == pytest.approx(50)
    low, high = (limit(runs[0].points, axis=0) for limit in (np.min, np.max))
    assert all((low < run.position[:, :2]).all() and (run.position[:, :2] < high).all() for run in runs)


def test_a_run_removes_the_parts_of_an_older_one(tmp_path: Path) -> None:
    out = tmp_path / "out"
    other = file_of(tmp_path, STILL, THREE.replace('"disc"\nfoot', '"round"\nfoot'), RUN)
    run_parts(read_parts(other), "many", out, picture=False, csv=True)
    (out / "many.mine.part.vtkhdf").write_bytes(b"")  # not of that run
    run_parts(read_parts(file_of(tmp_path, STILL, THREE, RUN))[1:], "many", out, picture=False)
    assert sorted(file.name for file in out.iterdir()) == [
        *("many.2.part.vtkhdf", "many.disc.part.vtkhdf", "many.mine.part.vtkhdf", "many.plate.vtkhdf")
    ]
    run_parts(read_parts(other)[1:2], "many", out, picture=False)
    assert [run.name for run in read_runs(out / "many")] == ["many.disc"]
    run_case(read_parts(other)[2].model_copy(update={"name": "many"}), out, picture=False)
    assert sorted(file.name for file in out.iterdir()) == [
        *("many.mine.part.vtkhdf", "many.part.vtkhdf", "many.plate.vtkhdf")
    ]
    assert read_runs(out / "many")[0].name == read_run(out / "many").name == "many"


def test_a_part_that_is_lost_has_the_steps_up_to_there(tmp_path: Path) -> None:
    thrown = SHAKEN.replace("motion.x", "motion.z")
    cases = read_parts(
        file_of(tmp_path, thrown, THREE.replace('mass = "1 ug"', 'mass = "1 ug"\nsqueeze = "1 mN"'), RUN)
    )
    result = run_parts(cases, "many", tmp_path)
    ends = {name: one.summary.end_time for name, one in result.results.items()}
    assert ends["square"] < 1e-4 and ends["2"] == 1e-3
    times = [run.time for run in read_runs(tmp_path / "many")]
    for time, end in zip(times, ends.values(), strict=True):
        assert time[-1] == end and np.array_equal(time, times[2][: len(time)])
    with h5py.File(tmp_path / "many.plate.vtkhdf") as file:
        assert np.array_equal(file["VTKHDF/Steps/Values"][()], times[2])
    assert all(run.complete for run in read_runs(tmp_path / "many"))


def test_summary_and_warnings_name_the_parts(tmp_path: Path) -> None:
    heavy = 'mass = "1 g"\nsize = "10 um"'
    path = file_of(tmp_path, STILL, THREE.replace('mass = "1 ug"', heavy).replace("-200 um", "-30 um"), RUN)
    done = command("run", path, "-o", tmp_path)
    rows = [line.split(maxsplit=1) for line in done.stdout.splitlines()]
    assert [row[1] for row in rows if row[0] == "part"] == ["square", "disc", "2"]
    warnings = [row[1] for row in rows if row[0] == "warning"]
    assert warnings[0].startswith("Parts square and disc overlap from the start") and warnings[1].startswith(
        "2: The part has"
    )
    assert command("check", path).stdout.count("2: The part has") == 1
    assert report.warnings_of_parts({"a": ["x", "y"], "b": ["y", "z"]}) == ["a: x", "y", "b: z"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"disc"\nfoot', '"square"\nfoot', 'line 12  parts[1].name must differ from those before it; got "square"'),
        ('"disc"\nfoot', '"2"\nfoot', 'line 18  parts[2].name must differ from those before it; got "2" again'),
        ('"square"', '"a/b"', 'line 4  parts[0].name must be at most 40 letters, digits, - and _; got "a/b"'),
        ('"50 um"', '"50"', 'line 14  parts[1].radius must be a length such as "150 um"; got "50", which has no unit'),
        ("mass", "maas", "line 19  parts[2].maas is not known; did you mean mass?"),
        (LAW[:10], f"[part]\n{ALONE}\n{LAW[:10]}", "line 3  parts must not be given with [part]"),
        ("1 ms", '1 ms"\nscheme = "fixed', 'scheme must be "events" with a footprint in [[parts]]'),
    ],
)
def test_mistakes_in_parts_are_named_by_line(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = STILL + THREE + RUN
    assert old in text
    with pytest.raises(CaseError) as error:
        read_parts(file_of(tmp_path, text.replace(old, new, 1)))
    assert said in str(error.value) and str(error.value).count("\n") == 1


def test_parts_beyond_the_rim_or_over_an_actuator(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as error:
        read_parts(file_of(tmp_path, PLATE, THREE.replace("-200 um", "-280 um"), RUN))
    assert "parts[0].position must put all of the part on the plate" in str(error.value)
    assert len(read_parts(file_of(tmp_path, PLATE, THREE.replace('["0 um", "0 um', '["-80 um", "20 um'), RUN))) == 3


def test_one_of_parts_is_a_part_and_more_are_refused_elsewhere(tmp_path: Path) -> None:
    one = file_of(tmp_path, STILL, f'[[parts]]\n{POINT}\nposition = ["0 um", "0 um"]\n', RUN)
    path = tmp_path / "alone.toml"
    path.write_text(f"{STILL}[part]\n{ALONE}\n{RUN}")
    assert read_case(one).part == read_case(path).part and read_case(one).name == "many"
    many = file_of(tmp_path, STILL, THREE, RUN)
    study = tmp_path / "study.toml"
    study.write_text('[study]\ncase = "many.toml"\n[[axes]]\nfield = "run.duration"\nvalues = ["1 ms"]\n')
    commands = [(name, many) for name in ("feasibility", "advise", "app")]
    for words in [("sweep", study), ("aim", many, "--target", "0 um, 0 um"), *commands]:
        done = command(*words)
        assert done.exit_code == 2 and "must be one part here, for which there is [part]; got 3" in done.output, words
    with pytest.raises(InputError, match="parts of Case must be left out"):
        Case(plate={"shape": "platform"}, parts=[{"mass": 1e-9, "position": (0, 0)}], friction={}, run={})
    first, second, _ = read_parts(many)
    for cases in ([], [first, first], [first, second.vary({"run.duration": 1.0})], [first.vary({}, "a b"), second]):
        with pytest.raises(ValueError, match="must be cases that differ in \\[part\\] only"):
            run_parts(cases)
    assert first_overlap(run_case(first), run_case(second)) is None


@pytest.mark.parametrize(
    "corners", [[[-1, -1], [1, -1], [1, 1], [-1, 1]], [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]]]
)
def test_parts_that_coincide_overlap_and_parts_that_touch_do_not(corners):
    face, still = Footprint.polygon(corners), np.zeros(1)
    same = face.outline(np.zeros((1, 2)), still)
    beside = face.outline([[np.ptp(face.corners[:, 0]), 0.0]], still)
    assert overlapping((same, 0.0), (same, 0.0)).all()
    assert not overlapping((same, 0.0), (beside, 0.0)).any()
