"""Chunks of a sweep: which are computed anew, where their records are kept, and what their key covers."""

import re
import sqlite3
from contextlib import closing

import numpy as np
import pytest
from sweeps import PLATFORM, SHAKEN, same, written

from active_surface.studies import read_study, run_study
from active_surface.studies.columns import new_records
from active_surface.studies.engine import Engine
from active_surface.studies.read import read_sweep
from active_surface.studies.sweep_file import read_dataset
from active_surface.studies.sweep_table import sweep_table

pytestmark = pytest.mark.usefixtures("without_pictures")


KEYS = [bytes([number]) * 16 for number in range(6)]


def test_a_table_finds_records_by_what_their_paths_follow_from(tmp_path):
    file, records = tmp_path / "made" / "study.sweep", new_records(6)
    records["end_x"] = [1.0, 2.0, np.nan, 4.0, 5.0, 6.0]
    with sweep_table(file) as table:
        table.ask(KEYS[:4])
        assert table.missing().tolist() == [0, 1, 2, 3]
        table.add(np.array([1, 3]), records[[1, 3]])
    with sweep_table(file) as table:  # a study with other paths, and an earlier sweep that has some of them
        table.ask([KEYS[3], KEYS[5], KEYS[2], KEYS[1], KEYS[5]])
        assert table.missing().tolist() == [1, 2, 4]
        assert table.keep([(KEYS[4:], records[4:])]) == (2, 1)
        table.add(np.array([2]), records[[2]])
        assert table.missing().tolist() == []
        lots = [lot.tobytes() for lot in table.records([2, 3])]
        assert lots == [records[[3, 5]].tobytes(), records[[2, 1, 5]].tobytes()]
        table.clear()
    assert not file.exists()


def test_what_is_not_committed_is_undone(tmp_path):
    records = new_records(6)
    with pytest.raises(KeyboardInterrupt), sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS)
        table.add(np.array([0]), records[:1])
        table.keep([(KEYS[1:], records[1:])])
        raise KeyboardInterrupt
    with sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS)
        assert table.missing().tolist() == [1, 2, 3, 4, 5]


def test_a_damaged_table_is_one_clear_error_and_stays(tmp_path):
    file = tmp_path / "study.sweep"
    records = new_records(6)
    records["end_x"] = 0.123456789
    with sweep_table(file) as table:
        table.ask(KEYS)
        table.add(np.arange(6), records)
    whole = file.read_bytes()
    for torn in (b"mine", whole[:100], whole[: len(whole) // 2]):
        file.write_bytes(torn)
        wrong = r"study.sweep: is damaged, or no file of finished paths; move it away"
        with pytest.raises(ValueError, match=wrong), sweep_table(file) as table:
            table.ask(KEYS)
            next(table.records([6]))
        assert len(file.read_bytes()) >= len(torn)
    with closing(sqlite3.connect(tmp_path / "other.sweep")) as other:
        other.execute("CREATE TABLE mine (what)")
    with pytest.raises(ValueError, match="no file of finished paths"), sweep_table(tmp_path / "other.sweep"):
        pass


def test_a_record_that_is_damaged_is_not_finished(tmp_path):
    file, records = tmp_path / "study.sweep", new_records(6)
    records["end_x"] = 0.123456789
    with sweep_table(file) as table:
        table.ask(KEYS)
        table.add(np.arange(6), records)
    whole = file.read_bytes()
    place = whole.rindex(records["end_x"][0].tobytes())
    file.write_bytes(whole[:place] + b"?" + whole[place + 1 :])
    with sweep_table(file) as table:
        table.ask(KEYS)
        (lost,) = table.missing()
        table.add(np.array([lost]), records[:1])
        assert b"".join(lot.tobytes() for lot in table.records([6])) == records.tobytes()


def test_a_table_that_lacks_a_record_is_damaged(tmp_path):
    with pytest.raises(ValueError, match="is damaged"), sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS[:2])
        table.add(np.array([0]), new_records(1))
        next(table.records([2]))


def test_paths_of_an_earlier_sweep_are_counted_once_after_a_stop(tmp_path):
    for _ in range(2):
        with sweep_table(tmp_path / "study.sweep") as table:
            table.ask(KEYS[:1])
            assert table.keep([(KEYS[:2], new_records(2))]) == (1, 1)
            table.commit()


def test_what_is_refused_leaves_no_table(tmp_path):
    with pytest.raises(ValueError, match="refused"), sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS[:1])
        table.keep([(KEYS[:2], new_records(2))])
        raise ValueError("refused")
    assert not list(tmp_path.iterdir())


def test_a_stop_after_the_results_were_read_leaves_a_table_that_goes_on(tmp_path):
    for _ in range(2):
        with sweep_table(tmp_path / "study.sweep") as table:
            table.ask(KEYS[:1])
            table.add(table.missing(), new_records(len(table.missing())))
            assert len(next(table.records([1]))) == 1
            table.commit()  # as `clear` does before the file goes


def test_finished_paths_that_a_study_does_not_ask_for_stay(tmp_path):
    with sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS[:3])
        table.add(np.arange(3), new_records(3))
    with sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS[:2])
        table.clear()
    with sweep_table(tmp_path / "study.sweep") as table:
        table.ask(KEYS[:3])
        assert table.missing().tolist() == [0, 1]


def test_a_table_whose_file_was_removed_meanwhile_is_in_use(tmp_path, monkeypatch):
    def connected(file, connect=sqlite3.connect, **options):
        database = connect(file, **options)
        file.unlink()  # by its last user
        return database

    (tmp_path / "study.sweep").touch()
    monkeypatch.setattr("active_surface.studies.sweep_table.sqlite3.connect", connected)
    with pytest.raises(RuntimeError, match="another sweep"), sweep_table(tmp_path / "study.sweep"):
        pass


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
