"""A part on a film of air: against a solution in two dimensions, in limits, and by two ledgers."""

from dataclasses import replace

import numpy as np
import pytest
import reynolds
from driven_surface import driven, steady

from particle import (
    Air,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    Film,
    KogutEtsion,
    LocalContact,
    Micropart,
    Outcome,
    State,
    platform_surface,
    simulate,
    simulate_many,
)
from particle.film.film import PER_AREA, assumed_contact
from particle.friction.contact import ScaledFriction

pytestmark = pytest.mark.compiled

MASS, SIZE, G = 2e-9, 1e-4, 9.80665
WEIGHT, STROKE = MASS * G, 0.5e-3
TABLE_1, LOCAL = KogutEtsion(), LocalContact(KogutEtsion.paper(), SIZE)
FILM = Film(Air(), SIZE)
PART = Micropart(MASS, (0.0, 0.0))
ON_FILM = replace(PART, film=FILM)


def asperities(path):
    return path.normal_force - path.air_force


@pytest.mark.parametrize("frequency", [2.0, 100.0, 1e3, 1e4])
def test_asperities_and_film_share_a_small_load_as_in_two_dimensions(frequency):
    stroke = 0.3 * G / (2 * np.pi * frequency) ** 2
    surface = platform_surface(z=Drive(stroke, frequency, cycle="sine"), size=stroke)
    begin, period = 4e-3 * (frequency > 100), 1 / frequency
    times = begin + (1.0 + np.arange(400) / 400) * period
    path = simulate(surface, ON_FILM, TABLE_1, begin + 2 * period).at(times)
    swing = np.exp(-2j * np.pi * frequency * times)
    share = (swing @ asperities(path)) / (swing @ path.normal_force)
    expected = reynolds.Film(reynolds.RoughContact(TABLE_1), lambda t: WEIGHT).share(frequency)
    assert abs(share - expected) < 1e-4


def strokes(load):
    """A platform whose acceleration swings the load by `load` [N]."""
    height = load / MASS / 5.7735027 * STROKE**2
    return platform_surface(z=Drive(height, 0.5 / STROKE), size=height)


# In the second millisecond [uN, nm], by the reference with 14 points; 4.0 is far beyond pull-off.
@pytest.mark.parametrize(
    ("over", "load", "gap"),
    [
        (0.9, (-2.2413673, 2.6967713), (87.1478259, 91.0894922)),
        (1.5, (-3.2807492, 4.5847887), (86.3429900, 93.4780044)),
        (4.0, (-3.7160197, 11.4738114), (84.3391609, 120.2846401)),
    ],
)
def test_strong_strokes_move_the_gap_as_in_two_dimensions(over, load, gap):
    path = simulate(strokes(over * 3.716020e-6), ON_FILM, TABLE_1, 4 * STROKE)
    found = path.at(np.linspace(2 * STROKE, 4 * STROKE, 4001))
    assert path.outcome is Outcome.STUCK
    assert [1e6 * asperities(found).min(), 1e6 * asperities(found).max()] == pytest.approx(load, rel=5e-5)
    assert [1e9 * found.gap.min(), 1e9 * found.gap.max()] == pytest.approx(gap, rel=1e-4)
    assert path.film_energy.balance < 1e-6


@pytest.mark.parametrize(
    ("bend", "local", "off"),
    [(-60.0, True, 1), (25.0, True, 1), (-1.0, False, 1), (5.0, False, 30), (25.0, False, 100)],
)
def test_a_surface_that_bends_pumps_the_film_as_in_two_dimensions(bend, local, off):
    """Of asperities that are not local, too, which meet a plane in its place: sags of 0.03, 0.14 and 0.64 gaps."""
    surface = driven([Drive(1.0, 0.5 / STROKE)], [[[0, 0, bend / 2], [0, 0, 0], [bend / 2, 0, 0]]], size=1e-3)
    times = np.linspace(0.0, 2 * STROKE, 41)
    law = LocalContact(TABLE_1, SIZE) if local else TABLE_1
    found = simulate(surface, ON_FILM, law, 2 * STROKE).at(times)
    drive = Drive(bend, 0.5 / STROKE)
    film = reynolds.Film(reynolds.RoughContact(TABLE_1), lambda t: WEIGHT, lambda t: float(drive.evaluate(t)[0]))
    _, gaps, loads = (values.ravel() for values in film.history([0.0, STROKE, 2 * STROKE], samples=21))
    keep = np.arange(42) != 21
    assert found.gap == pytest.approx(gaps[keep], abs=1e-3 * off * np.ptp(gaps))
    assert asperities(found) == pytest.approx(loads[keep], abs=2e-3 * max(off / 2, 1) * np.ptp(loads))


