"""Drives given by their quintics: many with common breakpoints, alone and beside others."""

from dataclasses import replace

import numpy as np
import pytest

from particle import Drive, polynomial_surface
from particle.drives import drive_table, next_breakpoint, quintic_drives
from particle.drives.table import FIFTH, FOURTH, JUMP_OVER
from particle.surface import enter, new_local, surface_at

EDGES = np.array([0.0, 0.5, 0.75, 2.0])


def smooth(s):
    """A motion with period 1.5 after 0.5, with its derivatives by their formulas."""
    rate = 2 * np.pi / 1.5
    return np.sin(rate * s), rate * np.cos(rate * s), -(rate**2) * np.sin(rate * s)


def coefficients(count):
    return np.random.default_rng(0).normal(size=(count, len(EDGES) - 1, 6))


def test_each_is_its_polynomials_and_holds_the_last_value():
    rows = coefficients(3)
    drives = quintic_drives(EDGES, rows, None, 0.5, 1.0, np.zeros(3))
    for drive, row in zip(drives, rows, strict=True):
        for k in range(3):
            s = np.array([0.0, 0.3, 0.9])
            values = np.polynomial.polynomial.polyval(s, row[k])
            assert drive.evaluate(EDGES[k] + s * np.diff(EDGES)[k])[0] == pytest.approx(values, rel=1e-12, abs=1e-12)
        assert drive.evaluate(5.0)[0] == pytest.approx(row[-1].sum(), rel=1e-14)


def test_a_pass_repeats_after_the_pieces_that_come_once():
    rows = coefficients(2)
    drive = quintic_drives(EDGES, rows, 1, 0.5, 1.0, np.zeros(2))[1]
    times = np.array([0.51, 0.9, 1.99])
    assert drive.evaluate(times + 7 * 1.5)[0] == pytest.approx(drive.evaluate(times)[0], rel=1e-12)
    assert drive.evaluate(0.25)[0] == pytest.approx(np.polynomial.polynomial.polyval(0.5, rows[1, 0]), rel=1e-14)


def test_they_are_rows_of_a_table_beside_other_drives():
    rows = coefficients(2)
    ours = quintic_drives(EDGES, rows, 1, 0.5, 1.0, np.array([1e-7, 2e-7]))
    table = drive_table([Drive(1.0, 0.4), *ours])
    assert table.stroke_time.tolist() == [1.25, 0.5, 0.5]
    assert [drive.error for drive in ours] == [1e-7, 2e-7]
    times, time = [], 0.0
    while (time := next_breakpoint(table, time)) < 3.0:
        times.append(time)
    assert times == pytest.approx([0.5, 0.75, 1.25, 2.0, 2.25, 2.5], rel=1e-14)
    assert (table.jump > 0).tolist() == [[False, False], [True, True], [True, True]]


@pytest.mark.parametrize("loop", [None, 1])
def test_jumps_are_those_of_each_derivative_from_piece_to_piece(loop):
    rows = coefficients(1) * [[[1.0], [1.0], [300.0]]]  # so that the largest jump is where the last one ends
    (drive,) = quintic_drives(EDGES, rows, loop, 0.5, 1.0, np.zeros(1))
    pieces, largest = drive.segments(), []
    for order in range(1, 6):
        rates = [np.polynomial.Polynomial(c).deriv(order) for c in pieces.coefficients]
        begins, ends = ([rate(s) for rate in rates] / pieces.scale**order for s in (0.0, 1.0))
        back = begins[pieces.lead] if loop else 0.0  # where the pass begins, or at rest
        largest.append(max(*np.abs(begins[1:] - ends[:-1]), abs(ends[-1] - back)))
    table, over = drive_table([drive]), JUMP_OVER * 0.5
    assert table.jump[0] == pytest.approx(largest[:2], rel=1e-12)
    assert table.rough[0] == pytest.approx(largest[2] + FOURTH * over * largest[3] + FIFTH * over**2 * largest[4])


def test_a_smooth_loop_does_not_jump():
    begin, end = smooth(EDGES[:-1]), smooth(EDGES[1:])
    length = np.diff(EDGES)
    rows = np.zeros((1, 3, 6))
    for k in range(3):
        # The quintic with the values and two derivatives at both ends, by a linear solve.
        ends = [[s**n for n in range(6)] for s in (0, 1)]
        slopes = [[n * s ** max(n - 1, 0) for n in range(6)] for s in (0, 1)]
        bends = [[n * (n - 1) * s ** max(n - 2, 0) for n in range(6)] for s in (0, 1)]
        right = [side[order][k] * length[k] ** order for order in range(3) for side in (begin, end)]
        rows[0, k] = np.linalg.solve(np.array([*ends, *slopes, *bends], dtype=float), right)
    table = drive_table(quintic_drives(EDGES, rows, 1, 0.5, 1.0, np.zeros(1)))
    assert (table.jump == 0).all() and table.rough[0] > 0


def test_thousands_of_pieces_of_many_drives_share_their_times():
    edges = np.linspace(0.0, 1.0, 5001)
    rows = np.zeros((40, 5000, 6))
    rows[:, :, 1] = np.arange(40.0)[:, None]
    drives = quintic_drives(edges, rows, None, 0.5, 1.0, np.zeros(40))
    assert all(drive.segments().start is drives[0].segments().start for drive in drives)
    assert drive_table(drives).coefficients.shape == (200_000 + 40, 6)  # one more piece brings each to rest


def test_those_with_the_same_breakpoints_are_known():
    rows = coefficients(3)
    ours = quintic_drives(EDGES, rows, 1, 0.5, 1.0, np.zeros(3))
    later = quintic_drives(np.array([0.0, 0.5, 0.7500001, 2.0]), rows[:1], 1, 0.5, 1.0, np.zeros(1))
    once = quintic_drives(EDGES, rows[:1], None, 0.5, 1.0, np.zeros(1))
    table = drive_table([Drive(1.0, 0.4), *ours, *later, *once])
    assert table.alike.tolist() == [False, False, True, True, False, False]


def test_a_surface_under_them_is_the_sum_of_its_shapes():
    """Each shape is a constant, so w is the sum of all drives, span after span and within the lead and passes."""
    rows = coefficients(4)
    drives = [Drive(0.3, 0.4), *quintic_drives(EDGES, rows, 1, 0.5, 1.0, np.zeros(4)), Drive(0.2, 0.7, delay=0.1)]
    surface = replace(polynomial_surface(np.ones((1, 1, len(drives)))), drives=drive_table(drives))
    record = surface.record
    local, time, spans = new_local(record), 0.0, 0
    while time < 6.0:
        enter(record, local, 0.0, 0.0, time, 7.0)
        end = local.frame[0].end
        for share in (0.0, 0.4, 0.99):
            at = time + share * (end - time) + 1e-9
            total = sum(np.array(drive.evaluate(at)) for drive in drives)
            f = surface_at(local, 0.0, 0.0, at)
            assert [f.w, f.w_t, f.w_tt] == pytest.approx(total, rel=1e-9, abs=1e-9)
        time, spans = end, spans + 1
    assert spans > 15
