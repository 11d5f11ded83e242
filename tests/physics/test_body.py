"""Parts with a face against references of a second formulation, closed forms, and the point that they shrink to.

The references follow a body whose averages over the face are exact; ends are good to 1e-10 m and 1e-6 rad.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from spring_body import frame

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import (
    Body,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    EventKind,
    Footprint,
    Micropart,
    Outcome,
    platform_surface,
    polynomial_surface,
    simulate,
    simulate_many,
)
from particle.body import new_body_memory
from particle.body.averages import TT, enter_all, fill_averages
from particle.jit import jit

pytestmark = pytest.mark.compiled
SQUARE, DISC = Footprint.rectangle(1e-4, 1e-4), Footprint.disc(5e-5)
ELL = Footprint.polygon([[0, 0], [1e-4, 0], [1e-4, 3.5e-5], [3.5e-5, 3.5e-5], [3.5e-5, 1e-4], [0, 1e-4]])
FLAT = polynomial_surface([[0.0]], size=1e-3)
BOWL = replace(polynomial_surface([[0, 0, 100.0], [0, 0, 0], [100.0, 0, 0]], size=1e-3), half_thickness=1e-5)
HALF = {"thickness": 5e-5, "density": 2330.0}


@pytest.fixture(scope="module")
def plate():
    """A clamped disc of radius 1 mm on two actuators, 20 um up and down a quarter of a cycle apart."""
    drives = [Drive(2e-5, 120, cycle="cosine"), Drive(2e-5, 120, cycle="cosine", phase=math.pi / 2)]
    return replace(surface_motion(DiscShapes(np.array([[-3e-4, 0], [3e-4, 0]]), 1e-3), drives), half_thickness=1e-5)


@pytest.fixture(scope="module")
def turntable():
    """A level base that sways along x and turns about its origin."""
    sway = Drive(2e-5, 100.0, cycle="sine")
    return platform_surface(x=sway, turn=Drive(0.1, 70.0, cycle="sine", phase=0.5), size=1e-3)


def moving(footprint, velocity, spin, **more):
    return Body(footprint, **HALF, velocity=velocity, spin=spin, **{"position": (0, 0), **more})


def resting_on(part, footprint, pressure="uniform"):
    """A part with another face and law of pressure, of the same mass and inertia."""
    return replace(part, footprint=footprint, density=math.nan, pressure=pressure)


# Surface, part, coefficient of friction, duration; then the end's place and heading, events and work dissipated.
REFERENCES = {
    "square": (
        "flat",
        moving(SQUARE, (0.05, 0), 500.0, centre_height=0.0, pressure="uniform"),
        (0.1, 0.1),
        ((0.0013855335206993888, 2.0327096882060908e-08), 17.608532062536963),
        ([(EventKind.STOPS, 0.05868575274706149)], 1.6989583333333363e-12),
    ),
    "L": (
        "flat",
        moving(ELL, (0.03, 0.01), -400.0),
        (0.1, 0.1),
        ((0.0005464006233991799, 0.00019210886355688951), -8.948789853971657),
        ([(EventKind.STOPS, 0.03862937693676755)], 4.2223562765151435e-13),
    ),
    "disc": (
        "flat",
        moving(DISC, (0.05, 0), 500.0, centre_height=0.0),
        (0.1, 0.1),
        ((0.0013571307926539759, 0.0), 17.496183513237053),
        ([(EventKind.STOPS, 0.05719003357176492)], 1.2867030848784765e-12),
    ),
    "bowl": (
        "bowl",
        moving(SQUARE, (0.005, 0.02), 100.0, position=(2e-4, 0.0), heading=0.2),
        (0.1, 0.1),
        ((0.000211869227672, 0.00017680391455), 1.4533925596579),
        ([(EventKind.STOPS, 0.0198436360457689)], 2.12827613567e-13),
    ),
    "plate": (
        "plate",
        moving(SQUARE, (0, 0), 0.0, position=(1e-4, 2e-4), heading=0.3),
        (0.02, 0.02),
        ((9.79442334559e-05, 0.000208091852299), 0.295767424156),
        ([(EventKind.SLIPS, 0.0)], 2.90304732352e-15),
    ),
    "turntable": (
        "turntable",
        moving(SQUARE, (0, 0), 0.0, position=(2e-4, 1e-4)),
        (0.3, 0.02),
        ((0.000223602439788, 0.000102416483321), 0.0594570641946),
        ([(EventKind.SLIPS, 0.0004955591440082912)], 5.91906889008e-13),
    ),
}


@pytest.mark.parametrize("name", REFERENCES)
def test_paths_of_a_second_formulation(name, request):
    surface, part, (coefficient, duration), (place, heading), (events, dissipated) = REFERENCES[name]
    ours = {"flat": FLAT, "bowl": BOWL}.get(surface) or request.getfixturevalue(surface)
    path = simulate(ours, part, CoulombAdhesion(coefficient), duration)
    assert np.hypot(*(path.position[-1] - place)) < 1e-9
    assert abs(path.heading[-1] - heading) < 1e-5
    assert [event.kind for event in path.events] == [kind for kind, _ in events]
    assert [event.time for event in path.events] == pytest.approx([time for _, time in events], abs=1e-7)
    assert path.energy.dissipated[-1] == pytest.approx(dissipated, rel=1e-6)
    assert path.energy.balance < 1e-9


def test_a_disc_stops_sliding_and_turning_at_once_in_the_same_ratio():
    """v/(R omega) tends to .6530017892056 under uniform pressure, whatever it began with (Farkas and others, 2003)."""
    for velocity, spin in ((0.05, 500.0), (0.01, 900.0)):
        part = moving(DISC, (velocity, 0), spin, centre_height=0.0)
        path = simulate(FLAT, part, CoulombAdhesion(0.1), 0.2, tolerance=1e-11)
        moves = path.spin != 0
        off = np.abs(np.hypot(*path.velocity[moves].T) / (5e-5 * path.spin[moves]) - 0.6530017892056)[-6:]
        assert off[-1] < 3e-4 and (np.diff(off) < 0).all()


def test_a_square_on_its_rim_spins_down_as_the_mean_distance_from_its_centre_asks():
    """Over a square of side a that mean is (sqrt(2) + asinh(1)) a/6, over a frame a difference of two of these."""
    square = moving(SQUARE, (0, 0), 500.0, centre_height=0.0, pressure="uniform")
    stops = 500**2 * square.inertia[2, 2] / (0.2 * square.mass * 9.80665)  # rad m, the turn times that mean
    for wall in (5e-5, 1e-5, 5e-6):
        outer, inner = 1e-4, 1e-4 - 2 * wall
        mean = (math.sqrt(2) + math.asinh(1)) / 6 * (outer**3 - inner**3) / (outer**2 - inner**2)
        face = SQUARE if wall == 5e-5 else Footprint.polygon(frame(5e-5, wall))
        path = simulate(FLAT, resting_on(square, face), CoulombAdhesion(0.1), 0.1)
        assert path.heading[-1] == pytest.approx(stops / mean, rel=1e-5)


def test_how_far_a_part_turns_depends_on_where_it_presses(plate):
    """The figures of docs/face.md; tests/validation/test_body_springs.py compares with bodies on springs."""
    rim = Footprint.polygon(frame(5e-5, 5e-6))
    thrown, carried = moving(SQUARE, (0.05, 0), 500.0), moving(SQUARE, (0, 0), 0.0, position=(1e-4, 2e-4), heading=0.3)
    cases = (
        (FLAT, thrown, 0.1, 0.1, ((1385.53, 1008.89), (1386.01, 1011.04), (1383.51, 784.10))),
        (plate, carried, 0.02, 0.02, ((8.348, -0.0478), (8.349, -0.2425), (8.277, -0.1640))),
        (plate, carried, 0.02, 0.1, ((44.896, -0.157), (44.897, -1.431), (44.494, -0.886))),
    )
    for surface, part, coefficient, duration, stated in cases:
        for face, pressure, wanted in zip((SQUARE, SQUARE, rim), ("uniform", "linear", "linear"), stated, strict=True):
            path = simulate(surface, resting_on(part, face, pressure), CoulombAdhesion(coefficient), duration)
            assert (1e6 * path.distance, math.degrees(path.heading[-1] - path.heading[0])) == pytest.approx(
                wanted, rel=5e-3
            )


def test_a_shrinking_face_moves_as_a_point_by_its_size_squared(plate):
    law, start = CoulombAdhesion(0.02), {"position": (1e-4, 2e-4)}
    point = simulate(plate, Micropart(1e-9, **start), law, 0.02, tolerance=1e-11)
    off = []
    for size in (2e-5, 1e-5, 5e-6):
        part = Body(
            Footprint.rectangle(size, size), size, 1e-9, **start, heading=0.3, centre_height=0.0, pressure="uniform"
        )
        off.append(np.hypot(*(simulate(plate, part, law, 0.02, tolerance=1e-11).position[-1] - point.position[-1])))
    assert off[0] / off[1] == pytest.approx(4, rel=0.02)
    assert off[1] / off[2] == pytest.approx(4, rel=0.02)
    assert off[-1] < 1e-4 * point.path_length


def test_a_mirrored_case_has_the_mirrored_path(turntable):
    mirrored = platform_surface(
        x=Drive(2e-5, 100.0, cycle="sine"), turn=Drive(-0.1, 70.0, cycle="sine", phase=0.5), size=1e-3
    )
    corners = ELL.corners * [1, -1]
    law, more = CoulombAdhesion(0.3), HALF | {"centre_height": 1e-5}
    path = simulate(turntable, Body(ELL, **more, position=(2e-4, 1e-4), heading=0.4), law, 0.01)
    image = simulate(
        mirrored, Body(Footprint.polygon(corners), **more, position=(2e-4, -1e-4), heading=-0.4), law, 0.01
    )
    assert np.abs(path.heading).max() > 0.4
    assert image.position[-1] == pytest.approx(path.position[-1] * [1, -1], abs=1e-12)
    assert image.heading[-1] == pytest.approx(-path.heading[-1], abs=1e-8)


def test_the_ledger_closes_for_each_face_on_a_moving_plate(plate):
    long = Footprint.rectangle(2e-4, 5e-5)
    parts = [moving(shape, (0.004, -0.002), 60.0, position=(1e-4, 2e-4)) for shape in (long, DISC, ELL)]
    for path in simulate_many(plate, parts, CoulombAdhesion(0.05), 0.005):
        assert path.energy.balance < 1e-9
        assert path.energy.dissipated[-1] > 0


def test_tolerances_agree(plate):
    part, law = moving(ELL, (0.0, 0.0), 0.0, position=(1e-4, 2e-4)), CoulombAdhesion(0.05, 2e-9)
    loose, tight = (simulate(plate, part, law, 0.02, tolerance=tolerance) for tolerance in (1e-9, 1e-11))
    assert len(tight.events) == len(loose.events)
    assert np.hypot(*(loose.position[-1] - tight.position[-1])) < 1e-9
    assert abs(loose.heading[-1] - tight.heading[-1]) < 1e-6


def test_many_paths_have_the_bits_of_single_ones(plate):
    parts = [moving(SQUARE, (0, 0), 0.0, position=(1e-4, 2e-4), heading=angle) for angle in (0.0, 0.3, 0.6)]
    law = CoulombAdhesion(0.02)
    for threads in (1, 2):
        for part, path in zip(parts, simulate_many(plate, parts, law, 0.004, threads=threads), strict=True):
            single = simulate(plate, part, law, 0.004)
            assert np.array_equal(path.position, single.position) and np.array_equal(path.heading, single.heading)


def test_samples_lie_on_the_path(plate):
    path = simulate(plate, moving(SQUARE, (0, 0), 0.0, position=(1e-4, 2e-4)), CoulombAdhesion(0.02), 0.01)
    middle = 0.5 * (path.time[20] + path.time[21])
    samples = path.at([path.time[20], middle, path.time[21]])
    assert samples.heading[[0, 2]] == pytest.approx(path.heading[20:22], abs=1e-12)
    assert samples.position[1] == pytest.approx(samples.position[[0, 2]].mean(axis=0), abs=1e-9)
    table = path.to_dataframe()
    assert table["heading"].to_numpy() == pytest.approx(path.heading[np.append(np.diff(path.time) > 0, True)])
    assert path.to_xarray()["spin"].attrs["units"] == "rad/s"


def test_without_friction_a_part_keeps_its_spin():
    path = simulate(FLAT, moving(ELL, (0.01, 0.02), 300.0), ConstantFriction(0.0), 0.01)
    assert path.spin == pytest.approx(np.full(len(path.time), 300.0))
    assert path.position[-1] == pytest.approx((1e-4, 2e-4))


def test_a_part_whose_friction_lifts_an_edge_tips():
    """A sliding square keeps 1 - 6 mu h/a of its mean pressure at its rear edge, h the height of its centre."""
    part = moving(SQUARE, (0.01, 0), 0.0, centre_height=4e-5)
    path = simulate(FLAT, part, CoulombAdhesion(0.3), 0.01)
    assert path.pressure_margin[1] == pytest.approx(1 - 6 * 0.3 * 0.4)
    high = moving(SQUARE, (0.01, 0), 0.0, centre_height=6e-5)
    tipped = simulate(FLAT, high, CoulombAdhesion(0.3), 0.01)
    assert tipped.outcome is Outcome.TIPPED and tipped.events[-1].kind is EventKind.TIPS
    assert simulate(FLAT, high, CoulombAdhesion(0.3), 0.01, after_tipping="ignore").outcome is Outcome.STUCK


def test_a_part_leaves_the_plate_with_its_first_corner(plate):
    path = simulate(plate, moving(SQUARE, (0.5, 0), 0.0, position=(8e-4, 0)), CoulombAdhesion(0.02), 0.01)
    assert path.outcome is Outcome.LEFT_PLATE
    corner = path.position[-1] + [5e-5, 5e-5]
    assert np.hypot(*corner) == pytest.approx(1e-3, rel=1e-3)


def test_a_part_comes_off_when_a_point_does():
    lift = platform_surface(z=Drive(5e-5, 200.0), size=1e-3)
    law = CoulombAdhesion(0.2, 1e-9)
    body, point = moving(SQUARE, (0, 0), 0.0), Micropart(1.165e-9, (0, 0))
    ends = [simulate(lift, part, law, 0.02) for part in (body, point)]
    assert [end.outcome for end in ends] == [Outcome.DETACHED] * 2
    assert ends[0].time[-1] == pytest.approx(ends[1].time[-1], rel=1e-12)


@pytest.mark.parametrize(
    "wrong, message",
    [
        (
            {"mass": 1e-9},
            "mass of Body must be given, or its density in its place, but not both; got 'mass and density'",
        ),
        ({"heading": math.nan}, "heading of Body must be a finite number, in rad"),
        ({"pressure": "even"}, "pressure of Body must be 'linear' or 'uniform'"),
        ({"inertia": (1.0, -1.0, 1.0)}, "inertia of Body must be three positive moments"),
        ({"footprint": 3}, "footprint of Body must be a Footprint"),
    ],
)
def test_a_wrong_field_is_named(wrong, message):
    with pytest.raises(ValueError, match=message):
        Body(**{"footprint": SQUARE, **HALF, "position": (0, 0), **wrong})


def test_what_a_face_does_not_go_with_is_refused(turntable):
    part, law = moving(SQUARE, (0, 0), 0.0), CoulombAdhesion(0.1)
    with pytest.raises(ValueError, match="scheme of simulate must be 'events' with a Body"):
        simulate(FLAT, part, law, 0.01, scheme="fixed")
    with pytest.raises(ValueError, match="after_detachment of simulate must be 'stop' with a Body"):
        simulate(FLAT, part, law, 0.01, after_detachment="fly")
    with pytest.raises(ValueError, match="must be a Body on a base that turns"):
        simulate(turntable, Micropart(1e-9, (0, 0)), law, 0.01)
    jumping = platform_surface(x=Drive(1e-5, 100.0, cycle="sine", delay=1e-3), size=1e-3)
    with pytest.raises(ValueError, match="without jumps of velocity under a Body; got one at 0.001 s"):
        simulate(jumping, part, law, 0.01)


def test_the_contact_of_a_small_face_is_that_of_a_point(plate):
    law, start = CoulombAdhesion(0.02), {"position": (1e-4, 2e-4)}
    small = Footprint.rectangle(2e-6, 2e-6)
    face = Body(small, 2e-6, 1e-9, **start, heading=0.3, centre_height=0.0, pressure="uniform")
    paths = [simulate(plate, part, law, 0.02) for part in (face, Micropart(1e-9, **start))]
    stuck = 0.5 * paths[1].time[np.flatnonzero(paths[1].state == 0)[:1]]
    times = np.append(np.linspace(1e-3, 2e-2, 20), stuck)
    ours, theirs = (path.contact_at(times) for path in paths)
    for name, near in (("contact", 1e-10), ("centre", 1e-10), ("normal", 1e-6), ("friction", 1e-12)):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), abs=near)
    assert ours.point_pull == pytest.approx(theirs.pull, rel=1e-3)


def test_friction_on_a_turning_table_is_against_the_slip(turntable):
    path = simulate(turntable, moving(SQUARE, (0.02, 0), 0.0, position=(2e-4, 1e-4)), CoulombAdhesion(0.3), 1e-3)
    samples = path.contact_at([0.0])
    assert samples.normal[0] == pytest.approx([0, 0, 1], abs=1e-12)
    assert samples.friction[0, 0] < 0 and np.hypot(*samples.friction[0, :2]) == pytest.approx(path.friction_force[0])
    assert samples.centre[0, 2] - samples.contact[0, 2] == pytest.approx(2.5e-5)


def test_a_disc_slides_on_a_platform_that_moves_by_less_than_its_radius():
    still = platform_surface(x=Drive(0.0, 100.0), size=2e-5)
    disc = Body(Footprint.disc(5e-5), 2e-5, 1e-9, position=(0.0, 0.0), velocity=(0.02, 0.0))
    path = simulate(still, disc, CoulombAdhesion(0.1), 0.05)
    assert path.distance == pytest.approx(0.02**2 / (2 * 0.1 * 9.80665), rel=1e-9)


@jit
def looked_at(surface, face, memory, out):
    """Averages under a face: made, asked for again, in the next span, at another heading, back; whether made anew."""
    local, under, averages, anew = memory.local, memory.under, memory.balance[0].averages, np.zeros(5)
    enter_all(surface, local, under, face, 0.0, 0.0, 0.3, 0.999e-3, 2.0, (0.0, 0.0))
    for k in range(5):
        if k == 2:
            enter_all(surface, local, under, face, 0.0, 0.0, 0.3, 1e-3, 2.0, (0.0, 0.0))
        anew[k] = fill_averages(local, under, 0.0, 0.0, 0.31 if k == 3 else 0.3, 1e-3, averages)
        out[k] = averages
    return anew


def test_a_place_is_not_looked_at_twice_in_one_span():
    until = Drive(1e-5, 1e3, "cosine", cycles=1)  # it ends with a jump of its acceleration
    surface = surface_motion(DiscShapes(np.array([[1e-4, 0.0]]), 1e-3), [until], 1e-9)
    surface.store.build(np.zeros((1, 2)))
    face = Body(SQUARE, position=(0.0, 0.0), **HALF).face(3, True)
    memory, out = new_body_memory(surface.record, face, np.zeros(1, dtype=np.int64)), np.zeros((5, 15, 9))
    assert looked_at(surface.record, face, memory, out).tolist() == [1, 0, 1, 1, 1]
    np.testing.assert_array_equal(out[1], out[0])
    np.testing.assert_array_equal(out[4], out[2])
    assert out[0][TT, 2] > 100.0 > 1e-6 > abs(out[2][TT, 2])
    assert not np.array_equal(out[3], out[2])