def plate(stroke=10e-6, frequency=2e3, cycle="up-down"):
    """A part of a plate that bends and twists, a millimetre wide, driven up and down."""
    x, y = 1.5e6, 0.3e9
    shape = [[1, 0, -x, 0.2 * y], [0, 0.1 * x, y, 0], [-x, 0, 0.4 * x * x, 0], [0.5 * y, 0, 0, 0]]
    return driven([Drive(stroke, frequency, cycle=cycle)], [shape], size=1e-3)


COULOMB = CoulombAdhesion(0.05, 1.5e-6)
BESIDE = Micropart(MASS, (3e-4, 1e-4), centre_height=25e-6)
BESIDE_ON_FILM = replace(BESIDE, film=FILM)


@pytest.fixture(scope="module")
def path():
    return simulate(plate(), BESIDE_ON_FILM, COULOMB, 5e-3)


def test_a_path_on_a_bent_plate_keeps_both_ledgers_and_its_tolerance(path):
    assert path.energy.balance < 1e-6
    assert path.film_energy.balance < 1e-6
    assert path.film_energy.heat[-1] > 0.1 * np.abs(path.film_energy.work).max()
    assert len(path.events) > 10
    assert path.distance > 2e-7
    loose, tight = (simulate(plate(), BESIDE_ON_FILM, COULOMB, 5e-3, tolerance=t) for t in (1e-8, 1e-10))
    assert path.position[-1] == pytest.approx(tight.position[-1], abs=5e-11)
    assert loose.position[-1] == pytest.approx(tight.position[-1], abs=2e-10)
    assert path.stays is None


def test_air_turns_this_path_around():
    free, found = (simulate(plate(9e-6), part, COULOMB, 5e-3) for part in (BESIDE, BESIDE_ON_FILM))
    assert (free.position[-1] - free.position[0]) @ (found.position[-1] - found.position[0]) < 0


def test_samples_are_as_good_as_rows(path):
    k = np.flatnonzero(np.diff(path.time) > 1e-6)[::7]
    middle = path.at((path.time[k] + path.time[k + 1]) / 2)
    tight = simulate(plate(), BESIDE_ON_FILM, COULOMB, 5e-3, tolerance=1e-11).at(middle.time)
    assert middle.position == pytest.approx(tight.position, abs=5e-11)
    assert middle.gap == pytest.approx(tight.gap, abs=1e-12)
    assert middle.air_force == pytest.approx(tight.air_force, abs=1e-11)
    at_rows = path.at(path.time[k])
    assert (at_rows.gap == path.gap[k]).all()
    sliding = np.flatnonzero(path.state == State.SLIP)[3]
    contact = path.contact_at(path.time[[sliding]])
    drag = FILM.air.drag(SIZE**2, path.gap[sliding]) * np.hypot(*path.velocity[sliding])
    assert np.linalg.norm(contact.friction) == pytest.approx(path.friction_force[sliding] + drag, rel=1e-3)
    assert {"gap", "air_force"} <= set(path.to_xarray().data_vars)


def test_many_paths_have_the_bits_of_one(path):
    for threads in (1, 2):
        again = simulate_many(plate(), [BESIDE_ON_FILM] * 2, COULOMB, 5e-3, threads=threads)
        assert all((other.position == path.position).all() and (other.gap == path.gap).all() for other in again)


@pytest.mark.parametrize("law", [LOCAL, COULOMB, ScaledFriction(LOCAL, 2.0)], ids=["local", "coulomb", "scaled"])
def test_under_thin_air_or_a_wide_gap_a_path_is_that_in_a_vacuum(law):
    """But for the drag, which a part may have without a film."""
    air = Air(pressure=1e3, bow=3e-6)
    gap = air.bow + float(TABLE_1.mean_gap(3.9))
    part = Micropart(MASS, (3e-4, 1e-4), centre_height=25e-6, drag=air.drag(SIZE**2, gap))
    free = simulate(plate(8e-6), part, law, 3e-3)
    path = simulate(plate(8e-6), replace(part, film=Film(air, SIZE)), law, 3e-3)
    assert np.abs(path.air_force).max() < 3e-4 * np.abs(path.normal_force).max()
    assert path.path_length == pytest.approx(free.path_length, rel=5e-3)
    assert path.position[-1] == pytest.approx(free.position[-1], abs=5e-3 * free.path_length)


