"""Every study among the examples runs and shows what it is there for."""

import shutil
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from active_surface.studies import read_study, run_study

STUDIES = Path(__file__).parents[2] / "examples" / "studies"
FILES = [file for file in sorted(STUDIES.glob("*.toml")) if "[study]" in file.read_text()]
# Whole they take ten minutes. Fewer points and repeats, starts on a strip of the same lattice, and parts in one corner.
FEWER = {
    "chladni": {"points = 1000": "points = 24", '"-4.9 mm"': '"3.4 mm"'},
    "frequency_stroke": {'"5 kHz"]\ncount = 41': '"5 kHz"]\ncount = 11', '"5 um"]\ncount = 41': '"5 um"]\ncount = 8'},
    "jittered_starts": {"count = 41": "count = 2", "repeats = 40": "repeats = 8"},
    "starts": {
        '"x"\nrange = ["-1 mm", "1 mm"]\ncount = 61': '"x"\nrange = ["-1 mm", "0 mm"]\ncount = 31',
        '"y"\nrange = ["-1 mm", "1 mm"]\ncount = 61': '"y"\nrange = ["-0.2 mm", "0.2 mm"]\ncount = 13',
    },
}
pytestmark = [pytest.mark.compiled, pytest.mark.slow]


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweeps")
    copied = shutil.copytree(STUDIES.parent, folder / "examples") / "studies"
    for name, changes in FEWER.items():
        file = copied / f"{name}.toml"
        text = file.read_text()
        assert all(text.count(old) for old in changes)
        file.write_text(reduce(lambda text, change: text.replace(*change), changes.items(), text))
    return {file.stem: run_study(read_study(copied / file.name), folder) for file in FILES}


def test_each_leaves_its_results_and_a_picture(found):
    for name, sweep in found.items():
        assert sorted(file.name for file in sweep.files) == [f"{name}.nc", f"{name}.sweep.png"]
        assert not sweep.warnings
        assert (sweep.dataset["mistakes"].values > 0).sum() == sweep.outcomes.get("refused", 0)


def test_a_larger_stroke_moves_the_part_at_a_lower_frequency(found):
    distance = found["frequency_stroke"].dataset["distance"]
    moves = (distance > 10e-6).values
    frequency = distance["frequency"].values
    threshold = [frequency[moves[:, k]].min() for k in range(moves.shape[1]) if moves[:, k].any()]
    assert (
        len(threshold) > moves.shape[1] / 2 and (np.diff(threshold) <= 0).all() and threshold[0] > 1.5 * threshold[-1]
    )


def test_parts_near_an_actuator_are_driven_away_from_it_and_far_ones_stay(found):
    data = found["starts"].dataset
    far = np.hypot(data["start_x"] + 300e-6, data["start_y"]).values
    away = np.hypot(data["end_x"] + 300e-6, data["end_y"]).values
    near = (far > 50e-6) & (far < 150e-6)
    assert near.sum() > 50 and (away[near] > far[near] + 20e-6).all()
    at_rim = np.hypot(data["start_x"], data["start_y"]).values > 900e-6
    at_rim &= data["mistakes"].values == 0
    assert (data["distance"].values[at_rim] < 1e-6).all()
    outside = np.hypot(data["x"], data["y"]).values > 1.001e-3
    assert (data["mistakes"].values[outside] == 1).all()


def test_jittered_starts_end_close_to_each_other_below_the_threshold(found):
    data = found["jittered_starts"].dataset
    assert data.sizes == {"frequency": 2, "repeat": 8}
    assert (data["distance"].sel(frequency=500).values < 1e-6).all()
    assert (data["distance"].sel(frequency=3700).values > 100e-6).all()


def test_parts_gather_where_the_plate_hardly_moves(found):
    """Beyond 3.4 mm along both axes the corners swing most: parts leave them for the nodal arcs."""
    data = found["chladni"].dataset
    start, end = (np.minimum(abs(data[f"{at}_x"].values), abs(data[f"{at}_y"].values)) for at in ("start", "end"))
    assert (start > 3.4e-3).sum() > 8 and (end > 3.4e-3).sum() < 3
