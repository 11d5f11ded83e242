"""Aims over a plate that stretches: one model for all drives that a search tries."""

import numpy as np
import pytest

from active_surface.steering import Task, aim
from active_surface.steering.objectives import spread_drives
from active_surface.steering.settings import Settings
from coupling import run_case
from coupling.case import ActuatorCase, Case, ConstantCase, PartCase, RunCase

PLATE = {
    "shape": "disc",
    "radius": 300e-6,
    "youngs_modulus": 169e9,
    "poisson_ratio": 0.3,
    "thickness": 5e-6,
    "cell_size": 75e-6,
    "theory": "von-karman",
}


def case_of(*places):
    return Case(
        plate=PLATE,
        actuators=[ActuatorCase(position=place, stroke=8e-6, frequency=2000, delay=2e-4) for place in places],
        part=PartCase(mass=2e-9, position=(20e-6, 60e-6)),
        friction=ConstantCase(limit=4e-9),
        run=RunCase(duration=20e-3),
    )


@pytest.mark.slow
@pytest.mark.compiled
def test_a_part_is_brought_to_a_target_and_a_run_of_its_own_ends_there():
    settings = Settings(paths=600, scatter=4)
    aimed = aim(Task(case_of((-75e-6, 0.0), (75e-6, 20e-6)), (30e-6, 55e-6), settings))
    assert aimed.case.plate.theory == "von-karman"
    assert aimed.distance <= settings.tolerance
    path = run_case(aimed.case).trajectory
    away = np.hypot(*(path.position[-1] - aimed.trajectory.position[-1]))
    assert away < 1e-3 * path.path_length
    assert np.isfinite(aimed.scatter.distance).all()


def test_drives_of_a_search_cover_the_strokes_with_room_for_scatter():
    case = case_of((-75e-6, 0.0), (75e-6, 20e-6), (0.0, 90e-6))
    sets = spread_drives(case, Settings(stroke=(-2e-6, 5e-6)), [0, 2], 1)
    heights = np.array([[drive.evaluate(np.linspace(0, 0.1, 4001))[0] for drive in drives] for drives in sets])
    low, high = heights.min(axis=(0, 2)), heights.max(axis=(0, 2))
    assert low == pytest.approx([-2.02e-6, 0.0, -2.02e-6], rel=1e-3)
    assert high == pytest.approx([5.05e-6, 0.0, 5.05e-6], rel=1e-3)
    moving = np.abs(heights).max(axis=2) > 0
    assert moving[:2, [0, 2]].all()
    assert (moving[2:].sum(axis=1) == 1).all()
    assert moving[:, [0, 2]].any(axis=0).all()
