"""Thresholds: conditions in words, where they begin to hold, and how that is drawn."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.figure import Figure
from sweeps import PLATE, PLATFORM, written

from active_surface.studies import read_study, run_study
from active_surface.studies.columns import OUTCOMES, Threshold, lowest, new_records, read_threshold
from active_surface.studies.engine import Engine
from active_surface.studies.pictures.panels import compose
from active_surface.studies.pictures.selection import Findings, read_findings
from active_surface.studies.read import read_sweep
from active_surface.studies.sweep_file import key_of, read_dataset, write_sweep
from coupling.case import CaseError

AXES = """\
[[axes]]
field = "friction.limit"
name = "limit"
values = ["1 nN", "2 nN", "4 nN"]
[[axes]]
field = "part.velocity.0"
name = "speed"
values = ["40 mm/s", "10 mm/s", "20 mm/s", "30 mm/s"]
"""
MASS = '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg", "2e-9 kg"]\n'


@pytest.mark.parametrize(
    "text, column, sign, level",
    [
        ("distance > 1 um", "distance", ">", 1e-6),
        ("  last_motion<2.5ms ", "last_motion", "<", 2.5e-3),
        ("largest_load > 1 uN", "largest_load", ">", 1e-6),
        ("evaluations > 1e3", "evaluations", ">", 1000.0),
        ("outcome = left the plate", "outcome", "=", OUTCOMES.index("left the plate")),
    ],
)
def test_conditions_are_read(text, column, sign, level):
    found = read_threshold(text)
    assert (found.column, found.sign, found.level) == (column, sign, level)


@pytest.mark.parametrize(
    "text, words",
    [
        (3, '^must be a condition such as "distance > 1 um" or "outcome = stuck"; got 3$'),
        ("distance", "^must be a condition such as .*; got "),
        ("distance >= 1 um", "length such as"),
        ("distanse > 1 um", "the results have no distanse, but distance$"),
        ("distance = 1 um", "^must have < or > for a figure, and = for the outcome"),
        ("outcome > stuck", "^must have < or > for a figure, and = for the outcome"),
        ("outcome = stick", "there is no outcome stick, but stuck$"),
        ("distance > 1 ms", "length such as .* a time"),
        ("distance > 1", "length such as"),
        ("evaluations > many", '^must compare evaluations with a number; got "many"$'),
        ("evaluations > nan", '^must compare evaluations with a number; got "nan"$'),
    ],
)
def test_what_is_no_condition_is_refused(text, words):
    with pytest.raises(ValueError, match=words):
        read_threshold(text)


def test_the_lowest_value_is_found_in_any_order_of_the_values():
    up = np.array([4.0, 1.0, 2.0, 3.0])
    holds = np.array(
        [[True, False, False, False], [False] * 4, [True, True, False, False], [False, False, True, False]]
    )
    begins, before = lowest(up, holds)
    assert begins == pytest.approx([4, np.nan, 1, 2], nan_ok=True)
    assert before == pytest.approx([3, np.nan, np.nan, 1], nan_ok=True)


def test_half_of_the_repeats_are_enough_and_refused_points_hold_nothing():
    refused = OUTCOMES.index("refused")
    distance = np.array([[1.0, 3.0, np.nan, 3.0], [np.nan, np.nan, np.nan, 3.0]])
    outcome = np.where(np.isnan(distance), refused, 0)
    columns = {"distance": distance, "outcome": outcome, "evaluations": np.where(np.isnan(distance), 0, 99)}
    columns["mistakes"] = np.isnan(distance).astype(int)
    dataset = {name: type("Array", (), {"values": values}) for name, values in columns.items()}
    for condition, holds in (
        (Threshold("distance", ">", 2.0, ""), [True, False]),
        (Threshold("evaluations", "<", 1e9, ""), [True, False]),
        (Threshold("outcome", "=", refused, ""), [False, True]),
        (Threshold("mistakes", ">", 0.0, ""), [False, True]),
    ):
        assert condition.holds(dataset, 4).tolist() == holds


def drawn(tmp_path, threshold):
    """The picture of results whose distance is (limit's index) + (speed's index) um."""
    study = read_study(written(tmp_path, f'{AXES}[map]\nthreshold = "{threshold}"\n', PLATFORM))
    records = new_records(12)
    records["distance"] = (np.arange(3)[:, None] + np.arange(4)).ravel() * 1e-6
    records["outcome"] = 0
    figure = Figure()
    FigureCanvasAgg(figure)
    dataset = read_dataset(write_sweep(study, [records], tmp_path / "found.nc"))
    compose(figure, Findings.of(study.name, dataset, study.threshold))
    figure.canvas.draw()
    return figure


def test_the_curve_and_the_line_lie_where_the_condition_begins(tmp_path):
    figure = drawn(tmp_path, "distance > 2.5 um")
    maps, curve = figure.axes[:2], figure.axes[2]
    line, from_first = curve.get_lines()
    assert curve.get_title() == "where distance > 2.5 um begins"
    assert line.get_xdata() == pytest.approx([1, 2, 4])
    assert line.get_ydata() == pytest.approx([30, 20, 10])
    assert from_first.get_xdata() == pytest.approx([4])
    for one in maps:
        (outline,) = (c for c in one.collections if isinstance(c, LineCollection))
        assert any(isinstance(c, QuadMesh) for c in one.collections)
        assert len(outline.get_segments()) == 7


def test_a_condition_that_holds_from_the_first_value_on_is_marked(tmp_path):
    line, marked = drawn(tmp_path, "distance < 1.5 um").axes[2].get_lines()
    assert line.get_ydata() == pytest.approx([10, 40, np.nan], nan_ok=True)
    assert marked.get_xdata() == pytest.approx([1])


def test_a_condition_that_holds_nowhere_says_so(tmp_path):
    curve = drawn(tmp_path, "outcome = moving").axes[2]
    assert [text.get_text() for text in curve.texts] == ["outcome = moving nowhere"]


@pytest.mark.slow
def test_another_threshold_is_drawn_without_running_again(tmp_path, monkeypatch):
    first = read_study(written(tmp_path, AXES + '[map]\nthreshold = "distance > 1 um"\n', PLATFORM))
    one = run_study(first, tmp_path / "out").files[1].read_bytes()
    monkeypatch.setattr(Engine, "records", None)
    other = read_study(written(tmp_path, AXES + '[map]\nthreshold = "distance > 20 um"\n', PLATFORM))
    assert other.key == first.key
    file, picture = run_study(other, tmp_path / "out").files
    assert picture.read_bytes() != one
    with read_findings(file) as found:
        assert found.threshold == other.threshold
    assert read_sweep(file)[0].threshold == other.threshold and key_of(file) == first.key
    kept = file.stat().st_mtime_ns, sorted(file.parent.iterdir())
    run_study(other, tmp_path / "out")
    assert (file.stat().st_mtime_ns, sorted(file.parent.iterdir())) == kept


@pytest.mark.parametrize(
    "text, words",
    [
        (f'{AXES}[map]\nthreshold = "distance > 1 s"\n', "map.threshold .*length such as"),
        (f'{AXES}[map]\nthreshhold = "distance > 1 um"\n', "map.threshhold .*did you mean threshold"),
        (
            f'{MASS}[map]\nthreshold = "distance > 1 um"\n',
            "map.threshold .*must not be given without a grid over two axes",
        ),
        (
            f'sampling = "random"\npoints = 9\n{AXES}[map]\nthreshold = "distance > 1 um"\n',
            "map.threshold .*must not be given without a grid over two axes",
        ),
    ],
)
def test_a_threshold_that_cannot_be_drawn_is_a_mistake_of_the_file(tmp_path, text, words):
    with pytest.raises(CaseError, match=words):
        read_study(written(tmp_path, text, PLATFORM))


def test_along_texts_nothing_begins(tmp_path):
    cycle = '[[axes]]\nfield = "actuators.0.cycle"\nvalues = ["up", "up-down"]\n'
    words = "map.threshold .*must not be given with texts along the second axis, actuators.0.cycle"
    with pytest.raises(CaseError, match=words):
        read_study(written(tmp_path, f'{MASS}{cycle}[map]\nthreshold = "distance > 1 um"\n', PLATE))
    assert read_study(written(tmp_path, f'{cycle}{MASS}[map]\nthreshold = "distance > 1 um"\n', PLATE)).threshold
