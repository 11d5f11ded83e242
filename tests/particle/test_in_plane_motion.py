"""A mid-plane that moves in its plane, under a part: closed forms, the moving base, the ledger, and mistakes."""

import math
from dataclasses import replace

import numpy as np
import pytest
from driven_surface import driven, level
from steep_surface import LAWS, G, steep_surface

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    Micropart,
    polynomial_surface,
    simulate,
    simulate_many,
)
from particle.drives import drive_table, monomial_table
from particle.surface.simple_surfaces import _joined


@pytest.mark.compiled
def test_a_uniform_motion_in_the_plane_is_that_of_a_base():
    """A bowl that heaves: with rests, slips, stops and reversals, tilted gravity and a centre above the contact."""
    bowl = [[0.0, 0.05, 0.9], [0.0, 0.2, 0.0], [0.6, 0.0, 0.0]]
    sway = [Drive(0.3, 1.6), Drive(-0.2, 2.5, delay=0.1)]
    heave = Drive(0.02, 2.0)
    shapes = [bowl, [[1.0, 0.3]]]
    uniform = [np.array([[[1.0]], [[0.0]]]), np.array([[[0.0]], [[1.0]]])]
    based = driven([level(), heave], shapes, sway)
    carried = driven([level(), heave], shapes, in_plane_drives=sway, in_plane=uniform)
    part = Micropart(1.0, (0.1, 0.0), centre_height=0.05)
    for law in (CoulombAdhesion(0.6, 30.0), ConstantFriction(20.0)):
        one, other = (
            simulate(replace(surface, half_thickness=0.02), part, law, 1.0, (0.5, -0.3, -G), tolerance=1e-11)
            for surface in (based, carried)
        )
        assert [event.kind for event in one.events] == [event.kind for event in other.events]
        assert len(one.events) >= 3
        assert other.position[-1] == pytest.approx(one.position[-1], abs=1e-9)
        times = np.linspace(0.0, 1.0, 31)
        for name in ("contact", "centre", "friction"):
            assert getattr(other.contact_at(times), name) == pytest.approx(
                getattr(one.contact_at(times), name), abs=1e-7
            )


@pytest.mark.compiled
@pytest.mark.parametrize("height", [0.0, 0.05])
def test_so_it_is_in_flight_and_where_velocities_jump(height):
    """Thrown up by a drive that stops at once, from a base that begins to move at once."""
    toss = [Drive(0.1, 1.0, "cosine"), Drive(0.05, 1.3, "sine", cycles=2, delay=0.2)]
    shape = [[1.0, 0.2], [0.1, 0.4]]
    uniform = [np.array([[[1.0]], [[0.0]]]), np.array([[[0.0]], [[1.0]]])]
    heave = Drive(0.6, 1.5, "sine", cycles=1, delay=0.1)
    based, carried = driven([heave], [shape], toss), driven([heave], [shape], (), 1.0, None, toss, uniform)
    part, law = Micropart(1.0, (0.1, 0.05), centre_height=height), CoulombAdhesion(0.4, 0.5)
    one, other = (
        simulate(surface, part, law, 1.2, tolerance=1e-11, after_detachment="fly") for surface in (based, carried)
    )
    assert [event.kind for event in one.events] == [event.kind for event in other.events]
    assert (one.state == 2).any()
    assert other.position[-1] == pytest.approx(one.position[-1], abs=1e-8)
    assert other.energy.work[-1] == pytest.approx(one.energy.work[-1], rel=1e-7)


@pytest.mark.parametrize("scheme", ["events", "fixed"])
def test_a_stretching_platform_leaves_a_part_behind(scheme):
    """u = e(t) X, e = k t^3: it sticks until e'' x_0 is Q/m, and then moves in space by Q/m outwards."""
    k, x_0, friction = 0.02, 0.5, 0.04
    stretch = np.zeros((2, 2, 2, 4))
    stretch[0, 1, 0, 3] = stretch[1, 0, 1, 3] = k
    surface = polynomial_surface([[0.0]], in_plane=stretch)
    options = {"tolerance": 1e-12} if scheme == "events" else {"time_step": 1e-3}
    path = simulate(surface, Micropart(1.0, (x_0, 0.0)), ConstantFriction(friction), 2.0, scheme=scheme, **options)
    slips = friction / (6 * k * x_0)
    exact = scheme == "events"
    assert [event.kind.name for event in path.events] == ["SLIPS"]
    assert path.events[0].time == pytest.approx(slips, rel=1e-12 if exact else 1e-2)
    since = path.time[-1] - slips
    place = x_0 * (1 + k * slips**3) + 3 * k * slips**2 * x_0 * since + friction * since**2 / 2
    assert path.position[-1, 0] * (1 + k * path.time[-1] ** 3) == pytest.approx(place, rel=1e-11 if exact else 1e-3)
    assert path.position[-1, 0] < x_0 - 1e-3 and path.position[-1, 1] == 0.0
    if exact:
        assert path.energy.balance < 1e-11


