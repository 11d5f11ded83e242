"""A part with a face on a film of air: against points, in two dimensions, by symmetry, in limits and by two ledgers."""

from dataclasses import replace

import numpy as np
import pytest
import reynolds
from driven_surface import driven

from particle import (
    Air,
    Body,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    Film,
    Footprint,
    KogutEtsion,
    LocalContact,
    Micropart,
    Outcome,
    State,
    platform_surface,
    simulate,
    simulate_many,
)

pytestmark = pytest.mark.compiled

MASS, SIDE, G = 2e-9, 1e-4, 9.80665
TABLE_1, COULOMB = KogutEtsion(), CoulombAdhesion(0.05, 1.5e-6)
SQUARE, BAR = Footprint.rectangle(SIDE, SIDE), Footprint.rectangle(6e-5, 1.2e-4)
PLACE = (3e-4, 1e-4)


def body(face=BAR, position=PLACE, **fields):
    return Body(face, 5e-5, MASS, position=position, **{"film": Air(), **fields})


def asperities(path):
    return path.normal_force - path.air_force


def shaken(load=1.5e-6):
    """A platform that shakes up and down by a load [N], and sways so that a part slips."""
    stroke = 0.5e-3
    sway = {"x": Drive(2e-6, 700.0, cycle="sine"), "y": Drive(1e-6, 900.0, cycle="sine")}
    return platform_surface(z=Drive(load / MASS / 5.7735027 * stroke**2, 0.5 / stroke), size=1e-5, **sway)


def plate(side=1.0, stroke=10e-6):
    """A part of a plate that bends and twists, a millimetre wide, driven up and down at 2 kHz; side: -1 mirrors y."""
    x, y = 1.5e6, 0.3e9
    shape = [[1, 0, -x, 0.2 * y * side], [0, 0.1 * x * side, y, 0], [-x, 0, 0.4 * x * x, 0], [0.5 * y, 0, 0, 0]]
    return driven([Drive(stroke, 2e3, cycle="up-down")], [shape], size=1e-3)


@pytest.mark.parametrize(("law", "pressure"), [(KogutEtsion.paper(), "uniform"), (COULOMB, "linear")])
def test_a_square_that_does_not_turn_goes_as_a_point_on_the_same_film(law, pressure):
    """On a platform friction has no torque, whatever the pressure."""
    start = {"position": (0.0, 0.0), "velocity": (0.02, 0.01)}
    point = Micropart(MASS, **start, centre_height=25e-6, film=Film(Air(), SIDE))
    face = body(SQUARE, pressure=pressure, **start)
    of_point, of_face = (simulate(shaken(), part, law, 4e-3, tolerance=1e-11) for part in (point, face))
    times = np.linspace(0.0, 4e-3, 801)
    one, other = of_point.at(times), of_face.at(times)
    assert [event.kind for event in of_face.events] == [event.kind for event in of_point.events]
    assert of_point.path_length > 1e-5
    assert other.position == pytest.approx(one.position, abs=1e-6 * of_point.path_length)
    assert asperities(other) == pytest.approx(asperities(one), abs=1e-5 * np.ptp(asperities(one)))
    assert of_face.energy.dissipated[-1] == pytest.approx(of_point.energy.dissipated[-1], rel=1e-6)
    assert of_face.film_energy.heat[-1] == pytest.approx(of_point.film_energy.heat[-1], rel=1e-6)
    assert np.abs(of_face.heading).max() < 1e-12
    assert of_face.contact_at(times).friction == pytest.approx(of_point.contact_at(times).friction, abs=1e-12)


@pytest.mark.parametrize("frequency", [100.0, 1e3, 1e4])
@pytest.mark.parametrize(("width", "height", "off"), [(1e-4, 2e-4, 5e-4), (1.8e-4, 0.6e-4, 1e-3)])
def test_asperities_and_film_of_a_rectangle_share_a_small_load_as_in_two_dimensions(width, height, off, frequency):
    stroke = 0.3 * G / (2 * np.pi * frequency) ** 2
    surface = platform_surface(z=Drive(stroke, frequency, cycle="sine"), size=stroke)
    face = Footprint.rectangle(width, height)
    law = replace(TABLE_1, contact_area=face.area)
    begin, period = 8e-3 * (frequency > 100), 1 / frequency
    times = begin + (1.0 + np.arange(400) / 400) * period
    path = simulate(surface, body(face, (0.0, 0.0), heading=0.4), law, begin + 2 * period).at(times)
    swing = np.exp(-2j * np.pi * frequency * times)
    share = (swing @ asperities(path)) / (swing @ path.normal_force)
    film = reynolds.Film(reynolds.RoughContact(law), lambda t: MASS * G, sides=(width, height))
    assert abs(share - film.share(frequency)) < off


