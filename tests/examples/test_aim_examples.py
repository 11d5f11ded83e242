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


def test_an_aim_over_a_case_of_the_examples_reaches_its_target():
    found = aim(read_task(AIMS.parent / "array_3x3.toml", target=(20e-6, -40e-6)))
    assert found.reached and not found.scatter.lost


@pytest.mark.slow
def test_the_aim_reaches_its_target_within_every_bound_of_the_plate():
    found = aim(read_task(AIMS / "to_target.toml"))
    assert found.reached and not found.scatter.lost and found.scatter.quantile(0.9) < 5e-6
    assert not warnings(run_case(found.case).summary)


@pytest.mark.slow
def test_the_plan_carries_the_part_round_a_corner_within_every_bound_of_the_plate():
    file = AIMS / "around_the_corner.toml"
    places = re.search(r"--through (.*)", file.read_text())[1]
    assert f"--through {places}\n" in (ROOT / "docs" / "aim.md").read_text()
    through = [read_place(text, "--through") for text in places.split()[:3]]  # behind the corner
    found = plan(read_route(file, through))
    assert found.complete and max(found.distances) < 1e-6
    passed = np.linalg.norm(found.trajectory.position[:, None] - through, axis=-1).min(axis=0)
    assert (passed < 1e-6).all()
    assert not warnings(run_case(found.case).summary)
