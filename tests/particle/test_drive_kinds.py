"""Sines, tables, measured motions and schedules: their heights, pieces and breakpoints, and what they refuse."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pieces import piece_at

from particle import Drive, HermiteDrive, Segment, SegmentDrive, TableDrive
from particle.drives import drive_table, monomial_table, next_breakpoint

POLYNOMIAL = np.polynomial.Polynomial([1e-6, -2e-3, 3.0, 4e2, -5e4, 6e6])


def blend(s):
    s = np.clip(s, 0, 1)
    return 10 * s**3 - 15 * s**4 + 6 * s**5


def wave(t):
    """The platform's motion t sin(3.2 t) of the paper's figure 4, its velocity and its acceleration."""
    s, c = np.sin(3.2 * t), np.cos(3.2 * t)
    return t * s, s + 3.2 * t * c, 6.4 * c - 3.2**2 * t * s


SCHEDULE = [
    Segment(2.0, 4.0, dwell=0.5, cycles=2),
    Segment(3.0, 2.0, cycle="up", cycles=2),
    Segment(cycle="hold", dwell=0.25),
    Segment(-6.0, 0.5, cycle="up", dwell=0.125),
]
# Each with its heights (k,) at times since the delay (k,) within a pass of it, and the time that a pass takes.
KINDS = {
    "up-down": (Drive(-2.0, 4.0, dwell=0.5), lambda t: -2 * (blend(8 * t) - blend(8 * (t - 0.625))), 1.25),
    "sine": (Drive(3.0, 4.0, "sine"), lambda t: 3 * np.sin(8 * np.pi * t), 0.25),
    "cosine": (Drive(3.0, 4.0, "cosine"), lambda t: 1.5 - 1.5 * np.cos(8 * np.pi * t), 0.25),
    "table": (
        TableDrive([0, 0.5, 0.75, 1.5], [1.0, 3.0, 3.0, 1.0], repeats=None),
        lambda t: 1 + 2 * blend(2 * t) - 2 * blend((t - 0.75) / 0.75),
        1.5,
    ),
    "schedule": (
        SegmentDrive(SCHEDULE, repeats=None),
        lambda t: (
            2 * (blend(8 * t) - blend(8 * (t - 0.625)) + blend(8 * (t - 1.25)) - blend(8 * (t - 1.875)))
            + 3 * (blend(2 * (t - 2.5)) + blend(2 * (t - 3)))
            - 6 * blend((t - 3.75) / 2)
        ),
        5.875,
    ),
}


def breakpoints_of(table, end, time=-1.0):
    breakpoints = []
    while (time := next_breakpoint(table, time)) < end:
        breakpoints.append(time)
    return breakpoints


@pytest.mark.parametrize("name", KINDS)
@given(passes=st.integers(0, 1_000_000), part=st.floats(0, 1, exclude_max=True))
@settings(max_examples=60, deadline=None)
def test_heights_are_those_of_the_formula_at_any_time(name, passes, part):
    drive, formula, span = KINDS[name]
    # As the sum is rounded, so is the time within the pass.
    time = span * passes + part * span
    lost = 4 * np.finfo(float).eps * time * np.abs(drive.evaluate(np.linspace(0, span, 65))[1]).max()
    bound = (drive.error + 1e-14) * 6 + lost
    assert drive.evaluate(time)[0] == pytest.approx(formula(part * span), rel=0, abs=bound)


@pytest.mark.parametrize("name", KINDS)
@given(passes=st.sampled_from([0, 1, 999, 1_000_000]), part=st.floats(0, 1), unit=st.floats(0.01, 10))
@settings(max_examples=60, deadline=None)
def test_from_one_breakpoint_to_the_next_the_height_is_one_quintic(name, passes, part, unit):
    drive, _, span = KINDS[name]
    table, start = drive_table([drive]), span * (passes + part)
    end = next_breakpoint(table, start)
    assert end > start
    piece = piece_at(table, 0, start + 0.5 * (end - start), unit)
    times = start + (end - start) * np.linspace(0.01, 0.99, 8)
    values = np.polynomial.polynomial.polyval((times - (start + 0.5 * (end - start))) / unit, piece)
    lost = 8 * np.finfo(float).eps * (1 + end) * np.abs(drive.evaluate(np.linspace(0, span, 65))[1]).max()
    assert np.abs(values - drive.evaluate(times)[0]).max() <= 2e-13 + lost


@pytest.mark.parametrize("passes", [0, 3, 1_000_000])
@pytest.mark.parametrize("name", KINDS)
def test_the_list_of_breakpoints_is_complete_at_any_time(name, passes):
    drive, _, span = KINDS[name]
    start, scale, *_ = drive.segments()
    breakpoints = breakpoints_of(drive_table([drive]), span * (passes + 1.5), span * (passes + 0.5) - 1e-3 * span)
    edges = np.concatenate([start + span * passes, start + span * (passes + 1)])
    edges = edges[(edges > span * (passes + 0.499)) & (edges < span * (passes + 1.5))]
    assert breakpoints == pytest.approx(edges, rel=1e-15)
    # At a breakpoint, the piece that begins there: otherwise its own fifth derivative would be another's.
    table = drive_table([drive])
    for breakpoint, after in zip(breakpoints[:-1], breakpoints[1:], strict=True):
        here, later = piece_at(table, 0, breakpoint, 1.0), piece_at(table, 0, 0.5 * (breakpoint + after), 1.0)
        assert here[5] == pytest.approx(later[5], rel=1e-12, abs=1e-300)


@given(frequency=st.floats(0.1, 1e4), delay=st.floats(0, 10), passes=st.integers(0, 1_000_000))
@settings(max_examples=200, deadline=None)
def test_breakpoints_that_rounding_blurs_still_begin_their_pieces(frequency, delay, passes):
    drive = Drive(1.0, frequency, delay=delay)
    table, half = drive_table([drive]), 0.5 / frequency
    for strokes in (2 * passes, 2 * passes + 1):
        breakpoint = next_breakpoint(table, delay + (strokes - 0.5) * half)
        assert breakpoint == pytest.approx(delay + strokes * half, rel=1e-15)
        piece, up = piece_at(table, 0, breakpoint, half), 1 - 2 * (strokes % 2)
        assert piece[:3] == pytest.approx([strokes % 2, 0, 0], abs=1e-6)
        assert piece[3] == pytest.approx(10 * up, rel=1e-6)
        # One rounding earlier it is still the piece before, which goes the other way.
        earlier = piece_at(table, 0, np.nextafter(breakpoint, -1), half)
        assert earlier[5] == pytest.approx(-6 * up if strokes else 0, rel=1e-6)
        assert next_breakpoint(table, breakpoint) == pytest.approx(delay + (strokes + 1) * half, rel=1e-15)


def test_breakpoints_of_drives_that_differ_by_rounding_are_one():
    one, other = Drive(1.0, 3.0), Drive(1.0, 3.0 * (1 + 1e-16), delay=1 / 3.0)
    breakpoints = breakpoints_of(drive_table([one, other]), 1e6, 1e6 - 10)
    assert np.diff(breakpoints) == pytest.approx(1 / 6, rel=1e-8)


@given(st.data())
@settings(max_examples=60, deadline=None)
def test_random_tables_are_their_own_points_with_every_breakpoint(data):
    gaps = data.draw(st.lists(st.floats(1e-6, 1.0), min_size=1, max_size=30))
    heights = data.draw(st.lists(st.floats(-1, 1), min_size=len(gaps) + 1, max_size=len(gaps) + 1))
    drive = TableDrive(np.concatenate([[0], np.cumsum(gaps)]), heights, delay=data.draw(st.floats(0, 2)))
    h, v, a = drive.evaluate(drive.delay + drive.times)
    assert h == pytest.approx(heights, abs=1e-8)  # the velocity may be 1e6, and the time is rounded
    assert breakpoints_of(drive_table([drive]), math.inf) == pytest.approx(drive.delay + drive.times, rel=1e-15)
    middle = drive.delay + 0.5 * (drive.times[:-1] + drive.times[1:])
    assert drive.evaluate(middle)[0] == pytest.approx(0.5 * (drive.heights[:-1] + drive.heights[1:]), abs=1e-8)


@pytest.mark.parametrize("cycle, amplitude", [("sine", 1.0), ("cosine", 0.5)])
def test_a_sine_is_as_good_as_it_says(cycle, amplitude):
    stroke, rate = 50e-6, 2 * np.pi * 300
    drive, times = Drive(stroke, 300, cycle), np.linspace(0, 1 / 300, 20011)
    s, c = np.sin(rate * times), np.cos(rate * times)
    truth = (s, rate * c, -(rate**2) * s) if cycle == "sine" else (0.5 - 0.5 * c, rate * s / 2, rate**2 * c / 2)
    wrong = [np.abs(got / stroke - h).max() for got, h in zip(drive.evaluate(times), truth, strict=True)]
    assert 0.9 * drive.error < wrong[0] < 1.01 * drive.error
    assert drive.error == pytest.approx(3.04e-13 * amplitude, rel=0.01)
    assert wrong[1] < 2.2e-11 * amplitude * rate
    assert wrong[2] < 3.1e-9 * amplitude * rate**2


@pytest.mark.parametrize("cycle", ["sine", "cosine"])
def test_a_counted_sine_ends_at_0_and_its_pieces_join(cycle):
    drive = Drive(1.0, 2.0, cycle, cycles=3, delay=0.25)
    assert drive.evaluate([0.0, 0.25, 1.75, 9.0])[0] == pytest.approx([0, 0, 0, 0], abs=1e-15)
    assert drive.evaluate(1.75)[1] == 0
    breakpoints = breakpoints_of(drive_table([drive]), math.inf)
    assert breakpoints == pytest.approx(0.25 + np.arange(3 * 128 + 1) / 256, rel=1e-15)
    inner = np.array(breakpoints[1:-1])
    for one, other, scale in zip(
        drive.evaluate(inner - 1e-9), drive.evaluate(inner + 1e-9), (20, 200, 3000), strict=True
    ):
        assert np.abs(one - other).max() < 2e-9 * scale


def test_a_quintic_is_its_own_hermite_drive():
    times = np.array([0.0, 1e-3, 4e-3, 4.5e-3, 7e-3])
    drive = HermiteDrive(times, POLYNOMIAL(times), POLYNOMIAL.deriv()(times), POLYNOMIAL.deriv(2)(times))
    dense = np.linspace(0, 7e-3, 501)[:-1]
    for k, got in enumerate(drive.evaluate(dense)):
        truth = POLYNOMIAL.deriv(k)(dense)
        assert np.abs(got - truth).max() < 1e-12 * np.abs(truth).max()


def test_an_analytic_motion_states_how_good_it_is():
    coarse, fine = (HermiteDrive.of(wave, 3.0, pieces) for pieces in (8, 16))
    times = np.linspace(0, 3, 4001)[:-1]
    for drive in (coarse, fine):
        wrong = np.abs(drive.evaluate(times)[0] - wave(times)[0]).max() / np.ptp(wave(times)[0])
        assert 0.95 * drive.error < wrong < 1.05 * drive.error
    assert 5.5 < math.log2(coarse.error / fine.error) < 6.5
    assert HermiteDrive.of(wave, 3.0, 300).error < 1e-12
    # tan(3.2 t) = -3.2 t at 0.6340, 1.5354, 2.4910
    assert fine.stroke_time == pytest.approx(0.6340, rel=0.02)
    inside = fine.times[1:-1]
    for one, other in zip(fine.evaluate(inside - 1e-12), fine.evaluate(inside + 1e-12), strict=True):
        assert one == pytest.approx(other, abs=1e-8)


def test_an_analytic_motion_may_be_late_and_have_constant_derivatives():
    drive = HermiteDrive.of(lambda t: (2 * t, 2.0, 0), 1.0, 4, delay=5.0)
    assert drive.evaluate([4.0, 5.25, 7.0])[0] == pytest.approx([0, 0.5, 2])
    assert drive.error < 1e-15
    assert (drive.stroke_time, drive.frequency) == (1.0, 0.5)


@pytest.mark.compiled
def test_a_measured_motion_of_many_samples_is_found_at_once():
    drive = HermiteDrive.of(wave, 3.0, 100_000)
    table = drive_table([drive])
    times = np.linspace(0, 3, 20_001)[:-1]
    assert np.abs(drive.evaluate(times)[0] - wave(times)[0]).max() < 1e-14
    assert [next_breakpoint(table, t) for t in (0.0, 1.5, 2.99999)] == pytest.approx([3e-5, 1.50003, 3.0])


def test_a_schedule_goes_on_from_where_each_segment_ended():
    drive = SegmentDrive(SCHEDULE[1:3], delay=1.0)
    assert drive.evaluate([0.5, 1.5, 1.6, 2.0, 9.0])[0] == pytest.approx([0, 3, 3 + 3 * blend(0.2), 6, 6])
    assert (drive.stroke_time, drive.frequency) == (0.5, 2.0)
    assert (SegmentDrive(SCHEDULE).stroke_time, SegmentDrive(SCHEDULE).frequency) == (0.125, 4.0)
    still = SegmentDrive([Segment(cycle="hold", dwell=2.0)])
    assert (still.stroke_time, still.frequency, still.evaluate(1.0)[0]) == (2.0, 0.0, 0.0)


def test_strokes_and_frequencies_of_each_kind():
    assert (Drive(1.0, 4.0).stroke_time, Drive(1.0, 4.0, "up").stroke_time) == (0.125, 0.25)
    assert Drive(1.0, 4.0, "sine").stroke_time == Drive(1.0, 4.0, "cosine").stroke_time == 0.125
    table = TableDrive([0, 0.1, 1.0, 1.5], [1, 1, 0, 2])
    assert (table.stroke_time, table.frequency) == (0.5, 1.0)
    assert TableDrive([0, 2], [1, 1]).frequency == 0
    rows = drive_table([table, Drive(1.0, 4.0, "sine")]).stroke_time
    assert rows.tolist() == [0.5, 0.125]
    assert monomial_table(2).stroke_time.tolist() == [math.inf, math.inf]


NAN = math.nan
WRONG = [
    (lambda: Drive(1.0, 1.0, dwell=-1.0), "Drive", "dwell"),
    (lambda: Drive(1.0, 1.0, "sine", dwell=1.0), "Drive", "dwell"),
    (lambda: Drive(1.0, 1.0, "up", dwell=1.0), "Drive", "dwell"),
    (lambda: Drive("1", 5e-324, cycles=True), "Drive", "stroke frequency cycles"),
    (lambda: Drive(1.0, 1.0, cycles=NAN), "Drive", "cycles"),
    (lambda: TableDrive([0, 2, 1], [0, 1, 0]), "TableDrive", "times"),
    (lambda: TableDrive([1, 2], [0, 1]), "TableDrive", "times"),
    (lambda: TableDrive([0, 1, 1], [0, 1, 0]), "TableDrive", "times"),
    (lambda: TableDrive([0, NAN], [0, 1]), "TableDrive", "times"),
    (lambda: TableDrive([0], [0]), "TableDrive", "times"),
    (lambda: TableDrive([], []), "TableDrive", "times heights"),
    (lambda: TableDrive("ab", [[1, 2]], 0, NAN), "TableDrive", "times heights repeats delay"),
    (lambda: TableDrive([0, 1], [0, math.inf]), "TableDrive", "heights"),
    (lambda: TableDrive([0, 1], [0, 1, 2]), "TableDrive", "heights"),
    (lambda: TableDrive([0, 1], [0, 1], repeats=None), "TableDrive", "repeats"),
    (lambda: TableDrive([0, 1], [0, 0], repeats=1.5), "TableDrive", "repeats"),
    (lambda: HermiteDrive([0, 1], [0, 1], [0], [0, NAN], -1.0), "HermiteDrive", "velocities accelerations delay"),
    (lambda: HermiteDrive.of(wave, -1.0, 0), "HermiteDrive.of", "end pieces"),
    (lambda: HermiteDrive.of(lambda t: t, 1.0, 4), "HermiteDrive.of", "function"),
    (lambda: Segment(), "Segment", "stroke frequency"),
    (lambda: Segment(1.0, 0.0, "down", 0, -1.0), "Segment", "frequency cycle cycles dwell"),
    (lambda: Segment(1.0, 1.0, "hold", 2), "Segment", "stroke frequency cycles dwell"),
    (lambda: SegmentDrive([], delay=-1.0), "SegmentDrive", "schedule delay"),
    (lambda: SegmentDrive([3]), "SegmentDrive", "schedule"),
    (lambda: SegmentDrive(None), "SegmentDrive", "schedule"),
    (lambda: SegmentDrive([Segment(1.0, 1.0, cycles=2_000_000)]), "SegmentDrive", "schedule"),
    (lambda: SegmentDrive(SCHEDULE[:2], repeats=2), "SegmentDrive", "repeats"),
]


@pytest.mark.parametrize("make, owner, names", WRONG)
def test_every_wrong_field_is_named(make, owner, names):
    with pytest.raises(ValueError) as caught:
        make()
    parts = str(caught.value).split("; Input ")
    assert len(parts) == len(names.split()), parts
    for part, name in zip(parts, names.split(), strict=True):
        assert part.removeprefix("Input ").startswith(f"{name} of {owner} must ")
        assert "; got " in part


@pytest.mark.parametrize(
    ("drive", "velocity", "acceleration"),
    [
        (Drive(1e-6, 300.0), False, False),
        (Drive(1e-6, 300.0, dwell=1e-3, cycles=3), False, False),
        (Drive(1e-6, 300.0, "cosine", cycles=2), False, True),
        (Drive(1e-6, 300.0, "sine", cycles=2), True, False),
        (SegmentDrive([Segment(1e-6, 300.0, "up"), Segment(-1e-6, 200.0, "up")]), False, False),
    ],
    ids=["up-down", "with dwell", "cosine", "sine", "schedule"],
)
def test_which_derivatives_jump_at_breakpoints(drive, velocity, acceleration):
    jump = drive_table([Drive(3e-6, 40.0), drive]).jump > 0
    assert jump.tolist() == [[False, False], [velocity, acceleration]]
