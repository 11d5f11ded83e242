"""simulate: what it refuses, what a trajectory holds, and every outcome once."""

import math

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    KogutEtsion,
    Micropart,
    Outcome,
    State,
    Stopped,
    polynomial_surface,
    simulate,
    stoppable,
)

MASS = 2e-9
FLAT = polynomial_surface([[0.0]])


def slope(angle):
    """An incline of that angle [rad], rising along x."""
    return polynomial_surface([[0.0], [math.tan(angle)]])


@pytest.mark.parametrize("mass", [0.0, -1.0, math.nan, math.inf])
def test_a_mass_that_is_not_positive_is_refused(mass):
    with pytest.raises(ValueError, match="^Input mass of Micropart must be positive, in kg; got"):
        Micropart(mass, (0.0, 0.0))


@pytest.mark.parametrize("value", [(0.0, math.nan), (math.inf, 0.0), (0.0,), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("name", ["position", "velocity"])
def test_a_place_or_velocity_that_is_no_pair_of_numbers_is_refused(name, value):
    with pytest.raises(ValueError, match=f"^Input {name} of Micropart must be two finite numbers; got"):
        Micropart(**{"mass": 1.0, "position": (0.0, 0.0)} | {name: value})


@pytest.mark.parametrize(
    "wrong, says",
    [
        ({"scheme": "euler"}, "scheme"),
        ({"duration": 0.0}, "duration"),
        ({"duration": math.inf}, "duration"),
        ({"duration": math.nan}, "duration"),
        ({"tolerance": 1e-14}, "tolerance"),
        ({"tolerance": 0.1}, "tolerance"),
        ({"tolerance": math.nan}, "tolerance"),
    ],
)
def test_a_wrong_request_is_refused_by_name(wrong, says):
    request = {"duration": 1.0} | wrong
    with pytest.raises(ValueError, match=f"^Input {says} of simulate must be .*; got"):
        simulate(FLAT, Micropart(1.0, (0.0, 0.0)), ConstantFriction(1.0), **request)


@pytest.mark.parametrize("gravity", [math.nan, math.inf])
def test_a_gravity_that_is_no_number_is_refused(gravity):
    with pytest.raises(ValueError, match="^Input gravity of simulate must be"):
        simulate(FLAT, Micropart(1.0, (0.0, 0.0)), ConstantFriction(1.0), 1.0, gravity=gravity)


def test_a_start_beyond_the_rim_is_refused(exact):
    surface = surface_motion(exact, [Drive(1e-6, 300)] * 2)
    with pytest.raises(ValueError, match="^Input position of Micropart must lie on the plate; got"):
        simulate(surface, Micropart(MASS, (301e-6, 0.0)), ConstantFriction(1.0), 1.0)


@pytest.fixture(scope="module")
def stroke(radius):
    """A central stroke of 150 um, up and down once at 300 Hz, and the part's answer to it."""
    surface = surface_motion(DiscShapes([[0.0, 0.0]], radius), [Drive(150e-6, 300, cycles=1)])
    part = Micropart(MASS, (100e-6, 30e-6))
    return surface, part, simulate(surface, part, ConstantFriction(20.9 * MASS), 8e-3, gravity=0.0)


def test_rows_run_from_the_start_to_the_duration_also_at_rest(stroke):
    _, _, trajectory = stroke
    assert trajectory.time[0] == 0.0 and trajectory.time[-1] == 8e-3
    assert (np.diff(trajectory.time) > 0).all()
    assert trajectory.position[0] == pytest.approx([100e-6, 30e-6], rel=0, abs=0)
    assert trajectory.outcome is Outcome.STUCK and trajectory.state[-1] == State.STICK
    assert not trajectory.velocity[-1].any()


def test_events_alternate_and_lie_on_rows(stroke):
    _, _, trajectory = stroke
    kinds = [event.kind for event in trajectory.events]
    assert kinds == [EventKind.SLIPS, EventKind.STOPS] * (len(kinds) // 2) and kinds
    for event in trajectory.events:
        row = np.flatnonzero(trajectory.time == event.time)
        assert len(row) == 1
        assert trajectory.position[row[0]] == pytest.approx(event.position, rel=0, abs=0)
        assert trajectory.normal_force[row[0]] == event.load


def test_the_part_sticks_between_stop_and_slip_and_slides_between_slip_and_stop(stroke):
    _, _, trajectory = stroke
    edges = [event.time for event in trajectory.events]
    slipping = np.searchsorted(edges, trajectory.time, side="right") % 2 == 1
    assert np.array_equal(trajectory.state == State.SLIP, slipping)
    slid = sum(b - a for a, b in zip(edges[::2], edges[1::2], strict=True))
    assert trajectory.time_in(State.SLIP) == pytest.approx(slid, rel=1e-12)
    assert trajectory.time_in(State.STICK) == pytest.approx(8e-3 - slid, rel=1e-12)


def test_forces_are_those_of_the_equations(stroke):
    surface, _, trajectory = stroke
    for k in range(0, len(trajectory.time), 5):
        f = surface.evaluate(trajectory.position[[k]], trajectory.time[k])
        v, g, h = trajectory.velocity[k], f.gradient[0], f.hessian[0]
        b = f.w_tt[0] + 2 * v @ f.gradient_t[0] + v @ h @ v
        assert trajectory.normal_force[k] == pytest.approx(MASS * b / math.sqrt(1 + g @ g), rel=1e-7, abs=1e-14)
        if trajectory.state[k] == State.SLIP:
            assert trajectory.friction_force[k] == 20.9 * MASS
        else:
            held = MASS * abs(b) * math.sqrt(g @ g / (1 + g @ g))
            assert trajectory.friction_force[k] == pytest.approx(held, rel=1e-7, abs=1e-14)
            assert held <= 20.9 * MASS * (1 + 1e-9)


def test_samples_between_rows_are_as_good_as_rows(stroke):
    _, _, trajectory = stroke
    rows = trajectory.at(trajectory.time)
    assert (rows.position == trajectory.position).all() and (rows.velocity == trajectory.velocity).all()
    middle = (trajectory.time[1:] + trajectory.time[:-1]) / 2
    fine = trajectory.at(middle)
    stuck = trajectory.state[:-1] == State.STICK
    assert np.abs(fine.position - trajectory.position[:-1])[stuck].max() == 0
    assert (trajectory.at([-1.0, 1.0]).position == trajectory.position[[0, -1]]).all()
    # One step from each of them leads to the next row again.
    shuffled = trajectory.at(middle[::-1])
    assert (shuffled.position[::-1] == fine.position).all()


def test_a_single_time_is_one_of_several_and_text_is_none(stroke):
    _, _, trajectory = stroke
    end = float(trajectory.time[-1])
    assert (trajectory.at(end).position == trajectory.position[-1:]).all()
    assert trajectory.contact_at(end).normal_force == trajectory.normal_force[-1]
    assert trajectory.to_xarray(end).sizes["time"] == len(trajectory.to_dataframe(end)) == 1
    for sampled in (trajectory.at, trajectory.contact_at, trajectory.to_xarray, trajectory.to_dataframe):
        with pytest.raises(ValueError, match=r"Input times of Trajectory must be numbers; got 'x'"):
            sampled("x")


def test_distance_is_from_the_start_to_the_end(stroke):
    _, _, trajectory = stroke
    assert trajectory.distance == math.dist(trajectory.position[0], trajectory.position[-1])


def test_still_sliding_at_the_end_is_an_outcome():
    trajectory = simulate(FLAT, Micropart(1.0, (0.0, 0.0), (2.0, 0.0)), ConstantFriction(1.0), 1.0)
    assert trajectory.outcome is Outcome.MOVING
    assert trajectory.velocity[-1] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_a_part_at_rest_comes_off_when_the_surface_falls_away():
    """w = -c t^3 / 6 leaves the load m (g - c t) at rest: it comes off at t = (g + pull-off / m) / c."""
    surface = polynomial_surface([[[0.0, 0.0, 0.0, -40 / 6]]])
    trajectory = simulate(
        surface, Micropart(MASS, (0.0, 0.0)), CoulombAdhesion(0.3, adhesion=5 * MASS), 1.0, gravity=9.0
    )
    assert trajectory.outcome is Outcome.DETACHED
    assert trajectory.events[-1].kind is EventKind.DETACHES
    assert trajectory.time[-1] == trajectory.events[-1].time == pytest.approx(14 / 40, rel=1e-10)
    assert trajectory.normal_force[-1] == pytest.approx(-5 * MASS, rel=1e-8)


def test_a_sliding_part_comes_off_at_its_moment():
    surface = polynomial_surface([[[0.0, 0.0, 0.0, -40 / 6]]])
    part = Micropart(MASS, (0.0, 0.0), (3.0, 0.0))
    trajectory = simulate(surface, part, CoulombAdhesion(0.1, adhesion=5 * MASS), 1.0, gravity=9.0)
    assert trajectory.outcome is Outcome.DETACHED
    assert trajectory.time[-1] == pytest.approx(14 / 40, rel=1e-9)
    assert trajectory.velocity[-1, 0] == pytest.approx(3 - 0.1 * (14 * 0.35 - 20 * 0.35**2), rel=1e-8)


def test_a_part_that_slides_over_the_rim_leaves_the_plate_there(exact, radius):
    surface = surface_motion(exact, [Drive(0.0, 300)] * 2)
    part = Micropart(MASS, (0.0, 0.0), (0.3, 0.4))
    trajectory = simulate(surface, part, ConstantFriction(1e-12), 1.0)
    assert trajectory.outcome is Outcome.LEFT_PLATE
    assert trajectory.events[-1].kind is EventKind.LEAVES_PLATE
    assert np.hypot(*trajectory.position[-1]) == pytest.approx(radius, rel=1e-10)
    # 300 um at 0.5 m/s, braked by 5e-4 m/s^2: 6e-4 s and as good as nothing more.
    assert trajectory.time[-1] == pytest.approx(6e-4 * (1 + 0.5 * 5e-4 * 6e-4 / 0.5), rel=1e-9)


def test_a_load_beyond_the_contact_model_overloads_it():
    contact = KogutEtsion.paper()
    limit = contact.largest_load / MASS
    surface = polynomial_surface([[[0.0, 0.0, 0.0, limit / 6]]])  # the load grows by m * limit each second
    trajectory = simulate(surface, Micropart(MASS, (0.0, 0.0)), contact, 2.0, gravity=0.0)
    assert trajectory.outcome is Outcome.OVERLOADED
    assert trajectory.events[-1].kind is EventKind.OVERLOADS
    assert trajectory.time[-1] == pytest.approx(1.0, rel=1e-9)


@pytest.mark.compiled
def test_a_run_that_would_take_for_ever_stops_at_its_work_limit():
    """A bowl without friction and without breakpoints in its drive: one span, 22 000 evaluations at most."""
    trajectory = simulate(
        polynomial_surface([[0, 0, 1.0], [0, 0, 0], [1.0, 0, 0]]),
        Micropart(1.0, (0.5, 0.0), (0.0, 1.0)),
        ConstantFriction(0.0),
        1e5,
    )
    assert trajectory.outcome is Outcome.WORK_LIMIT
    assert trajectory.time[-1] < 1e5
    assert 22_000 < trajectory.evaluations < 23_000


def test_every_outcome_is_said_in_a_sentence():
    assert all(outcome.sentence.endswith(".") for outcome in Outcome)
    assert len({outcome.sentence for outcome in Outcome}) == len(Outcome)


@pytest.mark.compiled
def test_no_row_is_lost_when_the_record_grows():
    """More than 1 024 rows and 256 events, the record's first sizes, by a part on a shaken platform."""
    base = [Drive(1e-2, 20.0), Drive(0.0, 20.0)]
    surface = polynomial_surface([[0.0]], base=base, size=1e-2)
    trajectory = simulate(surface, Micropart(1.0, (0.0, 0.0)), CoulombAdhesion(0.3), 8.0)
    assert len(trajectory.time) > 1024 and len(trajectory.events) > 256
    assert (np.diff(trajectory.time) > 0).all()
    assert (np.diff([event.time for event in trajectory.events]) > 0).all()
    assert trajectory.time[-1] == 8.0


def test_another_thread_can_stop_a_path():
    part, law = Micropart(MASS, (0.0, 0.0)), ConstantFriction(1e-9)
    flag = np.zeros(1, dtype=np.int64)
    with stoppable(flag):
        assert simulate(slope(0.3), part, law, 1e-3).outcome is Outcome.MOVING
        flag[0] = 1
        with pytest.raises(Stopped):
            simulate(slope(0.3), part, law, 1e-3)
    assert simulate(slope(0.3), part, law, 1e-3).outcome is Outcome.MOVING  # after the block it counts no more
