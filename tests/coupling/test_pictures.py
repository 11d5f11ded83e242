"""The picture of a run: when there is a window, what is marked, what the axes show; and nothing that is not there."""

import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from common import Unit, quantity_text, range_text, unit_for
from coupling.case import ActuatorCase, Case, ConstantCase, CoulombCase, PartCase, RunCase
from coupling.display.mesh import display_mesh
from coupling.display.surface import deflections, most_deflected
from coupling.drives import build_drives
from coupling.margins import Margin, Margins
from coupling.pictures.figure import put_keys
from coupling.pictures.plate import (
    BOTH_WAYS,
    MAX_LENGTHS,
    MIN_LENGTHS,
    UPWARDS,
    PlateView,
    Relief,
    Scale,
    draw_plate,
    path_window,
)
from coupling.pictures.portrait import chosen_drives, cycles_of, decisive_moment, portrait_of
from coupling.pictures.run import _spans, compose
from coupling.pictures.time import Curves, draw_over_time, limits, margins_over_time, strokes_of
from coupling.run import run_case
from fem_plate import Plate, PlateSection
from fem_plate import pictures as plate_pictures
from fem_plate.pictures import FEW, marker_size
from meshes import disc
from particle import Drive, Samples, State, shade

BOX = np.array([[-50.0, -50.0], [50.0, 50.0]])
DISC = {"shape": "disc", "radius": 3e-4, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 2e-5}


def straight(length, middle=(10.0, 10.0)):
    return np.array(middle) + length * np.array([[-0.5, -0.1], [0.5, 0.1]])


def lattice(n, pitch=1.0):
    side = pitch * (np.arange(n) - (n - 1) / 2)
    return np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)


@pytest.mark.parametrize(
    ("length", "times"), [(0.15, MAX_LENGTHS), (0.7, 2.2 / 0.7), (5.0, MIN_LENGTHS), (16.0, MIN_LENGTHS)]
)
def test_a_short_path_has_a_window_of_a_few_lengths_or_two_pitches(length, times):
    window = path_window(straight(length), BOX, lattice(100))
    assert np.ptp(window, axis=0) == pytest.approx([times * length] * 2)
    assert window.mean(axis=0) == pytest.approx([10.0, 10.0])


@pytest.mark.parametrize("length", [0.0, 0.09, 17.0, 80.0])
def test_a_long_path_and_one_that_is_a_point_have_none(length):
    assert path_window(straight(length), BOX, lattice(100)) is None


@pytest.mark.parametrize("actuators", [lattice(1), lattice(2, 1e-6), lattice(2, 1e3)])
def test_any_actuators_leave_the_path_visible_in_a_window_smaller_than_the_plate(actuators):
    for length in np.geomspace(0.11, 16, 9):
        side = np.ptp(path_window(straight(length), BOX, actuators), axis=0).max()
        assert length <= side / MIN_LENGTHS * (1 + 1e-9) and side <= min(MAX_LENGTHS * length, 0.42 * 100) * (1 + 1e-9)


def test_markers_shrink_with_the_pitch_and_go_before_they_merge():
    frame = np.array([[-1.0, -1.0], [1.0, 1.0]])
    sizes = [marker_size(lattice(n, 2 / n), frame) for n in (2, 10, 40, 100)]
    assert sizes[0] >= sizes[1] > sizes[2] > sizes[3] == 0
    assert all(0 < size <= 0.5 * 330 / n for size, n in zip(sizes, (2, 10, 40), strict=False))
    assert marker_size(np.stack([np.linspace(-1, 1, 100), np.zeros(100)], axis=1), frame) == 0  # a row
    assert marker_size(np.zeros((FEW, 2)), frame) > 0


@pytest.mark.parametrize(
    ("largest", "name", "number"),
    [
        (0.0, "µm", 0),
        (1e-13, "µm", 1e-7),
        (8e-11, "pm", 80),
        (2.6e-6, "µm", 2.6),
        (1e-3, "mm", 1),
        (0.05, "mm", 50),
        (4, "m", 4),
        (1500, "km", 1.5),
        (1.69e11, "Gm", 169),
    ],
)
def test_numbers_have_a_prefix_of_their_size(largest, name, number):
    unit = unit_for(np.array([-largest, largest / 2]), "m")
    assert unit.name == name
    assert largest * unit.per_si == pytest.approx(number, abs=1e-12)