def test_without_friction_a_flat_mid_plane_moves_under_the_part():
    """However it stretches and shears, the part goes straight on in space."""
    stretch = 0.1 * np.random.default_rng(2).normal(size=(2, 3, 3, 5))
    start, velocity = np.array([0.1, -0.3]), np.array([0.2, 0.1])
    surface = polynomial_surface([[0.0]], in_plane=stretch)
    begin = surface.evaluate(start, 0.0)
    path = simulate(surface, Micropart(1.0, tuple(start), tuple(velocity)), ConstantFriction(0.0), 1.0, tolerance=1e-12)
    step = 1e-6
    gradient = np.column_stack(
        [
            (surface.evaluate(start + d, 0.0).u[0] - surface.evaluate(start - d, 0.0).u[0]) / (2 * step)
            for d in step * np.eye(2)
        ]
    )
    speed = velocity + gradient @ velocity + begin.u_t[0]
    end = path.position[-1] + surface.evaluate(path.position[-1], 1.0).u[0]
    assert end == pytest.approx(start + begin.u[0] + speed, abs=1e-8)
    assert path.contact_at([1.0]).contact[0, :2] == pytest.approx(end, abs=1e-12)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("strain", [5e-3, 0.2])
def test_the_ledger_closes_whatever_the_strain(name, strain):
    surface = replace(steep_surface(strain), half_thickness=0.02)
    part = Micropart(1.0, (0.05, -0.02), (0.1, 0.2), centre_height=0.03)
    path = simulate(surface, part, LAWS[name], 0.4, tolerance=1e-10)
    assert path.path_length > 1e-3
    assert path.energy.balance < 1e-8


@pytest.mark.compiled
def test_fixed_steps_converge_with_order_one_to_located_events():
    surface = replace(steep_surface(0.05), half_thickness=0.02)
    part, law = Micropart(1.0, (0.05, -0.02), (0.1, 0.2), centre_height=0.03), ConstantFriction(4.0)
    truth = simulate(surface, part, law, 0.3, tolerance=1e-12)
    ends = [simulate(surface, part, law, 0.3, scheme="fixed", time_step=h) for h in (4e-5, 2e-5, 1e-5)]
    errors = [math.dist(end.position[-1], truth.position[-1]) for end in ends]
    assert errors[0] / errors[2] == pytest.approx(4.0, rel=0.2)
    assert ends[2].energy.work[-1] == pytest.approx(truth.energy.work[-1], rel=1e-2)


def test_what_is_wrong_is_named():
    part, law = Micropart(1.0, (0.0, 0.0)), ConstantFriction(1.0)
    with pytest.raises(
        ValueError, match="must be 'events' or 'fixed' where the mid-plane moves in its plane; got 'paper'"
    ):
        simulate(steep_surface(), part, law, 0.1, scheme="paper")
    with pytest.raises(ValueError, match=r"Input in_plane must have shape \(2, I, J\) or \(2, I, J, K\) with K <= 6"):
        polynomial_surface([[1.0]], in_plane=np.zeros((3, 2, 2)))
    surface = driven([Drive(1.0, 1.0)], in_plane_drives=[Drive(0.1, 1.0)], in_plane=[np.zeros((2, 1, 1))])
    with pytest.raises(ValueError, match="Input in_plane_drives must be one a shape in the plane, 1; got 2"):
        surface.driven_by([Drive(1.0, 2.0)], [Drive(0.1, 1.0)] * 2)
    with pytest.raises(ValueError, match="moves in its plane by drives that follow from them"):
        simulate_many(surface, [part], law, 0.1, drives=[[Drive(1.0, 2.0)]])


def test_other_drives_share_the_cells():
    surface = driven([Drive(1.0, 1.0)], in_plane_drives=[Drive(0.1, 1.0)], in_plane=[[[[0.0], [1.0]], [[0.5], [0.0]]]])
    other = surface.driven_by([Drive(0.5, 2.0)], [Drive(-0.2, 1.0)])
    assert other.store is surface.store
    h, g = Drive(0.5, 2.0).evaluate(0.1), Drive(-0.2, 1.0).evaluate(0.1)
    state = other.evaluate([[0.3, 0.2]], 0.1)
    assert (state.w[0], state.w_tt[0]) == pytest.approx((float(h[0]), float(h[2])))
    for found, rate in zip((state.u, state.u_t, state.u_tt), g, strict=True):
        assert found[0] == pytest.approx(float(rate) * np.array([0.3, 0.5]))


def test_only_strokes_of_actuators_and_base_set_the_pace():
    """What follows from them may wiggle much faster; where nothing else moves it counts, too."""
    shape = [np.array([[[1.0]], [[0.0]]])]
    slow, fast = Drive(1.0, 1.0), Drive(0.1, 50.0)
    assert driven([slow], in_plane_drives=[fast], in_plane=shape).stroke_times.tolist() == [0.5]
    assert driven([slow], base=[fast] * 2, in_plane_drives=[fast], in_plane=shape).stroke_times.min() == 0.01
    alone = replace(
        polynomial_surface([[1.0]], in_plane=shape[0]), drives=_joined(monomial_table(1), drive_table([fast]))
    )
    assert alone.stroke_times.tolist() == [0.01]
