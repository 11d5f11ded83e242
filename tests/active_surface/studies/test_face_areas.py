"""Feasible areas of a part with a face: against drives that really run faster, the point, and runs beside borders."""

import numpy as np
import pytest

from active_surface.studies.feasibility.area import find_feasible
from active_surface.studies.feasibility.case import _areas
from active_surface.studies.feasibility.ground import make_ground
from active_surface.studies.feasibility.places import responses_of, squares_within
from coupling import borders, surface_motion
from coupling.case import ActuatorCase, Case, CoulombCase, PartCase, RunCase
from fem_plate.analytic import DiscShapes
from particle import (
    Body,
    ConstantFriction,
    CoulombAdhesion,
    Drive,
    Footprint,
    Micropart,
    part_at_rest,
    platform_surface,
    polynomial_surface,
    simulate,
)

MASS, RADIUS, FREQUENCY = 2e-9, 300e-6, 400.0
SHAPES = DiscShapes([[40e-6, 20e-6]], RADIUS)
LAW = CoulombAdhesion(0.05, 2e-7, 0.06)
PERIOD = 1 / FREQUENCY
ACROSS = 20


def plate(stroke=40e-6):
    return surface_motion(SHAPES, [Drive(stroke, FREQUENCY)])


def bar(**fields):
    own = {"footprint": Footprint.rectangle(90e-6, 60e-6), "thickness": 10e-6, "position": (0.0, 0.0), "heading": 0.5}
    return Body(mass=MASS, **own | fields)


def shaken():
    """A saddle that heaves, on a base that sways and turns, in metres and seconds."""
    c = np.zeros((3, 3, 3))
    c[2, 0], c[0, 2], c[1, 1] = (0.02, 0.3, 0.4), (-0.01, 0.2, -0.5), (0.0, 0.1, 0.6)
    c[0, 0, 2] = 1.0
    return polynomial_surface(c, (Drive(0.05, 1.0, "sine"), Drive(0.02, 2.0, "sine"), Drive(0.1, 1.5, "sine")))


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_responses_are_those_of_drives_that_really_run_faster(factor):
    body = Body(Footprint.rectangle(0.2, 0.1), 0.03, 2.0, position=(0.0, 0.0), heading=0.4, squeeze=1.0)
    rest = part_at_rest(shaken(), body, LAW, 1.0, (0.3, 0.2, -9.8))
    places, times = np.array([(0.1, -0.2), (0.3, 0.05)]), np.array([0.1, 0.35])
    slow, fast = rest.responses(places, times), rest.scaled(factor).responses(places, times / factor)
    constant, growing = np.r_[0:6:2, 6:9], np.r_[1:6:2, 9:12]
    mine = slow[..., constant] + factor**2 * slow[..., growing]
    its = fast[..., constant] + fast[..., growing]
    assert np.abs(mine - its).max() < 1e-11 * np.abs(its).max()
    assert (np.abs(slow[..., growing]).max(axis=(0, 1)) > 1e-4).all()


def test_a_small_face_bears_what_a_point_does():
    """The difference falls as size squared; of a point there are three components of m p, in axes of the plate."""
    surface, places = plate(), np.array([(90e-6, -40e-6), (-150e-6, 30e-6)])
    times = np.array([0.2, 0.7]) * PERIOD
    dot = Micropart(MASS, (0.0, 0.0), squeeze=1e-8)
    point = np.array(list(responses_of(part_at_rest(surface, dot, LAW, PERIOD), places, times)()))
    off = []
    for size in (2e-6, 1e-6):
        small = bar(footprint=Footprint.rectangle(size, size), thickness=size, centre_height=0.0, squeeze=1e-8)
        face = np.array(list(responses_of(part_at_rest(surface, small, LAW, PERIOD), places, times)()))
        forces = np.linalg.norm(face[..., 6:8] + face[..., 9:11], axis=-1)
        pulls = MASS * np.linalg.norm(point[..., 2:5] + point[..., 5:8], axis=-1)
        loads = face[..., 0] + face[..., 1] - point[..., 0] - point[..., 1]
        off.append(max(np.abs(forces / pulls - 1).max(), np.abs(loads).max() / (MASS * 9.8)))
    assert off[1] < 1e-4 and off[0] / off[1] == pytest.approx(4, rel=0.02)


@pytest.mark.compiled
def test_areas_of_a_small_face_are_those_of_a_point():
    surface, factors = plate(), np.array([1.0, 2.0])

    def find(part):
        return find_feasible(surface, SHAPES.outline, part, LAW, PERIOD, factors, across=12)

    point = find(Micropart(MASS, (0.0, 0.0)))
    small = find(bar(footprint=Footprint.disc(1e-6), thickness=1e-6, centre_height=0.0))
    large = find(bar())
    assert len(small.points) == len(point.points) > len(large.points)
    for name in ("feasible", "slipping"):
        its, mine, other = (getattr(found, name) for found in (point, small, large))
        assert mine.integral == pytest.approx(its.integral, rel=0.03) and (its.integral > 0).all()
        assert (np.abs(other.integral / its.integral - 1) > 0.1).all()


