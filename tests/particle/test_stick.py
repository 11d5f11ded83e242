"""The search for the end of rest, against brute force: it misses no break-away and invents none."""

import math

import numpy as np
import pytest

from particle import ConstantFriction, CoulombAdhesion, Drive, KogutEtsion, polynomial_surface
from particle.events.mechanics.equations import Part, length, pull
from particle.events.rest.stick import leaves_rest, new_rest
from particle.friction.contact import friction_limit
from particle.surface.at_point import surface_at
from particle.surface.local import new_local
from particle.surface.span import enter

SAMPLES = 300
MASS = 2e-9


def moving(rng):
    """A surface whose slope and height follow random quintics in time, and half of the time a base that moves."""
    c = np.zeros((2, 2, 6))
    c[0, 0] = rng.normal(size=6) * [0, 0, 4, 4, 4, 4]
    c[1, 0], c[0, 1] = 0.4 * rng.normal(size=(2, 6))
    base = None
    if rng.random() < 0.5:
        base = [Drive(rng.normal(), 0.5, cycle="up"), Drive(rng.normal(), 0.5, cycle="up")]
    return polynomial_surface(c, base=base)


def law(rng, kind):
    if kind == "constant":
        return ConstantFriction(MASS * 10 ** rng.uniform(0, 1.5)).law
    if kind == "coulomb":
        return CoulombAdhesion(0.4, MASS * rng.uniform(2, 30), static_coefficient=rng.choice([0.4, 0.7])).law
    return KOGUT_ETSION


KOGUT_ETSION = KogutEtsion.paper().law


def stays(surface, local, part, time):
    """Whether a part at rest at the origin is held at one time: the definition, from the equations of motion."""
    f = surface_at(local, 0.0, 0.0, time)
    p = pull(f, 0.0, 0.0, part)
    limit = part.law.static_ratio * friction_limit(part.law, p.normal) / part.mass
    return -part.law.pull_off <= p.normal <= part.law.largest_load and length(f, p.x, p.y) <= limit


def search(surface, part, begin=0.0):
    record = surface.record
    local = new_local(record)
    enter(record, local, 0.0, 0.0, 0.0, 1.0)
    return leaves_rest(local, part, new_rest(), 0.0, 0.0, begin, 1.0), local


@pytest.mark.parametrize(
    "kind, gravity", [("constant", 9.81), ("coulomb", 9.81), ("coulomb", 0.0), ("kogut-etsion", 9.81)]
)
@pytest.mark.parametrize("heights", [(0.0, 0.0), (0.1, 0.5)])
def test_a_break_away_is_never_missed_and_never_early(kind, gravity, heights):
    rng, found = np.random.default_rng(7), []
    count = 24 if heights == (0.0, 0.0) else 12
    for _ in range(count):
        surface, begin = moving(rng), rng.choice([0.0, rng.uniform(0, 0.9)])
        part = Part(MASS, gravity, 0.0, 0.0, 0.0, law(rng, kind), *heights)
        leaves, local = search(surface, part, begin)
        times = begin + (1 - begin) * np.linspace(0, 1, SAMPLES)
        held = np.array([stays(surface, local, part, t) for t in times])
        first = times[~held][0] if (~held).any() else math.inf
        assert leaves <= first + 1e-12
        if leaves < 1:
            # Held until the moment found, not any more right after it.
            assert not stays(surface, local, part, leaves + 1e-12)
            assert all(stays(surface, local, part, t) for t in times if t < leaves - 1e-9)
        found.append(leaves)
    assert count / 6 < np.isfinite(found).sum() < count or kind == "kogut-etsion"
    assert np.isfinite(found).any()


@pytest.mark.parametrize("below", [1e-4, 1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize("adhesion", [0.0, MASS * 9.81])
def test_a_part_that_starts_just_below_its_limit_slips_as_its_load_falls(below, adhesion):
    """w = -c t^5, and a steady pull: the load m (g - 20 c t^3) bends, what is needed does not."""
    c = np.zeros((1, 1, 6))
    c[0, 0, 5] = -0.1
    hold = 9.81 + adhesion / MASS
    part = Part(MASS, 9.81, 0.3 * hold * (1 - below), 0.0, 0.0, CoulombAdhesion(0.3, adhesion=adhesion).law)
    leaves = search(polynomial_surface(c), part)[0]
    assert leaves == pytest.approx((hold * below / 2) ** (1 / 3), rel=1e-13 / below, abs=1e-12)


def hump(height):
    """Slope over time with its peak at t = 0.37."""
    c = np.zeros((2, 1, 6))
    c[1, 0, :3] = height * np.array([1 - 0.37**2, 2 * 0.37, -1.0])
    return polynomial_surface(c)


def test_a_peak_of_a_hundred_thousandth_of_the_stroke_is_found():
    """The slope exceeds what friction holds, 0.3 (Coulomb), for 1e-5 of the time."""
    part, half = Part(MASS, 9.81, 0.0, 0.0, 0.0, CoulombAdhesion(0.3).law), 0.5e-5
    leaves, _ = search(hump(0.3 / (1 - half**2)), part)
    assert leaves == pytest.approx(0.37 - half, abs=1e-9)


def test_a_peak_that_stays_just_below_the_limit_moves_nothing():
    part = Part(MASS, 9.81, 0.0, 0.0, 0.0, CoulombAdhesion(0.3).law)
    assert search(hump(0.3 * (1 - 1e-12)), part)[0] == math.inf


def test_the_moment_of_break_away_is_exact():
    """An incline that steepens as t: Coulomb friction holds up to the slope mu."""
    c = np.zeros((2, 1, 2))
    c[1, 0, 1] = 0.7
    leaves, _ = search(polynomial_surface(c), Part(MASS, 9.81, 0.0, 0.0, 0.0, CoulombAdhesion(0.3).law))
    assert leaves == pytest.approx(0.3 / 0.7, abs=1e-12)


def test_a_part_that_the_surface_leaves_behind_comes_off_in_time():
    """w = -c t^3 / 6: the normal force is m (g - c t)."""
    c = np.zeros((1, 1, 4))
    c[0, 0, 3] = -40 / 6
    part = Part(MASS, 9.81, 0.0, 0.0, 0.0, CoulombAdhesion(0.3, adhesion=MASS * 5.0).law)
    assert search(polynomial_surface(c), part)[0] == pytest.approx((9.81 + 5) / 40, abs=1e-12)


def test_a_static_coefficient_holds_longer_than_the_kinetic_one():
    c = np.zeros((2, 1, 2))
    c[1, 0, 1] = 0.7
    part = Part(MASS, 9.81, 0.0, 0.0, 0.0, CoulombAdhesion(0.3, static_coefficient=0.5).law)
    assert search(polynomial_surface(c), part)[0] == pytest.approx(0.5 / 0.7, abs=1e-12)
