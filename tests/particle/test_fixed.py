"""Scheme "fixed": one projected step, exact rest, every outcome, energies, rows and samples, and what is refused."""

import math

import numpy as np
import pytest
from motions import motion
from scipy.optimize import minimize

from coupling.surface.motion import surface_motion
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    KogutEtsion,
    Micropart,
    Outcome,
    State,
    polynomial_surface,
    simulate,
)
from particle.events.mechanics.equations import Part
from particle.fixed.moreau import moreau_step
from particle.fixed.steps import MAX_ROWS, MAX_STEPS, step_count
from particle.modes import Mode
from particle.surface.at_point import SurfacePoint

MASS, G = 2e-9, 9.80665
FLAT = polynomial_surface([[0.0]])


def fixed(surface, part, friction, duration, time_step, **more):
    return simulate(surface, part, friction, duration, scheme="fixed", time_step=time_step, **more)


def slope(tangent):
    return polynomial_surface([[0.0], [tangent]])


def breathing_bowl():
    """A tilted bowl that shakes: w = (0.3 t - 6 t^2 + 60 t^3) (0.05 + x/5 + 2 x^2 + y^2) + 0.6 x^2 + 0.1 y."""
    c = np.zeros((3, 3, 4))
    for i, j, value in ((0, 0, 0.05), (1, 0, 0.2), (2, 0, 2.0), (0, 2, 1.0)):
        c[i, j, 1:] = value * np.array([0.3, -6.0, 60.0])
    c[2, 0, 0], c[0, 1, 0] = 0.6, 0.1
    return polynomial_surface(c)


def some_point(rng):
    values = rng.normal(size=10)
    return SurfacePoint(*values, *np.zeros(15), *(1.0, 0.0, 0.0, 1.0), *np.zeros(10))


@pytest.mark.parametrize("seed", range(5))
def test_a_step_minimises_what_moreaus_inclusion_says(seed):
    """v+ is the minimum of |v - v_free|_M^2 / 2 + (h Q/m) |v|_M, found here by scipy."""
    rng = np.random.default_rng(seed)
    f, h, q = some_point(rng), 0.05, 3.0
    start, after = motion(*rng.normal(size=8)), motion()
    v, g = np.array([start.v_x, start.v_y]), np.array([f.w_x, f.w_y])
    hessian = np.array([[f.w_xx, f.w_xy], [f.w_xy, f.w_yy]])
    b = G + f.w_tt + 2 * v @ [f.w_xt, f.w_yt] + v @ hessian @ v
    free = v - h * b * g / (1 + g @ g)
    metric = np.eye(2) + np.outer(g, g)

    def cost(u):
        return (u - free) @ metric @ (u - free) / 2 + h * q * math.sqrt(u @ metric @ u)

    part = Part(MASS, G, 0.0, 0.0, 0.0, ConstantFriction(q * MASS).law)
    mode, load, way_x, way_y = moreau_step(f, part, h, int(Mode.SLIDING), start, after)
    end = np.array([after.v_x, after.v_y])
    best = minimize(cost, free, method="BFGS", options={"gtol": 1e-10}).x
    assert mode == Mode.SLIDING
    assert end == pytest.approx(best, abs=1e-7)
    assert [way_x, way_y] == pytest.approx(h / 2 * end, rel=1e-14)
    assert load == pytest.approx(MASS * b / math.sqrt(1 + g @ g), rel=1e-14)
    # Friction dissipates the kinetic energy that it takes away.
    lost = (free - end) @ metric @ (v + end) / 2
    assert after.dissipated - start.dissipated == pytest.approx(MASS * lost, rel=1e-6, abs=1e-24)


def test_an_impulse_within_the_disc_stops_the_part_to_the_bit():
    rng = np.random.default_rng(7)
    f, start, after = some_point(rng), motion(*rng.normal(size=8)), motion(*np.ones(8))
    part = Part(MASS, G, 0.0, 0.0, 0.0, ConstantFriction(100 * MASS).law)
    mode, _, way_x, way_y = moreau_step(f, part, 1.0, int(Mode.SLIDING), start, after)
    assert mode == Mode.RESTING
    assert after.v_x == after.v_y == way_x == way_y == 0.0


def test_a_stuck_part_stays_to_the_bit():
    """On a bowl that shakes with up to 3 m/s^2: friction is enough for what moves it."""
    start = (0.1, -0.07)
    found = fixed(breathing_bowl(), Micropart(MASS, start), ConstantFriction(30 * MASS), 0.05, 1e-3)
    assert found.outcome is Outcome.STUCK and not found.events
    assert (found.position == start).all() and not found.velocity.any()
    assert found.time[-1] == 0.05 and len(found.time) == 51


def test_a_part_rests_up_to_the_angle_of_friction_and_slides_above_it():
    part = Micropart(1.0, (0.0, 0.0))
    assert fixed(slope(0.3), part, CoulombAdhesion(0.3), 1.0, 0.02).outcome is Outcome.STUCK
    slides = fixed(slope(0.3001), part, CoulombAdhesion(0.3), 1.0, 0.02)
    assert slides.outcome is Outcome.MOVING
    assert [(event.kind, event.time) for event in slides.events] == [(EventKind.SLIPS, 0.0)]
    way = 0.5 * G * (0.3001 - 0.3) / (1 + 0.3001**2)  # along x: the slope's share cos^2
    assert slides.position[-1] == pytest.approx([-way, 0.0], rel=1e-9)