def ring(holds, neighbours):
    """Squares (n,) on whose side of a border something holds, one off the border."""
    whole = holds & holds[neighbours].all(axis=1)
    return np.flatnonzero(whole & ~whole[neighbours].all(axis=1))[::3].tolist()


@pytest.mark.compiled
@pytest.mark.parametrize(
    "fields",
    [
        {"pressure": "uniform"},
        pytest.param({}, marks=pytest.mark.slow),
        pytest.param({"footprint": Footprint.disc(35e-6)}, marks=pytest.mark.slow),
        pytest.param({"footprint": Footprint.polygon([(0, 0), (80e-6, 0), (0, 60e-6)])}, marks=pytest.mark.slow),
    ],
    ids=["uniform", "linear", "disc", "triangle"],
)
def test_runs_beside_the_borders_slip_and_are_lost_as_areas_say(fields):
    surface, part = plate(), bar(**fields)
    found = find_feasible(surface, SHAPES.outline, part, LAW, PERIOD, np.ones(1), across=ACROSS)
    squares = squares_within(SHAPES.outline, ACROSS, part_at_rest(surface, part, LAW, PERIOD))
    slips, lost = found.own.shares > 0, found.own.lost
    states = {"rest": ~slips & ~lost, "moves": slips & ~lost, "lost": lost}
    for name, holds in states.items():
        starts = ring(holds, squares.neighbours)
        assert len(starts) > 1
        paths = [simulate(surface, bar(position=tuple(found.points[n]), **fields), LAW, PERIOD) for n in starts]
        its = ["lost" if p.outcome in borders.LOST else "moves" if p.path_length > 0 else "rest" for p in paths]
        assert its == [name] * len(starts)


@pytest.mark.compiled
@pytest.mark.parametrize("share", [0.98, 1.02])
def test_a_table_that_turns_makes_a_square_slip_by_torque_alone(share):
    """In its middle a level square bears up to .382597858 Q a: it slips if it needs more."""
    side, turn = 300e-6, Drive(1e-3, FREQUENCY, "sine")
    largest = np.abs(turn.evaluate(np.linspace(0.0, PERIOD, 4001))[2]).max()
    limit = MASS * side**2 / 6 * largest / (0.382597858 * side) / share
    square = bar(footprint=Footprint.rectangle(side, side))
    table = platform_surface(turn=turn, size=1e-3)
    found = find_feasible(table, SHAPES.outline, square, ConstantFriction(limit), PERIOD, np.ones(1), across=31)
    middle = np.hypot(*found.points.T).argmin()
    assert (found.own.shares[middle] > 0) == (share > 1)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_factor_is_a_drive_that_runs_so_much_faster():
    found, fast = (
        find_feasible(plate().scaled(speed), SHAPES.outline, bar(), LAW, PERIOD / speed, np.array([factor]), across=30)
        for speed, factor in ((1.0, 1.5), (1.5, 1.0))
    )
    assert found.lost_area[0] > 0 and found.lost_area == pytest.approx(fast.lost_area, rel=0.01)
    for name in ("feasible", "slipping"):
        integral = getattr(found, name).integral
        assert integral[0] > 0 and integral == pytest.approx(getattr(fast, name).integral, rel=0.01)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_case_has_the_areas_of_its_face():
    """It is lost on less of the plate where tipping is ignored."""
    lost = []
    for after in ("stop", "ignore"):
        case = Case(
            plate={"shape": "disc", "radius": RADIUS, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6},
            actuators=[ActuatorCase(position=(40e-6, 20e-6), stroke=40e-6, frequency=FREQUENCY)],
            part=PartCase(
                mass=MASS, position=(0.0, 0.0), heading=0.5, footprint="rectangle", sides=(90e-6, 60e-6), thickness=4e-5
            ),
            friction=CoulombCase(coefficient=0.05, adhesion=2e-7, static_coefficient=0.06),
            run=RunCase(duration=PERIOD, after_tipping=after),
            name="bar",
        )  # fmt: skip
        ground = make_ground(case, (1.0, 1.0), (1.0, 1.0), PERIOD, PERIOD)
        lost.append(_areas(ground, PERIOD, PERIOD / 2, np.ones(1), 16).own.lost_area)
    assert lost[0] > 1.1 * lost[1] > 0


def test_a_face_that_has_no_room_is_refused():
    large = bar(footprint=Footprint.disc(290e-6))
    with pytest.raises(ValueError, match="^Input across must let the part lie .* got 10$"):
        find_feasible(plate(), SHAPES.outline, large, LAW, PERIOD, np.ones(1), across=10)
