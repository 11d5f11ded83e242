"""Paths and events against `motion_oracle`, which shares nothing with the integrator but the equations.

It knows the plate by Boggio's function, strokes and polynomials by formulas, and friction by its own formula except
for the rough contact and the table of points, which other tests check.
"""

import math

import numpy as np
import pytest
from motion_cases import NAMES, breakpoints, limit_of, path_length, ratio_of
from motion_oracle import trace
from motion_problem import Problem
from motion_surfaces import boggio, polynomial, still, up, up_down

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    FrictionTable,
    KogutEtsion,
    Micropart,
    polynomial_surface,
    simulate,
)

MASS, G, RADIUS = 2e-9, 9.80665, 300e-6
CONSTANT = ConstantFriction(20.9 * MASS)
PAIR = [[75e-6, 10e-6], [-75e-6, 10e-6]]
STROKES = [(150e-6, 300, 0.0), (90e-6, 450, 0.4e-3)]
THREE = [[0.0, 120e-6], [110e-6, -60e-6], [-90e-6, -80e-6]]
POINTS = FrictionTable([-4e-7, -2e-7, 0.0, 4e-7, 1e-6, 4e-6], [0.0, 1.5e-8, 2.6e-8, 4.2e-8, 6e-8, 1e-7], 1.2)
DOWN = (0.0, 0.0, -G)
# Tolerance, then how far ends may differ over the length of the path, and how far events over their time.
BOUNDS = [(1e-10, 1e-8, 1e-7), (1e-12, 1e-9, 1e-8)]
# m: rounding on a plate of 300 um. Whatever the tolerances of both and of the surface, ends stay 2e-14 to 9e-14 off,
# more or less by processor.
ROUNDING = 2e-13

# Actuators, (stroke, frequency, delay) of each, part, friction, gravity, duration.
PLATES = {
    "constant": (PAIR, STROKES, Micropart(MASS, (60e-6, -40e-6)), CONSTANT, DOWN, 3e-3),
    "many stops": (PAIR, STROKES, Micropart(MASS, (0.0, 100e-6)), ConstantFriction(60 * MASS), DOWN, 8e-3),
    "three actuators": (
        THREE,
        [(60e-6, 500, 0.0), (-40e-6, 700, 0.3e-3), (50e-6, 350, 0.1e-3)],
        Micropart(MASS, (20e-6, 10e-6)),
        CONSTANT,
        DOWN,
        5e-3,
    ),
    "rough": (PAIR, STROKES, Micropart(MASS, (100e-6, 100e-6)), KogutEtsion.paper(), DOWN, 4e-3),
    "static friction and adhesion": (
        PAIR,
        STROKES,
        Micropart(MASS, (60e-6, -40e-6)),
        CoulombAdhesion(0.05, 8e-7, static_coefficient=0.07),
        DOWN,
        4e-3,
    ),
    "squeezed": (PAIR, STROKES, Micropart(MASS, (60e-6, -40e-6), squeeze=8e-7), CoulombAdhesion(0.05), DOWN, 4e-3),
    "tilted": (PAIR, STROKES, Micropart(MASS, (-40e-6, -60e-6)), CONSTANT, (3.0, -2.0, -9.0), 4e-3),
    "points": (PAIR, STROKES, Micropart(MASS, (60e-6, -40e-6), squeeze=4e-7), POINTS, DOWN, 4e-3),
    "thrown": (PAIR, STROKES, Micropart(MASS, (60e-6, -40e-6), (-0.3, 0.2)), CONSTANT, DOWN, 3e-3),
    "without friction": (
        PAIR,
        STROKES,
        Micropart(MASS, (60e-6, -40e-6), (0.02, 0.05)),
        ConstantFriction(0.0),
        DOWN,
        2e-3,
    ),
    "comes off": (PAIR, STROKES, Micropart(MASS, (60e-6, -40e-6)), CoulombAdhesion(0.05, 6e-7), DOWN, 4e-3),
    "over the rim": (PAIR, STROKES, Micropart(MASS, (200e-6, 100e-6), (0.1, 0.1)), CONSTANT, DOWN, 4e-3),
}


QUICK = (
    "constant",
    "static friction and adhesion",
    "thrown",
    "without friction",
    "over the rim",
    "swaying",
    "round a bowl",
)


def some_slow(names):
    return [pytest.param(name, marks=[] if name in QUICK else [pytest.mark.slow]) for name in names]


def problem(actuators, strokes, part, law, gravity, duration):
    return Problem(
        boggio(actuators, RADIUS, [up_down(*stroke) for stroke in strokes]),
        part.mass,
        limit_of(law),
        breakpoints(strokes, duration),
        gravity,
        part.squeeze,
        law.pull_off,
        ratio_of(law),
        lambda x, y: RADIUS - math.hypot(x, y),
        0.5 / max(f for _, f, _ in strokes),
    )


def compare(run, theirs, start, rounding=0.0):
    """The same events at the same times and places, for each of the tolerances. run: of a tolerance."""
    kinds, times = [kind for kind, *_ in theirs.events], [time for _, time, *_ in theirs.events]
    corners = [start, *(place for _, _, *place in theirs.events), theirs.position]
    way = path_length(theirs, start)
    for tolerance, near, prompt in BOUNDS:
        ours = run(tolerance)
        assert [NAMES[event.kind.name] for event in ours.events] == kinds
        late = 1e-12 * ours.time[-1]  # for what begins at once
        assert [event.time for event in ours.events] == pytest.approx(times, rel=prompt, abs=late)
        assert [math.dist(e.position, p) for e, p in zip(ours.events, corners[1:-1], strict=True)] == pytest.approx(
            [0.0] * len(kinds), abs=near * way + rounding
        )
        assert np.hypot(*(ours.position[-1] - theirs.position)) < near * way + rounding
        assert ours.time[-1] == pytest.approx(theirs.time, rel=prompt)