def test_a_stuck_part_is_held_by_the_static_coefficient():
    friction = CoulombAdhesion(0.3, static_coefficient=0.5)
    assert fixed(slope(0.4), Micropart(1.0, (0.0, 0.0)), friction, 0.5, 0.02).outcome is Outcome.STUCK
    moving = fixed(slope(0.4), Micropart(1.0, (0.0, 0.0), (-1e-6, 0.0)), friction, 0.5, 0.02)
    assert moving.outcome is Outcome.MOVING
    assert moving.velocity[-1, 0] == pytest.approx(-1e-6 - 0.5 * G * 0.1 / 1.16, rel=1e-9)


def test_a_sliding_part_stops_within_its_step_and_never_creeps():
    found = fixed(FLAT, Micropart(1.0, (0.0, 0.0), (1.2, -1.6)), ConstantFriction(1.0), 3.0, 0.03)
    assert [event.kind for event in found.events] == [EventKind.STOPS]
    stop = found.events[0].time
    assert 2.0 <= stop < 2.0 + 0.03 + 1e-12
    assert found.position[-1] == pytest.approx([1.2, -1.6], abs=0.03**2)
    rest = found.time >= stop
    assert not found.velocity[rest].any() and (found.position[rest] == found.position[-1]).all()
    assert (found.state[rest] == State.STICK).all() and (found.state[~rest] == State.SLIP).all()


@pytest.mark.parametrize("time_step", [1e-3, 1.01e-3])
def test_a_part_that_friction_cannot_hold_turns_back(time_step):
    """Through a step that ends at rest, or in one step."""
    g, mu, u = 10.0, 0.5, 3.0
    part = Micropart(1.0, (0.0, 0.0), (u / math.sqrt(2), 0.0))
    found = fixed(slope(1.0), part, CoulombAdhesion(mu), 1.0, time_step, gravity=g)
    turn = u / (g * (1 + mu) / math.sqrt(2))
    assert [event.kind for event in found.events] == [EventKind.REVERSES]
    assert found.events[0].time == pytest.approx(turn, abs=1.1e-3)
    assert found.outcome is Outcome.MOVING


def test_a_shaken_platform_agrees_to_first_order():
    base = (Drive(6e-3, 5.0), Drive(-5e-3, 4.0))
    surface, part = polynomial_surface([[0.0]], base=base), Micropart(1.0, (0.0, 0.0))
    truth = simulate(surface, part, CoulombAdhesion(0.3), 0.2, tolerance=1e-11)
    assert len(truth.events) >= 2
    gaps = []
    for h in (4e-4, 1e-4):
        found = fixed(surface, part, CoulombAdhesion(0.3), 0.2, h)
        assert [event.kind for event in found.events] == [event.kind for event in truth.events]
        assert [e.time for e in found.events] == pytest.approx([e.time for e in truth.events], abs=2 * h)
        gaps.append(np.hypot(*(found.position[-1] - truth.position[-1])))
    assert gaps[0] < 1e-4 and gaps[1] < 0.3 * gaps[0]


def test_a_part_comes_off_within_half_a_step():
    surface = polynomial_surface([[[0.0, 0.0, 0.0, -40 / 6]]])
    for velocity in ((0.0, 0.0), (3.0, 0.0)):
        part = Micropart(MASS, (0.0, 0.0), velocity)
        found = fixed(surface, part, CoulombAdhesion(0.1, adhesion=5 * MASS), 1.0, 1e-3, gravity=9.0)
        assert found.outcome is Outcome.DETACHED and found.events[-1].kind is EventKind.DETACHES
        assert found.time[-1] == found.events[-1].time == pytest.approx(14 / 40, abs=1e-3)
        assert found.normal_force[-1] < -5 * MASS


def test_a_part_is_overloaded_within_half_a_step():
    contact = KogutEtsion.paper()
    surface = polynomial_surface([[[0.0, 0.0, 0.0, contact.largest_load / MASS / 6]]])
    found = fixed(surface, Micropart(MASS, (0.0, 0.0)), contact, 2.0, 0.01, gravity=0.0)
    assert found.outcome is Outcome.OVERLOADED and found.events[-1].kind is EventKind.OVERLOADS
    assert found.time[-1] == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("scheme, time_step", [("fixed", 2.7e-5), ("fixed", 4.1e-5), ("paper", 4.1e-5)])
def test_a_part_leaves_the_plate_at_its_rim(exact, radius, scheme, time_step):
    """In the first or second half of its step, where Moreau's is evaluated between them."""
    surface = surface_motion(exact, [Drive(0.0, 300)] * 2)
    part = Micropart(MASS, (0.0, 0.0), (0.3, 0.4))
    found = simulate(surface, part, ConstantFriction(1e-12), 1.0, scheme=scheme, time_step=time_step)
    assert found.outcome is Outcome.LEFT_PLATE and found.events[-1].kind is EventKind.LEAVES_PLATE
    assert np.hypot(*found.position[-1]) == pytest.approx(radius, rel=1e-12)
    assert found.time[-1] == found.events[-1].time == pytest.approx(6e-4, rel=1e-5)


