"""Pictures of aims: a path that is short beside its plate gets a window."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from active_surface.steering import Aimed, Task, picture
from active_surface.steering.scatter import Scatter
from coupling import read_case
from particle import ConstantFriction, Micropart, platform_surface, simulate

CASE = Path(__file__).parents[3] / "examples/aims/thick_plate.toml"
START = (260e-6, 230e-6)
LIMIT = 2e-9  # N: with 2e-9 kg a deceleration of 1 m/s^2


def drawn(monkeypatch, tmp_path, way):
    """The figure of a part that slides along x for a way [m] to its target."""
    case = read_case(CASE)
    target = (START[0] + way, START[1])
    part = Micropart(2e-9, START, velocity=(np.sqrt(2 * way), 0.0))
    path = simulate(platform_surface(size=1e-3), part, ConstantFriction(LIMIT), 0.1)
    assert path.position[-1] == pytest.approx(target, rel=1e-6)
    scatter = Scatter(path.position[-1:].repeat(9, axis=0) + 1e-6 * np.eye(9, 2), np.full(9, 1e-6))
    found = Aimed(case=case, trajectory=path, paths=1, scatter=scatter, task=Task(case, target), legs=())
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
    corners = plate.patches[-1].get_bbox().get_points() * 1e3  # um
    assert corners[:, 0] == pytest.approx(window.get_xlim()) and corners[:, 1] == pytest.approx(window.get_ylim())


def test_a_long_path_is_drawn_over_the_plate(monkeypatch, tmp_path):
    (plate, _), _ = drawn(monkeypatch, tmp_path, 900e-6)
    assert "path" in [line.get_label() for line in plate.lines]