@pytest.mark.compiled
@pytest.mark.parametrize(
    "height, end, events",
    [
        (up_down(150e-6, 300, cycles=1), -206.94636692e-6, [5.0145826380, 7.8174933769, 9.1779096176, 73.018081602]),
        (up(150e-6, 450), 80.912241714e-6, [12.991135930, 33.136873480]),
    ],
    ids=["up and down at 300 Hz", "up at 450 Hz"],
)
def test_the_oracle_finds_the_reference_paths_of_one_stroke(height, end, events):
    """On which two other integrators agreed; the digits given are all confirmed."""
    plate, changes = boggio([[0.0, 0.0]], RADIUS, [height]), [1 / 600, 1 / 450, 1 / 300]
    stroke = Problem(plate, MASS, lambda load: 20.9 * MASS, changes, (0.0, 0.0, 0.0))
    found = trace(stroke, (100e-6, 0.0), (0.0, 0.0), 8e-3)
    assert found.position == pytest.approx((end, 0.0), rel=3e-11, abs=1e-18)
    assert [time for _, time, *_ in found.events] == pytest.approx(1e-4 * np.array(events), rel=4e-11)


def test_the_oracle_keeps_the_pursuit_curve_and_stops_as_dry_friction_says():
    """mu = tan(angle), pushed across: u + v_down is kept. On the flat a push stops after u / (mu g)."""
    angle = math.radians(30)
    mu = math.tan(angle)
    incline = Problem(polynomial([[0.0], [mu]]), 1.0, lambda load: mu * load)
    found = trace(incline, (0.0, 0.0), (0.0, 2.0), 1.0).velocity
    down = -found[0] / math.cos(angle)
    assert down + math.hypot(down, found[1]) == pytest.approx(2.0, rel=1e-11)
    flat = Problem(polynomial([[0.0]]), 1.0, lambda load: 0.3 * load)
    found = trace(flat, (0.0, 0.0), (0.6, 0.8), 1.0)
    (kind, time, *place) = found.events[0]
    assert kind == "stops" and time == pytest.approx(1 / (0.3 * G), rel=1e-12)
    assert place == pytest.approx([0.6 / (0.6 * G), 0.8 / (0.6 * G)], rel=1e-12)


@pytest.mark.compiled
@pytest.mark.parametrize("name", some_slow(PLATES))
def test_a_path_on_a_plate_is_the_oracle_s(name):
    actuators, strokes, part, law, gravity, duration = PLATES[name]
    theirs = trace(problem(*PLATES[name]), part.position, part.velocity, duration)
    drives = [Drive(stroke, f, delay=delay) for stroke, f, delay in strokes]
    surface = surface_motion(DiscShapes(actuators, RADIUS), drives, 1e-11)
    compare(
        lambda tolerance: simulate(surface, part, law, duration, gravity, tolerance), theirs, part.position, ROUNDING
    )


BOWL = np.array([[0.0, 0.05, 0.9], [0.0, 0.2, 0.0], [0.6, 0.0, 0.0]])
SWAYS = np.zeros((3, 3, 4))  # a bowl that rises, tilts and flattens
SWAYS[:, :, 0] = BOWL
SWAYS[0, 0, 2:], SWAYS[1, 0, 1:3], SWAYS[0, 2, 1] = (0.5, -0.4), (0.2, -0.3), -0.4
BASE = [(0.3, 1.6, 0.0), (-0.2, 2.5, 0.1)]
# Coefficients, base, part, friction, gravity, duration.
POLYNOMIALS = {
    "to and fro in a bowl": (BOWL[:, :1], [], Micropart(1.0, (0.8, 0.0)), ConstantFriction(0.9), DOWN, 6.0),
    "round a bowl": (BOWL, [], Micropart(1.0, (0.5, -0.2), (0.3, 0.8)), CoulombAdhesion(0.05), DOWN, 4.0),
    "swaying": (SWAYS, [], Micropart(1.0, (0.4, 0.1)), CoulombAdhesion(0.2, 0.5, 0.25), DOWN, 1.5),
    "on a base": (BOWL, BASE, Micropart(1.0, (0.1, 0.0)), CoulombAdhesion(0.3), DOWN, 2.0),
    "flat, on a base": ([[0.0]], BASE, Micropart(1.0, (0.1, 0.0)), CoulombAdhesion(0.2), DOWN, 2.0),
    "all of it": (SWAYS, BASE, Micropart(1.0, (0.3, 0.2), squeeze=2.0), CoulombAdhesion(0.2), (1.0, 0.5, -9.0), 1.5),
}


@pytest.mark.compiled
@pytest.mark.parametrize("name", some_slow(POLYNOMIALS))
def test_a_path_on_a_polynomial_is_the_oracle_s(name):
    coefficients, base, part, law, gravity, duration = POLYNOMIALS[name]
    drives = [Drive(stroke, f, delay=delay) for stroke, f, delay in base] or None
    heights = [up_down(*stroke) for stroke in base] or (still, still)
    exact = Problem(
        polynomial(coefficients, heights),
        part.mass,
        limit_of(law),
        breakpoints(base, duration),
        gravity,
        part.squeeze,
        law.pull_off,
        ratio_of(law),
        stroke_time=0.2,
    )
    theirs = trace(exact, part.position, part.velocity, duration)
    surface = polynomial_surface(coefficients, drives)
    compare(lambda tolerance: simulate(surface, part, law, duration, gravity, tolerance), theirs, part.position)
