"""The logic of the paper's verdicts, on paths and arrays made by hand: what passes, and what must not."""

from types import SimpleNamespace

import numpy as np
import pytest

from active_surface.paper.figures.accuracy import _band, _fine, _named, within
from active_surface.paper.figures.coming_off import bending_pull, end_said, hardest, off_numbers, off_said
from active_surface.paper.figures.convergence import _converges, _leaves, leave
from active_surface.paper.figures.dead_zones import widest_served
from active_surface.paper.figures.feasible_area import curve_of
from active_surface.paper.figures.friction_logic import slips_of
from active_surface.paper.figures.handover import HANDOVERS, arrives, cycles_until_there
from active_surface.paper.figures.neighbours import crosses_and_returns, goes_over, trend_of
from active_surface.paper.figures.threshold import _at_stated, _curve, exceptions, mixed, thresholds
from active_surface.paper.figures.translocation import beyond, ends_of, farther, grows
from active_surface.paper.models import Bench
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.path import Path
from active_surface.paper.share import Share, share_of
from active_surface.paper.split import Ends, best_split, first_loss, fits_of
from particle import EventKind

BENCH = Bench()
PITCH, PERIOD = PARAMETERS.pitch, 1 / 300.0
FREQUENCIES = np.array([200.0, 220.0, 240.0, 260.0, 280.0])
NAN = float("nan")


def path(*places, outcome="moving", duration=30 * PERIOD, events=()):
    """A path over places in um, evenly spaced in time; it stays at the last one for the last half of the time."""
    rows = np.array([*places, places[-1]], dtype=float) * 1e-6
    times = np.append(np.linspace(0, duration / 2, len(places)), duration)
    trajectory = SimpleNamespace(time=times, position=rows, outcome=SimpleNamespace(value=outcome), events=events)
    return Path(trajectory, np.zeros(2))


def lost_at(x, y, speed=0.2):
    event = SimpleNamespace(kind=EventKind.DETACHES, position=(x, y), speed=speed)
    return path((100, 0), (1e6 * x, 1e6 * y), outcome="detached", events=(event,))


# ---- shares


@pytest.mark.parametrize(
    ("share", "interval", "met"),
    [
        (Share(52, 60), (0.758, 0.931), 0.5),
        (Share(60, 60), (0.940, 1.0), 1.0),
        (Share(58, 60), (0.886, 0.991), 0.5),
        (Share(0, 60), (0.0, 0.060), 0.0),
        (Share(9, 60), (0.081, 0.261), 0.5),
        (Share(16, 16), (0.806, 1.0), 0.5),
        (Share(1, 16), (0.011, 0.283), 0.5),
    ],
)
def test_a_share_is_met_only_if_its_whole_interval_is(share, interval, met):
    assert share.interval == pytest.approx(interval, abs=1e-3) and share.met == met


def test_a_share_says_its_interval():
    assert str(share_of([True] * 52 + [False] * 8)) == "87 % (76-93)"


# ---- paths


def test_converged_needs_the_last_five_cycles_near_the_actuator_and_on_the_surface():
    assert path((100, 0), (29, 0)).converged(PERIOD, 30e-6)
    assert not path((100, 0), (31, 0)).converged(PERIOD, 30e-6)
    assert not path((100, 0), (29, 0), outcome="detached").converged(PERIOD, 30e-6)
    assert path((100, 0), (140, 0)).converged(PERIOD, 30e-6, (150e-6, 0.0))
    late = path((100, 0), (29, 0))
    late.trajectory.position[-2] = 31e-6, 0.0
    assert late.converged(PERIOD, 30e-6)  # that was at half of the time
    late.trajectory.time[-2] = late.time[-1] - 4 * PERIOD
    assert not late.converged(PERIOD, 30e-6)


def test_leaves_at_and_lost():
    assert path((0, 0), (201, 0), (0, 0)).leaves_at(200e-6) == pytest.approx(30 * PERIOD / 4)
    assert path((0, 0), (199, 0)).leaves_at(200e-6) == np.inf
    over = path((0, 0), (150, 0), outcome="left the plate")
    assert over.leaves_at(200e-6) == over.time[-1] and over.lost(200e-6)
    assert lost_at(1e-9, 0.0).lost(200e-6) and not path((0, 0), (199, 0)).lost(200e-6)


