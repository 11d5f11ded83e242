"""A run over a plate that stretches: its summary, files and picture, beside full solutions and the linear plate."""

import json

import numpy as np
import pytest
from sweeps import DISC

from coupling import Case, read_run, report, run_case
from coupling.case import ActuatorCase, ConstantCase, PartCase, RunCase
from coupling.scene.plate import build_plate

pytestmark = pytest.mark.compiled

THICKNESS = 5e-6
PLATE = DISC | {"cell_size": 60e-6}
VON_KARMAN = PLATE | {"theory": "von-karman"}
ACTUATORS = [
    ActuatorCase(position=(-75e-6, 0.0), stroke=6e-6, frequency=300, cycle="up"),
    ActuatorCase(position=(75e-6, 20e-6), stroke=3e-6, frequency=300, cycle="up"),
]


def case_of(plate, duration=2.5e-3):
    return Case(
        plate=plate,
        actuators=ACTUATORS,
        part=PartCase(mass=2e-9, position=(20e-6, 60e-6)),
        friction=ConstantCase(limit=1e-8),
        run=RunCase(duration=duration, frames=5),
        name="stretching",
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return run_case(case_of(VON_KARMAN), tmp_path_factory.mktemp("stretching"))


@pytest.fixture(scope="module")
def saved(run):
    return read_run(run.files[0])


@pytest.fixture(scope="module")
def full(run):
    """The full solution at the end of the run."""
    large = build_plate(run.case.plate).large_deflection([one.position for one in ACTUATORS])
    return large.solve([drive.evaluate([2.5e-3])[0][0] for drive in run.scene.lifts])


@pytest.mark.slow
def test_the_summary_says_how_exactly_the_plate_stretches(run):
    s = run.summary
    assert s.theory == "von-karman"
    assert s.linear_path_error is None
    assert 0 < s.stretch_error.reduction < 1e-5
    assert 0 < s.stretch_error.pieces < 1e-4
    assert 0 < s.stretch_error.mesh < 1e-2
    assert s.stretch_solutions >= 2
    assert s.deflection_over_thickness > 1
    assert not any("small-deflection theory" in text for text in report.warnings(s))
    assert not s.plate_rings


def test_a_saved_run_has_the_same_summary_and_case(run, saved):
    assert saved.summary == json.loads(json.dumps(run.summary.as_dict()))
    assert saved.case.plate.theory == "von-karman"


@pytest.mark.slow
def test_files_show_the_plate_of_the_full_solution(saved, full):
    inside = np.hypot(*saved.points.T) < 0.999 * 300e-6
    w = full.evaluate(saved.points[inside])[0]
    shown = saved.plate_field("deflection", -1)[inside]
    assert np.abs(shown - w).max() < 1e-4 * np.abs(w).max()
    drive = saved.plate_field("drive", -1)
    assert shown[:2] == pytest.approx(drive[:2], rel=1e-5)
    assert not drive[2:].any()


@pytest.mark.slow
def test_files_show_membrane_force_and_strain_of_the_full_solution(saved, full):
    away = np.hypot(*(saved.points[:, None] - saved.actuators).transpose(2, 0, 1)).min(axis=1) > THICKNESS
    away &= np.hypot(*saved.points.T) < 0.9 * 300e-6
    force = full.membrane_force(saved.points[away])
    shown = saved.plate_field("membrane_force", -1)[away]
    expected = np.stack([force[:, 0, 0], force[:, 0, 1], force[:, 1, 1]], axis=1)
    assert np.abs(shown - expected).max() < 0.03 * np.abs(expected).max()
    nu, stiffness = 0.3, 169e9 * THICKNESS
    middle = (1 + nu) * force - nu * np.trace(force, axis1=1, axis2=2)[:, None, None] * np.eye(2)
    top = middle / stiffness - THICKNESS / 2 * full.evaluate(saved.points[away])[2]
    strain = saved.plate_field("strain", -1)[away]
    expected = np.stack([top[:, 0, 0], top[:, 0, 1], top[:, 1, 1]], axis=1)
    assert np.abs(strain - expected).max() < 0.03 * np.abs(expected).max()
    assert np.isfinite(saved.plate_field("strain")).all()


@pytest.mark.slow
def test_the_linear_plate_has_neither_and_bends_otherwise(run, saved, tmp_path):
    linear = run_case(case_of(PLATE), tmp_path)
    other = read_run(linear.files[0])
    assert set(saved.plate_fields) - set(other.plate_fields) == {"membrane_force", "strain"}
    both = [one.plate_field("deflection", -1) for one in (saved, other)]
    assert np.abs(both[0] - both[1]).max() > 0.01 * both[1].max()
    assert linear.summary.theory == "linear"
    assert linear.summary.stretch_error is None


def test_the_picture_is_drawn(run):
    assert [file.suffix for file in run.files] == [".vtkhdf", ".vtkhdf", ".png"]
    assert run.plot() is not None
