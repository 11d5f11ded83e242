"""Closed forms: a shaken block, a squeezed one, a tilted device, a lift, bowls, lines of symmetry, and rest."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    FrictionTable,
    HermiteDrive,
    KogutEtsion,
    Micropart,
    Outcome,
    polynomial_surface,
    simulate,
)

G, MASS, RADIUS, MU = 9.80665, 2e-9, 300e-6, 0.3
FLAT, STILL = [[0.0]], Drive(0.0, 1.0, cycle="up")
ANGLE = math.radians(25)
INCLINE = [[0.0], [math.tan(ANGLE)]]


def shaken(move, speed, push, limit, end, step):
    """Slips, stops and reversals (kind, time, place) of a block under dry friction `limit` [m/s^2] on a platform.

    The platform is at move(t), its speed and acceleration are speed(t), push(t). The block rests on it at first.
    While it slides its speed in space changes by the limit, until it is that of the platform.
    """

    def first(f, start):
        """The first root of f after start, which is one."""
        time = start + step
        while f(time) * f(time + step) > 0:
            time += step
        return brentq(f, time, time + step, xtol=1e-16, rtol=1e-15)

    events, time, place, rests = [], 0.0, 0.0, True
    while time < end:
        if rests:
            time = 0.0 if abs(push(time)) > limit else first(lambda t: abs(push(t)) - limit, time)
            events.append((EventKind.SLIPS, time, place))
        towards, begin = math.copysign(limit, push(time)), time  # the platform takes the block along

        def gained(t, towards=towards, begin=begin):
            return speed(begin) + towards * (t - begin) - speed(t)

        time = first(gained, begin)
        place += speed(begin) * (time - begin) + towards * (time - begin) ** 2 / 2 - move(time) + move(begin)
        rests = abs(push(time)) <= limit
        events.append((EventKind.STOPS if rests else EventKind.REVERSES, time, place))
    return [event for event in events if event[1] < end]


AMPLITUDE, RATE = 0.01, 2 * math.pi * 4.0  # m, 1/s: at most 6.3 m/s^2
SINE = (
    lambda t: AMPLITUDE * math.sin(RATE * t),
    lambda t: AMPLITUDE * RATE * math.cos(RATE * t),
    lambda t: -AMPLITUDE * RATE**2 * math.sin(RATE * t),
)
COSINE = (
    lambda t: AMPLITUDE * (1 - math.cos(RATE * t)),
    lambda t: AMPLITUDE * RATE * math.sin(RATE * t),
    lambda t: AMPLITUDE * RATE**2 * math.cos(RATE * t),
)
GROWING = (  # the paper's figure 4
    lambda t: t * math.sin(3.2 * t),
    lambda t: math.sin(3.2 * t) + 3.2 * t * math.cos(3.2 * t),
    lambda t: 6.4 * math.cos(3.2 * t) - 10.24 * t * math.sin(3.2 * t),
)


def sampled(motion, end, pieces):
    return HermiteDrive.of(lambda t: tuple(np.array([f(x) for x in t]) for f in motion), end, pieces)


SHAKERS = {
    "sine": (SINE, Drive(AMPLITUDE, 4.0, cycle="sine"), 3.0, 25.0),  # a hundred periods, as the next
    "sine, with rests": (SINE, Drive(AMPLITUDE, 4.0, cycle="sine"), 5.0, 25.0),
    "cosine": (COSINE, Drive(2 * AMPLITUDE, 4.0, cycle="cosine"), 3.0, 2.0),
    "sine through points": (SINE, sampled(SINE, 1.0, 512), 5.0, 1.0),
    "growing": (GROWING, sampled(GROWING, 4.0, 1000), 23.524, 4.0),
}


@pytest.mark.compiled
@pytest.mark.parametrize("coulomb", [True, False], ids=["coulomb", "constant"])
@pytest.mark.parametrize("name", SHAKERS)
def test_a_block_on_a_shaken_platform_slips_stops_and_turns_as_dry_friction_says(name, coulomb):
    motion, drive, limit, end = SHAKERS[name]
    law = CoulombAdhesion(limit / G) if coulomb else ConstantFriction(limit)
    expected = shaken(*motion, limit, end, 1e-4)
    surface = polynomial_surface(FLAT, base=(drive, STILL))
    path = simulate(surface, Micropart(1.0, (0.0, 0.0)), law, end, tolerance=1e-11)
    assert len(expected) >= 2
    assert [event.kind for event in path.events] == [kind for kind, _, _ in expected]
    assert [event.time for event in path.events] == pytest.approx([time for _, time, _ in expected], abs=1e-8)
    found = np.array([event.position for event in path.events])
    assert found[:, 0] == pytest.approx([place for _, _, place in expected], abs=1e-9)
    assert not found[:, 1].any()


def test_the_paper_s_platform_lets_its_block_slip_at_2_41_and_hold_near_2_86():
    """Its figure 4, x = t sin(3.2 t) and 23.524 m/s^2 of friction."""
    slip, stop = shaken(*GROWING, 23.524, 3.0, 1e-4)
    assert slip[1] == pytest.approx(2.41, abs=5e-3) and stop[1] == pytest.approx(2.86, abs=1e-2)


@pytest.mark.parametrize("law", [CoulombAdhesion(MU), CoulombAdhesion(0.2, 0.5)])
def test_a_push_on_a_lift_that_speeds_up_ends_when_friction_has_taken_its_speed(law):
    """On w = 0.8 t^2 - 0.3 t^3 the load is m (g + w''), so that u = u_0 - mu (g t + w'(t) + adhesion t / m)."""
    speed, mu = 1.1, law.coefficient

    def left(t):
        return speed - mu * ((G + law.adhesion) * t + 1.6 * t - 0.9 * t**2)

    stop = brentq(left, 0.0, 1.0, xtol=1e-16)
    way = speed * stop - mu * ((G + law.adhesion + 1.6) * stop**2 / 2 - 0.3 * stop**3)
    surface = polynomial_surface([[[0.0, 0.0, 0.8, -0.3]]])
    path = simulate(surface, Micropart(1.0, (0.0, 0.0), (0.6 * speed, -0.8 * speed)), law, 0.6, tolerance=1e-10)
    (event,) = path.events
    assert event.kind is EventKind.STOPS and event.time == pytest.approx(stop, abs=1e-9)
    assert event.position == pytest.approx((0.6 * way, -0.8 * way), abs=1e-9)


@pytest.mark.parametrize("adhesion", [0.0, 3.0])
def test_a_squeeze_adds_to_the_load_and_to_nothing_else(adhesion):
    """Pushed over a level surface mu (m g + F + adhesion) / m slows it down; on an incline it slides that much less."""
    mass, force, speed = 2.0, 7.0, 1.7
    law = CoulombAdhesion(MU, adhesion)
    slow = MU * (mass * G + force + adhesion) / mass
    part = Micropart(mass, (0.0, 0.0), (speed, 0.0), squeeze=force)
    (event,) = simulate(polynomial_surface(FLAT), part, law, 1.0).events
    assert event.time == pytest.approx(speed / slow, rel=1e-12)
    assert event.position == pytest.approx((speed**2 / (2 * slow), 0.0), rel=1e-12)
    steep = math.radians(50)
    downhill = G * math.sin(steep) - MU * (G * math.cos(steep) + (force + adhesion) / mass)
    assert downhill > 1
    incline = polynomial_surface([[0.0], [math.tan(steep)]])
    path = simulate(incline, Micropart(mass, (0.0, 0.0), squeeze=force), law, 0.7)
    assert path.position[-1, 0] == pytest.approx(-0.5 * downhill * 0.49 * math.cos(steep), rel=1e-12)
    assert path.normal_force[-1] == pytest.approx(mass * G * math.cos(steep) + force, rel=1e-14)


@pytest.mark.parametrize("share, outcome", [(1 + 1e-9, Outcome.STUCK), (1 - 1e-9, Outcome.MOVING)])
def test_a_squeeze_holds_a_part_on_an_incline_from_the_force_on_that_it_takes(share, outcome):
    needed = G * (math.sin(ANGLE) / MU - math.cos(ANGLE))  # per kg
    part = Micropart(1.0, (0.2, -0.1), squeeze=share * needed)
    path = simulate(polynomial_surface(INCLINE), part, CoulombAdhesion(MU), 5.0)
    assert path.outcome is outcome
    assert (path.position == [0.2, -0.1]).all() == (outcome is Outcome.STUCK)


@pytest.mark.parametrize("law", [CoulombAdhesion(MU), ConstantFriction(2.0), CoulombAdhesion(0.1, 2.0)])
@pytest.mark.parametrize("velocity, bound", [((0.0, 0.0), 1e-13), ((1.3, 0.0), 1e-13), ((0.5, 1.1), 1e-10)])
def test_a_tilted_device_is_an_incline(law, velocity, bound):
    """The same path in coordinates along the plane: to rounding where it is straight, else to the tolerance."""
    stretch = 1 / math.cos(ANGLE)
    sloped = simulate(polynomial_surface(INCLINE), Micropart(1.0, (0.0, 0.0), velocity), law, 0.8, tolerance=1e-12)
    along = (velocity[0] * stretch, velocity[1])
    gravity = (-G * math.sin(ANGLE), 0.0, -G * math.cos(ANGLE))
    tilted = simulate(polynomial_surface(FLAT), Micropart(1.0, (0.0, 0.0), along), law, 0.8, gravity, tolerance=1e-12)
    assert tilted.position[-1] == pytest.approx(sloped.position[-1] * [stretch, 1.0], abs=bound)
    assert tilted.velocity[-1] == pytest.approx(sloped.velocity[-1] * [stretch, 1.0], abs=10 * bound)
    assert tilted.normal_force[-1] == pytest.approx(sloped.normal_force[-1], rel=1e-13)
    assert [event.kind for event in tilted.events] == [event.kind for event in sloped.events]
    assert tilted.distance > 0.1


def test_a_part_pushed_uphill_turns_and_slides_back():
    up, down = (G * (math.sin(ANGLE) + sign * MU * math.cos(ANGLE)) for sign in (1, -1))
    speed, end = 1.5, 1.2
    top, turn = speed**2 / (2 * up), speed / up
    law = CoulombAdhesion(MU)
    start = Micropart(1.0, (0.0, 0.0), (speed * math.cos(ANGLE), 0.0))
    path = simulate(polynomial_surface(INCLINE), start, law, end)
    (event,) = path.events
    assert event.kind is EventKind.REVERSES and event.time == pytest.approx(turn, rel=1e-12)
    assert event.position[0] == pytest.approx(top * math.cos(ANGLE), rel=1e-12)
    place = (top - down * (end - turn) ** 2 / 2) * math.cos(ANGLE)
    assert path.position[-1, 0] == pytest.approx(place, abs=1e-12)


@pytest.mark.compiled
@pytest.mark.parametrize("squares", [(0.5, 0.5), (0.6, 0.9)], ids=["round", "oval"])
def test_a_bowl_without_friction_keeps_its_energy_over_a_hundred_periods(squares):
    """To 1e-10; in a round one the spin as well."""
    surface = polynomial_surface([[0.0, 0.0, squares[1]], [0.0, 0.0, 0.0], [squares[0], 0.0, 0.0]])
    period = 2 * math.pi / math.sqrt(2 * G * min(squares))  # of small swings; these take longer
    part = Micropart(1.0, (0.3, -0.2), (0.3, 0.8))
    path = simulate(surface, part, ConstantFriction(0.0), 100 * period, tolerance=1e-12)
    assert path.outcome is Outcome.MOVING
    energy = path.energy.kinetic + path.energy.potential
    spin = path.position[:, 0] * path.velocity[:, 1] - path.position[:, 1] * path.velocity[:, 0]
    assert np.ptp(energy) < 1e-10 * energy[0]
    if squares[0] == squares[1]:
        assert np.ptp(spin) < 1e-10 * abs(spin[0])


@pytest.mark.parametrize("start", [(100e-6, 0.0), (60e-6, -80e-6), (70e-6, 70e-6), (0.0, -90e-6)])
def test_a_pass_straight_over_an_actuator_stays_on_its_line(start):
    surface = surface_motion(DiscShapes([[0.0, 0.0]], RADIUS), [Drive(150e-6, 300, cycles=1)])
    path = simulate(surface, Micropart(MASS, start), ConstantFriction(20.9 * MASS), 8e-3, 0.0, tolerance=1e-10)
    x, y = np.array(start) / math.hypot(*start)
    assert (path.position @ [x, y]).min() < -0.5 * RADIUS
    assert np.abs(path.position @ [-y, x]).max() < 1e-12 * RADIUS


def test_a_pass_over_both_of_two_actuators_stays_on_their_line():
    """To what the cells' polynomials leave of the symmetry."""
    surface = surface_motion(DiscShapes([[75e-6, 0.0], [-75e-6, 0.0]], RADIUS), [Drive(150e-6, 300)] * 2)
    path = simulate(surface, Micropart(MASS, (140e-6, 0.0)), ConstantFriction(20.9 * MASS), 8e-3, tolerance=1e-10)
    assert path.position[:, 0].min() < -75e-6
    assert np.abs(path.position[:, 1]).max() < 2 * surface.error * RADIUS


@pytest.mark.compiled
@pytest.mark.parametrize(
    "law",
    [ConstantFriction(20.9 * MASS), CoulombAdhesion(MU, 8e-7), KogutEtsion.paper()],
    ids=lambda law: type(law).__name__,
)
def test_a_part_that_must_stick_for_a_thousand_strokes_drifts_exactly_nowhere(exact, law):
    surface = surface_motion(exact, [Drive(5e-6, 300), Drive(-4e-6, 450, cycle="cosine")])
    path = simulate(surface, Micropart(MASS, (100e-6, -30e-6)), law, 500 / 300)
    assert path.outcome is Outcome.STUCK and not path.events
    assert (path.position == [100e-6, -30e-6]).all() and not path.velocity.any()


@settings(max_examples=30, deadline=None)
@given(
    angle=st.floats(0.01, 1.3),
    turn=st.floats(0, 2 * math.pi),
    mass=st.floats(1e-10, 10.0),
    share=st.sampled_from([1 - 1e-9, 1 + 1e-9]),
    law=st.sampled_from(["coulomb", "adhesion", "constant", "points"]),
)
def test_a_slope_holds_a_part_up_to_the_friction_angle(angle, turn, mass, share, law):
    """Whichever way it faces, to 1e-9 of the friction limit."""
    slope = math.tan(angle)
    surface = polynomial_surface([[0.0, slope * math.sin(turn)], [slope * math.cos(turn), 0.0]])
    weight, pull = mass * G * math.cos(angle), mass * G * math.sin(angle)
    friction = {
        "coulomb": CoulombAdhesion(share * slope),
        "adhesion": CoulombAdhesion(share * pull / (3 * weight), 2 * weight),
        "constant": ConstantFriction(share * pull),
        "points": FrictionTable([0.0, weight, 3 * weight], [0.0, share * pull, 2 * share * pull]),
    }[law]
    path = simulate(surface, Micropart(mass, (0.3, 0.2)), friction, 10.0)
    if share > 1:
        assert path.outcome is Outcome.STUCK and (path.position == [0.3, 0.2]).all()
    else:
        assert path.outcome is Outcome.MOVING
        way = path.position[-1] - [0.3, 0.2]
        assert way @ [math.cos(turn), math.sin(turn)] < 0
