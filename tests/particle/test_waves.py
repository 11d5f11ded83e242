"""Waves: drives with a phase and a ramp against their formulas, what jumps, and where they begin and end."""

import math

import numpy as np
import pytest

from particle import Drive
from particle.drives import drive_table, horizon, next_breakpoint
from particle.drives.table import Segments

F, STROKE = 700.0, 2.0
PHASES = [0.0, math.pi / 2, -2.5]
RAMPS = [(0, None), (0, 3), (3, None), (0.37, None), (2.5, 7), (0.01, None), (1.5, 3), (0.3, 1), (1.1, 5)]
TURN = 2 * math.pi


def smooth(s):
    """The ramp's factor and its derivatives."""
    s = np.clip(s, 0, 1)
    return 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * s**2 * (1 - s) ** 2, 60 * s - 180 * s**2 + 120 * s**3


def expected(drive, time):
    """Height, velocity and acceleration of a sine or cosine, as the documents describe them."""
    end = math.inf if drive.cycles is None else drive.cycles
    u = np.clip((time - drive.delay) * drive.frequency, 0, end)
    angle = TURN * u + drive.phase
    s, c = np.sin(angle), np.cos(angle)
    wave = (s, TURN * c, -(TURN**2) * s)
    if drive.cycle == "cosine":
        wave = (0.5 - 0.5 * c, 0.5 * TURN * s, 0.5 * TURN**2 * c)
    a = [np.ones_like(u), np.zeros_like(u), np.zeros_like(u)]
    if drive.ramp:
        up = smooth(u / drive.ramp)
        down = smooth((end - u) / drive.ramp)
        signs = (1, -1, 1)
        grows = u < drive.ramp
        a = [np.where(grows, up[k], signs[k] * down[k]) / drive.ramp**k for k in range(3)]
    h = a[0] * wave[0]
    v = a[1] * wave[0] + a[0] * wave[1]
    b = a[2] * wave[0] + 2 * a[1] * wave[1] + a[0] * wave[2]
    rests = (time < drive.delay) | (u >= end)
    v, b = np.where(rests, 0, v), np.where(rests, 0, b)
    return drive.stroke * h, drive.stroke * v * drive.frequency, drive.stroke * b * drive.frequency**2