def test_the_last_step_is_cut():
    part = Micropart(1.0, (0.0, 0.0), (1.0, 0.0))
    found = fixed(FLAT, part, ConstantFriction(0.0), 1.0, 0.3)
    assert found.time.tolist() == pytest.approx([0.0, 0.3, 0.6, 0.9, 1.0]) and found.time[-1] == 1.0
    assert found.position[-1] == pytest.approx([1.0, 0.0], rel=1e-15)
    assert fixed(FLAT, part, ConstantFriction(0.0), 1.0, 5.0).evaluations == 1


def test_the_default_step_is_a_fraction_of_the_shortest_stroke():
    platform = polynomial_surface([[0.0]], base=(Drive(0.0, 40.0), Drive(0.0, 100.0, cycle="up")))
    part = Micropart(1.0, (0.0, 0.0), (1.0, 0.0))
    assert simulate(platform, part, ConstantFriction(0.0), 0.015, scheme="fixed").evaluations == 15_000  # of 1 us


@pytest.mark.slow
@pytest.mark.compiled
def test_rows_are_thinned_but_for_events():
    base = [Drive(1e-2, 20.0), Drive(0.0, 20.0)]
    surface = polynomial_surface([[0.0]], base=base, size=1e-2)
    found = fixed(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(0.3), 1.0, 1e-6)
    assert found.evaluations == 1_000_000
    assert MAX_ROWS < len(found.time) <= MAX_ROWS + 1 + len(found.events)
    assert (np.diff(found.time) > 0).all() and len(found.events) > 20
    assert np.isin([event.time for event in found.events], found.time).all()
    assert found.time[-1] == 1.0


def test_samples_are_the_rows_and_cubics_between_them():
    surface, part = breathing_bowl(), Micropart(1.0, (0.3, 0.2), (-0.2, 0.5))
    found = fixed(surface, part, CoulombAdhesion(0.1), 0.1, 1e-3)
    rows = found.at(found.time)
    for name in ("time", "position", "velocity", "height", "normal_force", "friction_force", "state"):
        assert np.array_equal(getattr(rows, name), getattr(found, name)), name
    fine = found.at(np.array([0.05005, 0.0204, 0.0712]))
    for k, time in enumerate((0.05005, 0.0204, 0.0712)):
        row = np.searchsorted(found.time, time) - 1
        cut = slice(row, row + 2)
        pulls = np.diff(found.velocity[cut], axis=0)[0] / np.diff(found.time[cut])
        straight = found.position[row] + (time - found.time[row]) * found.velocity[row]
        bent = straight + 0.5 * (time - found.time[row]) ** 2 * pulls
        assert fine.position[k] == pytest.approx(bent, abs=1e-7)
        assert fine.height[k] == pytest.approx(surface.evaluate(fine.position[k], time).w[0], abs=1e-14)
    assert (found.at([-1.0, 9.0]).position == found.position[[0, -1]]).all()


def test_samples_of_a_part_at_rest_are_at_rest():
    found = fixed(FLAT, Micropart(1.0, (0.1, 0.3), (0.2, 0.0)), ConstantFriction(1.0), 1.0, 0.03)
    rest = found.at(np.linspace(found.events[0].time, 1.0, 17))
    assert (rest.position == found.position[-1]).all() and not rest.velocity.any()
    assert (rest.state == State.STICK).all()


@pytest.mark.parametrize(
    "wrong, says",
    [
        ({"scheme": "fixed", "time_step": 0.0}, "time_step of simulate must be a positive time in s; got 0.0"),
        ({"scheme": "paper", "time_step": math.nan}, "time_step of simulate must be a positive time in s; got nan"),
        ({"scheme": "events", "time_step": 1e-3}, "time_step of simulate must be None with the scheme 'events'; got"),
        ({"scheme": "fixed", "after_detachment": "fly"}, "after_detachment of simulate must be 'stop' with the scheme"),
        (
            {"scheme": "fixed", "time_step": 9e-9},
            "time_step of simulate must be at least 1e-08 s, for at most 100000000",
        ),
    ],
)
def test_what_fixed_steps_cannot_do_is_refused(wrong, says):
    with pytest.raises(ValueError, match=f"^Input {says}"):
        simulate(FLAT, Micropart(1.0, (0.0, 0.0)), ConstantFriction(1.0), 1.0, **wrong)


def test_steps_are_counted_and_bounded():
    assert step_count(1.0, 0.25) == 4 and step_count(1.0, 0.3) == 4 and step_count(1.0, 5.0) == 1
    assert step_count(0.3, 0.1) == 3  # whatever rounding says of 0.3 / 0.1
    assert step_count(1.0, 1 / MAX_STEPS) == MAX_STEPS
    with pytest.raises(ValueError, match="got 1e-10, for 2e\\+10 steps$"):
        step_count(2.0, 1e-10)
