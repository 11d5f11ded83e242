"""Parts with a face against a free rigid body on stiff springs, point by point."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from spring_body import CASES, frame
from spring_body import Body as SpringBody

from coupling import read_case
from coupling.part import build_friction, build_part
from coupling.run import build_scene, simulate_run
from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import Body, CoulombAdhesion, Drive, Footprint, polynomial_surface, simulate

pytestmark = [pytest.mark.slow, pytest.mark.compiled]
EXAMPLES = Path(__file__).parents[2] / "examples"
RIM = Footprint.polygon(frame(5e-5, 5e-6))


def test_a_long_part_slides_and_turns_on_a_saddle_as_on_springs():
    """Friction that leans with each point's own normal, not with the face's, is the difference."""
    case, springs = CASES["C"], SpringBody("C", om=1e5, eps=1e-7)
    there = springs.run()
    end = springs.coords(there.y[:, -1], there.t[-1])
    x, y, heading = case["start"]
    part = Body(
        Footprint.rectangle(*case["face"]),
        case["thickness"],
        density=case["density"],
        position=(x, y),
        heading=heading,
        velocity=tuple(case["rate"][:2]),
        spin=case["rate"][2],
    )
    shape = case["surface"]
    saddle = polynomial_surface([[0, 0, shape["qy"]], [0, 0, 0], [shape["qx"], 0, 0]], size=1e-3)
    path = simulate(replace(saddle, half_thickness=case["zk"]), part, CoulombAdhesion(case["mu"]), case["end"])
    assert np.hypot(*(path.position[-1] - end[:2])) < 4e-4 * path.path_length
    assert abs(path.heading[-1] - end[2]) < 2e-3 * abs(end[2] - heading)


def test_a_part_on_a_plate_turns_less_on_its_rim_as_on_springs():
    """Two actuators carry a square; the springs slip point by point, which takes a seventh of the turn."""
    case = CASES["A20"]
    drives = [Drive(2e-5, 120.0, cycle="cosine", phase=phase) for phase in (0.0, math.pi / 2)]
    plate = surface_motion(DiscShapes(np.array(case["surface"]["sources"]), 1e-3), drives)
    square = Body(
        Footprint.rectangle(*case["face"]),
        case["thickness"],
        density=case["density"],
        position=tuple(case["start"][:2]),
        heading=case["start"][2],
    )
    ways, turns = [], []
    for face, rim in ((square.footprint, None), (RIM, 4.75e-5)):
        springs = SpringBody("A20", om=1e5, eps=1e-7, rim=rim)
        there = springs.run()
        end = springs.coords(there.y[:, -1], there.t[-1])
        part = replace(square, footprint=face, density=math.nan)
        path = simulate(replace(plate, half_thickness=case["zk"]), part, CoulombAdhesion(case["mu"]), case["end"])
        ways.append((path.distance, np.hypot(*(end[:2] - case["start"][:2]))))
        turns.append((path.heading[-1] - path.heading[0], end[2] - case["start"][2]))
    assert np.array(ways) * 1e6 == pytest.approx(np.array([(8.349, 8.384), (8.277, 8.320)]), abs=2e-3)
    assert np.degrees(turns) == pytest.approx(np.array([(-0.2425, -0.2089), (-0.1640, -0.1405)]), rel=5e-3)
    (face, springs), (rim, springs_rim) = turns
    assert rim / face == pytest.approx(springs_rim / springs, rel=0.02)


def test_the_part_of_the_example_turns_as_its_pressure_lies():
    case = read_case(EXAMPLES / "face.toml")
    surface, friction, part = build_scene(case).surface, build_friction(case), build_part(case)
    for face, pressure, way, turn in (
        (part.footprint, "uniform", 29.487, -0.228),
        (part.footprint, "linear", 29.470, -0.1214),
        (RIM, "linear", 29.138, -0.2103),  # with averages over the face to more degrees
    ):
        body = replace(part, footprint=face, density=math.nan, pressure=pressure)
        path = simulate_run(surface, body, friction, case.run)
        assert 1e6 * path.distance == pytest.approx(way, abs=1e-3)
        assert math.degrees(path.heading[-1] - path.heading[0]) == pytest.approx(turn, rel=5e-3)
