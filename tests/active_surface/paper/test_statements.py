"""The logic of verdicts, on paths and arrays made by hand: what meets a statement of the paper, and what must not."""

from types import SimpleNamespace

import numpy as np
import pytest

from active_surface.paper.bench import PARAMETERS, Bench, Path, coming_off
from active_surface.paper.dead_zones import widest_served
from active_surface.paper.feasible_area import curve_of
from active_surface.paper.one_actuator import converging, grows, leaving, placing, window, within
from active_surface.paper.statements import STATEMENTS
from active_surface.paper.strokes import slips_of, zero_after_each
from active_surface.paper.threshold import Ends, first_loss, quadratic_of, shares_around
from active_surface.paper.two_actuators import (
    HANDOVERS,
    arrives,
    crosses_and_returns,
    cycles_until_there,
    goes_over,
    trend_of,
)
from active_surface.paper.verdict import BEYOND, NOT, PARTLY, REPRODUCED, SAME, Share, Statement, share_of
from particle import EventKind

BENCH, PITCH, PERIOD = Bench(), PARAMETERS.pitch, 1 / 300.0  # m, s
FREQUENCIES = np.array([200.0, 220.0, 240.0, 260.0, 280.0])
NAN = float("nan")
TABLE = {one.figure: one for one in STATEMENTS}


def met(figure, **numbers):
    """How much of a statement numbers meet."""
    return TABLE[figure]._replace(text=lambda _: "").answer(numbers).met


def path(*places, outcome="moving", duration=30 * PERIOD, events=()):
    """A path over places in um, evenly spaced in time; it stays at the last one for the last half of the time."""
    rows = np.array([*places, places[-1]], dtype=float) * 1e-6
    times = np.append(np.linspace(0, duration / 2, len(places)), duration)
    trajectory = SimpleNamespace(time=times, position=rows, outcome=SimpleNamespace(value=outcome), events=events)
    return Path(trajectory, np.zeros(2))


def lost_at(x, y):
    event = SimpleNamespace(kind=EventKind.DETACHES, position=(x, y))
    return path((100, 0), (1e6 * x, 1e6 * y), outcome="detached", events=(event,))


# ---- shares and verdicts


@pytest.mark.parametrize(
    ("share", "interval", "met"),
    [
        (Share(52, 60), (0.758, 0.931), 0.5),
        (Share(60, 60), (0.940, 1.0), 1.0),
        (Share(58, 60), (0.886, 0.991), 0.5),
        (Share(0, 60), (0.0, 0.060), 0.0),
        (Share(16, 16), (0.806, 1.0), 0.5),
    ],
)
def test_a_share_is_met_only_if_its_whole_interval_is(share, interval, met):
    assert share.interval == pytest.approx(interval, abs=1e-3) and share.met == met
    assert str(share_of([True] * 52 + [False] * 8)) == "87 % (76-93)"


def test_a_verdict_is_that_of_the_papers_own_scheme_over_the_better_surface():
    row = Statement("1", "", lambda n: n["text"], lambda n: n["checks"])
    good, half, bad = ({"text": text, "checks": own} for text, own in (("g", [1]), ("h", [1, 0]), ("b", [0])))
    assert row.judged({"paper": good, "closed": bad}).verdict == REPRODUCED
    assert row.judged({"paper": bad, "closed": good, "else": good}).verdict == NOT
    two = row.judged({"paper, nearest": bad, "paper, superposed": half, "plate": good})
    assert two.verdict == PARTLY and two.answers["paper"].text == "nearest: b, superposed: h"
    assert two.as_dict()["answers"]["plate"] == {"text": "g", "met": 1.0, "verdict": REPRODUCED}
    alone = row.judged({"closed": half, "plate": good})  # no scheme in it
    assert alone.answers["paper"] == (SAME, 0.5) and list(alone.answers) == ["paper", "closed", "plate"]
    assert row._replace(beyond=True).judged({"plate": bad}).verdict == BEYOND


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
    unknown = path((0, 0), (10, 0), outcome="overloaded")
    assert not unknown.lost(200e-6) and not unknown.converged(PERIOD, 30e-6)


def test_where_parts_come_off():
    parts = [lost_at(5e-9, 0.0), lost_at(PITCH, 20e-6), path((0, 0)), path((0, 0))]
    numbers = coming_off(parts, [(0.0, 0.0), (PITCH, 0.0)])
    assert numbers["come_off"] == 0.5 and numbers["median_distance"] == pytest.approx(10.0025e-6)
    assert coming_off(parts[2:], [(0.0, 0.0)])["come_off"] == 0.0


# ---- figure 4


