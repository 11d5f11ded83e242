"""`active-surface plot`: files with text as text, labels with units, nothing blank, clipped or overlapping."""

import json
import re

import numpy as np
import pytest
from click.testing import CliRunner
from legible import check
from matplotlib.layout_engine import ConstrainedLayoutEngine
from sweeps import PLATE, PLATFORM, written

from active_surface.cli.program import main
from active_surface.studies import read_study, run_study
from active_surface.studies.pictures.selection import Selection, read_findings
from active_surface.views.prints.plots import plot, sweep_pictures
from active_surface.views.prints.run_pictures import run_pictures
from active_surface.views.prints.sheet import MM, drawn
from coupling import read_case, run_case
from coupling.pictures.portrait import portrait_of
from coupling.pictures.time import MARKS, all_curves_of
from coupling.results.saved import read_run
from particle import EventKind

STROKE = '[[axes]]\nfield = "actuators.*.stroke"\nname = "stroke"\nvalues = ["20 um", "40 um", "60 um"]\n'
FREQUENCY = '[[axes]]\nfield = "actuators.0.frequency"\nname = "frequency"\nrange = ["200 Hz", "600 Hz"]\ncount = 4\n'
MASS = '[[axes]]\nfield = "part.mass"\nname = "mass"\nvalues = ["1e-9 kg", "4e-9 kg"]\n'
X = '[[axes]]\nfield = "part.position.0"\nname = "x"\nrange = ["-200 um", "200 um"]\ncount = 4\n'
Y = X.replace("position.0", "position.1").replace('"x"', '"y"')
STAYS = PLATE.replace("40 nN", "40 uN")
COMES_OFF = PLATE.replace('"300 Hz"', '"3 kHz"').replace("model =", 'model = "coulomb"\ncoefficient = 0.2 #')
COMES_OFF = re.sub(r'limit = ".*"', "", COMES_OFF)
MANY = (
    PLATE[: PLATE.index("[[actuators]]")]
    + '[lattice]\nrows = 12\ncolumns = 12\npitch = "25 um"\nstroke = "5 um"\nfrequency = "400 Hz"\n\n'
    + PLATE[PLATE.index("[part]") :]
).replace('"disc"\nradius = "300 um"', '"rectangle"\nwidth = "600 um"\nheight = "400 um"')


def ran(folder, text=PLATE, duration="5 ms"):
    (folder / "case.toml").write_text(re.sub(r'duration = ".*"', f'duration = "{duration}"', text))
    return run_case(read_case(folder / "case.toml"), folder)


