"""A path turned or mirrored with plate, actuators and part is the same path, to the integrator's tolerance."""

import numpy as np
import pytest

from coupling.surface.motion import surface_motion
from fem_plate.analytic import DiscShapes
from particle import ConstantFriction, Drive, KogutEtsion, Micropart, simulate

MASS = 2e-9
DRIVES = [Drive(150e-6, 300), Drive(90e-6, 450, delay=0.4e-3)]
START = np.array([0.0, 100e-6])
TURN = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
MAPS = {
    "turned by 0.7": TURN,
    "mirrored": np.diag([1.0, -1.0]),
    "mirrored and turned": TURN @ np.diag([-1.0, 1.0]),
}


@pytest.fixture(scope="module")
def surfaces(layout, radius):
    """The surface of the layout as it is and after each map."""
    maps = {"plain": np.eye(2)} | MAPS
    return {name: surface_motion(DiscShapes(layout @ m.T, radius), DRIVES, 1e-10) for name, m in maps.items()}


def path(surface, start, friction):
    return simulate(surface, Micropart(MASS, tuple(start)), friction, 4e-3, tolerance=1e-11)


@pytest.mark.parametrize(
    "name, friction",
    [
        ("turned by 0.7", ConstantFriction(20.9 * MASS)),
        ("mirrored", KogutEtsion.paper()),
        ("mirrored and turned", ConstantFriction(20.9 * MASS)),
    ],
)
def test_the_path_moves_with_its_plate(surfaces, radius, name, friction):
    plain, moved = path(surfaces["plain"], START, friction), path(surfaces[name], MAPS[name] @ START, friction)
    assert plain.distance > 20e-6
    assert np.abs(moved.position[-1] - MAPS[name] @ plain.position[-1]).max() < 2e-9 * radius
    assert [event.kind for event in moved.events] == [event.kind for event in plain.events]
    assert [e.time for e in moved.events] == pytest.approx([e.time for e in plain.events], abs=1e-6 * 4e-3)


def test_the_order_of_the_actuators_does_not_matter(surfaces, layout, radius):
    friction = ConstantFriction(20.9 * MASS)
    plain = path(surfaces["plain"], START, friction)
    swapped = path(surface_motion(DiscShapes(layout[::-1].copy(), radius), DRIVES[::-1], 1e-10), START, friction)
    assert np.abs(swapped.position[-1] - plain.position[-1]).max() < 2e-9 * radius
