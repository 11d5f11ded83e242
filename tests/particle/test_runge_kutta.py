"""The embedded Runge-Kutta pairs of Dormand and Prince (1980) and of Hairer, Norsett and Wanner (DOP853, 1993)."""

import math

import numpy as np
import pytest

from particle import ConstantFriction, polynomial_surface
from particle.events.equations import Part
from particle.events.record import SLIDING
from particle.events.runge_kutta import Pairs, attempt, error, fields_at_start, new_step, pairs_for, rate, tableau
from particle.surface.at_point import fields
from particle.surface.local import CELL, new_local
from particle.surface.span import enter

OMEGA = 3.0  # 1/s


def bowl():
    """A bowl so shallow that its slope's square does not count: gravity makes a harmonic oscillator of it."""
    return polynomial_surface([[0, 0, 0.5 * OMEGA**2 * 1e-9], [0, 0, 0], [0.5 * OMEGA**2 * 1e-9, 0, 0]])


def march(pair, steps):
    """Position and velocity after 1 s by `steps` steps, and the pair's estimate for the first of them."""
    surface, part = bowl().record, Part(1.0, 1e9, 0.0, 0.0, 0.0, ConstantFriction(0.0).law)
    local, step = new_local(surface), new_step(Pairs(pair, pair))
    enter(surface, local, 0.0, 0.0, 0.0, 1.0)
    state, h, first = np.array([0.1, 0.0, 0.0, 0.2, 0.0, 0.0]), 1 / steps, 0.0
    for k in range(steps):
        step.loads[0] = rate(
            fields(local, state[0], state[1], k * h), SLIDING, local, part, k * h, state, step.rates[0]
        )
        assert attempt(SLIDING, surface, local, part, pair, step, k * h, state, h)
        first = error(pair, step, h, 1.0, math.inf) if k == 0 else first
        state[:] = step.end
    return state[:4], first


def truth():
    c, s = math.cos(OMEGA), math.sin(OMEGA)
    return np.array([0.1 * c, 0.2 / OMEGA * s, -0.1 * OMEGA * s, 0.2 * c])


@pytest.mark.parametrize("order, steps", [(5, (16, 32)), (8, (4, 8))])
def test_the_error_falls_at_the_pairs_order(order, steps):
    pair = tableau(order)
    errors = [np.linalg.norm(march(pair, n)[0] - truth()) for n in steps]
    assert math.log2(errors[0] / errors[1]) > order - 0.3
    assert errors[1] < 1e-6


@pytest.mark.parametrize("order", [5, 8])
def test_the_estimate_falls_with_the_step_and_is_not_below_the_error(order):
    pair = tableau(order)
    coarse, fine = march(pair, 4)[1], march(pair, 8)[1]
    assert math.log2(coarse / fine) > order - 1.2
    one = march(pair, 8)[0]
    assert np.linalg.norm(one - truth()) < 8 * 3 * fine


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6, 9e-7, 1e-12])
def test_the_tableau_is_consistent(tolerance):
    long, short = pairs_for(tolerance)
    assert (long.order, short.order) == (5 if tolerance >= 1e-6 else 8, 5)
    for pair in (long, short):
        is_consistent(pair)


def is_consistent(pair):
    assert pair.a.sum(axis=1) == pytest.approx(pair.c, abs=1e-14)
    assert np.abs(pair.error.sum(axis=1)).max() < 1e-14
    assert not np.triu(pair.a).any()


def test_the_part_does_not_slide_back_within_a_step_under_friction():
    surface, part, pair = (
        polynomial_surface([[0.0]]).record,
        Part(1.0, 9.81, 0.0, 0.0, 0.0, ConstantFriction(1.0).law),
        tableau(8),
    )
    local, step, state = new_local(surface), new_step(Pairs(pair, pair)), np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    enter(surface, local, 0.0, 0.0, 0.0, 10.0)
    step.loads[0] = rate(fields(local, 0.0, 0.0, 0.0), SLIDING, local, part, 0.0, state, step.rates[0])
    assert attempt(SLIDING, surface, local, part, pair, step, 0.0, state, 0.9)
    assert step.end == pytest.approx([0.9 - 0.5 * 0.81, 0, 0.1, 0, -0.5 * (1 - 0.01) + 0.495, 0.495], abs=1e-14)
    assert not attempt(SLIDING, surface, local, part, pair, step, 0.0, state, 1.5)


def test_the_surface_at_a_steps_end_serves_the_next_step_in_the_same_cell():
    surface, part = bowl().record, Part(1.0, 1e9, 0.0, 0.0, 0.0, ConstantFriction(0.0).law)
    local, step, count = new_local(surface), new_step(pairs_for(1e-9)), np.zeros(3, dtype=np.int64)
    enter(surface, local, 0.0, 0.0, 0.0, 1.0)
    state, h = np.array([0.1, 0.0, 0.0, 0.2, 0.0, 0.0]), 0.01
    step.loads[0] = rate(
        fields_at_start(local, step, count, 0.0, state), SLIDING, local, part, 0.0, state, step.rates[0]
    )
    assert count[0] == 1
    assert attempt(SLIDING, surface, local, part, tableau(8), step, 0.0, state, h)
    assert fields_at_start(local, step, count, h, step.end) == fields(local, step.end[0], step.end[1], h)
    assert count[0] == 1  # it was kept
    elsewhere = step.end + np.array([1e-15, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert fields_at_start(local, step, count, h, elsewhere) == fields(local, elsewhere[0], elsewhere[1], h)
    fields_at_start(local, step, count, 1.1 * h, step.end)
    local.counts[CELL] += 1
    fields_at_start(local, step, count, h, step.end)
    assert count[0] == 4  # another place, time or cell
