"""The logic of the paper's verdicts, on paths and arrays made by hand: what passes, and what must not."""

from types import SimpleNamespace

import numpy as np
import pytest
from paper_paths import PERIOD, PITCH, lost_at, path

from active_surface.paper.figures.accuracy import _band, _fine, _named, within
from active_surface.paper.figures.convergence import _converges, _leaves, leave
from active_surface.paper.figures.dead_zones import widest_served
from active_surface.paper.figures.feasible_area import curve_of
from active_surface.paper.figures.friction_logic import slips_of, zero_after_each
from active_surface.paper.figures.handover import HANDOVERS, arrives, cycles_until_there
from active_surface.paper.figures.neighbours import crosses_and_returns, goes_over, trend_of
from active_surface.paper.figures.translocation import beyond, ends_of, farther, grows
from active_surface.paper.models import Bench
from particle import EventKind

BENCH = Bench()
FREQUENCIES = np.array([200.0, 220.0, 240.0, 260.0, 280.0])
NAN = float("nan")


# ---- figure 4


def swing(after):
    kinds = ((2.4, EventKind.SLIPS), (2.9, EventKind.STOPS), (3.2, EventKind.SLIPS), (3.6, EventKind.STOPS))
    events = [SimpleNamespace(time=time, kind=kind) for time, kind in kinds]

    def at(times):
        return SimpleNamespace(velocity=np.array([[1.0 if t < 3 else after if t < 3.6 else -after, 0] for t in times]))

    return SimpleNamespace(events=events, time=np.array([0.0, 4.0]), at=at)


def reversing():
    """Slips once, and turns at once each time."""
    kinds = ((2.4, EventKind.SLIPS), (2.9, EventKind.REVERSES), (3.5, EventKind.REVERSES))
    events = [SimpleNamespace(time=time, kind=kind) for time, kind in kinds]

    def at(times):
        return SimpleNamespace(velocity=np.array([[1.0 if t < 2.9 else -1.0 if t < 3.5 else 1.0, 0] for t in times]))

    return SimpleNamespace(events=events, time=np.array([0.0, 4.0]), at=at)


def test_a_part_that_reverses_at_once_sticks_for_a_moment_and_goes_the_other_way():
    assert slips_of(reversing()) == (2.4, 2.9, 2.9, True)


def test_the_relative_velocity_is_zero_once_after_each_reversal_of_the_platform():
    assert zero_after_each(reversing(), np.array([1.0, 2.5, 3.0]))
    assert not zero_after_each(reversing(), np.array([1.0, 2.5]))  # twice after the last one
    assert not zero_after_each(reversing(), np.array([1.0, 2.5, 2.95, 3.0]))  # not between the last two


def test_the_way_after_the_second_slip_is_that_right_after_it():
    assert slips_of(swing(-1.0)) == (2.4, 2.9, 3.2, True)
    assert not slips_of(swing(1.0)).turns


# ---- figures 5, 15


def test_a_curve_that_grows_and_falls_or_does_not():
    hill = curve_of(FREQUENCIES, np.array([0.0, 2.0, 4.0, 3.0, 1.0]))
    assert hill == (240.0, True, True, (220.0, 260.0))
    rising = curve_of(FREQUENCIES, np.arange(5.0))
    assert rising.top == 280 and rising.grows and not rising.falls
    assert not curve_of(FREQUENCIES, np.array([0.0, 2.0, 1.0, 4.0, 1.0])).grows
    assert not curve_of(FREQUENCIES, np.array([0.0, 4.0, 1.0, 3.0, 1.0])).falls


def test_farther_counts_only_where_both_strokes_move_the_part():
    both = np.array([[0.0, 1e-6, 2e-6, NAN], [1e-6, 2e-6, 3e-6, 4e-6]])
    assert farther(both) == 1.0 and farther(both[::-1]) == 0.0
    assert np.isnan(farther(np.array([[NAN, 1e-6], [1e-6, NAN]])))


def test_grows_ends_and_what_is_beyond():
    row = np.array([0.0, 1e-6, 2e-6, 1.5e-6, NAN])
    assert grows(row[None]) == 0.5
    assert ends_of(FREQUENCIES, row) == (220.0, 260.0)
    assert beyond(row, np.array(["stuck", "stuck", "stuck", "stuck", "detached"])) == "detached"
    assert beyond(row[:4], np.array(["stuck"] * 4)) == beyond(row[:1], np.array(["stuck"])) == "not reached"
    assert np.isnan(ends_of(FREQUENCIES, 0 * FREQUENCIES)).all()


# ---- figure 16


def stays():
    return path((-50, 15), (40, -10), (-20, 5))


def crosses_over():
    return path((-50, 15), (40, 0), (140, 0))


