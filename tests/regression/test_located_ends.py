"""Cases that once went wrong, each with its story."""

import numpy as np
import pytest

from coupling import run_case, surface_motion
from coupling.case import Case
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    Micropart,
    Outcome,
    polynomial_surface,
    simulate,
)
from particle.drives import drive_table, next_breakpoint

RADIUS = 300e-6


@pytest.mark.parametrize("direction", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_surface_can_be_evaluated_where_the_rim_touches_its_box(direction):
    """The grid's last cell did not own its far edge: a part that left along +x or +y lost the whole run."""
    surface = surface_motion(DiscShapes([[0, 0]], RADIUS), [Drive(1e-6, 300.0)])
    assert abs(surface.evaluate(RADIUS * np.array(direction), 1e-3).w[0]) < 1e-15


@pytest.mark.compiled
@pytest.mark.parametrize("axis", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_a_part_that_leaves_along_an_axis_has_its_files(axis, tmp_path):
    position, velocity = [0.0, 0.0], [0.0, 0.0]
    position[axis], velocity[axis] = 200e-6, 1.0
    plate = {"shape": "disc", "radius": RADIUS, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
    case = Case(
        plate=plate,
        actuators=[{"position": (0.0, 0.0), "stroke": 1e-6, "frequency": 300.0}],
        part={"mass": 2e-9, "position": position, "velocity": velocity},
        friction={"model": "constant", "limit": 1e-9},
        run={"duration": 1e-3},
    )
    result = run_case(case, output=tmp_path)
    assert result.trajectory.outcome is Outcome.LEFT_PLATE
    assert all(file.exists() for file in result.files)


def test_next_breakpoint_is_always_later():
    """At late times rounding put a breakpoint before the time that it was asked for, and a run never ended."""
    random = np.random.default_rng(5)
    for _ in range(100):
        drive = Drive(1e-6, random.uniform(100, 1000), delay=random.choice([0.0, 1e-3]))
        table = drive_table([drive])
        for count in random.integers(1, 100_000, 20):
            breakpoint = drive.delay + count * 0.5 / drive.frequency
            assert next_breakpoint(table, breakpoint) > breakpoint


@pytest.mark.parametrize("static, kind", [(0.39, EventKind.REVERSES), (0.41, EventKind.STOPS)])
def test_static_friction_holds_a_part_that_turns_back(static, kind):
    """On a slope of 0.4 a part thrown uphill comes back only if static friction, not sliding friction, lets it."""
    incline = polynomial_surface([[0.0], [0.4]])
    path = simulate(incline, Micropart(1e-9, (0, 0), (1.0, 0)), CoulombAdhesion(0.3, 0.0, static), duration=0.5)
    assert path.events[0].kind is kind
    assert path.outcome is (Outcome.STUCK if kind is EventKind.STOPS else Outcome.MOVING)


def test_forces_between_rows_are_those_of_the_moment():
    """A stuck part's forces once were those at the last event, although the surface under it goes on moving."""
    surface = surface_motion(DiscShapes([[0, 0]], RADIUS), [Drive(10e-6, 300.0)])
    friction, mass, gravity = ConstantFriction(1e-6), 2e-9, 9.80665
    path = simulate(surface, Micropart(mass, (100e-6, 0)), friction, duration=5e-3)
    assert path.outcome is Outcome.STUCK
    times = np.linspace(0, 5e-3, 23)
    samples = path.at(times)
    for time, n, q in zip(times, samples.normal_force, samples.friction_force, strict=True):
        at = surface.evaluate(path.position[0], time)
        force = mass * (gravity + at.w_tt[0]) / np.sqrt(1 + at.gradient[0, 0] ** 2)
        assert n == pytest.approx(force, rel=1e-12)
        assert q == pytest.approx(abs(force * at.gradient[0, 0]), rel=1e-9, abs=1e-20)


@pytest.mark.parametrize("slope", [0.1, 0.2, 0.3, 0.4, 0.5, 0.577, 0.7, 1.0])
def test_a_slope_at_the_angle_of_friction_holds(slope):
    """Rounding once let go of the part for some slopes (0.2, 0.3) and not for others."""
    incline = polynomial_surface([[0.0], [slope]])
    path = simulate(incline, Micropart(1e-9, (0, 0)), CoulombAdhesion(slope), duration=1.0)
    assert path.outcome is Outcome.STUCK
    assert path.distance == 0
