"""Quick paths: those of a run where that is quick, and marked where they are not."""

import time

import numpy as np
import pytest
from app_case import CASE

from active_surface.app import quick
from active_surface.app.quick import LINEAR, PLATE, QuickPaths
from coupling import SolvedPlates, read_case, run_case, silent
from coupling.surface import cell_maker
from particle import Stopped


@pytest.fixture
def case(tmp_path):
    (tmp_path / "one.toml").write_text(CASE)
    return read_case(tmp_path / "one.toml")


@pytest.fixture
def patient(monkeypatch):
    monkeypatch.setattr(quick, "LIMIT", 1e3)


@pytest.mark.compiled
def test_over_a_known_plate_it_is_the_path_of_a_run(case, patient):
    plates = SolvedPlates()
    plates.scene(case)
    changed = case.vary({"actuators.0.frequency": "1 kHz", "part.mass": "3e-9 kg"})
    found = QuickPaths(plates).of(changed)
    assert found.coarse == ()
    np.testing.assert_array_equal(found.path.position, run_case(changed).trajectory.position)


@pytest.mark.compiled
def test_over_an_unknown_plate_it_is_near_and_marked(case, patient):
    moved = case.vary({"actuators.0.position.0": "20 um"})
    found = QuickPaths(SolvedPlates()).of(moved)
    exact = run_case(moved).trajectory
    assert found.coarse == (PLATE,)
    assert np.abs(found.path.position[-1] - exact.position[-1]).max() < 1e-3 * exact.path_length


@pytest.mark.compiled
def test_a_path_that_takes_too_long_is_cut_and_marked(case, patient, monkeypatch):
    plates = SolvedPlates()
    plates.scene(case)
    paths = QuickPaths(plates)
    whole = paths.of(case).path
    follow, calls = quick.follow_part, []

    def stopped_twice(*arguments):
        calls.append(arguments)
        if len(calls) in (2, 3):  # the first fits a cell
            raise Stopped
        return follow(*arguments)

    monkeypatch.setattr(quick, "follow_part", stopped_twice)
    cut = paths.of(case)
    assert cut.path.time[-1] == whole.time[-1] / 4
    assert cut.coarse == ("steps to 1e-06", "only its first 0.75 ms")
    assert paths.of(case, rest=False).coarse == cut.coarse and len(calls) == 6  # while it is dragged
    assert paths.of(case).coarse == ()


@pytest.mark.compiled
def test_an_actuator_that_is_dragged_has_a_path_though_cells_take_long(case, monkeypatch):
    make = cell_maker.CellMaker.make

    def slow(*arguments):
        time.sleep(2 * quick.LIMIT)
        make(*arguments)

    monkeypatch.setattr(cell_maker, "FEW", 0)  # as with many actuators, when a cell is fitted once a part is there
    monkeypatch.setattr(cell_maker.CellMaker, "make", slow)
    paths = QuickPaths(SolvedPlates())
    for k in range(quick.LEVELS + 1):
        assert paths.of(case.vary({"actuators.0.position.0": f"{k} um"}), rest=False) is not None


@pytest.mark.slow
@pytest.mark.compiled
def test_a_plate_that_stretches_is_linear_until_its_model_is_made(case, patient):
    stretching = case.vary(
        {"plate.theory": "von-karman", "actuators.0.stroke": "2 um", "actuators.0.frequency": "5 kHz"}
    )
    paths = QuickPaths(SolvedPlates())
    assert paths.of(stretching).coarse[0].startswith(LINEAR)
    paths.prepare(stretching, silent)
    prepared = paths.of(stretching)
    exact = run_case(stretching).trajectory
    assert prepared.coarse == ("a model made for these strokes",)
    assert np.abs(prepared.path.position[-1] - exact.position[-1]).max() < 1e-3 * max(exact.path_length, 1e-9)
    assert paths.of(stretching.vary({"actuators.0.stroke": "9 um"})).coarse[0].startswith(LINEAR)  # beyond the model


def test_too_many_actuators_on_an_unknown_plate_wait(case, monkeypatch):
    monkeypatch.setattr(quick, "MAX_ACTUATORS", 0)
    assert QuickPaths(SolvedPlates()).of(case) is None
