"""A rough contact under a part with a size, by the curvature of the surface under it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

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
from particle.body.balance import Balance
from particle.body.press import gaps
from particle.friction.contact import ScaledFriction
from particle.friction.local import LocalContact
from particle.records import new_records

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
    face = Footprint.rectangle(2 * SIZE, SIZE / 2)
    bodies = [Body(face, 50e-6, MASS, position=(x, 0.0), heading=0.3) for x in (0.0, 3e-5)]
    law = LocalContact(KogutEtsion.paper(), face)
    surface = bent(-10.0, 5.0, Drive(5e-6, 1500.0, cycle="sine"))
    one, two = (simulate_many(surface, bodies, law, 2e-3, threads=threads) for threads in (1, 2))
    assert all((a.position == b.position).all() for a, b in zip(one, two, strict=True))
    assert all(path.events and path.heading[-1] != 0.3 for path in one)


def test_moments_between_rows_do_not_depend_on_those_asked_for_with_them():
    """On a saddle, where there are two tilts under one load."""
    face = Footprint.rectangle(2 * SIZE, SIZE / 2)
    surface = bent(20.0, -20.0, Drive(10e-6, 1000.0, cycle="sine"))
    body = Body(face, 20e-6, MASS, position=(0.0, 0.0), heading=0.3)
    path = simulate(surface, body, LocalContact(KogutEtsion.paper(), face), 2e-3)
    times = np.linspace(0.1e-3, 1.9e-3, 12)
    alone = [path.at([time]).position[0] for time in times]
    assert path.at(times).position == pytest.approx(np.array(alone), abs=1e-20)


def test_what_does_not_go_together_is_refused(local):
    surface, face = bent(-80.0, -20.0), Footprint.rectangle(SIZE, SIZE)
    body = Body(face, 50e-6, MASS, position=(0.0, 0.0))
    uniform = Body(face, 50e-6, MASS, position=(0.0, 0.0), pressure="uniform")
    law = LocalContact(KogutEtsion.paper(), face)
    with pytest.raises(ValueError, match="size of LocalContact must be the footprint of the Body"):
        simulate(surface, body, ScaledFriction(local, 2.0), 1e-3)
    with pytest.raises(ValueError, match="size of LocalContact must be the side of a square"):
        simulate(surface, Micropart(MASS, (0.0, 0.0)), law, 1e-3)
    with pytest.raises(ValueError, match="pressure of Body must be 'linear'"):
        simulate(surface, uniform, law, 1e-3)
    with pytest.raises(ValueError, match="after_tipping of simulate must be 'stop'"):
        simulate(surface, body, law, 1e-3, after_tipping="ignore")
    with pytest.raises(ValueError, match="friction of simulate must be a friction law"):
        simulate(surface, body, 0.3, 1e-3)
    around = [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [1, 1], [1, 3], [0, 3]]
    with pytest.raises(ValueError, match="all of which its centroid sees"):
        LocalContact(KogutEtsion.paper(), Footprint.polygon(np.array(around) * 3e-5))


FACES = {
    "bar": Footprint.rectangle(2e-4, 5e-5),
    "disc": Footprint.disc(5e-5),
    "L": Footprint.polygon(np.array([[0, 0], [10, 0], [10, 4], [4, 4], [4, 10], [0, 10]]) * 1e-5),
    "triangle": Footprint.polygon(np.array([[0, 0], [12, 0], [3, 10]]) * 1e-5),
}


@pytest.mark.parametrize(
    "name", ["disc", *(pytest.param(name, marks=pytest.mark.slow) for name in FACES if name != "disc")]
)
def test_a_gap_bears_its_load_and_moments_at_least_potential_and_gives_the_friction_of_its_tractions(name):
    face, contact, generator = FACES[name], KogutEtsion.paper(), np.random.default_rng(5)
    law = LocalContact(contact, face)
    bends = generator.normal(size=(12, 3)) * np.geomspace(1.0, 20.0, 12)[:, None]
    loads = (
        law.pull_off * generator.uniform([-0.1, -0.03, -0.03], [0.5, 0.03, 0.03], (12, 3)) * [1, face.reach, face.reach]
    )
    slips = np.column_stack([generator.normal(size=(12, 2)), generator.normal(size=12) / face.reach])
    one = Body(face, 5e-5, MASS, position=(0.0, 0.0)).face(3, True)
    found = gaps(law.law, one, loads, bends, slips, new_records(Balance))
    assert np.isfinite(found).all()
    places, weights = face.rule(30)
    x, y = places.T

    def pressed(gap, bend):
        sag = (bend[0] * x * x + 2 * bend[1] * x * y + bend[2] * y * y) / 2 / contact.roughness
        load, adhesion, limit = contact.forces(gap[0] + (gap[1] * x + gap[2] * y) / face.reach - sag)
        share = weights * face.area / contact.contact_area
        return share * (load - adhesion), share * limit

    for gap, force, load, bend, slip in zip(found[:, :3], found[:, 3:6], loads, bends, slips, strict=True):
        net, limit = pressed(gap, bend)
        borne = np.array([net.sum(), net @ y / face.reach, -net @ x / face.reach])
        assert borne == pytest.approx(load / [1, face.reach, face.reach], abs=3e-5 * np.abs(net).sum())
        by_gap = []
        for step in 1e-4 * np.eye(3):
            less, more = (pressed(gap + side * step, bend)[0] for side in (-1, 1))
            change = (less - more) / 2e-4
            by_gap.append([change.sum(), change @ x / face.reach, change @ y / face.reach])
        assert np.linalg.eigvalsh((np.array(by_gap) + np.transpose(by_gap)) / 2).min() > 0
        u = np.array([slip[0] - slip[2] * y, slip[1] + slip[2] * x])
        pull = -limit * u / np.hypot(*u)
        wrench = np.array([*pull.sum(axis=1), (x * pull[1] - y * pull[0]).sum() / face.reach])
        assert force / [1, 1, face.reach] == pytest.approx(wrench, abs=3e-3 * limit.sum())


@pytest.mark.slow
def test_a_face_rocks_off_a_hump_where_it_does_not_stiffen_against_a_tilt_any_more(local):
    contact, face = KogutEtsion.paper(), Footprint.rectangle(SIZE, SIZE)
    places, weights = face.rule(40)
    sag, x = 40 * (places**2).sum(axis=1) / contact.roughness, places[:, 0]

    def net(z):
        load, adhesion, _ = contact.forces(z + sag)
        return weights * SIZE**2 / contact.contact_area * (load - adhesion)

    def stiffness(z):
        return ((net(z - 1e-3) - net(z + 1e-3)) @ x**2) / SIZE**2

    z = brentq(stiffness, 3.0, 4.5, xtol=1e-10)
    borne = -net(z).sum()
    assert 0.3 < borne / local.on_surface(np.diag([-80.0, -80.0])).pull_off < 0.6
    body, law = Body(face, 1e-9, MASS, position=(0.0, 0.0)), LocalContact(contact, face)
    for share, outcome in ((0.998, Outcome.STUCK), (1.002, Outcome.TIPPED)):
        lift = share * borne / MASS
        assert simulate(bent(-80.0, -80.0), body, law, 1e-3, gravity=(0.0, 0.0, lift)).outcome is outcome


@pytest.mark.parametrize("bend", [(-20.0, -20.0), (10.0, -30.0)])
def test_a_face_that_bears_no_moments_goes_by_the_law_of_one_curvature_tabulated(bend):
    heading, face = np.pi / 2, Footprint.rectangle(1.2e-4, 0.8e-4)
    surface, law = bent(*bend, Drive(14e-6, 200.0, cycle="sine")), LocalContact(KogutEtsion.paper(), face)
    one = law.on_surface(np.diag(bend[::-1]))
    loads = np.concatenate([[-one.pull_off], np.linspace(-5e-9, 5e-8, 34)])
    table = FrictionTable(loads, one.friction_limit(loads))
    parts = [Body(face, 1e-9, MASS, position=(2e-5, 0.0), heading=heading, pressure=p) for p in ("uniform", "linear")]
    other, path = (
        simulate(surface, part, by, 20e-3, tolerance=1e-8) for part, by in zip(parts, (table, law), strict=True)
    )
    assert [event.kind for event in path.events] == [event.kind for event in other.events] and len(path.events) >= 8
    assert [event.time for event in path.events] == pytest.approx([event.time for event in other.events], abs=1e-8)
    assert path.position[-1] == pytest.approx(other.position[-1], abs=1e-10)
    assert np.hypot(*(path.position[-1] - parts[0].position)) > 2e-8
