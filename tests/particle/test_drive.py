"""Drives: quintic strokes 10 s^3 - 15 s^4 + 6 s^5, their breakpoints, and what they refuse."""

import math

import numpy as np
import pytest

from particle import Drive
from particle.drives import drive_table, next_breakpoint


def quintic(s):
    return 10 * s**3 - 15 * s**4 + 6 * s**5


DRIVES = {
    "up-down": Drive(150e-6, 300),
    "up": Drive(150e-6, 450, cycle="up"),
    "late": Drive(-40e-6, 250, delay=1.3e-3),
    "two cycles": Drive(80e-6, 500, cycles=2, delay=0.4e-3),
}
TIMES = np.linspace(0, 9e-3, 1001) + 1e-7  # never on a breakpoint


def expected(drive, time):
    """The stroke as the paper describes it, at one time."""
    since = (time - drive.delay) * drive.frequency
    if since < 0:
        return 0.0
    if drive.cycle == "up":
        return drive.stroke * quintic(min(since, 1.0))
    if drive.cycles is not None and since >= drive.cycles:
        return 0.0
    phase = 2 * (since % 1)
    return drive.stroke * (quintic(phase) if phase < 1 else 1 - quintic(phase - 1))


@pytest.mark.parametrize("name", DRIVES)
def test_stroke_is_the_quintic_up_and_down(name):
    drive = DRIVES[name]
    h, _, _ = drive.evaluate(TIMES)
    assert np.abs(h - [expected(drive, t) for t in TIMES]).max() < 2e-14 * abs(drive.stroke)


@pytest.mark.parametrize("name", DRIVES)
def test_velocity_and_acceleration_are_the_derivatives(name):
    drive, step = DRIVES[name], 1e-7
    (before, v_before, _), (_, v, a), (after, v_after, _) = (drive.evaluate(TIMES + k * step) for k in (-1, 0, 1))
    assert np.abs((after - before) / (2 * step) - v).max() < 1e-6 * np.abs(v).max()
    # The third derivative jumps at breakpoints, which a difference across one feels at first order.
    assert np.abs((v_after - v_before) / (2 * step) - a).max() < 2e-3 * np.abs(a).max()


@pytest.mark.parametrize("name", DRIVES)
def test_stroke_velocity_and_acceleration_are_continuous_at_breakpoints(name):
    drive, breakpoints, time = DRIVES[name], [], -1.0
    table = drive_table([drive])
    while (time := next_breakpoint(table, time)) < 9e-3:
        breakpoints.append(time)
    assert breakpoints
    before, after = (drive.evaluate(np.array(breakpoints) + shift) for shift in (-1e-12, 1e-12))
    for one, other, scale in zip(before, after, (1, 1e3, 1e7), strict=True):
        assert np.abs(one - other).max() < 1e-6 * scale * abs(drive.stroke)
    assert np.abs(after[1]).max() < 1e-9 * abs(drive.stroke) * drive.frequency + 1e-9


def test_breakpoints_come_at_delay_half_periods_and_the_last_end():
    table = drive_table([DRIVES["two cycles"], DRIVES["up"]])
    breakpoints, time = [], -1.0
    while (time := next_breakpoint(table, time)) < math.inf:
        breakpoints.append(time)
    assert breakpoints == pytest.approx(sorted([0.4e-3, 1.4e-3, 2.4e-3, 3.4e-3, 4.4e-3, 0.0, 1 / 450]), abs=1e-15)


def test_a_surface_without_drives_has_no_breakpoint():
    assert next_breakpoint(drive_table([]), 0.0) == math.inf


def test_a_stroke_of_up_is_held_for_ever_and_a_counted_one_ends_at_0():
    assert DRIVES["up"].evaluate(1e3)[0] == pytest.approx(150e-6, rel=1e-15)
    h, v, a = DRIVES["two cycles"].evaluate([4.4e-3 + 1e-9, 1.0])
    assert np.abs(h).max() < 1e-20 and not v.any() and not a.any()


def test_values_keep_the_shape_of_the_times():
    for values in DRIVES["up"].evaluate(np.zeros((2, 3))):
        assert values.shape == (2, 3)
    assert DRIVES["up"].evaluate(1e-3)[0].shape == ()


@pytest.mark.parametrize(
    "wrong, says",
    [
        ({"stroke": math.nan}, "stroke"),
        ({"stroke": math.inf}, "stroke"),
        ({"frequency": 0.0}, "frequency"),
        ({"frequency": -1.0}, "frequency"),
        ({"cycle": "down"}, "cycle"),
        ({"cycles": 0}, "cycles"),
        ({"cycles": 1.5}, "cycles"),
        ({"cycle": "up", "cycles": 2}, "cycles"),
        ({"delay": -1e-3}, "delay"),
        ({"delay": math.inf}, "delay"),
    ],
)
def test_a_wrong_field_is_refused_by_name(wrong, says):
    with pytest.raises(ValueError, match=f"^Input {says} of Drive must be [^;]*; got [^;]*$"):
        Drive(**{"stroke": 1e-4, "frequency": 300.0} | wrong)
