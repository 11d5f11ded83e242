"""Pictures of aims: a path that is short beside its plate gets a window, and no words lie over others or lines."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import ConnectionPatch, Rectangle

from active_surface.steering import Aimed, Task, picture
from active_surface.steering.robustness import Scatter
from coupling import read_case
from particle import ConstantFriction, Micropart, platform_surface, simulate

EXAMPLES = Path(__file__).parents[3] / "examples"
CASE = EXAMPLES / "aims/thick_plate.toml"
START = (260e-6, 230e-6)
LIMIT = 2e-9  # N: with 2e-9 kg a deceleration of 1 m/s^2


def drawn(monkeypatch, tmp_path, way, case=CASE, name="", lost=0):
    """The axes of the figure of a part that slides along x for a way [m] to its target, and the target.

    lost: of nine disturbed runs, in which it comes off at its start.
    """
    case = read_case(case)
    start = case.part.position
    target = (start[0] + way, start[1])
    part = Micropart(2e-9, start, velocity=(np.sqrt(2 * way), 0.0))
    path = simulate(platform_surface(size=1e-3), part, ConstantFriction(LIMIT), 0.1)
    assert path.position[-1] == pytest.approx(target, rel=1e-6)
    scatter = Scatter(path.position[-1:].repeat(9, axis=0) + 1e-6 * np.eye(9, 2), np.full(9, 1e-6))
    scatter.ends[:lost], scatter.distance[:lost] = start, np.inf
    found = Aimed(case=case, trajectory=path, paths=1, scatter=scatter, task=Task(case, target, name=name), legs=())
    figures = []
    monkeypatch.setattr(picture, "save_picture", lambda figure, path: figures.append(figure))
    picture.draw_aim(found, tmp_path / "aim.png")
    FigureCanvasAgg(figures[0]).draw()
    return figures[0].axes, target


def test_a_short_path_is_drawn_in_a_window_beside_the_plate(monkeypatch, tmp_path):
    (plate, window, ends), target = drawn(monkeypatch, tmp_path, 50e-6)
    assert "Around the path" in window.get_title() and "disturbed runs" in ends.get_title()
    assert plate.get_xlim()[1] > 2.0 and np.ptp(window.get_xlim()) == pytest.approx(
        200.0
    )  # mm; um, four times the path
    assert np.mean(window.get_xlim()) == pytest.approx(1e6 * (START[0] + target[0]) / 2)
    lines = [line.get_label() for line in plate.lines]
    assert "path" not in lines and "path" in [line.get_label() for line in window.lines]
    (frame,) = [patch for patch in plate.patches if isinstance(patch, Rectangle)]
    joints = [patch.zorder for patch in plate.patches if isinstance(patch, ConnectionPatch)]
    assert len(joints) == 2 and plate.title.get_bbox_patch() and plate.title.zorder > max(joints)  # it is legible
    corners = frame.get_bbox().get_points() * 1e3  # um
    assert corners[:, 0] == pytest.approx(window.get_xlim()) and corners[:, 1] == pytest.approx(window.get_ylim())
    (_, window, _), _ = drawn(monkeypatch, tmp_path, 41e-6, EXAMPLES / "device.toml")
    assert 0 < window.get_ylim()[1] < 3 and not window.texts  # um: no room for the mark of actuator 4, nor its number


def test_lost_parts_are_counted_and_leave_the_frame_to_the_others(monkeypatch, tmp_path):
    (*_, all_there), _ = drawn(monkeypatch, tmp_path, 50e-6)
    (*_, ends), _ = drawn(monkeypatch, tmp_path, 50e-6, lost=4)
    assert ends.get_title() == "Where 9 disturbed runs end; 4 are lost"
    assert len(ends.lines[0].get_xdata()) == 5 and np.ptp(ends.get_xlim()) <= 1.5 * np.ptp(all_there.get_xlim())
    (*_, ends), _ = drawn(monkeypatch, tmp_path, 50e-6, lost=9)
    assert len(ends.lines[0].get_xdata()) == 9


def test_a_long_path_is_drawn_over_the_plate(monkeypatch, tmp_path):
    (plate, _), _ = drawn(monkeypatch, tmp_path, 900e-6)
    assert "path" in [line.get_label() for line in plate.lines]


@pytest.mark.parametrize(
    ("case", "way"), [("aims/thick_plate", 50e-6), ("array_10x10", 50e-6), ("array_10x10", 400e-6)]
)
def test_words_are_clear_of_each_other_and_numbers_of_lines(monkeypatch, tmp_path, case, way):
    axes, _ = drawn(monkeypatch, tmp_path, way, EXAMPLES / f"{case}.toml")
    figure = axes[0].figure
    line = 10 / 72 * figure.dpi  # pixels, of an axis label or the title of a panel
    legend = figure.legends[0].get_window_extent()
    for one in axes:
        assert figure._suptitle.get_window_extent().y0 > one.title.get_window_extent().y1 + line / 2
        assert legend.y1 < one.xaxis.label.get_window_extent().y0 - line / 2
    for one in axes[:-1]:
        boxes = [text.get_window_extent() for text in one.texts]
        assert not any(box.count_overlaps(boxes[:k]) for k, box in enumerate(boxes))
        curves = [line for line in one.lines if line.get_linestyle() != "None"]
        curves += one.patches  # the window, and what joins it to its panel
        paths = [curve.get_transform().transform_path(curve.get_path()) for curve in curves]
        assert not any(path.intersects_bbox(box, filled=False) for path in paths for box in boxes)
    assert len(axes[0].texts) == len(read_case(EXAMPLES / f"{case}.toml").actuators)


def test_a_long_name_is_a_title_of_several_lines(monkeypatch, tmp_path):
    axes, _ = drawn(monkeypatch, tmp_path, 900e-6, name="W" * 200)
    title = axes[0].figure._suptitle.get_window_extent()
    assert title.x0 > 0 and title.x1 < axes[0].figure.bbox.x1 and title.y0 > axes[0].title.get_window_extent().y1
