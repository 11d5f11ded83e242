"""Whole runs of the app: what they leave behind."""

import gc
import weakref

import numpy as np
import pytest
from app_case import CASE
from matplotlib.tri import Triangulation

from active_surface.app.full import full_answer
from coupling import SolvedPlates, read_case


@pytest.mark.compiled
def test_a_plate_that_is_not_kept_is_gone_at_once(tmp_path):
    (tmp_path / "mine.toml").write_text(CASE)
    case, plates, stop = read_case(tmp_path / "mine.toml"), SolvedPlates(keep=1), np.zeros(1, np.int64)
    gc.collect()
    gc.disable()
    try:
        full_answer(case, plates, lambda *stage: None, stop)
        plate = weakref.ref(plates.scene(case).plate)
        full_answer(case.vary({"actuators.0.position.0": "20 um"}), plates, lambda *stage: None, stop)
        assert plate() is None
        assert not [one for one in gc.get_objects() if isinstance(one, Triangulation)]
    finally:
        gc.enable()