def test_a_quantity_is_written_with_its_unit():
    assert quantity_text(1.2345e-5, "m") == "12.3 µm"
    assert quantity_text(0.2512, "s", 2) == "250 ms"
    assert quantity_text(0.0, "N") == "0 N" and quantity_text(0.0, "m") == "0 µm"
    assert quantity_text(1704.0, "Hz", 4) == "1.704 kHz" and quantity_text(np.inf, "Hz") == "inf Hz"
    assert range_text(69.9, 2500.0, "Hz") == "69.9 Hz to 2.5 kHz" and range_text(1, 2, "s", word="and") == "1 and 2 s"


def test_limits_hold_zero_and_every_value_and_are_never_empty():
    for values in ([0.0, 0.0], [3.0, 5.0], [-5.0, -3.0], [-1.0, 4.0], [1e-17]):
        low, high = limits(np.array(values))
        assert low < min(0, *values) and high > max(0, *values)
        assert high - low < 1.2 * max(np.ptp([0, *values]), 1.0)


def test_heights_below_zero_have_a_colour_of_their_own_and_zero_is_white_where_they_matter():
    up, both = Scale.of(np.array([-1e-8, 1e-5])), Scale.of(np.array([-2e-6, 1e-5]))
    assert up.colours is UPWARDS and both.colours is BOTH_WAYS
    for scale in (up, both):
        assert scale.colours(scale.norm(0.0))[:3] == pytest.approx((1, 1, 1), abs=0.01)
        assert scale.norm(10.0) == pytest.approx(1)
    assert min(both.colours(both.norm(-2.0))[:3]) < 0.95
    assert Scale.of(np.zeros(3)).colours is UPWARDS


def test_the_moment_shown_is_the_first_of_the_most():
    assert most_deflected(np.array([0.0, 1.0, 4.0, 2.0, 4.0])) == 2
    assert most_deflected(np.array([0.0, 1.0, 3.9999, 2.0, 4.0])) == 2
    assert most_deflected(np.array([0.0, 3.9, 4.0])) == 2
    assert most_deflected(np.zeros(5)) == 0


def drawn(case, tmp_path):
    """The figure of a run, drawn, with warnings as errors."""
    result = run_case(case, tmp_path)
    figure = Figure()
    canvas = FigureCanvasAgg(figure)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        compose(figure, portrait_of(result))
        canvas.draw()
    return figure


