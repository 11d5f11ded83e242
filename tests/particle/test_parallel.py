"""Contact and centre of mass off the mid-plane: kinematics against differences of positions, and what follows."""

from dataclasses import replace

import numpy as np
import pytest
from driven_surface import driven
from scipy.optimize import brentq

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    KogutEtsion,
    Micropart,
    Outcome,
    TableDrive,
    platform_surface,
    polynomial_surface,
    simulate,
)
from particle.events.mechanics.breakaway import first_slip, mobility, moved
from particle.events.mechanics.equations import Part, at_centre, at_contact, energy, length, pull
from particle.events.mechanics.parallel import (
    from_height,
    normal_bend,
    normal_bend_along,
    normal_rate,
    shape_operator,
    to_height,
)
from particle.surface.at_point import surface_at
from particle.surface.local import new_local
from particle.surface.span import enter

MASS, G = 2e-9, 9.80665
STEP = 1e-4


@pytest.fixture(scope="module")
def steep():
    """A surface with slopes around 0.5 on which all derivatives count, of two shapes and a base that moves."""
    rng = np.random.default_rng(5)
    shapes = [0.4 * rng.normal(size=(4, 4)) for _ in range(2)]
    ways = [TableDrive([0.0, 1.0], [0.0, height]) for height in (1.0, -0.7, 0.3, -0.2)]
    return driven(ways[:2], shapes, ways[2:])


def local_at(surface, x, y, time):
    local = new_local(surface.record)
    enter(surface.record, local, x, y, time, 1.0)
    return local


PLACE, VELOCITY, TIME = np.array([0.3, -0.2]), np.array([0.7, -1.1]), 0.4


def place(surface, local, xy, time, z):
    """The point at the height z over (x, y), in space."""
    f = surface_at(local, *xy, time)
    normal = np.array([-f.w_x, -f.w_y, 1.0]) / np.sqrt(1 + f.w_x**2 + f.w_y**2)
    return np.array([xy[0] + f.base_px, xy[1] + f.base_py, f.w]) + z * normal


def moving_place(surface, local, z):
    """The same over time and a steady way from PLACE: t -> (3,)."""
    return lambda t, s: place(surface, local, PLACE + s * VELOCITY, TIME + t, z)


def difference(f, step=STEP):
    """The derivative of f at 0, to fourth order."""
    return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)


def second(f, step=10 * STEP):
    return (16 * (f(step) + f(-step)) - (f(2 * step) + f(-2 * step)) - 30 * f(0.0)) / (12 * step**2)


@pytest.fixture(scope="module")
def point(steep):
    local = local_at(steep, *PLACE, TIME)
    return steep, local, surface_at(local, *PLACE, TIME)


def normal_of(f):
    return np.array([-f.w_x, -f.w_y, 1.0]) / np.sqrt(1 + f.w_x**2 + f.w_y**2)


def along(f, x, y):
    """A vector along the surface in space."""
    return np.array([x, y, x * f.w_x + y * f.w_y])


def test_third_derivatives_are_those_of_the_second_ones(point):
    surface, local, f = point

    def field(name):
        return lambda x, y, t: getattr(surface_at(local, PLACE[0] + x, PLACE[1] + y, TIME + t), name)

    rates = {"w_xtt": ("w_tt", 0), "w_ytt": ("w_tt", 1), "w_xxt": ("w_xx", 2), "w_xyt": ("w_xy", 2)}
    rates |= {"w_yyt": ("w_yy", 2), "w_xxx": ("w_xx", 0), "w_xxy": ("w_xx", 1), "w_xyy": ("w_yy", 0)}
    rates |= {"w_yyy": ("w_yy", 1)}
    for name, (lower, axis) in rates.items():
        shift = np.eye(3)[axis]
        slope = difference(lambda s, lower=lower, shift=shift: field(lower)(*(s * shift)))
        assert getattr(f, name) == pytest.approx(slope, rel=1e-8, abs=1e-8), name