def test_crosses_and_returns_and_goes_over():
    assert crosses_and_returns(stays(), PITCH) and not goes_over(stays(), PITCH)
    assert goes_over(crosses_over(), PITCH) and not crosses_and_returns(crosses_over(), PITCH)
    assert not crosses_and_returns(path((-50, 15), (-10, 3)), PITCH)  # never beyond it
    assert not crosses_and_returns(path((-50, 15), (40, 0), (-10, 0), outcome="detached"), PITCH)
    assert not goes_over(path((-50, 15), (80, 200)), PITCH)  # beyond the half-way line, but nowhere near


def test_only_a_contrast_between_low_and_high_meets_the_trend():
    stay, go = [stays()] * 60, [crosses_over()] * 60
    apart = trend_of({250.0: stay, 450.0: go, 650.0: go}, PITCH)
    assert apart.met == 1 and [share.hits for share in apart.stay] == [60, 0, 0]
    assert trend_of({250.0: go, 450.0: go, 650.0: go}, PITCH).met == 0  # all go over at every frequency
    assert trend_of({250.0: go, 450.0: stay, 650.0: stay}, PITCH).met == 0  # the opposite
    assert trend_of({250.0: stay, 450.0: stay, 650.0: stay}, PITCH).met == 0.5
    assert trend_of({250.0: stay, 450.0: go, 650.0: go[:30] + stay[:30]}, PITCH).met == 0.75


# ---- figures 17, 20


def test_17a_and_17b_tell_what_the_stated_start_does():
    near, wide = path((100, 100), (5, 5)), path((100, 100), (210, 0), duration=0.05)
    verdict = _converges(BENCH, {"closed": [wide, *[near] * 59], "plate": [near] * 60})
    assert verdict.answers["closed"].more.endswith("the stated start does not")
    assert verdict.answers["plate"].met == 1 and verdict.answers["plate"].more.endswith("does")
    returned = path((100, 100), (210, 0), (5, 5))
    numbers = _converges(BENCH, {"closed": [returned, near]}).numbers["closed"]
    assert (numbers["share"], numbers["lost"], numbers["to_and_fro"]) == (1.0, 0.0, 0.0)
    verdict = _leaves(BENCH, {"closed": [lost_at(1e-9, 0.0)] * 60, "plate": [wide] * 60})
    assert verdict.answers["closed"].met == 0 and "never leaves and comes off 1 nm" in verdict.answers["closed"].more
    assert verdict.answers["plate"].met == 0.5 and "after 15.00 cycles" in verdict.answers["plate"].more
    assert leave(BENCH, [wide], 14.9).hits == 0 and leave(BENCH, [wide], 15.1).hits == 1


def test_20_arrives_and_is_there_after_so_many_cycles():
    one = HANDOVERS["20"]  # 300 Hz at (0, 0)
    there = path((100, 0), (60, 0), (0, 0))
    assert arrives(BENCH, one, there) and not arrives(BENCH, one, path((100, 0), (60, 0), (150, 0)))
    assert arrives(BENCH, HANDOVERS["21"], path((-50, 15), (150, 0)))  # 300 Hz at (150, 0)
    assert cycles_until_there(BENCH, one, there) == pytest.approx(30 * PERIOD / 4 * 450)
    assert cycles_until_there(BENCH, one, path((100, 0), (80, 0))) == np.inf


# ---- figure 22, dead zones


def test_22_counts_parts_that_are_gone_and_each_frequency_by_itself():
    good, bad = np.full((5, 15), 2e-6), np.full((5, 15), NAN)
    verdict = _band(BENCH, {"closed": np.stack([good] * 8 + [bad]), "plate": np.stack([good] * 9)})
    assert (
        verdict.answers["closed"].met == pytest.approx(8 / 9)
        and "by frequency 0 to 100 %" in verdict.answers["closed"].text
    )
    assert verdict.answers["plate"].met == 1 and within(bad, 1.0).hits == 0
    assert _fine({"closed": np.stack([good])}).answers["closed"].met == 0
    assert _fine({"closed": np.stack([good / 4])}).answers["closed"].met == 1


def test_22_judges_the_two_cases_by_all_starts_not_by_one():
    lucky = np.full((2, 60), 3e-6)
    lucky[:, 0] = 0.5e-6
    assert _named({"closed": lucky}).answers["closed"].met == 0
    assert _named({"closed": 0 * lucky}).answers["closed"].met == 1


def test_a_pitch_is_served_only_if_all_smaller_ones_are():
    pitches = np.array([1.0, 2.0, 3.0])
    rows = np.array([[1] * 10, [1] * 5 + [0] * 5, [1] * 10], dtype=bool)
    assert widest_served(pitches, rows) == 1.0 and widest_served(pitches, rows[[0, 2, 1]]) == 2.0
    assert widest_served(pitches, ~rows) == 0.0