def test_a_path_begins_with_the_gap_and_the_friction_of_a_vacuum():
    part = Micropart(MASS, (3e-4, 1e-4), velocity=(0.01, 0.02))
    surface = plate(frequency=50.0)
    free, path = (simulate(surface, replace(part, film=film), LOCAL, 1e-4) for film in (None, FILM))
    assert path.friction_force[0] == pytest.approx(free.friction_force[0], rel=1e-6)
    assert path.air_force[0] == pytest.approx(0.0, abs=1e-14)


def test_a_part_comes_off_where_air_is_too_thin_to_hold_it():
    surface = strokes(1.5 * 3.716020e-6)
    thin = Film(Air(pressure=100.0, bow=1e-6), SIZE)
    free = simulate(surface, PART, TABLE_1, 3e-3)
    path = simulate(surface, replace(PART, film=thin), TABLE_1, 3e-3)
    assert path.outcome is free.outcome is Outcome.DETACHED
    assert path.time[-1] == pytest.approx(free.time[-1], abs=1e-3 * STROKE)
    at = simulate(surface, ON_FILM, TABLE_1, 1e-3, gravity=(0, 0, 2e3))
    assert (at.outcome, at.time[-1]) == (Outcome.DETACHED, 0.0)


def test_a_part_is_followed_off_the_surface_as_far_as_a_film_holds_it():
    surface = strokes(3 * 3.716020e-6)
    path = simulate(surface, replace(PART, film=Film(Air(pressure=3e4), SIZE)), TABLE_1, 1e-3, after_detachment="fly")
    assert [event.kind for event in path.events] == [EventKind.DETACHES, EventKind.LANDS]
    assert path.outcome is Outcome.STUCK
    assert 2e-7 < path.gap.max() < 2e-6
    assert set(path.state) == {State.STICK, State.FLIGHT}
    assert path.film_energy.balance < 1e-6
    lost = simulate(surface, replace(PART, film=Film(Air(pressure=1e4), SIZE)), TABLE_1, 1e-3, after_detachment="fly")
    assert lost.outcome is Outcome.DETACHED
    assert [event.kind for event in lost.events] == [EventKind.DETACHES, EventKind.DETACHES]


def test_beyond_pull_off_a_law_without_a_separation_has_no_friction():
    """The asperities' load comes back to 0 there, and friction must not with it."""
    thrown = replace(ON_FILM, velocity=(0.2, 0.0))
    path = simulate(strokes(8 * COULOMB.adhesion), thrown, COULOMB, 2 * STROKE).at(np.linspace(0.0, 2 * STROKE, 201))
    assert (path.state == State.SLIP).all()
    off = path.gap > TABLE_1.mean_gap(TABLE_1.branch[1]) + 1e-9
    assert off.sum() > 5
    assert (path.friction_force[off] == 0.0).all()
    assert (path.friction_force[path.gap < TABLE_1.mean_gap(3.9)] > 0.0).any()


def test_an_assumed_contact_has_the_pull_off_force_of_its_law():
    assert pytest.approx(TABLE_1.pull_off / TABLE_1.contact_area, rel=1e-12) == PER_AREA
    assert assumed_contact(COULOMB, SIZE**2).pull_off == pytest.approx(COULOMB.adhesion, rel=1e-12)


def test_a_rough_contact_smaller_than_the_face_keeps_its_friction_on_a_film():
    law = KogutEtsion(contact_area=SIZE**2 / 4)
    part = Micropart(MASS, (0.0, 0.0), velocity=(0.01, 0.0))
    free, path = (simulate(platform_surface(size=1e-3), replace(part, film=film), law, 1e-5) for film in (None, FILM))
    assert path.friction_force[0] == pytest.approx(free.friction_force[0], rel=1e-6)


def test_what_does_not_go_with_a_film_is_refused():
    with pytest.raises(ValueError, match="friction of simulate must have a pull-off force on a film of air"):
        simulate(plate(), ON_FILM, CoulombAdhesion(0.1), 1e-3)
    with pytest.raises(ValueError, match="size of Film must be that of the LocalContact"):
        simulate_many(plate(), [replace(PART, film=Film(Air(), 5e-5))], LOCAL, 1e-3)
    with pytest.raises(ValueError, match="film of Micropart must be left out with the scheme 'fixed'"):
        simulate(plate(), ON_FILM, COULOMB, 1e-3, scheme="fixed")
    with pytest.raises(ValueError, match="air of Film must be an Air of a positive pressure"):
        Film(Air(pressure=0.0), SIZE)
    with pytest.raises(ValueError, match="without jumps of velocity under a Film; got one at 0.001 s"):
        simulate(platform_surface(z=steady(1e-3, 1e-3), size=1e-6), ON_FILM, ConstantFriction(1e-8), 2e-3)
