"""Chunks of a sweep: how long they are, which are computed anew, and what their key covers."""

import re

import numpy as np
import pytest
from sweeps import PLATFORM, SHAKEN, same, written

from active_surface.studies import read_study, run_study
from active_surface.studies.chunk_store import ChunkStore
from active_surface.studies.dataset import read_dataset
from active_surface.studies.engine import Engine
from active_surface.studies.record import new_records
from active_surface.studies.saved import read_sweep

pytestmark = pytest.mark.usefixtures("without_pictures")


def test_a_chunk_that_is_foreign_or_torn_counts_as_none(tmp_path):
    store = ChunkStore(tmp_path / "chunks", "ab" * 32)
    assert list(store.load()) == []
    records = new_records(3)
    records["end_x"] = [1.0, 2.0, np.nan]
    store.save(np.array([1, 4, 5]), records)
    ((numbers, loaded),) = store.load()
    assert numbers.tolist() == [1, 4, 5] and loaded.tobytes() == records.tobytes()
    assert list(ChunkStore(tmp_path / "chunks", "ac" * 32).load()) == []
    (file,) = (tmp_path / "chunks").iterdir()
    whole = file.read_bytes()
    for torn in (b"", whole[:10], whole[:-1], whole[:-9] + bytes([whole[-9] ^ 1]) + whole[-8:]):
        file.write_bytes(torn)
        assert list(store.load()) == []
    store.clear()
    assert list(tmp_path.iterdir()) == []


