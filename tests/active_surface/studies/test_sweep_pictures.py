"""Pictures of sweeps: a map, a curve, points or basins, each with what it must show."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from sweeps import PLATE, PLATFORM, written

from active_surface.studies import read_study
from active_surface.studies.columns import OUTCOMES, new_records
from active_surface.studies.pictures.charts import CELLS, draw_nearest, edges
from active_surface.studies.pictures.panels import compose, draw_sweep
from active_surface.studies.pictures.selection import Findings, Scale, Selection
from active_surface.studies.sweep_file import read_dataset, write_sweep


def axis(field, values, name=""):
    name = f'name = "{name}"\n' if name else ""
    return f'[[axes]]\nfield = "{field}"\n{name}values = {values}\n'


STROKE = axis("actuators.0.stroke", '["10 um", "20 um", "40 um"]', "stroke")
LIMIT = axis("friction.limit", '["1 nN", "2 nN"]', "limit")
CYCLE = axis("actuators.0.cycle", '["up-down", "up"]', "cycle")
X = axis("part.position.0", '["-100 um", "0 um", "100 um"]', "x")
Y = axis("part.position.1", '["0 um", "50 um"]', "y")


def made(tmp_path, text, case=PLATE):
    """A study and results that tell their places: distance and end are functions of the index."""
    study = read_study(written(tmp_path, text, case))
    records = new_records(len(study.points))
    k = np.arange(len(records))
    records["distance"], records["end_x"], records["end_y"] = k * 1e-6, 75e-6, 0.0
    records["outcome"] = k % 2
    records["distance"][0], records["outcome"][0] = np.nan, OUTCOMES.index("refused")
    path = write_sweep(study, [records], tmp_path / "found.nc")
    return study, read_dataset(path)


def drawn(study, dataset):
    figure = Figure()
    FigureCanvasAgg(figure)
    compose(figure, Findings.of(study.name, dataset, study.threshold))
    figure.canvas.draw()
    return figure


def test_a_map_has_each_value_at_its_place(tmp_path):
    figure = drawn(*made(tmp_path, STROKE + LIMIT))
    field, classes = figure.axes[:2]
    assert (field.get_xlabel(), field.get_ylabel()) == ("stroke [µm]", "limit [nN]")
    (mesh,) = (one for one in field.collections if isinstance(one, QuadMesh))
    assert mesh.get_array().tolist() == [[None, 2.0, 4.0], [1.0, 3.0, 5.0]]
    assert np.asarray(mesh.get_coordinates())[0, :, 0] == pytest.approx([5, 15, 30, 50])
    assert [text.get_text() for text in classes.get_legend().get_texts()] == [
        "stuck, 33.3 %",
        "moving, 50 %",
        "refused, 16.7 %",
    ]


def shuffled(dataset, *names):
    """The same results, with the values of axes in the order in which a study listed them."""
    return dataset.load().isel({name: [2, 0, 1] for name in names})


@pytest.mark.parametrize("other", ["", LIMIT])
def test_the_order_in_which_values_are_listed_does_not_change_the_picture(tmp_path, other):
    study, dataset = made(tmp_path, STROKE + other)
    mixed = read_study(
        written(tmp_path, STROKE.replace('"10 um", "20 um", "40 um"', '"40 um", "10 um", "20 um"') + other)
    )
    pictures = []
    for one, results in ((study, dataset), (mixed, shuffled(dataset, "stroke"))):
        figure = drawn(one, results)
        pictures.append(np.asarray(figure.canvas.buffer_rgba()).tobytes())
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize(
    ("values", "scale", "expected"),
    [
        ('["10 nN", "1 nN", "1 uN"]', "log", None),
        ('["1 nN", "1000 nN", "2 nN"]', "linear", [-0.5, 0.5, 1.5, 2.5]),
        ('["0 nN", "100 nN", "1 nN"]', "linear", [-0.5, 0.5, 1.5, 2.5]),
        ('["2 nN", "1 nN", "4 nN"]', "linear", [0.5, 1.5, 3, 5]),
    ],
)
def test_no_cell_of_a_map_is_a_sliver(tmp_path, values, scale, expected):
    figure = drawn(*made(tmp_path, axis("friction.limit", values, "limit") + CYCLE))
    (mesh,) = (one for one in figure.axes[0].collections if isinstance(one, QuadMesh))
    places = np.asarray(mesh.get_coordinates())[0, :, 0]
    assert figure.axes[0].get_xscale() == scale
    widths = np.diff(np.log(places) if scale == "log" else places)
    assert (widths > 0).all() and widths.max() <= 4 * widths.min()
    if expected:
        assert places == pytest.approx(expected)


def test_the_bar_of_parts_that_stand_still_begins_at_0_um(tmp_path):
    study, dataset = made(tmp_path, STROKE + LIMIT)
    figure = drawn(study, dataset.assign(distance=0.0 * dataset["distance"]))
    (mesh,) = (one for one in figure.axes[0].collections if isinstance(one, QuadMesh))
    assert mesh.colorbar.ax.get_ylabel() == "distance from the start [µm]" and mesh.get_clim() == (0.0, 1.0)


def test_a_map_over_a_text_names_it(tmp_path):
    study, dataset = made(tmp_path, CYCLE + STROKE)
    assert dataset["cycle"].values.tolist() == ["up-down", "up"]
    figure = drawn(study, dataset)
    assert [label.get_text() for label in figure.axes[0].get_xticklabels()] == ["up-down", "up"]


def test_axes_beyond_the_longest_two_stay_at_their_middle_value(tmp_path):
    figure = drawn(*made(tmp_path, STROKE + LIMIT + axis("part.mass", '["1e-9 kg", "2e-9 kg", "3e-9 kg"]', "mass")))
    assert "9 of 18 paths, limit = 2 nN" in figure.get_suptitle()
    assert figure.axes[0].get_xlabel() == "stroke [µm]"


def test_a_value_that_is_not_shown_keeps_its_digits(tmp_path):
    ratios = axis("plate.poisson_ratio", "[0.1]", "ratio")
    assert drawn(*made(tmp_path, STROKE + LIMIT + ratios)).get_suptitle().endswith(", ratio = 0.1")


def test_the_name_of_a_study_is_no_formula(tmp_path):
    study, dataset = made(tmp_path, LIMIT + STROKE)
    figure = drawn(replace(study, name="q$_$s"), dataset)
    assert figure.get_suptitle() == "q$_$s: 6 paths"


def test_a_curve_shows_the_mean_and_the_spread_of_repeats(tmp_path):
    figure = drawn(*made(tmp_path, 'repeats = 4\njitter = "1 um"\n' + STROKE))
    curve = figure.axes[0].get_lines()[0]
    assert curve.get_xdata() == pytest.approx([10, 20, 40])
    assert curve.get_ydata() == pytest.approx([2.0, 5.5, 9.5])  # the refused one is left out
    assert "mean of 4 starts" in figure.get_suptitle()


def test_basins_tell_the_nearest_actuator_of_those_that_were_carried(tmp_path):
    study, dataset = made(tmp_path, Y + X)
    dataset = dataset.load()
    dataset["distance"][:] = 50e-6
    dataset["distance"][1, 1] = 1e-6
    figure = drawn(study, dataset)
    (mesh,) = (one for one in figure.axes[0].collections if isinstance(one, QuadMesh))
    assert figure.axes[0].get_xlabel() == "x [µm]" and mesh.get_array().shape == (2, 3)
    refused, stays, second = OUTCOMES.index("refused"), len(OUTCOMES), len(OUTCOMES) + 2
    assert mesh.get_array().tolist() == [[refused, second, second], [second, stays, second]]


def test_starts_over_a_platform_are_a_map(tmp_path):
    figure = drawn(*made(tmp_path, X + Y, PLATFORM))
    assert figure.axes[0].get_title() == "distance from the start"


@pytest.mark.parametrize("axes", [X + Y, Y + X])
def test_parts_from_random_starts_are_drawn_where_they_end(tmp_path, axes):
    study, dataset = made(tmp_path, 'sampling = "random"\npoints = 9\n' + axes)
    dataset = dataset.load()
    dataset["end_x"][:], dataset["end_y"][:] = np.arange(9) * 1e-5, np.arange(9) * -1e-6
    panel = drawn(study, dataset).axes[0]
    assert panel.get_title() == "where the part ends"
    ends = [np.asarray(marks.get_offsets()) for marks in panel.collections if len(marks.get_offsets()) == 9]
    expected = np.stack([np.arange(9) * 10.0, np.arange(9) * -1.0], axis=-1)
    assert ends[-1] == pytest.approx(expected if axes == X + Y else expected[:, ::-1])


@pytest.mark.parametrize("axes", [STROKE, STROKE + LIMIT])
@pytest.mark.parametrize("sampling", ['sampling = "random"\npoints = 9\n', 'sampling = "list"\n'])
def test_points_are_drawn_where_they_are(tmp_path, axes, sampling):
    axes = axes.replace('"2 nN"', '"2 nN", "3 nN"')
    study, dataset = made(tmp_path, sampling + axes)
    figure = drawn(study, dataset)
    marks = np.asarray(figure.axes[1].collections[0].get_offsets())
    assert len(marks) == len(study.points)
    assert marks[:, 0] == pytest.approx(dataset["stroke"].values * 1e6)


def test_a_sweep_of_refused_points_alone_is_drawn(tmp_path):
    for text in (STROKE + LIMIT, STROKE, X + Y, 'sampling = "list"\n' + STROKE):
        study, dataset = made(tmp_path, text)
        dataset = dataset.load()
        dataset["distance"][:] = np.nan
        dataset["outcome"][:] = OUTCOMES.index("refused")
        assert draw_sweep(study, dataset, tmp_path / "picture.png").stat().st_size > 1000


def test_one_value_alone_is_drawn(tmp_path):
    assert drawn(*made(tmp_path, axis("part.mass", '["1e-9 kg"]') + STROKE))
    assert drawn(*made(tmp_path, axis("part.mass", '["1e-9 kg"]')))


@pytest.mark.parametrize("other", ["", STROKE])
def test_an_axis_may_be_called_number(tmp_path, other):
    study, dataset = made(tmp_path, LIMIT.replace('"limit"', '"number"') + other)
    shown = Selection.of(Findings.of(study.name, dataset, None))
    scale = shown.axes[[axis.axis.name for axis in shown.axes].index("number")]
    assert scale.drawn == pytest.approx([1, 2]) and scale.unit.name == "nN"
    assert sorted(shown.numbers.ravel()) == list(range(len(study.points)))
    assert drawn(study, dataset).axes


def test_edges_lie_half_way_between_values(tmp_path):
    text = '[[axes]]\nfield = "part.mass"\nrange = ["1 kg", "100 kg"]\ncount = 3\nspacing = "logarithmic"\n'
    study, dataset = made(tmp_path, text)
    scale = Scale.of(study.points.axes[0], dataset["part.mass"].values)
    assert edges(scale) == pytest.approx(10.0 ** np.array([-0.5, 0.5, 1.5, 2.5]))


def test_near_values_of_an_axis_are_told_apart(tmp_path):
    near = axis("actuators.0.frequency", '["10000 Hz", "10000.5 Hz", "10001 Hz"]', "frequency")
    uneven = axis("actuators.0.stroke", '["20 um", "20.00001 um", "20.001 um", "30 um"]', "stroke")
    study, dataset = made(tmp_path, near + uneven + axis("friction.limit", '["1 nN", "2 nN", "3 nN", "4 nN"]', "limit"))
    shown = Selection.of(Findings.of(study.name, dataset, study.threshold), "stroke", "limit")
    assert shown.fixed == {"frequency": "10.0005 kHz"}
    assert shown.axes[0].texts == ("20", "20.00001", "20.001", "30")


def test_around_points_is_the_colour_of_the_nearest():
    generator = np.random.default_rng(5)
    places = np.stack([generator.uniform(1, 3, 60), np.exp(generator.uniform(0, 4, 60))], axis=1)
    values = np.arange(60.0)
    scales = [SimpleNamespace(logarithmic=False), SimpleNamespace(logarithmic=True)]
    axes = Figure().subplots()
    draw_nearest(axes, scales, places, values, {})
    mesh = axes.collections[0]
    shown = np.asarray(mesh.get_array()).reshape(CELLS, CELLS)
    corners = mesh.get_coordinates()
    flat = np.stack([places[:, 0], np.log(places[:, 1])], axis=1)
    sides = np.ptp(flat, axis=0)
    for row, column in generator.integers(0, CELLS, (200, 2)):
        x = corners[row, column : column + 2, 0].mean()
        y = np.log(corners[row : row + 2, column, 1]).mean()
        away = np.hypot(*((flat - [x, y]) / sides).T)
        assert shown[row, column] == values[np.argmin(away)]
