"""Sweeps over a plate with inertia: its modes are found once, and its paths are those of single runs."""

import numpy as np
import pytest
from sweeps import DISC_PLATE, toml, written

from active_surface.studies import read_study
from active_surface.studies.engine import Engine
from coupling import run_case
from coupling.vibration import vibration
from fem_plate import Plate

pytestmark = pytest.mark.compiled

CASE = (
    DISC_PLATE
    + 'density = "2330 kg/m^3"\ncell_size = "75 um"\ninertia = true\n\n'
    + toml(
        actuators=[{"position": ["0 um", "0 um"], "stroke": "0.5 um", "frequency": "100 kHz"}],
        part={"mass": "2e-9 kg", "position": ["100 um", "60 um"]},
        friction={"model": "constant", "limit": "2 nN"},
        run={"duration": "0.1 ms"},
    )
)
AXES = """\
[[axes]]
field = "actuators.0.frequency"
values = ["50 kHz", "100 kHz", "242 kHz", "480 kHz"]
"""


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """An engine, the records of its paths in two calls, and how often the plate was solved and its modes found."""
    counts = {"plate": 0, "modes": 0}
    influence, excitation = Plate.influence, vibration.Excitation

    def solved(*arguments, **options):
        counts["plate"] += 1
        return influence(*arguments, **options)

    def sought(*arguments):
        counts["modes"] += 1
        return excitation(*arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Plate, "influence", solved)
        patch.setattr(vibration, "Excitation", sought)
        engine = Engine(read_study(written(tmp_path_factory.mktemp("sweep"), AXES, CASE)))
        records = np.concatenate([engine.records(range(3)), engine.records(range(3, 4))])
    return engine, records, counts


def test_plate_and_modes_are_found_once(found):
    _, records, counts = found
    assert counts == {"plate": 1, "modes": 1} and not records["mistakes"].any()


@pytest.mark.slow
@pytest.mark.parametrize("k", [2, 3])
def test_paths_are_those_of_single_runs(found, k):
    """Which keep other modes each: to 1e-6 of the place at the end, and 1e-4 of the path."""
    engine, records, _ = found
    path = run_case(engine.study.case_at(engine.study.points.values([k])[0])).trajectory
    end = np.array([records["end_x"][k], records["end_y"][k]])
    assert path.path_length > 5e-8
    assert end == pytest.approx(path.position[-1], rel=1e-6)
    assert np.hypot(*(end - path.position[-1])) < 1e-4 * path.path_length
