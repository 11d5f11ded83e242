"""Shares with their intervals, and what a path does: converge, leave, come off."""

import numpy as np
import pytest
from paper_paths import PERIOD, PITCH, lost_at, path

from active_surface.paper.figures.coming_off import bending_pull, end_said, hardest, off_numbers, off_said
from active_surface.paper.models import Bench
from active_surface.paper.parameters import PARAMETERS
from active_surface.paper.share import Share, share_of

BENCH = Bench()


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
