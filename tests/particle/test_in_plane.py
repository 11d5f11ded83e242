"""A mid-plane that moves in its plane: kinematics against differences of places, closed forms, and the moving base."""

import math
from dataclasses import replace

import numpy as np
import pytest
from driven_surface import driven, level
from scipy.optimize import brentq
from scipy.special import comb

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    Micropart,
    TableDrive,
    polynomial_surface,
    simulate,
    simulate_many,
)
from particle.drives import drive_table, monomial_table
from particle.events.equations import Part, energy, length, pull, rising
from particle.events.parallel import from_height, normal_bend, normal_bend_along, normal_rate, shape_operator, to_height
from particle.events.stick import leaves_rest, new_rest
from particle.events.stick_stretched import NARROW, fill_stretched, is_safe_stretched, largest_force
from particle.surface.at_point import surface_at
from particle.surface.local import new_local
from particle.surface.simple_surfaces import _joined
from particle.surface.span import enter

G = 9.80665
PLACE, VELOCITY, TIME = np.array([0.3, -0.2]), np.array([0.7, -1.1]), 0.4
TILT = np.array([0.3, -0.2, -G])


def steep_surface(strain=0.2):
    """Slopes around 0.5 on a base that moves, with a gradient of u of that order."""
    rng = np.random.default_rng(5)
    base = [TableDrive([0.0, 1.0], [0.0, height]) for height in (0.3, -0.2)]
    c, u = 0.4 * rng.normal(size=(4, 4, 5)), strain * rng.normal(size=(2, 3, 3, 5))
    return polynomial_surface(c, base=base, in_plane=u)


@pytest.fixture(scope="module")
def steep():
    return steep_surface()


@pytest.fixture(scope="module")
def local(steep):
    return local_at(steep)


@pytest.fixture(scope="module")
def point(local):
    return surface_at(local, *PLACE, TIME)


def local_at(surface, place=PLACE, time=TIME):
    local = new_local(surface.record)
    enter(surface.record, local, *place, time, 1.0)
    return local


def normal_of(f):
    return np.array([-f.w_x, -f.w_y, 1.0]) / math.sqrt(1 + f.w_x**2 + f.w_y**2)


def along(f, x, y):
    """A vector along the surface in space."""
    return np.array([x, y, x * f.w_x + y * f.w_y])


def place(local, z):
    """The point at a height over the material point PLACE + s VELOCITY, at the time TIME + t."""

    def at(t, s):
        x, y = PLACE + s * VELOCITY
        f = surface_at(local, x, y, TIME + t)
        return np.array([x + f.base_px, y + f.base_py, f.w]) + z * normal_of(f)

    return at


def difference(f, step=1e-3):
    return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)


def second(f, step=2e-3):
    return (16 * (f(step) + f(-step)) - (f(2 * step) + f(-2 * step)) - 30 * f(0.0)) / (12 * step**2)


def test_the_slope_is_at_right_angles_to_the_surface_in_space(local, point):
    for direction in np.eye(2):
        moves = difference(
            lambda s, d=direction: (lambda f, x: np.array([x[0] + f.base_px, x[1] + f.base_py, f.w]))(
                surface_at(local, *(PLACE + s * d), TIME), PLACE + s * d
            )
        )
        assert moves @ normal_of(point) == pytest.approx(0.0, abs=1e-10)


def test_points_off_the_mid_plane_move_with_stretch_and_normal(local, point):
    z, shape = 0.23, shape_operator(point)
    moves = difference(lambda s: place(local, z)(0.0, s))
    assert along(point, *to_height(shape, z, *VELOCITY)) == pytest.approx(moves, abs=1e-9)
    assert from_height(shape, z, *to_height(shape, z, 3.0, 4.0)) == pytest.approx((3.0, 4.0))


