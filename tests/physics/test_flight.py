"""Flight and impact against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from driven_surface import driven, level
from scipy.optimize import brentq

from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    FrictionTable,
    Micropart,
    Outcome,
    State,
    polynomial_surface,
    simulate,
)

G, MASS = 9.80665, 2e-9
DETACHES, LANDS, STOPS = EventKind.DETACHES, EventKind.LANDS, EventKind.STOPS
THROWS = {"lab": (1.0, 2.0), "micro": (150e-6, 450.0)}  # stroke [m] and frequency [Hz] of a rise that throws


def flies(surface, part, law, duration, **more):
    return simulate(surface, part, law, duration, after_detachment="fly", **more)


def throw(drive, pull, off):
    """When a flat surface lets go of a part and when it lands: it comes off at h'' = -off and falls with `pull`."""
    end = 1 / drive.frequency

    def h(t):
        return [float(value) for value in drive.evaluate(t)]

    begin = brentq(lambda t: h(t)[2] + off, 0.5 * end, 0.5 * end * (1 + 1 / math.sqrt(3)), xtol=1e-18, rtol=1e-15)
    z, v, _ = h(begin)

    def gap(t):
        return z + v * (t - begin) - pull * (t - begin) ** 2 / 2 - h(t)[0]

    land = brentq(gap, begin + 1e-3 * end, begin + 2 * v / pull + end, xtol=1e-18, rtol=1e-15)
    return begin, land, z, v


@pytest.mark.parametrize("adhesion", [0.0, 5.0], ids=["dry", "sticky"])
@pytest.mark.parametrize("squeeze", [0.0, 3.0], ids=["free", "squeezed"])
@pytest.mark.parametrize("name", THROWS)
def test_a_part_thrown_up_flies_and_lands_as_a_stone(name, squeeze, adhesion):
    """Adhesion and squeeze in m/s^2 times the mass; both hold it longer, the squeeze also pulls it down in flight."""
    drive = Drive(*THROWS[name], cycle="up")
    begin, land, z, v = throw(drive, G + squeeze, G + squeeze + adhesion)
    part = Micropart(MASS, (0.0, 0.0), squeeze=squeeze * MASS)
    size = drive.stroke
    path = flies(driven([drive], size=size), part, CoulombAdhesion(0.3, adhesion * MASS), 2 * land, tolerance=1e-11)
    assert [e.kind for e in path.events] == [DETACHES, LANDS]
    assert path.events[0].time == pytest.approx(begin, rel=1e-10)
    assert path.events[0].load == pytest.approx(-adhesion * MASS, abs=1e-8 * MASS * G)
    assert path.events[1].time == pytest.approx(land, rel=1e-10)
    top = path.at([begin + v / (G + squeeze)])
    assert top.state[0] == State.FLIGHT
    assert top.height[0] == pytest.approx(z + v**2 / (G + squeeze) / 2, rel=1e-10)
    assert top.normal_force[0] == top.friction_force[0] == 0
    assert not path.position.any() and path.energy.balance < 1e-10


@pytest.mark.parametrize("tolerance, bound", [(1e-6, 1e-5), (1e-9, 1e-8), (1e-12, 2e-11)])
@pytest.mark.parametrize("name", THROWS)
def test_a_sliding_part_thrown_up_lands_where_the_ballistic_path_says(name, tolerance, bound):
    """It slides at u0 - mu (g t + h'), flies straight on, and loses mu times the impact's speed in landing."""
    drive, mu = Drive(*THROWS[name], cycle="up"), 0.2
    begin, land, z, v = throw(drive, G, G)
    u0 = 6.0 * mu * v
    u1 = u0 - mu * (G * begin + v)
    x1 = u0 * begin - mu * (G * begin**2 / 2 + z)
    h2, w2, _ = (float(value) for value in drive.evaluate(land))
    blow = w2 - (v - G * (land - begin))
    u2 = u1 - mu * blow
    assert u2 > 0 and blow > 0
    part = Micropart(MASS, (0.0, 0.0), (0.6 * u0, -0.8 * u0))
    law = CoulombAdhesion(mu)
    path = flies(driven([drive], size=drive.stroke), part, law, 1.01 * land, tolerance=tolerance)
    away, landing = path.events[:2]
    assert [away.kind, landing.kind] == [DETACHES, LANDS]
    size = drive.stroke
    x2 = x1 + u1 * (land - begin)
    assert away.position == pytest.approx((0.6 * x1, -0.8 * x1), abs=bound * size)
    assert landing.position == pytest.approx((0.6 * x2, -0.8 * x2), abs=bound * size)
    assert landing.time == pytest.approx(land, rel=bound)
    assert landing.speed == pytest.approx(u2, rel=bound)
    assert path.energy.balance < max(bound, 1e-10)


def falling(slope, bend, c, d, **more):
    """w = slope.x + bend x^2/2 - c t^2/2 + d t^3/6: a part at the origin with velocity v is left behind at once.

    Its height over the surface is (c - g - bend v_x^2) t^2/2 - d t^3/6.
    """
    w = np.zeros((3, 2, 4))
    w[1, 0, 0], w[0, 1, 0], w[2, 0, 0], w[0, 0, 2], w[0, 0, 3] = *slope, bend / 2, -c / 2, d / 6
    return polynomial_surface(w, **more)


LAWS = {
    "smooth": (CoulombAdhesion(0.0), 0.0),
    "coulomb": (CoulombAdhesion(0.15), 0.15),
    "rough": (CoulombAdhesion(0.9), 0.9),
    "table": (FrictionTable([0, 1e3 * MASS, 1e6 * MASS], [0, 200 * MASS, 300 * MASS]), 0.0),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("velocity", [(0.4, -0.7), (-0.5, 0.2), (0.0, 0.0)])
@pytest.mark.parametrize("slope, bend", [((0.0, 0.0), 0.0), ((0.5, 0.0), 0.0), ((-0.4, 0.3), 0.0), ((0.3, -0.2), 0.8)])
def test_an_impact_takes_the_normal_velocity_and_mu_times_as_much_of_the_tangential(law, velocity, slope, bend):
    friction, mu = LAWS[law]
    v, c, d = np.array(velocity), 30.0, 60.0
    lift = c - G - bend * v[0] ** 2
    land = 3 * lift / d
    place = v * land
    gradient = np.array(slope) + [bend * place[0], 0.0]
    s = math.sqrt(1 + gradient @ gradient)
    normal = np.array([*-gradient, 1.0]) / s
    before = np.array([*v, v @ gradient + lift * land - d * land**2 / 2])  # relative to the surface's points
    blow = -before @ normal
    tangential = before + blow * normal
    size = math.hypot(*tangential)
    after = tangential * (max(0.0, 1 - mu * blow / size) if size > 1e-15 else 0.0)
    path = flies(falling(slope, bend, c, d), Micropart(MASS, (0.0, 0.0), velocity), friction, land + 0.01)
    away, landing = path.events[:2]
    assert (away.kind, landing.kind) == (DETACHES, LANDS)
    assert away.time == pytest.approx(0.0, abs=1e-12)
    assert landing.time == pytest.approx(land, rel=1e-9)
    assert landing.position == pytest.approx(place, abs=1e-9)
    row = np.flatnonzero(path.time == landing.time)[-1]
    assert path.velocity[row] == pytest.approx(after[:2], abs=1e-9)
    assert landing.speed == pytest.approx(math.hypot(*after[:2]), abs=1e-9)
    assert path.energy.balance < 1e-8
    lost = MASS * (before @ before - after @ after) / 2
    assert path.energy.dissipated[row] - path.energy.dissipated[row - 1] == pytest.approx(lost, rel=1e-8)
    assert path.state[row] == (State.SLIP if after.any() else State.STICK)


def test_landing_at_rest_where_friction_holds_is_a_stick():
    path = flies(falling((0.1, 0.0), 0.0, 30.0, 60.0), Micropart(MASS, (0.0, 0.0)), CoulombAdhesion(0.9), 1.2)
    assert path.outcome is Outcome.STUCK and path.state[-1] == State.STICK
    assert not path.position.any()


@pytest.mark.parametrize("gravity", [(0.0, 0.0, -G), (1.5, -0.7, -9.0), (-3.0, 4.0, -2.0)])
@pytest.mark.parametrize("squeeze", [0.0, 4.0])
def test_tilted_gravity_and_a_squeeze_bend_the_flight(gravity, squeeze):
    """On a flat surface that falls away with c = 30 m/s^2: x'' = g_x, z'' = g_z - squeeze/m."""
    g, v, c, d = np.array(gravity), np.array([0.3, 0.1]), 30.0, 60.0
    lift = c + g[2] - squeeze
    land, half = 3 * lift / d, 1.5 * lift / d
    part = Micropart(MASS, (0.0, 0.0), tuple(v), squeeze=squeeze * MASS)
    path = flies(falling((0.0, 0.0), 0.0, c, d), part, CoulombAdhesion(0.0), land * 1.01, gravity=gravity)
    assert path.events[1].kind is LANDS and path.events[1].time == pytest.approx(land, rel=1e-9)
    middle = path.at([half])
    assert middle.position[0] == pytest.approx(v * half + g[:2] * half**2 / 2, abs=1e-12)
    assert middle.velocity[0] == pytest.approx(v + g[:2] * half, abs=1e-12)
    assert middle.height[0] == pytest.approx((g[2] - squeeze) * half**2 / 2, abs=1e-12)
    assert path.events[1].position == pytest.approx(v * land + g[:2] * land**2 / 2, abs=1e-9)
    assert path.energy.balance < 1e-9


def test_the_part_flies_straight_while_the_base_moves_under_it():
    """Seen from the base its path is v t - b(t)."""
    base = (Drive(0.4, 0.8, cycle="up"), Drive(-0.3, 1.1, cycle="up"))
    fall = Drive(-8.0, 1.0, cycle="up")  # at 46 m/s^2 downwards, then slower and slower
    slide = flies(driven([fall], base=base), Micropart(MASS, (0.0, 0.0), (0.5, 0.2)), CoulombAdhesion(0.0), 1.5)
    away, landing = slide.events[:2]
    assert [away.kind, landing.kind] == [DETACHES, LANDS]
    z, v, a = (float(value) for value in fall.evaluate(away.time))
    assert a == pytest.approx(-G, rel=1e-8)
    land = brentq(
        lambda t: z + v * (t - away.time) - G * (t - away.time) ** 2 / 2 - float(fall.evaluate(t)[0]), 0.3, 1.4
    )
    assert landing.time == pytest.approx(land, rel=1e-8)
    times = np.linspace(0.0, landing.time, 30)
    seen = np.array([0.5, 0.2]) * times[:, None] - np.stack([drive.evaluate(times)[0] for drive in base], axis=1)
    assert slide.at(times).position == pytest.approx(seen, abs=1e-8)
    assert slide.energy.balance < 1e-8


def test_a_part_that_flies_over_the_rim_leaves_the_plate_there():
    surface = replace(falling((0.0, 0.0), 0.0, 30.0, 60.0), conics=np.array([[0.0, 0.0, 0.2, 0.2]]))
    path = flies(surface, Micropart(MASS, (0.0, -0.1), (0.48, 0.36)), CoulombAdhesion(0.3), 2.0)
    assert path.outcome is Outcome.LEFT_PLATE
    assert [e.kind for e in path.events] == [DETACHES, EventKind.LEAVES_PLATE]
    reach = brentq(lambda t: math.hypot(0.48 * t, 0.36 * t - 0.1) - 0.2, 0.0, 1.0, xtol=1e-16)
    assert path.time[-1] == path.events[-1].time == pytest.approx(reach, rel=1e-10)
    assert math.hypot(*path.position[-1]) == pytest.approx(0.2, rel=1e-10)
    assert path.state[-2] == State.FLIGHT and path.height[-1] == pytest.approx(-G * reach**2 / 2, rel=1e-9)


def test_a_part_held_without_pull_off_never_flies():
    drive = Drive(1.0, 3.0, cycle="up")
    path = flies(driven([drive]), Micropart(MASS, (0.0, 0.0), (1.0, 0.0)), ConstantFriction(2.0 * MASS), 0.4)
    assert not path.events and not (path.state == State.FLIGHT).any()
    assert path.position[-1, 0] == pytest.approx(0.4 - 0.16, abs=1e-9)


def test_a_part_lands_where_its_parabola_meets_a_surface_of_sixth_order_along_it():
    """The surface rises and is warped by (x y)^3 / 2: below a part on its way the gap is of order 6 in time."""
    drive, warp = Drive(*THROWS["lab"], cycle="up"), np.zeros((4, 4))
    warp[3, 3] = 0.5
    surface = driven([drive, level()], [[[1.0]], warp])
    path = flies(surface, Micropart(MASS, (0.0, 0.0), (1.0, 1.2)), CoulombAdhesion(0.01), 0.9, tolerance=1e-9)
    off, land = path.events[:2]
    assert (off.kind, land.kind) == (DETACHES, LANDS)
    begin = path.at([np.nextafter(off.time, 0)])
    (x, y), (u, v) = begin.position[0], begin.velocity[0][:2]
    height, rate = (float(value) for value in drive.evaluate(off.time)[:2])
    height, rate = height + (x * y) ** 3 / 2, rate + 1.5 * (x * y) ** 2 * (x * v + y * u)

    def gap(t):
        ahead = float(drive.evaluate(off.time + t)[0]) + ((x + u * t) * (y + v * t)) ** 3 / 2
        return height + rate * t - G * t**2 / 2 - ahead

    assert land.time - off.time == pytest.approx(brentq(gap, 0.01, 0.9, xtol=1e-15), rel=1e-8)
