"""Plates that are kept for other cases: which are shared, and which make room."""

import numpy as np
import pytest
from sweeps import PLATE, read_text

from coupling import SolvedPlates, build_scene, ground_key
from coupling.display import moving_heights

OTHERS = {
    "actuators.0.position.0": "-60 um",
    "actuators.0.stiffness": "100 N/m",
    "plate.thickness": "6 um",
    "plate.top_face": False,
    "run.surface_tolerance": 1e-5,
}
"""Fields that change what cells follow from."""


@pytest.mark.compiled
def test_the_plates_used_last_are_kept_and_their_cells_shared(tmp_path):
    base = read_text(tmp_path, PLATE)
    first, second, third = (base.vary({"plate.thickness": f"{t} um"}) for t in (5, 6, 7))
    plates = SolvedPlates(keep=2)
    store = plates.scene(first).surface.store
    plates.scene(second)
    assert plates.scene(first.vary({"actuators.0.stroke": "3 um"})).surface.store is store  # used again
    plates.scene(third)
    assert [plates.knows(case) for case in (first, second, third)] == [True, False, True]


@pytest.mark.parametrize("field", OTHERS)
def test_plates_that_differ_in_what_cells_follow_from_are_not_shared(tmp_path, field):
    base = read_text(tmp_path, PLATE)
    assert ground_key(base.vary({field: OTHERS[field]})) != ground_key(base)
    same = base.vary({"actuators.0.stroke": "3 um", "part.mass": "1e-9 kg", "run.duration": "1 ms"})
    assert ground_key(same) == ground_key(base)


def test_a_stretching_plate_is_known_up_to_the_end_that_it_was_solved_for(tmp_path, monkeypatch):
    case = read_text(tmp_path, PLATE.replace('"disc"', '"disc"\ntheory = "von-karman"'))
    monkeypatch.setattr("coupling.solved_plates.shared_surface", lambda *_: object())
    plates = SolvedPlates()
    surface = plates.surface(case, list, 1e-3)
    assert plates.known_surface(case, 1e-3) is surface and plates.known_surface(case, 2e-3) is None
    assert plates.surface(case, list, 1e-3) is surface


@pytest.mark.compiled
@pytest.mark.parametrize("pressure", ["0 Pa", "10 Pa"])
def test_a_plate_that_is_shared_moves_by_the_drives_of_each_case(tmp_path, pressure):
    base = read_text(tmp_path, PLATE).vary({"plate.pressure": pressure})
    other, plates, times = base.vary({"actuators.0.stroke": "3 um"}), SolvedPlates(), np.linspace(0, 1e-3, 5)
    plates.scene(base)
    shared, own = plates.scene(other), build_scene(other)
    assert np.array_equal(moving_heights(shared, times), moving_heights(own, times))
    place = [(1e-5, 2e-5)]
    assert np.array_equal(shared.surface.evaluate(place, 7e-4).w, own.surface.evaluate(place, 7e-4).w)
