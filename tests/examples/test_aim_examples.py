"""Every aim among the examples is reached, and the plan that the documents show goes round its corner."""

import re
from pathlib import Path

import numpy as np
import pytest

from active_surface.steering import aim, plan, read_route, read_task
from active_surface.steering.read import read_place
from coupling import run_case, warnings

ROOT = Path(__file__).parents[2]
AIMS = ROOT / "examples" / "aims"
pytestmark = pytest.mark.compiled


def test_the_aim_reaches_its_target():
    found = aim(read_task(AIMS / "to_target.toml"))
    assert found.reached and not found.scatter.lost and found.scatter.quantile(0.9) < 10e-6


@pytest.mark.slow
def test_the_aim_on_a_thick_plate_stays_within_every_bound_of_the_model():
    found = aim(read_task(AIMS / "glide.toml"))
    assert found.reached and not found.scatter.lost and found.scatter.quantile(0.9) < 5e-6
    assert not warnings(run_case(found.case).summary)


@pytest.mark.slow
def test_the_plan_carries_the_part_over_five_actuators_round_a_corner():
    file = AIMS / "around_the_corner.toml"
    told = re.search(r"--through (.*)", file.read_text())[1]
    assert f"--through {told}\n" in (ROOT / "docs" / "aim.md").read_text()
    through = [read_place(text, "--through") for text in told.split()]
    found = plan(read_route(file, through))
    assert found.complete and max(found.distances) < 1e-6
    actuators = np.array([actuator.position for actuator in found.case.actuators])
    passed = np.linalg.norm(found.trajectory.position[:, None] - actuators, axis=-1).min(axis=0)
    assert (passed < 2e-6).sum() >= 5