@pytest.mark.parametrize(("bend", "off"), [(1.0, 3e-3), (5.0, 4e-2), (-20.0, 8e-2)])
def test_a_surface_that_bends_pumps_the_film_of_a_rectangle_as_in_two_dimensions(bend, off):
    stroke, face = 0.5e-3, Footprint.rectangle(1.3e-4, 0.8e-4)
    surface = driven([Drive(1.0, 0.5 / stroke)], [[[0, 0, bend / 2], [0, 0, 0], [bend / 2, 0, 0]]], size=1e-3)
    times, law = np.linspace(0.0, 2 * stroke, 41), replace(TABLE_1, contact_area=face.area)
    found = simulate(surface, body(face, (0.0, 0.0), heading=0.7), law, 2 * stroke).at(times)
    drive = Drive(bend, 0.5 / stroke)
    contact, sides = reynolds.RoughContact(law), (1.3e-4, 0.8e-4)
    film = reynolds.Film(contact, lambda t: MASS * G, lambda t: float(drive.evaluate(t)[0]), points=7, sides=sides)
    _, gaps, loads = (values.ravel() for values in film.history([0.0, stroke, 2 * stroke], samples=21))
    keep = np.arange(42) != 21
    assert found.gap == pytest.approx(gaps[keep], abs=off * np.ptp(gaps))
    assert asperities(found) == pytest.approx(loads[keep], abs=off * np.ptp(loads))


@pytest.fixture(scope="module")
def path():
    return simulate(plate(), body(heading=0.3), COULOMB, 3e-3)


def test_a_path_on_a_bent_plate_keeps_both_ledgers_and_its_tolerance(path):
    assert path.outcome is Outcome.STUCK
    assert len(path.events) > 10
    assert path.energy.balance < 1e-6
    assert path.film_energy.balance < 1e-6
    tight = simulate(plate(), body(heading=0.3), COULOMB, 3e-3, tolerance=1e-11)
    assert path.position[-1] == pytest.approx(tight.position[-1], abs=2e-10)
    assert path.heading[-1] == pytest.approx(tight.heading[-1], abs=1e-7)
    times = (path.time[1::9] + path.time[:-1:9][: len(path.time[1::9])]) / 2
    one, other = path.at(times), tight.at(times)
    assert one.position == pytest.approx(other.position, abs=2e-10)
    assert one.gap == pytest.approx(other.gap, abs=1e-11)
    assert {"gap", "air_force", "heading", "pressure_margin"} <= set(path.to_xarray().data_vars)


def test_a_bar_turned_by_a_right_angle_with_its_sides_exchanged_goes_the_same_way(path):
    turned = simulate(plate(), body(Footprint.rectangle(1.2e-4, 6e-5), heading=0.3 + np.pi / 2), COULOMB, 3e-3)
    assert turned.position[-1] == pytest.approx(path.position[-1], abs=1e-4 * path.path_length)
    assert turned.heading[-1] - np.pi / 2 == pytest.approx(path.heading[-1], abs=1e-7)


def test_a_mirrored_case_mirrors(path):
    mirrored = simulate(plate(-1.0), body(position=(3e-4, -1e-4), heading=-0.3), COULOMB, 3e-3)
    assert mirrored.position[-1] * (1, -1) == pytest.approx(path.position[-1], abs=1e-4 * path.path_length)
    assert mirrored.heading[-1] == pytest.approx(-path.heading[-1], abs=1e-7)


def test_many_paths_have_the_bits_of_one(path):
    again = simulate_many(plate(), [body(heading=0.3)] * 2, COULOMB, 3e-3, threads=2)
    assert all((other.position == path.position).all() and (other.gap == path.gap).all() for other in again)


@pytest.mark.parametrize("face", [BAR, Footprint.disc(5e-5)], ids=["bar", "disc"])
def test_under_thin_air_in_a_wide_gap_a_path_is_that_in_a_vacuum(face):
    """But for the drag, which a part may have without a film."""
    air = Air(pressure=1e3, bow=3e-6)
    gap = air.bow + float(TABLE_1.mean_gap(3.9))
    start = {"face": face, "heading": 0.3, "velocity": (2e-3, 0.0), "spin": 20.0}
    free = simulate(plate(stroke=8e-6), body(**start, film=None, drag=air.drag(face.area, gap)), COULOMB, 3e-3)
    found = simulate(plate(stroke=8e-6), body(**start, film=air), COULOMB, 3e-3)
    assert np.abs(found.air_force).max() < 3e-4 * np.abs(found.normal_force).max()
    assert found.path_length == pytest.approx(free.path_length, rel=5e-3)
    assert found.position[-1] == pytest.approx(free.position[-1], abs=5e-3 * free.path_length)
    assert found.heading[-1] - 0.3 == pytest.approx(free.heading[-1] - 0.3, rel=5e-3)