@pytest.mark.parametrize("outcome", ["overloaded", "work limit"])
def test_what_was_not_followed_to_the_end_is_neither_lost_nor_kept(outcome):
    one = path((0, 0), (10, 0), outcome=outcome)
    assert one.unknown and not (one.attached or one.came_off or one.over_rim or one.lost(200e-6))
    assert not one.converged(PERIOD, 30e-6) and "not followed" in end_said(one, [(0, 0)])


def test_where_parts_come_off():
    parts = [lost_at(5e-9, 0.0), lost_at(PITCH, 20e-6), path((0, 0)), path((0, 0))]
    numbers = off_numbers(parts, [(0.0, 0.0), (PITCH, 0.0)])
    assert (numbers["come_off"], numbers["close"], numbers["median_speed"]) == (0.5, 0.5, 0.2)
    assert numbers["median_distance"] == pytest.approx(10.0025e-6)
    assert end_said(parts[0], [(0.0, 0.0)]) == "comes off 5 nm from an actuator"
    assert off_numbers(parts[2:], [(0.0, 0.0)]) == {"come_off": 0.0} and "half" not in off_said(parts[2:], [(0.0, 0.0)])


def test_the_pull_of_curvature_next_to_an_actuator():
    assert bending_pull(PARAMETERS, [5e-9, 1e-6, 50e-6]) == pytest.approx([-2667, -1254, -211], abs=1)
    drive = BENCH.drive(650.0)
    moments = np.linspace(0, 1 / 650, 20001)
    assert hardest(PARAMETERS, 650.0) == pytest.approx(np.abs(drive.evaluate(moments)[2]).max(), rel=1e-6)


# ---- figure 4


def swing(after):
    kinds = ((2.4, EventKind.SLIPS), (2.9, EventKind.STOPS), (3.2, EventKind.SLIPS), (3.6, EventKind.STOPS))
    events = [SimpleNamespace(time=time, kind=kind) for time, kind in kinds]

    def at(times):
        return SimpleNamespace(velocity=np.array([[1.0 if t < 3 else after if t < 3.6 else -after, 0] for t in times]))

    return SimpleNamespace(events=events, time=np.array([0.0, 4.0]), at=at)


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
    assert verdict.answers["closed"].text.endswith("the stated start does not")
    assert verdict.answers["plate"].met == 1 and verdict.answers["plate"].text.endswith("does")
    returned = path((100, 100), (210, 0), (5, 5))
    numbers = _converges(BENCH, {"closed": [returned, near]}).numbers["closed"]
    assert (numbers["share"], numbers["lost"], numbers["to_and_fro"]) == (1.0, 0.0, 0.0)
    verdict = _leaves(BENCH, {"closed": [lost_at(1e-9, 0.0)] * 60, "plate": [wide] * 60})
    assert verdict.answers["closed"].met == 0 and "never leaves and comes off 1 nm" in verdict.answers["closed"].text
    assert verdict.answers["plate"].met == 0.5 and "after 15.00 cycles" in verdict.answers["plate"].text
    assert leave(BENCH, [wide], 14.9).hits == 0 and leave(BENCH, [wide], 15.1).hits == 1


def test_20_arrives_and_is_there_after_so_many_cycles():
    one = HANDOVERS["20"]  # 300 Hz at (0, 0)
    there = path((100, 0), (60, 0), (0, 0))
    assert arrives(BENCH, one, there) and not arrives(BENCH, one, path((100, 0), (60, 0), (150, 0)))
    assert arrives(BENCH, HANDOVERS["21"], path((-50, 15), (150, 0)))  # 300 Hz at (150, 0)
    assert cycles_until_there(BENCH, one, there) == pytest.approx(30 * PERIOD / 4 * 450)
    assert cycles_until_there(BENCH, one, path((100, 0), (80, 0))) == np.inf


# ---- figure 18


def ends(*rows):
    """By frequency one letter a start: c converges, l is lost, o neither."""
    letters = np.array([list(row) for row in rows])
    return Ends(letters == "c", letters == "l")