# Each pair of values of two fields once.
WAVES = [
    (cycle, PHASES[(k + j) % 3], ramp, cycles, (0.0, 1.3e-3)[(k // 3 + j) % 2])
    for j, cycle in enumerate(("sine", "cosine"))
    for k, (ramp, cycles) in enumerate(RAMPS)
]


@pytest.mark.parametrize(("cycle", "phase", "ramp", "cycles", "delay"), WAVES)
def test_a_wave_is_its_formula_with_two_derivatives(cycle, phase, ramp, cycles, delay):
    drive = Drive(STROKE, F, cycle, cycles, delay, phase=phase, ramp=ramp)
    time = np.linspace(0, 9 / F, 401) + 1e-9
    found, truth = drive.evaluate(time), expected(drive, time)
    least = min(1.0, ramp or 1.0)  # cycles: a short ramp has large derivatives
    assert drive.error == Drive(STROKE, F, cycle).error
    assert np.abs(found[0] - truth[0]).max() <= (1.02 * drive.error + 4e-15) * STROKE
    assert np.abs(found[1] - truth[1]).max() <= 1e-10 * STROKE * TURN * F / least
    assert np.abs(found[2] - truth[2]).max() <= 1e-8 * STROKE * (TURN * F / least) ** 2


@pytest.mark.parametrize(("cycle", "phase", "ramp", "cycles", "_"), [wave for wave in WAVES if wave[2]])
def test_with_a_ramp_velocity_and_acceleration_are_continuous_everywhere(cycle, phase, ramp, cycles, _):
    drive = Drive(STROKE, F, cycle, cycles, 1e-3, phase=phase, ramp=ramp)
    table = drive_table([drive])
    assert not table.jump.any()
    assert table.rough[0] > 0
    time, edges = -1.0, []
    while (time := next_breakpoint(table, time)) < 1e-3 + 9 / F:
        edges.append(time)
    # What a jump would be, beside what changes smoothly within the time between.
    apart = 1e-9 / F
    before, after = (drive.evaluate(np.array(edges) + sign * apart) for sign in (-1, 1))
    least = min(1.0, ramp)
    for k in range(3):
        assert np.abs(after[k] - before[k]).max() <= 1e-5 * STROKE * (TURN * F / least) ** k
    assert [values[0] for values in before] == [0, 0, 0]
    if cycles:
        assert edges[-1] == pytest.approx(1e-3 + cycles / F, rel=1e-14)
        assert np.abs(after[0][-1]) < 1e-15 and after[1][-1] == after[2][-1] == 0


@pytest.mark.parametrize(
    ("cycle", "phase", "begins"),
    [
        ("sine", 0.0, (True, False)),
        ("sine", math.pi / 2, (False, True)),
        ("sine", 1.0, (True, True)),
        ("cosine", 0.0, (False, True)),
        ("cosine", math.pi / 2, (True, False)),
        ("cosine", 1.0, (True, True)),
        ("up-down", 0.0, (False, False)),
        ("up-down", math.pi, (False, False)),
        ("up-down", 1.0, (True, True)),
        ("up-down", math.pi / 2, (True, False)),
    ],
)
def test_what_jumps_is_what_differs_from_rest_at_the_start_or_the_end(cycle, phase, begins):
    steady = Drive(1e-6, F, cycle, phase=phase)
    late, counted = Drive(1e-6, F, cycle, delay=1e-3, phase=phase), Drive(1e-6, F, cycle, 3, phase=phase)
    table = drive_table([steady, late, counted])
    assert (table.jump[0] == 0).all()  # it has been running all the time
    assert tuple(table.jump[1] > 0) == tuple(table.jump[2] > 0) == begins
    _, v, a = steady.evaluate(0.0)
    if begins[0]:
        assert table.jump[1:, 0] == pytest.approx(abs(float(v)), rel=1e-9)
    if begins[1] and cycle != "up-down":
        assert table.jump[1:, 1] == pytest.approx(abs(float(a)), rel=1e-7)


@pytest.mark.parametrize(
    ("phase", "dwell", "cycles"),
    [
        (0.0, 0.3e-3, None),
        (0.4, 0.3e-3, 1),
        (math.pi, 0.0, 5),
        (4.0, 0.3e-3, 5),
        (-0.1, 0.0, 1),
        (1e-14, 0.3e-3, 1),
        (2 * math.pi - 1e-14, 0.0, None),
        (9.0, 0.3e-3, None),
    ],
)
def test_up_down_begins_in_the_middle_and_ends_there(phase, dwell, cycles):
    plain = Drive(STROKE, F, dwell=dwell)
    drive = Drive(STROKE, F, cycles=cycles, dwell=dwell, delay=1e-3, phase=phase)
    period = 1 / F + 2 * dwell
    ahead = phase / TURN % 1 * period
    end = math.inf if cycles is None else cycles * period
    since = np.linspace(-0.5, 6.51, 311) * period
    found, truth = drive.evaluate(1e-3 + since), plain.evaluate(np.clip(since, 0, end) + ahead)
    rests = (since < 0) | (since >= end)
    assert np.abs(found[0] - truth[0]).max() < 1e-12 * STROKE
    for k in (1, 2):
        moving = np.where(rests, 0, truth[k])
        assert np.abs(found[k] - moving).max() < 1e-11 * STROKE * (TURN * F) ** k
    assert found[0][0] == pytest.approx(float(plain.evaluate(ahead)[0]), abs=1e-12)  # the height of its phase
    pieces = drive.segments()
    assert pieces.duration == pytest.approx(end, rel=1e-14)
    assert drive.error == 0


@pytest.mark.parametrize("passes", [0, 3, 1_000_000])
def test_at_late_times_breakpoints_and_pieces_agree(passes):
    for drive in (Drive(1.0, 4.0, phase=1.0), Drive(1.0, 4.0, "sine", phase=1.0, ramp=0.6), Drive(1.0, 4.0, ramp=0)):
        table = drive_table([drive])
        time = start = 0.25 * passes
        count = 0
        while (after := next_breakpoint(table, time)) < start + 1:
            assert after > time
            inside = time + (after - time) * np.array([0.1, 0.5, 0.9])
            fit = np.polynomial.Polynomial.fit(
                np.linspace(-1, 1, 6), drive.evaluate(np.linspace(time, after, 8)[1:-1])[0], 5
            )
            assert fit((inside - time) / (after - time) * 2.8 - 1.4) == pytest.approx(
                drive.evaluate(inside)[0], abs=1e-11 + 1e-14 * start
            )
            time, count = after, count + 1
        assert count > 6


def test_phases_of_a_whole_turn_more_are_the_same_drive():
    time = np.linspace(0, 5 / F, 301)
    for cycle in ("sine", "cosine", "up-down"):
        one, other = (Drive(STROKE, F, cycle, phase=phase).evaluate(time)[0] for phase in (1.0, 1.0 - 4 * TURN))
        assert np.abs(one - other).max() < 1e-13


def test_a_phase_of_0_and_no_ramp_are_the_drive_without_them():
    for cycle in ("sine", "cosine", "up-down"):
        one, other = drive_table([Drive(3e-6, F, cycle, 4)]), drive_table([Drive(3e-6, F, cycle, 4, phase=0.0, ramp=0)])
        for left, right in zip(one, other, strict=True):
            assert (left == right).all()


def test_a_short_ramp_is_the_shortest_stroke():
    assert Drive(1.0, 100.0, "sine", ramp=0.2).stroke_time == pytest.approx(2e-3)
    assert Drive(1.0, 100.0, "sine", ramp=3).stroke_time == pytest.approx(5e-3)


def test_times_of_leads_and_tails_count():
    ramped = Drive(1.0, 100.0, "sine", 8, 1e-3, ramp=2.5).segments()
    assert (ramped.lead_time, ramped.span, ramped.repeats) == pytest.approx((25e-3, 10e-3, 3))
    assert ramped.duration == pytest.approx(80e-3)
    assert ramped.since[0] == 0 and ramped.since[-1] + ramped.scale[-1] == pytest.approx(80e-3)
    table = drive_table([Drive(1.0, 100.0, "sine", 8, 1e-3, ramp=2.5)])
    assert horizon(table, 0.0) == pytest.approx(81e-3)
    # The ramp is over before the period that all endless drives have in common.
    table = drive_table([Drive(1.0, 100.0, "sine", ramp=2.5), Drive(1.0, 50.0, delay=2e-3)])
    assert horizon(table, 0.0) == pytest.approx(25e-3 + 20e-3)
    assert isinstance(Drive(1.0, 1.0).segments(), Segments)


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"phase": math.nan}, "phase"),
        ({"phase": 1.0, "cycle": "up"}, "phase"),
        ({"ramp": 3}, "ramp"),
        ({"ramp": 3, "cycle": "up"}, "ramp"),
        ({"ramp": -1, "cycle": "sine"}, "ramp"),
        ({"ramp": 0.001, "cycle": "sine"}, "ramp"),
        ({"ramp": 1001, "cycle": "sine"}, "ramp"),
        ({"ramp": 3, "cycle": "sine", "cycles": 5}, "ramp"),
    ],
)
def test_a_wrong_phase_or_ramp_is_refused_by_name(wrong, field):
    with pytest.raises(ValueError, match=f"^Input {field} of Drive must be [^;]*; got [^;]*$"):
        Drive(**{"stroke": 1e-4, "frequency": 300.0} | wrong)