def test_the_normal_turns_as_differences_say(local, point):
    def normal(t, s):
        return place(local, 1.0)(t, s) - place(local, 0.0)(t, s)

    assert normal_rate(point, *VELOCITY) == pytest.approx(difference(lambda t: normal(t, t)), abs=1e-9)
    for bend, truth in (
        (normal_bend(point, *VELOCITY), second(lambda t: normal(t, t))),
        (normal_bend_along(point, *VELOCITY), difference(lambda s: difference(lambda t: normal(t, s + t)))),
    ):
        assert along(point, bend.x, bend.y) - bend.down * normal_of(point) == pytest.approx(truth, abs=1e-6)


def test_the_pull_is_what_keeps_the_centre_of_mass_going(local, point):
    part = Part(2.0, G, 0.3, -0.2, 0.0, ConstantFriction(0.0).law, 0.1, 0.25)
    p, path, normal = pull(point, *VELOCITY, part), place(local, part.centre), normal_of(point)
    wanted = TILT - second(lambda t: path(t, t))
    assert p.normal == pytest.approx(-part.mass * wanted @ normal, rel=1e-7)
    assert along(point, p.x, p.y) == pytest.approx(wanted - (wanted @ normal) * normal, abs=1e-6)
    kinetic, potential = energy(point, *PLACE, *VELOCITY, point.w, rising(point, *VELOCITY), part)
    speed = difference(lambda t: path(t, t))
    assert kinetic == pytest.approx(part.mass / 2 * speed @ speed, rel=1e-9)
    assert potential == pytest.approx(-part.mass * TILT @ path(0.0, 0.0), rel=1e-12)


def test_evaluate_has_the_material_s_own_derivatives(steep):
    flat = replace(steep, in_plane_count=0, drives=driven_alike(steep))
    state, bare = steep.evaluate(PLACE, TIME), flat.evaluate(PLACE, TIME)
    for name in ("w", "w_t", "w_tt", "gradient", "gradient_t", "gradient_tt", "hessian"):
        assert getattr(state, name) == pytest.approx(getattr(bare, name), rel=1e-13, abs=1e-13), name
    assert not bare.u.any() and not bare.u_tt.any()

    def u(t):
        return steep.evaluate(PLACE, TIME + t).u[0]

    assert state.u_t[0] == pytest.approx(difference(u), abs=1e-10)
    assert state.u_tt[0] == pytest.approx(second(u), abs=1e-7)


def driven_alike(surface):
    """The drives of a surface without those in its plane."""
    rng = np.random.default_rng(5)
    base = [TableDrive([0.0, 1.0], [0.0, height]) for height in (0.3, -0.2)]
    return polynomial_surface(0.4 * rng.normal(size=(4, 4, 5)), base=base).drives


LAWS = {
    "constant": ConstantFriction(6.0),
    "coulomb": CoulombAdhesion(0.6, 10.0, static_coefficient=0.7),
}


def test_the_proof_that_a_part_stays_is_made_of_the_pull_on_it(steep):
    """Its polynomials are load and pull at any time, and so they are with a centre of mass on the mid-plane."""
    local, begin, lasting = local_at(steep, time=0.1), 0.1, NARROW
    rest = new_rest()
    for heights in ((0.1, 0.25), (0.0, 0.0)):
        part = Part(2.0, G, 0.3, -0.2, 0.0, LAWS["constant"].law, *heights)
        leaves_rest(local, part, rest, *PLACE, begin, begin + lasting)
        fill_stretched(part, rest.motion, rest.plane, lasting, rest.stretched[0])
        degree, z = rest.stretched.shape[2] - 1, part.centre
        for s in (0.0, 0.3, 0.77, 1.0):
            basis = [comb(degree, i) * s**i * (1 - s) ** (degree - i) for i in range(degree + 1)]
            c, force, square, e, x, y = rest.stretched[0] @ basis
            p = pull(surface_at(local, *PLACE, begin + s * lasting), 0.0, 0.0, part)
            assert p.normal == pytest.approx(part.mass * (c / math.sqrt(square) - z * e / square**2), rel=1e-12)
            found = (force + 2 * z * x / square**1.5 + z * z * y / square**3) / square
            demand = length(surface_at(local, *PLACE, begin + s * lasting), p.x, p.y)
            assert found == pytest.approx(demand**2, rel=1e-11)


