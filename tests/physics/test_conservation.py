"""Energy and rest: what must not change at all, or only by rounding."""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid

from coupling.surface.motion import surface_motion
from particle import ConstantFriction, CoulombAdhesion, Drive, Micropart, polynomial_surface, simulate

G, MASS = 9.80665, 2e-9
BOWL = [[0.0, 0.05, 0.9], [0.0, 0.2, 0.0], [0.6, 0.0, 0.0]]  # tilted and oval


@pytest.mark.parametrize("tolerance, bound", [(1e-6, 3e-5), (1e-9, 3e-8), (1e-12, 1e-10)])
def test_a_bowl_without_friction_keeps_the_energy(tolerance, bound):
    part = Micropart(1.0, (0.5, -0.2), (0.3, 0.8))
    surface = polynomial_surface(BOWL)
    trajectory = simulate(surface, part, ConstantFriction(0.0), 5.0, tolerance=tolerance)
    energy = []
    for xy, v in zip(trajectory.position, trajectory.velocity, strict=True):
        state = surface.evaluate(xy, 0.0)
        energy.append(G * state.w[0] + 0.5 * (v @ v + (v @ state.gradient[0]) ** 2))
    assert len(energy) > 20
    assert np.ptp(energy) < bound * energy[0]


@pytest.mark.compiled
def test_friction_takes_the_work_of_its_way():
    """Constant friction on a bowl at rest: energy lost = Q times the way along the surface."""
    surface, q = polynomial_surface(BOWL), 0.5
    trajectory = simulate(surface, Micropart(1.0, (0.5, -0.2), (0.3, 0.8)), ConstantFriction(q), 1.0, tolerance=1e-11)
    times = np.linspace(0, 1.0, 4_001)

    def height_and_speed(position, velocity):
        state = surface.evaluate(position, 0.0)
        climb = np.einsum("ni,ni->n", velocity, state.gradient)
        return state.w, np.sqrt((velocity**2).sum(axis=1) + climb**2)

    w, u = height_and_speed(trajectory.position, trajectory.velocity)
    # Cubics between the rows are good to about 1e-6 here.
    way = trapezoid(height_and_speed(*trajectory.at(times)[1:3])[1], times)
    lost = G * (w[0] - w[-1]) + 0.5 * (u[0] ** 2 - u[-1] ** 2)
    assert lost == pytest.approx(q * way, rel=1e-4)


def test_a_part_at_rest_on_a_plate_at_rest_stays(exact):
    surface = surface_motion(exact, [Drive(0.0, 300), Drive(0.0, 300)])
    trajectory = simulate(surface, Micropart(MASS, (1e-4, 1e-4)), CoulombAdhesion(0.0), 10e-3)
    assert (trajectory.position == 1e-4).all()


def test_without_friction_a_flat_surface_lets_the_part_go_on_for_ever():
    trajectory = simulate(
        polynomial_surface([[0.0]]), Micropart(1.0, (0.0, 0.0), (0.3, -0.1)), ConstantFriction(0.0), 7.0
    )
    assert trajectory.position[-1] == pytest.approx([2.1, -0.7], rel=1e-14)
    assert math.hypot(*trajectory.velocity[-1]) == pytest.approx(math.hypot(0.3, 0.1), rel=1e-15)
