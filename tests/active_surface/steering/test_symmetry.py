"""Targets that symmetry keeps a part from are refused, and no others."""

from pathlib import Path

import pytest

from active_surface.steering import Settings, Task
from coupling import read_case

EXAMPLES = Path(__file__).parents[3] / "examples"
NINE = (EXAMPLES / "array_3x3.toml").read_text()
SQUARE = 'shape = "rectangle"\nwidth = "600 um"\nheight = "600 um"\n'
OFF = (2e-5, -4e-5)


def nine(folder, start, *changes):
    text = NINE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "base.toml").write_text(text)
    case = read_case(folder / "base.toml")
    return case.model_copy(update={"part": case.part.model_copy(update={"position": start})})


def refused(case, target, movers):
    try:
        Task(case, target, Settings(actuators=movers))
    except ValueError as error:
        return str(error)
    return ""


def test_those_at_rest_on_both_sides_of_a_line_leave_it_a_line(tmp_path):
    case = nine(tmp_path, (5e-5, 0.0))
    assert "these 3 actuators move the part only along the line" in refused(case, OFF, (1, 4, 7))
    assert not refused(case, (-8e-5, 4e-7), (1, 4, 7))
    assert not refused(case, OFF, (1, 4, 8)) and not refused(case, OFF, (0, 1, 2))
    stiff = [*case.actuators]
    stiff[0] = stiff[0].model_copy(update={"stiffness": 1e3})
    assert not refused(case.model_copy(update={"actuators": tuple(stiff)}), OFF, (1, 4, 7))
    assert not refused(case.model_copy(update={"actuators": case.actuators[:-1]}), OFF, (1, 4, 7))
    assert not refused(nine(tmp_path, (5e-5, 1e-9)), OFF, (1, 4, 7))


@pytest.mark.parametrize(("edges", "kept"), [("clamped", True), ("left", False)])
def test_the_diagonals_of_a_square_are_such_lines(tmp_path, edges, kept):
    supports = 'supports = "clamped"' if kept else 'supports = { left = "clamped", right = "simply-supported" }'
    changes = [('shape = "disc"\nradius = "300 um"\n', SQUARE), ('supports = "clamped"', supports)]
    case = nine(tmp_path, (5e-5, -5e-5), *changes)
    assert ("at 135 degrees" in refused(case, OFF, (2, 4, 6))) == kept
    assert ("at 45 degrees" in refused(nine(tmp_path, (5e-5, 5e-5), *changes), OFF, (0, 4, 8))) == kept
    wide = [(changes[0][0], SQUARE.replace('width = "600', 'width = "700')), *changes[1:]]
    assert not refused(nine(tmp_path, (5e-5, -5e-5), *wide), OFF, (2, 4, 6))


def test_an_ellipse_of_equal_axes_is_a_disc(tmp_path):
    circle = 'shape = "ellipse"\nsemi_axis_x = "300 um"\nsemi_axis_y = "300 um"\n'
    changed = ('shape = "disc"\nradius = "300 um"\n', circle)
    start = (4e-5, -4e-5)
    assert "at 135 degrees" in refused(nine(tmp_path, start, changed), OFF, (2, 4, 6))
    flat = (changed[0], circle.replace('y = "300', 'y = "290'))
    assert not refused(nine(tmp_path, start, flat), OFF, (2, 4, 6))


def test_nothing_moves_a_part_that_stands_on_the_only_actuator_that_moves(tmp_path):
    case = nine(tmp_path, (0.0, 0.0))
    assert "cannot be reached: nothing moves the part" in refused(case, (0.0, 1e-5), (4,))
    assert not refused(case, (0.0, 4e-5), (3, 4))
    assert "along the line" in refused(case, OFF, (3, 4))


def test_a_push_along_the_line_may_be_rounded(tmp_path):
    case = nine(tmp_path, (4e-5, -4e-5))
    tilted = case.model_copy(update={"run": case.run.model_copy(update={"gravity": (0.1, -0.1 * (1 + 1e-15), -9.8)})})
    assert "at 135 degrees" in refused(tilted, OFF, (2, 4, 6))
    tilted = case.model_copy(update={"run": case.run.model_copy(update={"gravity": (0.1, -0.11, -9.8)})})
    assert not refused(tilted, OFF, (2, 4, 6))


def test_a_target_where_the_part_is_already_is_refused_unless_the_part_moves(tmp_path):
    case = nine(tmp_path, (5e-5, 0.0))
    said = refused(case, (5.04e-5, 0.0), (1, 4, 8))
    assert said == (
        "target must be farther from the part than the tolerance, 0.5 um; "
        "got a point 0.4 um from where it starts: it is there already"
    )
    assert not refused(case, (5.06e-5, 0.0), (1, 4, 8))
    moving = case.part.model_copy(update={"velocity": (1e-3, 0.0)})
    assert not refused(case.model_copy(update={"part": moving}), (5.04e-5, 0.0), (1, 4, 8))


@pytest.mark.parametrize(
    ("wafer", "angle", "kept"), [("110", 20, False), ("110", 0, True), ("100", 45, True), ("111", 20, True)]
)
def test_a_wafer_keeps_a_part_on_its_own_lines_of_symmetry(tmp_path, wafer, angle, kept):
    isotropic = 'youngs_modulus = "169 GPa"\npoisson_ratio = 0.3\n'
    changes = [(isotropic, f'wafer = "{wafer}"\nwafer_angle = "{angle} deg"\n')]
    case = nine(tmp_path, (5e-5, 0.0), *changes)
    assert ("these 3 actuators move the part only along the line" in refused(case, OFF, (1, 4, 7))) == kept
