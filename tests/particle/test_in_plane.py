"""A mid-plane that moves in its plane: kinematics against differences of places."""

import math
from dataclasses import replace

import numpy as np
import pytest
from steep_surface import PLACE, TIME, VELOCITY, G, local_at, steep_surface

from particle import (
    ConstantFriction,
    TableDrive,
    polynomial_surface,
)
from particle.events.mechanics.equations import Part, energy, pull, rising
from particle.events.mechanics.parallel import (
    from_height,
    normal_bend,
    normal_bend_along,
    normal_rate,
    shape_operator,
    to_height,
)
from particle.surface.at_point import surface_at

TILT = np.array([0.3, -0.2, -G])


@pytest.fixture(scope="module")
def steep():
    return steep_surface()


@pytest.fixture(scope="module")
def local(steep):
    return local_at(steep)


@pytest.fixture(scope="module")
def point(local):
    return surface_at(local, *PLACE, TIME)


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