def texts(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def plate_case(duration=1e-3, limit=1e-9, strokes=(5e-5, 4e-5)):
    return Case(
        plate=DISC,
        actuators=[
            ActuatorCase(position=(x, 0.0), stroke=stroke, frequency=700.0)
            for x, stroke in zip((-1e-4, 1e-4), strokes, strict=True)
        ],
        part=PartCase(mass=2e-9, position=(-1.8e-4, 4e-5)),
        friction=ConstantCase(limit=limit),
        run=RunCase(duration=duration),
        name="small",
    )


@pytest.mark.slow
@pytest.mark.compiled
def test_a_short_path_is_drawn_in_a_window_with_keys_for_what_is_there(tmp_path):
    figure = drawn(plate_case(), tmp_path)
    assert figure.axes[0].get_title() == "The plate at 0.6869 ms, when it is deflected most"
    assert figure.axes[1].get_title() == "Around the path, also at 0.6869 ms"
    assert texts(figure)[:1] == ["path"] and "actuator" in texts(figure) and "in flight" not in texts(figure)
    map_axes, window = figure.axes[:2]
    path = next(line for line in window.lines if line.get_label() == "path").get_xydata()
    low, high = np.transpose([window.get_xlim(), window.get_ylim()])
    assert (path > low).all() and (path < high).all()
    assert np.ptp(path, axis=0).max() > (high - low).max() / (1.01 * MAX_LENGTHS)
    assert np.ptp(map_axes.get_xlim()) > 600  # µm: all of the plate
    start = next(line for line in window.lines if line.get_label() == "start")
    assert start.get_markerfacecolor() == "none"


@pytest.mark.slow
@pytest.mark.compiled
@pytest.mark.parametrize("case", [plate_case(2.6e-6, 1e-3), plate_case(strokes=(0.0, 0.0))])
def test_a_part_at_rest_is_a_point_on_the_map_with_axes_that_can_be_read(case, tmp_path):
    figure = drawn(case, tmp_path)
    assert texts(figure) == ["the part, which stays where it is", "actuator", "stuck"]
    panel = next(axes for axes in figure.axes if axes.get_ylabel().startswith("speed"))
    assert panel.get_yticks().tolist() == [0] and panel.get_ylim()[0] > -0.1
    assert panel.get_xlabel() == ("time [µs]" if case.run.duration < 1e-5 else "time [ms]")
    assert not any(axis.get_offset_text().get_text() for axes in figure.axes for axis in (axes.xaxis, axes.yaxis))


@pytest.mark.slow
@pytest.mark.compiled
def test_a_run_that_slips_has_strokes_and_margins_over_time_and_a_line_where_it_was_lost(tmp_path):
    case = plate_case(3e-3, 4e-9)
    lost = case.vary({"friction": CoulombCase(coefficient=0.4, adhesion=1e-7)})
    result = run_case(lost)
    assert result.summary.outcome == "detached"
    found = portrait_of(result)
    off = result.trajectory.events[-1]
    assert found.decisive == off.time and found.why == "when it is lost"
    assert list(found.drives) == ["actuator 0", "actuator 1"]
    strokes = strokes_of(found)
    assert strokes.values["actuator 1"] == pytest.approx(
        result.scene.lifts[1].evaluate(found.samples.time)[0], rel=1e-9, abs=1e-15
    )
    margins = margins_over_time(found)
    assert margins.marked == 1.0 and np.nanmin(margins.right.values["distance from coming off"]) < 0.05
    figure = drawn(lost, tmp_path)
    assert "comes off" in texts(figure)
    notes = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert any(text.startswith("comes off at") for text in notes)
    panels = [axes for axes in figure.axes if axes.get_ylabel().startswith(("height", "pull", "friction", "speed"))]
    assert len(panels) == 4
    per_second = off.time / panels[0].get_xlim()[1]
    for axes in panels:
        assert any(
            line.get_xdata() == pytest.approx([off.time / per_second] * 2) and line.get_linestyle() == "--"
            for line in axes.lines
            if len(line.get_xdata()) == 2
        )


def test_the_close_up_has_six_cycles_of_the_fastest_drive_also_where_it_stops_early():
    drive = Drive(1e-6, 1000.0, cycles=40)
    samples = SimpleNamespace(time=np.linspace(0, 0.2, 8001))
    given = {"drives": {"actuator 0": drive}, "base": (), "cycles": cycles_of([drive])}
    whole, part = _spans(SimpleNamespace(samples=samples, decisive=0.01, **given))
    assert whole == (0.0, 0.2) and part == pytest.approx((0.007, 0.013))
    assert _spans(SimpleNamespace(samples=samples, decisive=0.2, **given))[1] == pytest.approx((0.194, 0.2))


def test_a_curve_that_is_mostly_steady_is_drawn_as_its_line_and_not_as_a_band():
    axes = Figure(figsize=(10.0, 2.0)).add_axes((0.0, 0.0, 1.0, 1.0))
    rows = Samples(*(np.zeros(2) for _ in Samples._fields))._replace(time=np.array([0.0, 1.0]))
    times = np.linspace(0, 1, 40_001)
    for share, bands in ((0.01, 0), (0.2, 1)):  # of the step that it makes halfway
        axes.clear()
        curves = Curves("speed", "m/s", {"": (times > 0.5) + share / 2 * np.sin(2 * np.pi * 950 * times)}, times)
        assert len(draw_over_time(axes, rows, curves, Unit("s", 1.0), cycles=[1 / 950])) == bands
        assert bool(axes.lines[0].get_xdata().size) == (not bands)


@pytest.mark.slow
@pytest.mark.compiled
def test_of_many_cycles_all_and_some_around_the_first_slip_are_drawn_and_curves_that_crowd_are_bands(tmp_path):
    figure = drawn(plate_case(0.15), tmp_path)
    title = next(axes.get_title() for axes in figure.axes if axes.get_title().startswith("Around 0"))
    assert title.endswith("when it first slips")
    heights = [axes for axes in figure.axes if axes.get_legend() and axes.get_subplotspec() is not None]
    whole, part = heights[:1][0], heights[-1]
    assert whole.get_xlim() == pytest.approx((0, 150)) and np.ptp(part.get_xlim()) == pytest.approx(6 / 0.7, rel=0.03)
    assert len(whole.collections) > len(part.collections) - 1 and whole.collections[0].get_paths()
    for band in whole.collections[:2]:
        y = band.get_paths()[0].vertices[:, 1]
        assert y.min() >= -1e-9 and y.max() <= 50 * (1 + 1e-9)


@pytest.mark.parametrize(("width", "lines"), [(7.6, 2), (3.3, 4), (14.0, 1)])
def test_keys_fit_their_picture(width, lines):
    names = ("path", "rests here", "start", "end", "actuator", "slips", "stops", "stuck", "path")
    figure = Figure(figsize=(width, 4.0))
    FigureCanvasAgg(figure)
    put_keys(figure, [Line2D([], [], label=name) for name in names])
    legend = figure.legends[0]
    figure.draw_without_rendering()
    box, texts = legend.get_window_extent(), legend.get_texts()
    assert sorted(text.get_text() for text in texts) == sorted({*names}) and len(figure.legends) == 1
    assert box.x0 >= 0 and box.x1 <= figure.bbox.x1
    assert len({round(text.get_window_extent().y0 / 5) for text in texts}) == lines


def test_a_curve_is_followed_while_two_points_lie_between_its_turns():
    axes = Figure(figsize=(10.0, 2.0)).add_axes((0.0, 0.0, 1.0, 1.0))  # 720 points
    rows = Samples(*(np.zeros(2) for _ in Samples._fields))._replace(time=np.array([0.0, 1.0]))
    times = np.linspace(0, 1, 40_001)
    for cycles, bands in ((170, 0), (190, 1)):
        axes.clear()
        curves = Curves("speed", "m/s", {"": np.sin(2 * np.pi * cycles * times)}, times)
        draw_over_time(axes, rows, curves, Unit("s", 1.0))
        followed = [line for line in axes.get_lines() if len(line.get_xdata()) == len(times)]
        edged = [one for one in axes.collections if any(len(path.vertices) > 1000 for path in one.get_paths())]
        assert (len(followed), len(edged)) == (1 - bands, bands)


def test_steps_of_a_band_are_whole_cycles_so_that_a_steady_motion_has_a_level_band():
    axes = Figure(figsize=(10.0, 2.0)).add_axes((0.0, 0.0, 1.0, 1.0))  # 720 points
    rows = Samples(*(np.zeros(2) for _ in Samples._fields))._replace(time=np.array([0.0, 1.0]))
    times = np.linspace(0, 1, 40_001)
    for cycles, text in (((1 / 190,), "each cycle"), ((1 / 950, 1 / 190, 0.4), "each cycle of the slowest drive")):
        axes.clear()
        values = sum(np.sin(2 * np.pi * times / cycle) for cycle in cycles if cycle < 0.1)
        (key,) = draw_over_time(axes, rows, Curves("speed", "m/s", {"": values}, times), Unit("s", 1.0), cycles=cycles)
        assert key.get_label() == f"lowest to highest in {text}, 5.26 ms"
        band = max((path.vertices for one in axes.collections for path in one.get_paths()), key=len)
        assert np.diff(np.unique(band[:, 0]))[:-1] == pytest.approx(1 / 190)
        top = band[band[:, 1] > 0, 1]
        assert np.ptp(top) < 0.02 * top.max()


def test_of_many_actuators_those_are_drawn_that_the_margins_name():
    case = plate_case()
    many = case.model_copy(update={"actuators": case.actuators * 4})
    lifts = build_drives(many)
    named = Margin(0.5, 1e-3, (0.0, 0.0), 5)
    margins = Margins(named, None, None, 1.0, 0.0)
    assert list(chosen_drives(many, lifts, margins)) == ["actuator 5"]
    nameless = Margins(Margin(0.5, 1e-3, (0.0, 0.0), None), None, None, 1.0, 0.0)
    assert list(chosen_drives(many, lifts, nameless)) == ["actuator 0"]  # the nearest to the start
    assert decisive_moment([], margins) == 1e-3


HEIGHTS = np.array([2e-6, -1e-6])


def small_plate():
    """The shapes of its actuators, and what pictures show of it."""
    plate = Plate(disc(3e-4, 1e-4), PlateSection(169e9, 0.3, 2e-5, 2330.0))
    shapes = plate.influence([(-1e-4, 0.0), (1e-4, 0.0)])
    points, triangles = display_mesh(plate.mesh, shapes.points)
    relief = Relief(
        points, triangles, deflections(shapes, points)(HEIGHTS[None])[0], lambda xy: shapes.evaluate(xy, HEIGHTS)[0]
    )
    return shapes, PlateView(shapes.outline, shapes.points, relief)


def test_the_fine_piece_covers_the_plate_and_is_that_of_the_shapes():
    shapes, view = small_plate()
    relief, frame = view.relief, view.outline.box
    for piece, error in ((relief, 1e-15), (replace(relief, exact=None), 1e-8)):
        xy, cells, w = piece.within(frame)
        assert len(cells) >= 4 * len(relief.triangles)
        inside = np.hypot(*xy.T) < 2.9e-4
        assert w[inside] == pytest.approx(shapes.evaluate(xy[inside], HEIGHTS)[0], abs=error)
    a, b, c = np.moveaxis(xy[cells], 1, 0)
    (p, q), (r, s) = (b - a).T, (c - a).T
    assert np.abs(p * s - q * r).sum() / 2 == pytest.approx(np.pi * 9e-8, rel=3e-3)
    window = np.array([[0.0, 0.0], [5e-5, 5e-5]])
    xy, cells, _ = relief.within(window)
    longest = np.hypot(*(xy[cells] - xy[np.roll(cells, 1, axis=1)]).reshape(-1, 2).T).max()
    assert longest < 5e-5 / 25 and xy.min() > -5e-5 and xy.max() < 1e-4
    figure = Figure()
    axes, unit = list(figure.subplots(1, 2)), unit_for(window, "m")
    keys = draw_plate(axes[0], view, unit)
    assert not draw_plate(axes[1], view, unit, window)  # both stand outside of the window
    FigureCanvasAgg(figure).draw()
    assert [key.get_label() for key in keys] == ["actuator"]
    assert np.transpose([axes[1].get_xlim(), axes[1].get_ylim()]) == pytest.approx(window * 1e6)
    assert 0 in figure.axes[2].get_yticks()
    assert sum(line.get_xdata().size for line in axes[1].lines) == 0


def test_a_map_whose_lines_would_merge_is_shaded_and_its_bar_ends_where_the_heights_do(monkeypatch):
    _, view = small_plate()
    monkeypatch.setattr(plate_pictures, "FEW", 1)
    figure = Figure()
    # So narrow that the lines would merge, as would the markers.
    keys = draw_plate(figure.subplots(), view, unit_for(view.outline.box, "m"), width=1.0)
    FigureCanvasAgg(figure).draw()
    low, high = figure.axes[1].get_ylim()
    assert -1.3 < low <= -1 + 1e-12 and 2 - 1e-12 <= high < 2.5
    assert [key.get_label() for key in keys] == ["2 actuators, not marked"]


@pytest.mark.parametrize("count", [1, 3, 404])
def test_rests_shorter_than_a_pixel_shade_by_their_share_of_the_time(count):
    """Moved to whole pixels each, they shaded some times fully and others not at all."""
    rows = SimpleNamespace(time=np.linspace(0.0, 1.0, 2 * count + 1), state=np.full(2 * count + 1, State.SLIP))
    rows.state[::2] = State.STICK
    figure = Figure(figsize=(4, 1), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.axis("off")
    shade(axes, rows)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    dark = 1 - np.asarray(canvas.buffer_rgba())[50, :, 0] / 255
    full = 0.18 * (1 - 0x1B / 0xFF)  # as dark as all of it at rest, in red
    assert dark.mean() == pytest.approx(full / 2, rel=0.1)
    blocks = dark.reshape(-1, 20).mean(axis=1)  # of twenty pixels each
    assert count < 400 or np.ptp(blocks) < 0.2 * full