STUDIES = {
    "one": FREQUENCY,
    "two": FREQUENCY + STROKE + '[map]\nthreshold = "distance > 1 um"\n',
    "three": FREQUENCY + STROKE + MASS,
    "points": 'sampling = "random"\npoints = 8\n' + FREQUENCY.replace("count = 4\n", "") + STROKE,
    "starts": X + Y,
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The results of a run."""
    folder = tmp_path_factory.mktemp("results")
    ran(folder, duration="2 ms")
    return folder


def swept(folder, name):
    """The results of a sweep over one axis, two, three, random points or starts."""
    file = folder / f"{name}.nc"
    if not file.exists():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("active_surface.studies.run.draw_sweep", lambda study, dataset, path: path)
            path = written(folder, STUDIES[name], PLATE.replace('"5 ms"', '"1 ms"'))
            run_study(read_study(path.rename(folder / f"{name}.toml")), folder, threads=1).dataset.close()
    return file


def findings_of(folder, name, *chosen):
    with read_findings(swept(folder, name)) as findings:
        return findings, sweep_pictures(findings, *chosen)


RUNS = {"stays": STAYS, "platform": PLATFORM, "off": COMES_OFF, "many": MANY}
SOME_SLOW = [("off", 60), *(pytest.param(*one, marks=pytest.mark.slow) for one in (("stays", 85), ("platform", 60)))]
SOME_SLOW.append(pytest.param("many", 180, marks=pytest.mark.slow))


@pytest.mark.compiled
@pytest.mark.parametrize(("name", "width"), SOME_SLOW)
def test_pictures_of_a_run_can_be_read(tmp_path, name, width):
    result = ran(tmp_path, RUNS[name], "2 ms")
    pictures = run_pictures(portrait_of(read_run(tmp_path / "case")))
    assert [picture.name for picture in pictures if picture.name != "closeup"] == ["path", "time"]
    assert result.summary.sentence in pictures[0].caption
    for picture in pictures:
        check(drawn(picture, width), width)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_saved_run_looks_as_the_run_itself(folder):
    result = ran(folder, duration="2 ms")
    saved = portrait_of(read_run(folder / "case"))
    found = portrait_of(result)
    assert saved.decisive == found.decisive and list(saved.drives) == list(found.drives)
    for one, other in zip(saved.margins, found.margins, strict=True):
        np.testing.assert_array_equal(one, other)
    assert (saved.moment, saved.sentence, saved.events) == (found.moment, found.sentence, found.events)
    assert saved.rows.state.tolist() == found.rows.state.tolist()
    truth = result.trajectory.at(saved.samples.time)
    largest = np.ptp(truth.position, axis=0).max()
    assert np.abs(saved.samples.position - truth.position).max() < 1e-3 * largest
    assert np.abs(saved.samples.height - truth.height).max() < 0.02 * truth.height.max()
    points, triangles, w = saved.plate.relief.within(saved.plate.frame)
    exact = result.shapes.values(points[::10] * (1 - 1e-9), result.scene.lifts and heights(result, saved.moment))
    assert len(triangles) > 10_000 and np.abs(w[::10] - exact[:, 0]).max() < 0.01 * exact.max()
    for one, other in zip(all_curves_of(saved), all_curves_of(found), strict=True):
        assert one.label == other.label and one.values.keys() == other.values.keys()


def heights(result, moment):
    return np.array([[drive.evaluate([moment])[0][0]] for drive in result.scene.lifts])


@pytest.mark.slow
@pytest.mark.compiled
def test_what_jumps_is_drawn_with_jumps(tmp_path):
    ran(tmp_path, COMES_OFF.replace("[run]", '[run]\nafter_detachment = "fly"'), "2 ms")
    run = read_run(tmp_path / "case")
    samples = portrait_of(run).samples
    lands = [event.time for event in run.events if event.kind is EventKind.LANDS]
    assert lands and (np.diff(samples.time) >= 0).all()
    for time in lands:
        after = int(np.searchsorted(samples.time, time))
        assert samples.time[after] == time and samples.time[after - 1] == np.nextafter(time, 0)
        assert samples.normal_force[after - 1] == 0 == samples.friction_force[after - 1]


@pytest.mark.slow
@pytest.mark.compiled
def test_a_picture_of_a_partial_run_says_so(folder, tmp_path):
    for kind in ("plate", "part"):
        (tmp_path / f"case.partial.{kind}.vtkhdf").write_bytes((folder / f"case.{kind}.vtkhdf").read_bytes())
    done = CliRunner().invoke(main, ["plot", str(tmp_path / "case")])
    assert done.exit_code == 0 and done.output.startswith("partial     The files were not written to the end")
    assert "when it is deflected most of the steps that were written." in done.output
    told = json.loads(CliRunner().invoke(main, ["plot", str(tmp_path / "case"), "--json"]).stdout)
    assert told["complete"] is False and [len(one["files"]) for one in told["pictures"]] == [1] * len(told["pictures"])


@pytest.mark.slow
@pytest.mark.compiled
def test_events_are_marked_where_they_happen(folder):
    run = read_run(folder / "case")
    figure = drawn(run_pictures(portrait_of(run))[-1])
    marked = {line.get_marker(): sorted(line.get_xdata()) for line in figure.axes[0].get_lines()}
    assert run.events
    for kind, (marker, *_) in MARKS.items():
        times = sorted(event.time * 1e3 for event in run.events if event.kind is kind)
        assert marked.get(marker, []) == pytest.approx(times)


@pytest.mark.compiled
@pytest.mark.parametrize(
    ("name", "chosen", "expected", "width"),
    [
        ("two", (), ["distance", "outcome", "threshold"], 60),
        *(
            pytest.param(*one, marks=pytest.mark.slow)
            for one in (
                ("one", (), ["distance", "outcome"], 180),
                ("three", ("mass",), ["distance", "outcome"], 60),
                ("points", (), ["distance", "outcome"], 180),
                ("starts", (), ["basins", "nearness"], 60),
                ("starts", (None, None, "evaluations"), ["evaluations"], 180),
            )
        ),
    ],
)
def test_pictures_of_a_sweep_can_be_read(folder, name, chosen, expected, width):
    _, pictures = findings_of(folder, name, *chosen)
    assert [picture.name for picture in pictures] == expected
    for picture in pictures:
        figure = drawn(picture, width)
        if not picture.name.startswith("eval"):
            check(figure, width)


@pytest.mark.slow
@pytest.mark.compiled
def test_axes_of_a_map_are_those_that_are_named(folder):
    with read_findings(swept(folder, "two")) as findings:
        found, turned = Selection.of(findings), Selection.of(findings, "stroke")
        assert [scale.axis.name for scale in found.axes] == ["frequency", "stroke"]
        assert [scale.axis.name for scale in turned.axes] == ["stroke", "frequency"]
        assert turned.mean_value.T.tolist() == found.mean_value.tolist()
        assert turned.holds.T.tolist() == found.holds.tolist()
    with read_findings(swept(folder, "three")) as findings:
        shown = Selection.of(findings, "mass", None, "path_length")
        assert [scale.axis.name for scale in shown.axes] == ["mass", "frequency"] and shown.fixed == {"stroke": "40 µm"}
        expected = findings.dataset["path_length"].sel(stroke=40e-6, method="nearest").transpose("mass", "frequency")
        assert shown.mean_value.tolist() == expected.values.tolist()


@pytest.mark.compiled
@pytest.mark.parametrize("form", ["svg", pytest.param("pdf", marks=pytest.mark.slow)])
def test_files_have_text_as_text_and_the_wanted_width(folder, tmp_path, form):
    done = CliRunner().invoke(main, ["plot", str(folder / "case"), "-o", str(tmp_path / "new"), "--format", form])
    assert done.exit_code == 0, done.output
    assert "not written to the end" not in done.output
    assert re.search(rf"wrote +\S+case.path.{form}\n +The path over the plate at ", done.output)
    raw = (tmp_path / f"new/case.path.{form}").read_bytes()
    if form == "pdf":
        assert b"/TrueType" in raw or b"/CIDFontType2" in raw
        assert b"/Type3" not in raw and b"/FontFile2" in raw
        return
    said = raw.decode()
    for text in (r"x \[µm\]", r"deflection \[µm\]", "actuator"):
        assert re.search(rf"<text[^>]*>{text}</text>", said)
    assert float(re.search(r'width="([\d.]+)pt"', said)[1]) == pytest.approx(85 * MM * 72, abs=0.1)


@pytest.mark.slow
@pytest.mark.compiled
def test_the_same_picture_gives_the_same_bytes(folder, tmp_path, monkeypatch):
    """Even where the layout's solver, which orders its unknowns by their addresses, rounds otherwise."""
    formats = ("svg", "pdf", "png")
    first, second = (tmp_path / name for name in ("first", "second"))
    plot(folder / "case", first, formats)
    solve, nudged = ConstrainedLayoutEngine.execute, []

    def rounds_otherwise(engine, figure):
        solve(engine, figure)
        for axes in figure.axes:
            nudged.append(axes)
            for which in ("original", "active"):
                axes._set_position(
                    axes.get_position(which == "original").bounds + np.array([2, -1, 1, 2]) * 1e-15, which
                )

    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", rounds_otherwise)
    plot(folder / "case.part.vtkhdf", second, formats)
    assert nudged and len(list(first.iterdir())) >= 6
    assert {file.name: file.read_bytes() for file in second.iterdir()} == {
        file.name: file.read_bytes() for file in first.iterdir()
    }


@pytest.mark.slow
@pytest.mark.compiled
def test_what_is_no_result_is_refused_with_one_message(folder, tmp_path):
    one, two = (swept(folder, name) for name in ("one", "two"))
    (tmp_path / "text.nc").write_text("mine")
    (tmp_path / "other.vtkhdf").write_text("mine")
    (tmp_path / "text.part.vtkhdf").write_text("mine")
    wrong = {
        tmp_path / "none": "which is no file",
        folder / "cas": f"which is no file; did you mean {folder / 'case'}?",
        folder: f"a folder: name a result in it: {folder / 'case'}",
        tmp_path / "text.nc": "which is another file",
        tmp_path / "other.vtkhdf": "which is another file: those of a run end in .plate.vtkhdf and .part.vtkhdf",
        folder / "case.png": f"which is beside a result: name {folder / 'case'}",
        folder / "one.toml": "which is input: name its result, such as results/one after `active-surface run`",
        folder / "case.toml": f"which is beside a result: name {folder / 'case'}",
    }
    for path, said in wrong.items():
        done = CliRunner().invoke(main, ["plot", str(path), "-o", str(tmp_path / "new")])
        wanted = "must be a file that `active-surface run` or `active-surface sweep` left"
        assert done.exit_code == 2
        assert done.output.splitlines()[1:] == [f"  RESULT|SWEEP {wanted}; got {path}, {said}"]
    others = [
        ([tmp_path / "text.part.vtkhdf"], "but there is no"),
        ([folder / "case", "--value", "distance"], "--value must be given for a sweep only"),
        ([two, "--x", "strok"], "must be one of frequency, stroke; got strok; did you mean stroke?"),
        ([two, "--value", "distanc"], "did you mean distance?"),
        ([two, "--x", "strok", "--value", "distanc"], "plot: 2 mistakes"),
        ([two, "--x", "stroke", "--y", "stroke"], "must be another axis than x; got stroke for both"),
        ([one, "--y", "frequency"], "must not be given where there is but one axis"),
        ([folder / "case", "--width", "10"], "--width must be from 50 to 500 mm; got 10"),
        ([folder / "case", "--format", "gif"], "'gif' is not one of 'pdf', 'svg', 'png'"),
    ]
    for arguments, said in others:
        done = CliRunner().invoke(main, ["plot", *map(str, arguments), "-o", str(tmp_path / "new")])
        assert done.exit_code == 2 and said in done.output, done.output
    assert not (tmp_path / "new").exists()
