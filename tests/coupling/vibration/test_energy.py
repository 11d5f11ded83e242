"""The energy ledger of a plate that vibrates: what actuators do, what bends and moves, and what damping takes."""

import numpy as np
import pytest

from coupling.vibration import make_vibration_model
from fem_plate import Plate, PlateSection
from meshes import disc
from particle import Drive

pytestmark = pytest.mark.compiled

SECTION = PlateSection(169e9, 0.3, 5e-6, 2330.0)
RADIUS = 300e-6
PLACES = np.array([[0.3, 0.1], [-0.25, -0.35], [-0.2, 0.4]]) * RADIUS
GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(8)


@pytest.mark.parametrize(
    "stiffness, ratio",
    [
        pytest.param([np.inf, 2e3, np.inf], 0.02, id="a spring"),
        pytest.param(np.inf, 0.0, id="undamped", marks=pytest.mark.slow),
    ],
)
def test_energy_is_conserved(stiffness, ratio):
    """Strokes that end, and the ringing after them.

    Forces come from virtual work, P_i = sum_j K_ij h_j + rho t (phi_i, w_tt), all masses from quadrature of the shapes
    themselves: the modes' own masses and shares are not used.
    """
    plate = Plate(disc(RADIUS, RADIUS / 6), SECTION)
    shapes = plate.influence(PLACES, stiffness)
    first = plate.frequencies(1, PLACES, shapes.springs)[0]
    drives = [Drive(1e-6, 0.3 * first, cycles=2), Drive(-0.7e-6, 0.45 * first, "cosine", ramp=1, cycles=2)]
    drives.append(Drive(0.4e-6, 0.2 * first, cycles=1, delay=1 / first))
    end = 10 / first
    model = make_vibration_model(shapes, SECTION, lambda f: np.full(len(f), ratio), [drives], end, False)
    motion, (xy, weights) = model.motion(drives), shapes.model.space.quadrature
    few = np.arange(len(motion.oscillators.omega)) < 8  # the ledger closes with any of them
    motion = motion.chosen(few)
    values = model.shapes.values(xy * shapes.size)[:, np.append([True] * len(drives), few)]
    mass = SECTION.density * SECTION.thickness * shapes.size**2 * (values.T @ (weights[:, None] * values))
    edges = motion.course.edges
    fastest = motion.oscillators.omega.max()
    steps = [np.linspace(a, b, 2 + int(8 * (b - a) * fastest / 6)) for a, b in zip(edges[:-1], edges[1:], strict=True)]
    grid = np.unique(np.concatenate(steps))
    half, middle = np.diff(grid) / 2, (grid[1:] + grid[:-1]) / 2
    times = (middle[:, None] + half[:, None] * GAUSS).ravel()
    h, eta = np.stack([drive.evaluate(times) for drive in drives], axis=2), motion.evaluate(times)
    acceleration = np.concatenate([h[2], eta[2]], axis=1)
    forces = h[0] @ shapes.stiffness.T + acceleration @ mass[:, : len(drives)]
    omega, of_modes = motion.oscillators.omega, np.diag(mass)[len(drives) :]
    powers = np.stack([(forces * h[1]).sum(axis=1), 2 * ratio * omega * of_modes @ (eta[1] ** 2).T])
    work, lost = ((powers * (half[:, None] * WEIGHTS).ravel()).reshape(2, len(half), -1).sum(axis=2)).cumsum(axis=1)

    h, eta = np.stack([drive.evaluate(grid[1:]) for drive in drives], axis=2), motion.evaluate(grid[1:])
    velocity = np.concatenate([h[1], eta[1]], axis=1)
    moving = ((velocity @ mass) * velocity).sum(axis=1) / 2
    bending = ((h[0] @ shapes.stiffness) * h[0]).sum(axis=1) / 2 + eta[0] ** 2 @ (omega**2 * of_modes) / 2
    largest = max(np.abs(entry).max() for entry in (work, lost, moving, bending))
    assert np.abs(work - lost - moving - bending).max() < 1e-9 * largest
    assert moving[-1] > 1e-6 * largest  # it rings
    assert (lost[-1] > 1e-3 * largest) == (ratio > 0)
