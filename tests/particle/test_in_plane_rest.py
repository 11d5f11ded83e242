"""A part at rest where the mid-plane moves in its plane: the proof that it stays, and its quick bound."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import comb
from steep_surface import LAWS, PLACE, G, local_at, steep_surface

from particle import (
    ConstantFriction,
    polynomial_surface,
)
from particle.events.mechanics.breakaway import rest_pull
from particle.events.mechanics.equations import Part
from particle.events.rest.stick import leaves_rest, new_rest
from particle.events.rest.stick_bound import is_safe_by_bound, largest_force
from particle.events.rest.stick_margin import NARROW, fill_margin
from particle.surface.at_point import surface_at


def test_the_proof_that_a_part_stays_is_made_of_the_pull_on_it():
    """Its polynomials are the load and what is needed at any time, with a centre of mass on the mid-plane too."""
    local, begin, lasting = local_at(steep_surface(), time=0.1), 0.1, NARROW
    rest = new_rest()
    for heights in ((0.1, 0.25), (0.0, 0.0)):
        part = Part(2.0, G, 0.3, -0.2, 0.0, LAWS["constant"].law, *heights)
        leaves_rest(local, part, rest, *PLACE, begin, begin + lasting)
        fill_margin(part, rest.motion, rest.plane, lasting, rest.margins[0])
        degree = rest.margins.shape[2] - 1
        for s in (0.0, 0.3, 0.77, 1.0):
            basis = [comb(degree, i) * s**i * (1 - s) ** (degree - i) for i in range(degree + 1)]
            load, needed = rest.margins[0] @ basis
            a = rest_pull(surface_at(local, *PLACE, begin + s * lasting), part)
            assert load == pytest.approx(a.load, rel=1e-12)
            assert needed == pytest.approx(a.demand**2, rel=1e-11)


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
            return rest_pull(surface_at(local, *PLACE, t), part).demand

        demands = np.array([demand(t) for t in moments])
        if demands.max() < 1.01 * demands[0]:
            continue
        for share in (0.6, 0.999, 1.02, 4.0):
            limit = demands[0] + share * (demands.max() - demands[0])
            held = part._replace(law=ConstantFriction(limit).law)
            found = leaves_rest(local, held, rest, *PLACE, 0.0, 1.0)
            safe = is_safe_by_bound(held, rest.motion, rest.plane, 1.0, rest.quintic, rest.force)
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
                demands.append(rest_pull(surface_at(local, *PLACE, time), part).demand)
            force = largest_force(part, rest.motion, rest.plane, lasting, rest.force)
            assert force == pytest.approx(max(demands), rel=0.02 + 3 * strain + lasting * 3)
            for share, safe in ((1 - 1e-12, False), (1.02 + 20 * strain + lasting * 3, True)):
                held = part._replace(law=ConstantFriction(share * max(demands)).law)
                quick = is_safe_by_bound(held, rest.motion, rest.plane, lasting, rest.quintic, rest.force)
                assert quick == safe, (seed, lasting, share)
