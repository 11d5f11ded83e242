"""Sweeps over a plate that stretches: one model for all their drives, and the paths of single runs."""

import numpy as np
import pytest
from sweeps import DISC_PLATE, toml, written

from active_surface.studies import read_study
from active_surface.studies.engine import Engine
from coupling import build_drives, run_case, shared_surface

pytestmark = pytest.mark.compiled

CASE = (
    DISC_PLATE
    + 'cell_size = "75 um"\ntheory = "von-karman"\n\n'
    + toml(
        actuators=[{"position": ["0 um", "0 um"], "stroke": "10 um", "frequency": "2000 Hz"}],
        part={"mass": "2e-9 kg", "position": ["50 um", "60 um"]},
        friction={"model": "constant", "limit": "2 nN"},
        run={"duration": "2 ms"},
    )
)
AXES = """\
[[axes]]
field = "actuators.0.stroke"
values = ["5 um", "10 um"]
[[axes]]
field = "actuators.0.frequency"
values = ["1500 Hz", "2500 Hz"]
"""


@pytest.fixture(scope="module")
def engine(tmp_path_factory):
    return Engine(read_study(written(tmp_path_factory.mktemp("sweep"), AXES, CASE)))


@pytest.mark.slow
def test_paths_are_those_of_single_runs(engine):
    records = engine.records(range(4))
    assert not records["mistakes"].any()
    for k, values in enumerate(engine.study.points.values(range(4))):
        case = engine.study.case_at(values)
        path = run_case(case).trajectory
        assert path.path_length > 1e-7
        end = records["end_x"][k], records["end_y"][k]
        assert end == pytest.approx(path.position[-1], abs=3e-4 * path.path_length)


@pytest.mark.slow
def test_records_do_not_depend_on_the_chunk(engine):
    together = engine.records(range(4))
    other = Engine(engine.study, threads=1)
    assert (
        np.concatenate([other.records(range(2, 4)), other.records(range(2))])[[2, 3, 0, 1]].tobytes()
        == together.tobytes()
    )


@pytest.mark.slow
def test_longer_runs_than_the_base_cases_are_followed(tmp_path):
    text = '[[axes]]\nfield = "run.duration"\nvalues = ["1 ms", "4 ms"]\n'
    engine = Engine(read_study(written(tmp_path, text, CASE.replace('"2000 Hz"', '"2000 Hz"\ncycles = 20'))))
    records = engine.records(range(2))
    longer = run_case(engine.study.case_at((4e-3,))).trajectory
    end = records["end_x"][1], records["end_y"][1]
    assert end == pytest.approx(longer.position[-1], abs=3e-4 * longer.path_length)


@pytest.mark.slow
def test_drives_beyond_the_heights_of_the_model_are_refused(engine):
    case = engine.study.case
    surface = shared_surface(case, [build_drives(case)], case.run.duration)
    actuator = case.actuators[0].model_copy(update={"stroke": 12e-6})
    higher = build_drives(case.model_copy(update={"actuators": (actuator,)}))
    with pytest.raises(
        ValueError, match=r"drive 0 must stay within the heights .*0 to 1e-05; it goes from 0 to 1.2e-05"
    ):
        surface.driven_by(higher)
    with pytest.raises(ValueError, match="Input drives must be one an actuator, 1; got 2"):
        surface.driven_by(2 * higher)