def swing(*events, turns):
    """Events of (time, kind); the relative velocity changes its sign at times."""

    def at(times):
        return SimpleNamespace(velocity=np.array([[(-1.0) ** sum(t >= turn for turn in turns), 0] for t in times]))

    rows = [SimpleNamespace(time=time, kind=kind) for time, kind in events]
    return SimpleNamespace(events=rows, time=np.array([0.0, 4.0]), at=at)


SLIPS, STOPS, REVERSES = EventKind.SLIPS, EventKind.STOPS, EventKind.REVERSES
REVERSING = swing((2.4, SLIPS), (2.9, REVERSES), (3.5, REVERSES), turns=(2.9, 3.5))


def test_4_slips_sticks_and_goes_the_other_way():
    assert slips_of(REVERSING) == (2.4, 2.9, 2.9, True)
    stopping = [(2.4, SLIPS), (2.9, STOPS), (3.2, SLIPS), (3.6, STOPS)]
    assert slips_of(swing(*stopping, turns=(3.0, 3.6))) == (2.4, 2.9, 3.2, True)
    assert not slips_of(swing(*stopping, turns=(3.6,))).turns
    assert met("4", slips=2.41, sticks=2.87, again=2.87, turns=True) == 1
    assert met("4", slips=2.44, sticks=2.87, again=3.2, turns=True) == 0.5


def test_4_the_relative_velocity_is_zero_once_after_each_reversal_of_the_platform():
    assert zero_after_each(REVERSING, np.array([1.0, 2.5, 3.0]))
    assert not zero_after_each(REVERSING, np.array([1.0, 2.5]))  # twice after the last one
    assert not zero_after_each(REVERSING, np.array([1.0, 2.5, 2.95, 3.0]))  # not between the last two


# ---- figures 5, 15


def test_5_a_curve_that_grows_and_falls_or_does_not():
    hill = curve_of(FREQUENCIES, np.array([0.0, 2.0, 4.0, 3.0, 1.0]))
    assert hill == (240.0, True, True, (220.0, 260.0))
    rising = curve_of(FREQUENCIES, np.arange(5.0))
    assert rising.top == 280 and rising.grows and not rising.falls
    assert not curve_of(FREQUENCIES, np.array([0.0, 2.0, 1.0, 4.0, 1.0])).grows
    assert not curve_of(FREQUENCIES, np.array([0.0, 4.0, 1.0, 3.0, 1.0])).falls
    assert met("5", onset=[160, 200, 260], grows=True, falls=False) == 0.6
    assert met("5, 6 (range)", halves=[(300, 1000), (320, 1100)]) == 1
    assert met("5, 6 (range)", halves=[(300, 1000), (390, 1000)]) == pytest.approx(1 / 3)


def test_15_grows_ends_and_what_is_beyond():
    row = np.array([0.0, 1e-6, 2e-6, 1.5e-6, NAN])
    outcome = np.array(["stuck", "stuck", "stuck", "stuck", "detached"])
    assert grows(row[None]) == 0.5 and window(FREQUENCIES, row, outcome) == (220.0, 260.0, "detached")
    assert window(FREQUENCIES[:4], row[:4], outcome)[2] == window(FREQUENCIES, 0 * row, outcome)[2] == "not reached"
    assert met("15", first=[100.0, NAN], beyond_the_last=["detached"], grows=0.95) == pytest.approx(2 / 3)


# ---- figures 16, 17, 20