@pytest.mark.parametrize("x, y, step", [(3e-10, 4e-10, 1e-11), (2e-5, 3e-5, 1e-7)])
def test_third_derivatives_of_a_logarithm_within_and_beyond_its_floor(x, y, step):
    surface = surface_motion(DiscShapes([[0.0, 0.0]], 1e-3), [Drive(1e-5, 100.0)])
    local = local_at(surface, x, y, 2e-3)

    def slope(name, along_x, along_y):
        def field(s):
            return getattr(surface_at(local, x + s * along_x, y + s * along_y, 2e-3), name)

        return difference(field, step)

    f = surface_at(local, x, y, 2e-3)
    slopes = [slope("w_xx", 1, 0), slope("w_xx", 0, 1), slope("w_yy", 1, 0), slope("w_yy", 0, 1)]
    assert [f.w_xxx, f.w_xxy, f.w_xyy, f.w_yyy] == pytest.approx(slopes, rel=1e-6, abs=1e-6 * max(map(abs, slopes)))


def test_the_shape_operator_moves_points_off_the_mid_plane(point):
    surface, local, f = point
    z = 0.23
    moves = difference(lambda s: moving_place(surface, local, z)(0.0, s))
    assert along(f, *to_height(shape_operator(f), z, *VELOCITY)) == pytest.approx(moves, rel=1e-9, abs=1e-9)
    assert from_height(shape_operator(f), z, *to_height(shape_operator(f), z, 3.0, 4.0)) == pytest.approx((3.0, 4.0))


def test_the_normal_turns_as_differences_say(point):
    surface, local, f = point

    def normal(t, s):
        return normal_of(surface_at(local, *(PLACE + s * VELOCITY), TIME + t))

    assert normal_rate(f, *VELOCITY) == pytest.approx(difference(lambda t: normal(t, t)), rel=1e-9, abs=1e-9)
    for bend, truth in (
        (normal_bend(f, *VELOCITY), second(lambda t: normal(t, t))),
        (normal_bend_along(f, *VELOCITY), difference(lambda s: difference(lambda t: normal(t, s + t), 1e-3), 1e-3)),
    ):
        assert along(f, bend.x, bend.y) - bend.down * normal_of(f) == pytest.approx(truth, rel=1e-6, abs=1e-6)


def test_the_pull_is_what_keeps_the_centre_of_mass_going(point):
    """Without friction the pull moves it as gravity alone would, along the surface; the rest is the normal force."""
    surface, local, f = point
    part = Part(MASS, G, 0.3, -0.2, 0.0, ConstantFriction(0.0).law, 0.1, 0.25)
    p = pull(f, *VELOCITY, part)
    path = moving_place(surface, local, part.centre)
    wanted = np.array([0.3, -0.2, -G]) - second(lambda t: path(t, t))
    normal = normal_of(f)
    assert p.normal == pytest.approx(-MASS * wanted @ normal, rel=1e-7)
    assert along(f, p.x, p.y) == pytest.approx(wanted - (wanted @ normal) * normal, rel=1e-6, abs=1e-6)


def test_energy_is_that_of_the_centre_of_mass(point):
    surface, local, f = point
    part = Part(MASS, G, 0.3, -0.2, 0.0, ConstantFriction(0.0).law, 0.1, 0.25)
    path = moving_place(surface, local, part.centre)
    speed = difference(lambda t: path(t, t))
    v_z = f.w_t + VELOCITY @ (f.w_x, f.w_y)
    kinetic, potential = energy(f, *PLACE, *VELOCITY, f.w, v_z, part)
    assert kinetic == pytest.approx(MASS / 2 * speed @ speed, rel=1e-9)
    assert potential == pytest.approx(-MASS * np.array([0.3, -0.2, -G]) @ path(0.0, 0.0), rel=1e-12)


