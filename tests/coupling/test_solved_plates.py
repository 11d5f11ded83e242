"""Plates that are kept for other cases: which are shared, and which make room."""

import pytest
from sweeps import PLATE, read_text

from coupling import SolvedPlates


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
