"""A rough contact under a part with a size, by the curvature of the surface under it."""

from __future__ import annotations

import numpy as np
import pytest

from particle import (
    Body,
    Drive,
    Footprint,
    FrictionTable,
    KogutEtsion,
    Micropart,
    Outcome,
    polynomial_surface,
    simulate,
    simulate_many,
)
from particle.friction.local import LocalContact

SIZE, MASS = 100e-6, 2e-9
STILL = Drive(0.0, 100.0)


@pytest.fixture(scope="module")
def local() -> LocalContact:
    return LocalContact(KogutEtsion.paper(), SIZE)


def bent(xx: float, yy: float, base: Drive = STILL):
    """A surface with these curvatures [1/m] that is carried along x."""
    return polynomial_surface([[0.0, 0.0, yy / 2], [0.0, 0.0, 0.0], [xx / 2, 0.0, 0.0]], size=1e-3, base=(base, STILL))


@pytest.mark.parametrize("hessian", [(0, 0, 0), (-80, -80, 0), (60, 60, 0), (80, -80, 0), (-80, -20, 30), (25, 3, -4)])
def test_limits_and_pull_off_are_those_of_a_finer_rule_on_the_whole_face(local, hessian):
    xx, yy, xy = hessian
    face = local.on_surface([[xx, xy], [xy, yy]])
    loads = face.pull_off * np.array([-0.99, -0.5, 0.0, 0.4])
    limits, pull_offs = local.bears(loads, np.tile([[xx, xy], [xy, yy]], (4, 1, 1)))
    assert limits == pytest.approx(face.friction_limit(loads), rel=1e-4)
    assert limits[2:] == pytest.approx(face.friction_limit(loads[2:]), rel=2e-5)
    assert pull_offs == pytest.approx(face.pull_off, rel=2e-6)


@pytest.mark.parametrize("bend", [(-80.0, -80.0), (40.0, -60.0)])
def test_a_path_is_that_by_the_law_of_one_curvature_tabulated(local, bend):
    surface = bent(*bend, Drive(8e-6, 200.0, cycle="sine"))
    face = local.on_surface(np.diag(bend))
    loads = np.concatenate([[-face.pull_off], np.linspace(-5e-9, 5e-8, 34)])
    table = FrictionTable(loads, face.friction_limit(loads))
    part = Micropart(MASS, (20e-6, 10e-6), centre_height=20e-6)
    other, path = (simulate(surface, part, law, 20e-3, tolerance=1e-8) for law in (table, local))
    assert [event.kind for event in path.events] == [event.kind for event in other.events]
    assert len(path.events) >= 8
    assert path.position[-1] == pytest.approx(other.position[-1], abs=2e-10)
    assert np.hypot(*(path.position[-1] - part.position)) > 2e-7
    assert [event.time for event in path.events] == pytest.approx([event.time for event in other.events], abs=1e-8)


def test_a_part_comes_off_where_its_pull_exceeds_the_pull_off_of_the_bent_surface(local):
    part = Micropart(MASS, (0.0, 0.0))
    for bend in ((0.0, 0.0), (-80.0, -80.0), (60.0, 60.0)):
        pull_off = local.on_surface(np.diag(bend)).pull_off
        lift = np.array([0.99, 1.01]) * (1 + pull_off / (MASS * 9.80665))
        ends = [simulate(bent(*bend), part, local, 1e-3, gravity=(0.0, 0.0, 9.80665 * (g - 1))).outcome for g in lift]
        assert ends == [Outcome.STUCK, Outcome.DETACHED]


def test_threads_bits_and_bodies(local):
    surface = bent(-80.0, -20.0, Drive(5e-6, 1500.0, cycle="sine"))
    parts = [Micropart(MASS, (x, 0.0)) for x in (0.0, 3e-5)]
    one, two = (simulate_many(surface, parts, local, 2e-3, threads=threads) for threads in (1, 2))
    assert all((a.position == b.position).all() for a, b in zip(one, two, strict=True))
    body = Body(Footprint.rectangle(SIZE, SIZE), 50e-6, MASS, position=(0.0, 0.0))
    with pytest.raises(ValueError, match="must not be a LocalContact with a Body"):
        simulate(surface, body, local, 1e-3)
