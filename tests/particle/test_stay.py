"""Whether a part that rests at the end of a run does so for good."""

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from particle import ConstantFriction, CoulombAdhesion, Drive, Micropart, Outcome, polynomial_surface, simulate
from particle.drives import drive_table, horizon, monomial_table

MASS, START = 2e-9, (100e-6, -30e-6)


def run(exact, drives, duration, limit=20.9):
    return simulate(surface_motion(exact, drives), Micropart(MASS, START), ConstantFriction(limit * MASS), duration)


def test_strokes_too_weak_to_move_it_never_will(exact):
    path = run(exact, [Drive(10e-6, 300), Drive(-8e-6, 450)], 1e-3)
    assert path.outcome is Outcome.STUCK and path.stays
    assert path.sentence == "The part is at rest, and the drives do not move it again."


def test_a_stroke_that_comes_later_is_seen(exact):
    late = Drive(150e-6, 300, cycles=1, delay=5e-3)
    path = run(exact, [late, Drive(0.0, 300)], 1e-3)
    assert path.outcome is Outcome.STUCK and path.stays is False
    assert path.sentence.endswith("rests between slips at the end of the run.")
    assert run(exact, [late, Drive(0.0, 300)], 6e-3).events


@pytest.mark.compiled
def test_a_part_that_only_both_drives_together_move_is_told_of_from_their_common_period(exact):
    """Out of step within the run, in step after 1 / (310 Hz - 300 Hz)."""
    drives = [Drive(60e-6, 300), Drive(60e-6, 310, delay=0.5 / 310)]
    path = run(exact, drives, 0.5e-3)
    later = run(exact, drives, 0.2)
    assert path.outcome is Outcome.STUCK
    assert path.stays is (not later.events)


def test_what_is_not_known_is_not_said(exact):
    path = run(exact, [Drive(10e-6, 300), Drive(-8e-6, 300 * np.sqrt(2))], 1e-3)
    assert path.outcome is Outcome.STUCK and path.stays is None
    assert path.sentence == Outcome.STUCK.sentence


def test_a_part_on_a_slope_at_rest_stays_and_one_on_a_slope_that_steepens_is_not_judged():
    still = simulate(polynomial_surface([[0.0], [0.1]]), Micropart(MASS, (0, 0)), CoulombAdhesion(0.3), 1.0)
    assert still.stays
    moving = np.zeros((2, 1, 2))
    moving[1, 0] = 0.1, 0.01
    assert simulate(polynomial_surface(moving), Micropart(MASS, (0, 0)), CoulombAdhesion(0.3), 1.0).stays is None


@pytest.mark.parametrize(
    "drives, time, expected",
    [
        ([Drive(1e-6, 300), Drive(1e-6, 400)], 0.05, 0.06),
        ([Drive(1e-6, 300), Drive(1e-6, 450, delay=0.1)], 0.05, 0.1 + 1 / 150),
        ([Drive(1e-6, 300, cycles=3)], 0.05, 0.05),
        ([Drive(1e-6, 300, cycles=3)], 0.0, 0.01),
        ([Drive(1e-6, 300), Drive(1e-6, 300 * np.sqrt(2))], 0.0, None),
    ],
)
def test_the_horizon_is_a_common_period_after_the_last_single_stroke(drives, time, expected):
    assert horizon(drive_table(drives), time) == (None if expected is None else pytest.approx(expected, rel=1e-12))


def test_a_polynomial_in_time_has_no_horizon():
    assert horizon(monomial_table(1), 0.5) == 0.5
    assert horizon(monomial_table(2), 0.5) is None