@pytest.mark.parametrize("face", [BAR, Footprint.disc(5e-5)], ids=["bar", "disc"])
def test_without_friction_drag_slows_slip_and_spin(face):
    law, air = CoulombAdhesion(0.0, 1.5e-6), Air()
    start = body(face, (0.0, 0.0), velocity=(0.01, 0.0), spin=300.0)
    found = simulate(platform_surface(size=1e-3), start, law, 2e-3)
    drag = air.drag(face.area, float(found.gap[0]))
    assert found.velocity[-1, 0] == pytest.approx(0.01 * np.exp(-drag / MASS * 2e-3), rel=1e-6)
    torque = drag * np.trace(face.second_moments)
    assert found.spin[-1] == pytest.approx(300.0 * np.exp(-torque / start.inertia[2, 2] * 2e-3), rel=1e-6)
    assert found.energy.balance < 1e-6


def test_a_linear_pressure_tips_where_an_edge_would_let_go_and_a_uniform_one_goes_on():
    surface = platform_surface(z=Drive(4e-6, 1e3), x=Drive(40e-6, 1e3, cycle="sine"), size=1e-5)
    tall = body(SQUARE, (0.0, 0.0), centre_height=2e-4)
    tipped = simulate(surface, tall, COULOMB, 3e-3)
    assert tipped.outcome is Outcome.TIPPED
    edge = asperities(tipped)[-1] * tipped.pressure_margin[-1]
    assert edge == pytest.approx(-COULOMB.pull_off, rel=1e-6)
    uniform = simulate(surface, replace(tall, pressure="uniform", density=float("nan")), COULOMB, 3e-3)
    assert uniform.outcome is not Outcome.TIPPED
    assert uniform.time[-1] > tipped.time[-1]


def test_where_air_is_too_thin_to_hold_a_face_it_comes_off():
    surface = platform_surface(z=Drive(60e-6, 1e3), size=1e-5)
    thin = body(position=(0.0, 0.0), film=Air(pressure=100.0, bow=1e-6))
    free, found = (simulate(surface, part, COULOMB, 3e-3) for part in (replace(thin, film=None, density=np.nan), thin))
    assert found.outcome is free.outcome is Outcome.DETACHED
    assert found.time[-1] == pytest.approx(free.time[-1], abs=1e-6)


def test_a_thrown_face_begins_with_the_friction_of_a_vacuum():
    parts = [body(position=(0.0, 0.0), velocity=(0.01, 0.02), spin=100.0, film=film) for film in (None, Air())]
    law = replace(TABLE_1, contact_area=BAR.area)
    free, found = (simulate(platform_surface(size=1e-3), part, law, 1e-5) for part in parts)
    assert found.friction_force[0] == pytest.approx(free.friction_force[0], rel=2e-2)  # drag is in it
    assert found.air_force[0] == pytest.approx(0.0, abs=1e-14)
    assert found.state[0] == State.SLIP


def test_what_does_not_go_with_a_film_is_refused():
    with pytest.raises(ValueError, match="film of Body must be None, or an Air of a positive pressure under a rect"):
        body(Footprint.polygon([(0, 0), (1e-4, 0), (0, 1e-4)]))
    with pytest.raises(ValueError, match="friction of simulate must not be a LocalContact with the film of a Body"):
        simulate(plate(), body(), LocalContact(KogutEtsion.paper(), BAR), 1e-3)
    with pytest.raises(ValueError, match="after_tipping of simulate must be 'stop' with the film of a Body"):
        simulate(plate(), body(), COULOMB, 1e-3, after_tipping="ignore")
    with pytest.raises(ValueError, match="friction of simulate must have a pull-off force on a film of air"):
        simulate(plate(), body(), CoulombAdhesion(0.1), 1e-3)
    with pytest.raises(ValueError, match="size of Film must be a rectangle or a disc"):
        Film(Air(), Footprint.polygon([(0, 0), (1e-4, 0), (0, 1e-4)]))
    surface = driven([Drive(1e-6, 1e3, cycle="sine", cycles=1)], size=1e-6)
    with pytest.raises(ValueError, match="without jumps of velocity under a Film; got one at 0.001 s"):
        simulate(surface, body(position=(0.0, 0.0)), ConstantFriction(1e-8), 2e-3)