def test_a_sharp_threshold_tells_all():
    sharp = ends("cc", "cc", "ll", "ll", "ll")
    split = best_split(FREQUENCIES, *sharp)
    assert split == (230.0, 1.0, 1.0, 1.0)
    assert mixed(FREQUENCIES, *sharp) is None and exceptions(FREQUENCIES, sharp, split) == ([], [])


def test_a_band_in_which_all_converge_again_is_seen_and_costs():
    """The first loss at 240 Hz is not the end of it: at 260 Hz all converge."""
    bands = ends("cc", "cc", "ll", "cc", "ll")
    split = best_split(FREQUENCIES, *bands)
    assert split.told == pytest.approx(0.8) and mixed(FREQUENCIES, *bands) == (240.0, 260.0)
    assert exceptions(FREQUENCIES, bands, split._replace(frequency=230.0)) == ([], [260.0])
    assert exceptions(FREQUENCIES, bands, split._replace(frequency=270.0)) == ([240.0], [])
    assert first_loss(FREQUENCIES, bands.lost) == 230.0


def test_the_first_loss_counts_a_start_that_is_never_lost():
    assert first_loss(FREQUENCIES, ends("cc", "lc", "cc", "cc", "lc").lost) == pytest.approx((210.0 + 290.0) / 2)


def test_to_and_fro_is_told_by_no_threshold():
    assert best_split(FREQUENCIES, *ends("oo", "cc", "co", "ll", "ll")).told == pytest.approx(0.7)
    assert np.isnan(best_split(FREQUENCIES, *ends("oo", "oo", "oo", "oo", "oo")).frequency)
    assert best_split(FREQUENCIES, *ends("cc", "cc", "cc", "cc", "cc")).frequency == 290.0
    assert best_split(FREQUENCIES, *ends("ll", "ll", "ll", "ll", "ll")).frequency == 190.0


def test_thresholds_scatter_over_single_starts():
    converges, lost = (rows[None] for rows in ends("cc", "cc", "cl", "cl", "ll"))
    found = thresholds(np.array([150e-6]), FREQUENCIES, Ends(converges, lost))
    assert found.scatter[0] == pytest.approx((234.0, 266.0)) and found.fits is None


@pytest.mark.parametrize(
    ("frequency", "below", "above", "met"),
    [(330.0, 0.95, 1.0, 1.0), (345.0, 0.95, 1.0, 2 / 3), (330.0, 0.6, 0.8, 1 / 3)],
)
def test_18_asks_for_the_place_and_for_what_parts_do_on_either_side(frequency, below, above, met):
    split = best_split(FREQUENCIES, *ends("c", "c", "l", "l", "l"))._replace(
        frequency=frequency, below=below, above=above
    )
    assert _at_stated(split, (300.0, 340.0), 20, None, ([], []), {}).met == pytest.approx(met)


def test_quadratic_and_power_law_are_told_apart():
    strokes = np.linspace(100e-6, 200e-6, 9)
    x = strokes / 150e-6
    square = fits_of(strokes, 900 - 900 * x + 320 * x**2, 150e-6)
    assert square.quadratic_misfit < 1e-6 < square.law_misfit and _curve(square, {}).met == 1
    law = fits_of(strokes, 320 * x**-1.6, 150e-6)
    assert law.law_misfit < 1e-6 and law.exponent == pytest.approx(-1.6) and _curve(law, {}).met == 0.5
    wild = fits_of(strokes, 320 + 100 * (-1.0) ** np.arange(9), 150e-6)
    assert wild.quadratic_misfit > 10 and _curve(wild, {}).met < 1
    assert fits_of(strokes, np.full(9, NAN), 150e-6) is None and _curve(None, {}).met == 0


# ---- figure 22, dead zones


def test_22_counts_parts_that_are_gone_and_each_frequency_by_itself():
    good, bad = np.full((5, 15), 2e-6), np.full((5, 15), NAN)
    verdict = _band(BENCH, {"closed": np.stack([good] * 8 + [bad]), "plate": np.stack([good] * 9)})
    assert verdict.answers["closed"].met == pytest.approx(8 / 9) and "from 0 to 100 %" in verdict.answers["closed"].text
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
