"""A part on the surface of equation (2), moved by one stroke: reference paths on which two integrators agreed.

Radius 300 um, stroke 150 um at the centre, start (100 um, 0) at rest, no gravity, Q/m = 20.9 m/s^2.
"""

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate import Plate
from fem_plate.analytic import DiscShapes
from meshes import disc
from particle import ConstantFriction, Drive, EventKind, Micropart, simulate

MASS = 2e-9
SLIPS, STOPS = EventKind.SLIPS, EventKind.STOPS
CASES = {
    "up and down at 300 Hz": (
        Drive(150e-6, 300, cycles=1),
        -206.94636692e-6,
        [(SLIPS, 0.50145826380e-3), (STOPS, 0.78174933769e-3), (SLIPS, 0.91779096176e-3), (STOPS, 7.3018081602e-3)],
    ),
    "up at 450 Hz": (
        Drive(150e-6, 450, cycle="up"),
        80.912241714e-6,
        [(SLIPS, 1.2991135930e-3), (STOPS, 3.3136873480e-3)],
    ),
}


def path(shapes, drive, tolerance=1e-9, start=(100e-6, 0.0)):
    surface = surface_motion(shapes, [drive])
    return simulate(surface, Micropart(MASS, start), ConstantFriction(20.9 * MASS), 8e-3, 0.0, tolerance)


@pytest.fixture(scope="module")
def central(radius):
    return DiscShapes([[0.0, 0.0]], radius)


@pytest.fixture(scope="module")
def paths(central):
    return {name: path(central, drive) for name, (drive, *_) in CASES.items()}


@pytest.mark.parametrize("name", CASES)
def test_the_end_point_is_the_reference_to_1e_6(paths, name):
    _, end, _ = CASES[name]
    x, y = paths[name].position[-1]
    assert x == pytest.approx(end, rel=2e-8)
    assert abs(y) < 1e-14


@pytest.mark.parametrize("name", CASES)
def test_slips_and_stops_come_at_the_reference_times(paths, name):
    _, _, events = CASES[name]
    found = paths[name].events
    assert [event.kind for event in found] == [kind for kind, _ in events]
    assert [event.time for event in found] == pytest.approx([time for _, time in events], rel=1e-6)


@pytest.mark.parametrize("name", CASES)
def test_a_tight_tolerance_gives_the_times_to_1e_7(central, name):
    drive, end, events = CASES[name]
    found = path(central, drive, tolerance=1e-11)
    assert found.position[-1, 0] == pytest.approx(end, rel=1e-8)
    assert [event.time for event in found.events] == pytest.approx([time for _, time in events], rel=1e-7)


def test_the_direction_of_the_start_does_not_matter(central):
    """The surface is one of revolution, its grid of cells is not."""
    drive, end, _ = CASES["up at 450 Hz"]
    found = path(central, drive, start=(60e-6, -80e-6)).position[-1]
    assert found == pytest.approx(np.array([0.6, -0.8]) * end, rel=1e-7)


@pytest.mark.parametrize("name", CASES)
def test_finite_elements_give_the_same_path(section, radius, paths, name):
    drive, end, _ = CASES[name]
    shapes = Plate(disc(radius, radius / 8), section).influence([[0.0, 0.0]])
    gap = path(shapes, drive).position[-1] - paths[name].position[-1]
    assert np.hypot(*gap) < 1e-7 * abs(end - 100e-6)