def test_16_crosses_and_returns_and_goes_over():
    stays, crosses = path((-50, 15), (40, -10), (-20, 5)), path((-50, 15), (40, 0), (140, 0))
    assert crosses_and_returns(stays, PITCH) and not goes_over(stays, PITCH)
    assert goes_over(crosses, PITCH) and not crosses_and_returns(crosses, PITCH)
    assert not crosses_and_returns(path((-50, 15), (-10, 3)), PITCH)  # never beyond it
    assert not crosses_and_returns(path((-50, 15), (40, 0), (-10, 0), outcome="detached"), PITCH)
    assert not goes_over(path((-50, 15), (80, 200)), PITCH)  # beyond the half-way line, but nowhere near
    for low, middle, high, share in (
        ([stays], [crosses], [crosses], 1.0),
        ([crosses], [crosses], [crosses], 0.0),
        ([crosses], [stays], [stays], 0.0),  # the opposite
        ([stays], [stays], [stays], 0.5),
        ([stays], [crosses], [stays, crosses], 0.75),
    ):
        rows = {250.0 + k: own * (60 // len(own)) for k, own in enumerate((low, middle, high))}
        assert met("16", **trend_of(rows, PITCH)) == share


def test_17_counts_all_starts_and_says_what_the_stated_one_does():
    near, wide = path((100, 100), (5, 5)), path((100, 100), (210, 0), duration=0.05)
    numbers = converging(BENCH, [wide, *[near] * 59], 300.0)
    assert not numbers["stated_start_converges"] and numbers["share"] == (59, 60) and numbers["lost"] == (1, 60)
    returned = path((100, 100), (210, 0), (5, 5))
    assert converging(BENCH, [returned, near], 300.0)["lost"].hits == 0
    off, left = leaving(BENCH, [lost_at(1e-9, 0.0)] * 60), leaving(BENCH, [wide] * 60)
    assert met("17b", **off) == 0 and off["cycles_of_the_stated_start"] == np.inf
    assert met("17b", **left) == 0.5 and left["cycles_of_the_stated_start"] == pytest.approx(15.0)


def test_20_arrives_and_is_there_after_so_many_cycles():
    one = HANDOVERS["20"]  # 300 Hz at (0, 0)
    there = path((100, 0), (60, 0), (0, 0))
    assert arrives(BENCH, one, there) and not arrives(BENCH, one, path((100, 0), (60, 0), (150, 0)))
    assert arrives(BENCH, HANDOVERS["21"], path((-50, 15), (150, 0)))  # 300 Hz at (150, 0)
    assert cycles_until_there(BENCH, one, there) == pytest.approx(30 * PERIOD / 4 * 450)
    assert cycles_until_there(BENCH, one, path((100, 0), (80, 0))) == np.inf


# ---- figure 18


def ends(*rows, starts=10):
    """By frequency: c all converge, l all are lost, o all go to and fro, s all stay, 1 one of them is lost."""
    letters = np.array([["l" if k == 0 and row == "1" else row for k in range(starts)] for row in rows])
    return Ends(np.isin(letters, ["c", "1"]), letters == "l", letters != "s")


def test_18_the_threshold_is_the_first_loss_of_more_than_one_start_in_ten():
    frequencies = FREQUENCIES + 80
    assert first_loss(frequencies, ends(*"cclll")) == 310.0
    assert first_loss(frequencies, ends(*"c1lcl")) == 310.0  # one start of ten is tolerated; bands above do not count
    assert first_loss(frequencies, ends(*"c1lll", starts=9)) == 290.0
    assert np.isnan(first_loss(frequencies, ends(*"ccccc"))) and first_loss(frequencies, ends(*"lllll")) == 270.0
    assert shares_around(frequencies, ends(*"sclcl"), 310.0) == ((10, 10), (20, 30))
    for rows, below, above in (("cclll", 1.0, 1.0), ("oclll", 0.5, 1.0), ("ccccl", 0.5, 1.0), ("cclcc", 1.0, 0.5)):
        one = ends(*rows, starts=40)
        level = first_loss(frequencies, one)
        converge, leave = shares_around(frequencies, one, level)
        assert met("18", threshold=level, below=converge) == below and met("18 (above)", above=leave) == above


def test_18_a_quadratic_must_be_as_near_as_thresholds_are_known():
    x = np.linspace(100e-6, 200e-6, 9) / 150e-6
    coefficients, misfit = quadratic_of(x, 900 - 900 * x + 320 * x**2)
    assert coefficients == pytest.approx([320, -900, 900]) and misfit < 1e-6
    _, wild = quadratic_of(x, 320 + 100 * (-1.0) ** np.arange(9))
    assert met("18 (curve)", misfit=misfit, step=20.0) == 1 and met("18 (curve)", misfit=wild, step=20.0) == 0
    assert np.isnan(quadratic_of(x, np.full(9, NAN))[1]) and met("18 (curve)", misfit=NAN, step=20.0) == 0


# ---- figure 22, dead zones


def test_22_counts_parts_that_are_gone_and_each_frequency_by_itself():
    good, bad = np.full((5, 15), 2e-6), np.full((5, 15), NAN)
    mixed = TABLE["22"].answer(placing(np.stack([good] * 8 + [bad])))
    assert mixed.met == pytest.approx(8 / 9) and "by frequency 0 to 100 %" in mixed.text
    assert met("22", **placing(np.stack([good] * 9))) == 1 and within(bad, 1.0).hits == 0
    lucky = np.full(60, 3e-6)
    lucky[0] = 0.5e-6
    assert met("22 (two cases)", shares=[within(lucky, 1e-6)] * 2) == 0  # by all starts, not by one


def test_a_pitch_is_served_only_if_all_smaller_ones_are():
    pitches = np.array([1.0, 2.0, 3.0])
    rows = np.array([[1] * 10, [1] * 5 + [0] * 5, [1] * 10], dtype=bool)
    assert widest_served(pitches, rows) == 1.0 and widest_served(pitches, rows[[0, 2, 1]]) == 2.0
    assert widest_served(pitches, ~rows) == 0.0
    assert "at no pitch looked at" in TABLE["beyond: dead zones"].text(
        {"widest_served": 0.0, "there": None, "pitch": [1.0], "touches_two": [1.0]}
    )