def test_the_first_slip_accelerates_along_itself(point):
    _, _, f = point
    part = Part(MASS, G, 0.0, 0.0, 0.0, ConstantFriction(0.0).law, 0.0, 0.4)
    k = mobility(f, part)
    assert moved(k, 3.0, -1.0) == pytest.approx(at_centre(f, part, *at_centre(f, part, 3.0, -1.0)), rel=1e-12)
    assert at_contact(f, part, *at_centre(f, part, 3.0, -1.0)) == pytest.approx((3.0, -1.0), rel=1e-12)
    for limit in (1.0, 2.9):
        rate, e_x, e_y = first_slip(f, k, 3.0, -1.0, limit)
        assert length(f, e_x, e_y) == pytest.approx(1.0, rel=1e-14)
        assert moved(k, 3.0 - limit * e_x, -1.0 - limit * e_y) == pytest.approx((rate * e_x, rate * e_y), abs=1e-13)


def disc(half_thickness=0.0):
    points = [[300e-6, 100e-6], [-250e-6, -350e-6]]
    drives = [Drive(12e-6, 300.0), Drive(-9e-6, 400.0)]
    return replace(surface_motion(DiscShapes(points, 1e-3), drives), half_thickness=half_thickness)


LAWS = {
    "constant": ConstantFriction(8e-10),
    "coulomb": CoulombAdhesion(0.04, 1e-9, static_coefficient=0.05),
    "kogut-etsion": KogutEtsion.paper(),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("scheme", ["events", "fixed"])
def test_the_ledger_closes_with_the_new_terms(name, scheme):
    """Heights that differ, on a slope that counts: a bowl that heaves, in an accelerated frame."""
    c = np.zeros((3, 3, 5))
    c[2, 0, 0] = c[0, 2, 0] = 2.0
    c[1, 0, 2:], c[0, 0, 2:] = [0.8, -1.5, 0.9], [0.3, -0.2, 0.1]
    surface = replace(polynomial_surface(c, base=[Drive(0.05, 1.0), Drive(-0.03, 2.0)]), half_thickness=0.02)
    part = Micropart(MASS, (0.12, -0.05), (0.15, 0.3), centre_height=0.03)
    step = {"time_step": 5e-4} if scheme == "fixed" else {}
    path = simulate(surface, part, LAWS[name], 0.5, scheme=scheme, tolerance=1e-10, **step)
    assert path.path_length > 1e-3
    assert path.energy.balance < (1e-8 if scheme == "events" else 1e-2)
    if scheme == "fixed":
        truth = simulate(surface, part, LAWS[name], 0.5, tolerance=1e-10).energy
        assert path.energy.dissipated[-1] == pytest.approx(truth.dissipated[-1], rel=2e-2)
        assert path.energy.work[-1] == pytest.approx(truth.work[-1], rel=2e-2)


def test_a_platform_does_not_tilt():
    platform = platform_surface(Drive(1e-3, 20.0), None, Drive(1e-4, 30.0), size=1e-3)
    low, high = (
        simulate(platform, Micropart(MASS, (0.0, 0.0), centre_height=height), CoulombAdhesion(0.1), 0.1)
        for height in (0.0, 5e-5)
    )
    assert np.array_equal(low.position, high.position)


def test_a_height_below_the_mid_plane_is_refused():
    with pytest.raises(ValueError, match="Input half_thickness of SurfaceMotion must be 0 or a positive length"):
        simulate(disc(-1e-6), Micropart(MASS, (0.0, 0.0)), LAWS["constant"], 1e-3)


def test_on_a_platform_the_centre_of_mass_is_above_the_contact():
    path = simulate(platform_surface(), Micropart(MASS, (0.0, 0.0), centre_height=5e-5), CoulombAdhesion(0.1), 0.1)
    assert path.contact_at([0.0]).centre[0] == pytest.approx((0.0, 0.0, 5e-5))


def test_dense_output_and_rest_are_those_of_the_rows():
    surface, part = disc(50e-6), Micropart(MASS, (100e-6, 200e-6), centre_height=30e-6)
    path = simulate(surface, part, LAWS["coulomb"], 4e-3)
    again = path.at(path.time[1:-1] * (1 - 1e-12))
    assert np.abs(again.position - path.position[1:-1]).max() < 1e-9 * 1e-3


@pytest.mark.parametrize("height", [0.0, 40e-6])
def test_a_part_flies_and_lands_with_its_centre_of_mass(height):
    """The ledger closes over flights and impacts, and the centre flies freely."""
    surface = replace(surface_motion(DiscShapes([[0.0, 0.0]], 1e-3), [Drive(15e-6, 1200.0)]), half_thickness=50e-6)
    part = Micropart(MASS, (200e-6, 150e-6), centre_height=height)
    law = CoulombAdhesion(0.2, 1e-9)
    path = simulate(surface, part, law, 4e-3, after_detachment="fly")
    assert (path.state == 2).any() and path.outcome is not Outcome.WORK_LIMIT
    assert path.energy.balance < 1e-6
    flying = np.flatnonzero(path.state == 2)[0]
    begin, end = path.time[flying], path.time[flying + 1]
    times = begin + (end - begin) * np.linspace(0.1, 0.9, 9)
    centre = path.contact_at(times).centre
    fit = np.polynomial.polynomial.polyfit((times - begin) / (end - begin), centre, 2)
    fitted = np.polynomial.polynomial.polyval((times - begin) / (end - begin), fit).T
    assert np.abs(fitted - centre).max() < 1e-13
    assert 2 * fit[2, 2] / (end - begin) ** 2 == pytest.approx(-G, rel=1e-4)


def test_a_part_at_rest_slips_when_newton_says_so():
    """A level plate that begins to tilt: the centre of mass is thrown aside before any slope pulls it."""
    c = np.zeros((2, 1, 4))
    c[1, 0, 2:] = [2.0, 3.0]  # grad w = 2 t^2 + 3 t^3
    surface = replace(polynomial_surface(c), half_thickness=0.3)
    path = simulate(surface, Micropart(MASS, (0.0, 0.0), centre_height=0.2), ConstantFriction(MASS * 2.5), 1.0)

    def over(t):
        g, g_t, g_tt = 2 * t**2 + 3 * t**3, 4 * t + 9 * t**2, 4 + 18 * t
        square = 1 + g * g
        # Along the slope: gravity, and z_c times the tilt's angular acceleration.
        return abs(-G * g / np.sqrt(square) + 0.5 * (g_tt / square - 2 * g * g_t**2 / square**2)) - 2.5

    assert path.events[0].time == pytest.approx(brentq(over, 0.0, 1.0), abs=1e-9)


def test_contact_and_centre_are_one_call_away():
    surface, part = disc(50e-6), Micropart(MASS, (100e-6, 200e-6), centre_height=30e-6)
    law = LAWS["kogut-etsion"]
    path = simulate(surface, part, law, 2e-3)
    times = np.linspace(0.0, 2e-3, 21)
    contact, samples = path.contact_at(times, law), path.at(times)
    assert np.linalg.norm(contact.centre - contact.contact, axis=1) == pytest.approx(np.full(21, 30e-6))
    assert np.linalg.norm(contact.normal, axis=1) == pytest.approx(np.ones(21))
    under = np.column_stack([samples.position, samples.height])
    assert contact.contact - 50e-6 * contact.normal == pytest.approx(under, rel=1e-12, abs=1e-18)
    assert np.linalg.norm(contact.friction, axis=1) == pytest.approx(samples.friction_force, rel=1e-12, abs=1e-24)
    assert np.abs((contact.friction * contact.normal).sum(axis=1)).max() < 1e-12 * samples.friction_force.max()
    assert contact.contact_load - contact.adhesion == pytest.approx(contact.normal_force, rel=1e-9)
    assert np.isnan(path.contact_at(times).separation).all()
    assert (contact.pull <= contact.added_pull + contact.point_pull + 1e-12).all()