@pytest.mark.parametrize("centre", [0.0, 0.2])
def test_a_part_at_rest_slips_when_its_pull_says_so(centre):
    """The first root of pull less friction, found by looking closely at many times; a quick bound never denies it."""
    quick = proved = 0
    for seed in range(8):
        rng = np.random.default_rng(seed)
        c, u = 0.02 * rng.normal(size=(3, 3, 5)), 0.05 * rng.normal(size=(2, 3, 3, 5))
        surface = polynomial_surface(c, in_plane=u)
        local, rest = local_at(surface, time=0.0), new_rest()
        moments = np.linspace(0.0, 1.0, 200)
        part = Part(1.0, G, 0.0, 0.0, 0.0, ConstantFriction(0.0).law, centre / 2, centre)

        def demand(t, local=local, part=part):
            f = surface_at(local, *PLACE, t)
            p = pull(f, 0.0, 0.0, part)
            return length(f, p.x, p.y)

        demands = np.array([demand(t) for t in moments])
        if demands.max() < 1.01 * demands[0]:
            continue
        for share in (0.6, 0.999, 1.02, 4.0):
            limit = demands[0] + share * (demands.max() - demands[0])
            held = part._replace(law=ConstantFriction(limit).law)
            found = leaves_rest(local, held, rest, *PLACE, 0.0, 1.0)
            safe = is_safe_stretched(held, rest.motion, rest.plane, 1.0, rest.bounds, rest.force)
            over = np.flatnonzero(demands > limit)
            quick, proved = quick + safe, proved + math.isinf(found)
            if share > 1:
                assert math.isinf(found)
            else:
                first = brentq(
                    lambda t, limit=limit: demand(t) - limit, moments[over[0] - 1], moments[over[0]], xtol=1e-14
                )
                assert found == pytest.approx(first, abs=1e-9)
                assert not safe
    assert proved >= 8 and quick > 0


@pytest.mark.parametrize("strain", [0.0, 0.003, 0.03])
def test_the_bound_of_a_part_at_rest_is_close(strain):
    """No limit below the largest pull passes; one above it does once it is so by what strain and slope allow."""
    for seed in range(6):
        rng = np.random.default_rng(seed)
        c, u = 0.02 * rng.normal(size=(3, 3, 5)), strain * rng.normal(size=(2, 3, 3, 5))
        local, rest = local_at(polynomial_surface(c, in_plane=u), time=0.0), new_rest()
        part = Part(1.0, G, 0.1, -0.2, 0.0, ConstantFriction(1e3).law, 0.1, 0.2)
        for lasting in (0.1, 1e-3):
            leaves_rest(local, part, rest, *PLACE, 0.0, lasting)
            demands = []
            for time in np.linspace(0.0, lasting, 50):
                f = surface_at(local, *PLACE, time)
                p = pull(f, 0.0, 0.0, part)
                demands.append(length(f, p.x, p.y))
            force = largest_force(part, rest.motion, rest.plane, lasting, rest.force)
            assert force == pytest.approx(max(demands), rel=0.02 + 3 * strain + lasting * 3)
            for share, safe in ((1 - 1e-12, False), (1.02 + 20 * strain + lasting * 3, True)):
                held = part._replace(law=ConstantFriction(share * max(demands)).law)
                quick = is_safe_stretched(held, rest.motion, rest.plane, lasting, rest.bounds, rest.force)
                assert quick == safe, (seed, lasting, share)


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


def test_what_is_wrong_is_named(steep):
    part, law = Micropart(1.0, (0.0, 0.0)), ConstantFriction(1.0)
    with pytest.raises(
        ValueError, match="must be 'events' or 'fixed' where the mid-plane moves in its plane; got 'paper'"
    ):
        simulate(steep, part, law, 0.1, scheme="paper")
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
