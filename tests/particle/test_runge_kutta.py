"""The embedded Runge-Kutta pairs of Dormand and Prince (1980) and of Hairer, Norsett and Wanner (DOP853, 1993)."""

import math

import numpy as np
import pytest

from particle import ConstantFriction, polynomial_surface
from particle.events.mechanics.equations import Part
from particle.events.mechanics.motion import as_numbers
from particle.events.memory import new_memory
from particle.events.sliding.runge_kutta import attempt, motion_rate, step_error
from particle.events.tableau import Pairs, pairs_for, tableau
from particle.modes import Mode
from particle.surface.at_point import surface_at
from particle.surface.span import enter

OMEGA = 3.0  # 1/s


def bowl():
    """A bowl so shallow that its slope's square does not count: gravity makes a harmonic oscillator of it."""
    return polynomial_surface([[0, 0, 0.5 * OMEGA**2 * 1e-9], [0, 0, 0], [0.5 * OMEGA**2 * 1e-9, 0, 0]])


def prepared(surface, pairs, *start, end=1.0):
    """Memory of a sliding part at its start, until an end [s]."""
    memory = new_memory(surface, pairs, np.zeros(1, dtype=np.int64))
    memory.motion_numbers[0, : len(start)] = start
    memory.now["mode"] = Mode.SLIDING
    enter(surface, memory.local, 0.0, 0.0, 0.0, end)
    return memory


def find_rate(memory, part):
    """The rate at the start of a step."""
    motion, time, step = memory.motion[0], memory.now[0].time, memory.step
    f = surface_at(memory.local, motion.x, motion.y, time)
    step.loads[0] = motion_rate(f, int(Mode.SLIDING), memory.local, part, time, motion, step.rates[0])


def march(pair, steps):
    """Position and velocity after 1 s by `steps` steps, and the pair's estimate for the first of them."""
    surface, part = bowl().record, Part(1.0, 1e9, 0.0, 0.0, 0.0, ConstantFriction(0.0).law)
    memory, h, first = prepared(surface, Pairs(pair, pair), 0.1, 0.0, 0.0, 0.2), 1 / steps, 0.0
    for k in range(steps):
        memory.now["time"] = k * h
        find_rate(memory, part)
        assert attempt(surface, part, pair, memory, h)
        first = step_error(pair, memory.step, h, 1.0, math.inf) if k == 0 else first
        memory.motion[0] = memory.step.end[0]
    return memory.motion_numbers[0, :4], first


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
    memory = prepared(surface, Pairs(pair, pair), 0.0, 0.0, 1.0, end=10.0)
    find_rate(memory, part)
    assert attempt(surface, part, pair, memory, 0.9)
    end = as_numbers(memory.step.end)[0]
    assert end == pytest.approx([0.9 - 0.5 * 0.81, 0, 0.1, 0, -0.5 * (1 - 0.01) + 0.495, 0.495, 0, 0], abs=1e-14)
    assert not attempt(surface, part, pair, memory, 1.5)