def test_finished_chunks_are_not_found_again_and_other_ones_are(tmp_path, monkeypatch):
    monkeypatch.setattr(Engine, "_chunk_length", lambda engine: 2)
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    whole = run_study(study).dataset
    asked = []
    records = Engine.records

    def counted(self, numbers):
        if len(asked) == 2:
            raise KeyboardInterrupt
        asked.append(numbers[0] // 2)
        return records(self, numbers)

    monkeypatch.setattr(Engine, "records", counted)
    with pytest.raises(KeyboardInterrupt):
        run_study(study, tmp_path / "out")
    assert sorted(file.name for file in (tmp_path / "out").rglob("*.chunk")) == [
        "0000000000-0000000002.chunk",
        "0000000002-0000000004.chunk",
    ]
    asked.clear()
    told = []
    sweep = run_study(study, tmp_path / "out", tell=lambda done, of: told.append((done, of)))
    assert asked == [2] and told == [(4, 6), (6, 6)]
    assert same(whole, sweep.dataset)
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["study.nc", "study.sweep.png"]
    asked.clear()
    assert same(whole, run_study(study, tmp_path / "out").dataset) and asked == []
    changed = read_study(written(tmp_path, SHAKEN, PLATFORM.replace("2e-9 kg", "3e-9 kg")))
    with pytest.raises(KeyboardInterrupt):  # it begins anew, and is stopped after two chunks
        run_study(changed, tmp_path / "out", overwrite=True)
    assert asked == [0, 1] and same(whole, read_dataset(tmp_path / "out" / "study.nc").load())


JITTERED = 'repeats = 2\njitter = "1 um"\n' + SHAKEN
NUMBERS = {
    "a value of an axis": (SHAKEN.replace("40 um", "41 um"), PLATFORM),
    "repeats": (JITTERED, PLATFORM),
    "a seed that is used": ("seed = 1\n" + JITTERED, PLATFORM),
    "jitter": (JITTERED.replace("1 um", "2 um"), PLATFORM),
    "a mass": (SHAKEN, PLATFORM.replace('"2e-9 kg"', '"3e-9 kg"')),
    "a duration": (SHAKEN, PLATFORM.replace('"2 ms"', '"3 ms"')),
    "a default": (SHAKEN, PLATFORM + 'gravity = "9.8 m/s^2"\n'),
    "a tolerance": (SHAKEN, PLATFORM + "tolerance = 1e-8\n"),
}
TEXT = {
    "remarks": ("# a remark\n" + SHAKEN, PLATFORM + "# another one\n"),
    "the label of an axis": (SHAKEN.replace('"stroke"\n', '"Stroke"\n'), PLATFORM),
    "a threshold of the picture": (SHAKEN + '[map]\nthreshold = "distance > 1 um"\n', PLATFORM),
    "another unit": (SHAKEN, PLATFORM.replace('"2e-9 kg"', '"2e-6 g"')),
    "steps in files that a sweep does not write": (SHAKEN, PLATFORM + "frames = 300\n"),
    "a seed that is not used": ("seed = 1\n" + SHAKEN, PLATFORM),
}


def test_the_key_changes_with_every_number(tmp_path):
    keys = [read_study(written(tmp_path, *texts)).key for texts in [(SHAKEN, PLATFORM), *NUMBERS.values()]]
    assert len(set(keys)) == len(NUMBERS) + 1


def test_the_key_does_not_change_with_a_text(tmp_path):
    key = read_study(written(tmp_path, SHAKEN, PLATFORM)).key
    assert [what for what, texts in TEXT.items() if read_study(written(tmp_path, *texts)).key != key] == []
    assert read_study((tmp_path / "study.toml").rename(tmp_path / "another_name.toml")).key == key


def test_sweeps_go_on_under_other_labels(tmp_path, monkeypatch):
    """One is interrupted, one finished; then the axes swap their names."""
    monkeypatch.setattr(Engine, "_chunk_length", lambda engine: 2)
    records, starts = Engine.records, []

    def counted(self, numbers):
        starts.append(numbers[0])
        if len(starts) == 3:
            raise KeyboardInterrupt
        return records(self, numbers)

    monkeypatch.setattr(Engine, "records", counted)
    study = read_study(written(tmp_path, SHAKEN, PLATFORM))
    with pytest.raises(KeyboardInterrupt):
        run_study(study, tmp_path / "out")
    stroke, limit = study.points.axes
    swapped = SHAKEN.replace('name = "stroke"', 'name = "friction.limit"').replace(
        'field = "friction.limit"\n', 'field = "friction.limit"\nname = "stroke"\n'
    )
    other = read_study(written(tmp_path, swapped, PLATFORM))
    assert [axis.name for axis in other.points.axes] == ["friction.limit", "stroke"] == [limit.name, stroke.name]
    found = run_study(other, tmp_path / "out").dataset
    assert starts == [0, 2, 4, 4]
    with read_sweep(tmp_path / "out" / "study.nc", study)[1] as seen:
        assert list(seen["outcome"].dims) == ["stroke", "friction.limit"] == seen.attrs["axes"].split()
        assert seen["stroke"].values.tolist() == list(stroke.values)
    renamed = run_study(study, tmp_path / "out")
    assert starts == [0, 2, 4, 4] and renamed.warnings == []
    assert same(renamed.dataset, run_study(study).dataset)
    assert list(found["outcome"].dims) == ["friction.limit", "stroke"]
    with read_sweep(tmp_path / "out" / "study.nc")[1] as read:
        assert list(read["outcome"].dims) == ["stroke", "friction.limit"] and "swap" not in read.attrs["study"]
        assert read.attrs["study"] == study.source


def test_the_key_knows_the_content_of_a_measured_motion(tmp_path):
    motion = tmp_path / "motion.csv"
    case = re.sub(r"\[plate\.motion\.x\].*?\n\n", "", PLATFORM, flags=re.S)
    case = case.replace('"platform"', '"platform"\nmotion = "motion.csv"')
    keys = set()
    for size in (1, 2):
        rows = [f"{time},{size * np.sin(time)}" for time in range(8)]
        motion.write_text("time [ms], x [um]\n" + "\n".join(rows) + "\n")
        keys.add(read_study(written(tmp_path, '[[axes]]\nfield = "part.mass"\nvalues = ["1e-9 kg"]\n', case)).key)
    assert len(keys) == 2
