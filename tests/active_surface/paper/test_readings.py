"""The sweep over readings: a small grid as oracle, what is kept of a stopped one, and the page's tables."""

import json

import pytest
from made_builder import BUILDER

from active_surface.paper.readings import (
    Reading,
    Row,
    Sweep,
    SweepSize,
    best_row,
    page_of_readings,
    reproduce_readings,
    sweep_readings,
)
from active_surface.paper.readings.cases import STATEMENTS, cases_of, cell, where
from active_surface.paper.readings.effects import CHANGES, differences, pairs_of
from active_surface.paper.readings.reading import CONSTANT, FLAT, INDEX, RIM, benches_of
from active_surface.paper.readings.sensitivity import Sensitivity
from active_surface.paper.readings.single import strokes_of
from active_surface.paper.readings.two import _sixteen
from active_surface.paper.reproduction import builder_of

ONE, TWO, HEAVY = Reading(300e-6, 0.0, INDEX), Reading(400e-6, 0.0, INDEX), Reading(300e-6, 9.80665, INDEX)
SIZE = SweepSize((ONE, TWO), 8, 20.0, 18, 14)


def row(reading, **shares):
    """In the paper's scheme; nothing holds in ours."""
    own = {name: {"": 0.0} for name in STATEMENTS} | shares
    return Row(
        reading, {"paper": own, "closed": {name: {"": 0.0} for name in STATEMENTS}}, {"paper": 310.0}, 60.0, 90.0
    )


ROWS = [
    row(ONE, **{"16": {"one cycle": 1.0, "ten cycles": 0.2}, "17a": {"": 0.95}, "11": {"": 1.0}}),
    row(TWO, **{"20": {"nearest": 0.9, "superposed": 0.0}, "11": {"": 1.0}}),
]


def test_where_a_statement_holds():
    sixteen = cases_of(ROWS[:1], "paper", "16") + cases_of(ROWS[1:], "paper", "16")
    holding = [case for case in sixteen if case.holds]
    assert cell(sixteen) == "1 of 3" and where(holding, sixteen) == "a = 300; one cycle"
    assert cell(cases_of(ROWS, "paper", "11")) == "**everywhere** (2)"
    assert cell(cases_of(ROWS, "paper", "21")) == "**nowhere**, at most 0 %" and cell([]) == "-"


def test_the_page_names_the_best_reading_and_that_no_radius_meets_all():
    page = page_of_readings(Sweep(SIZE, ROWS))
    assert best_row(Sweep(SIZE, ROWS)).reading == ONE and "**a = 300 µm, no gravity, rough contact**: 3 of" in page
    assert "**No single radius meets them all**: at most 3, by a = 300 µm, where 20 fail" in page
    assert "| 16 | **100** / 0 | 0 / 0 |" in page
    both = [row(ONE, **{"16": {"": 1.0}, "20": {"": 1.0}}), ROWS[1]]
    assert "a = 300 µm meets all of those" in page_of_readings(Sweep(SIZE, [both[0]]))


def test_a_sweep_that_was_stopped_goes_on_where_it_was(tmp_path):
    kept = tmp_path / "kept.jsonl"
    lines = [json.dumps({"size": list(SIZE[1:])} | one._asdict()) for one in ROWS]
    kept.write_text("\n".join([*lines, '{"size": [1, 2']))  # the last line was cut off
    done = sweep_readings(SIZE, kept)
    assert done.rows == ROWS and done.seconds == 120.0 and done.processor == 180.0 and done.rows[0].reading == ONE


@pytest.mark.compiled
def test_two_readings_as_oracle():
    """Without gravity the part slows down by 20.9 m/s^2 and with it does not; figure 16 holds from one start by one."""
    for reading, stated in ((ONE, 1.0), (HEAVY, 0.0)):
        bench = benches_of(reading, {})[RIM]
        assert strokes_of(bench, "closed")["13, 14"] == {"": stated}
    assert strokes_of(benches_of(Reading(227e-6, 0.0, CONSTANT), {})[RIM], "closed") == {
        "11": {"": 0.0}, "12": {"": 0.0}, "13, 14": {"": 0.0}, "VI-B": {"wavelength 2 a": 1.0, "wavelength a": 0.0},
    }  # fmt: skip
    benches = benches_of(HEAVY, {})
    assert benches[FLAT].margin > 0 and benches[FLAT].grounds is not benches[RIM].grounds
    shares = _sixteen(benches[RIM], "closed", "nearest", 3)
    assert shares["one cycle from (-100, 0) um"] >= 2 / 3 and shares["one cycle from (-50, 15) um"] == 0.0


def test_gravity_and_the_contact_by_pairs():
    """Of two pairs of readings one gains a statement with gravity, and loses another."""
    rows = [
        row(ONE, **{"16": {"": 1.0}, "17a": {"": 1.0}}),
        row(HEAVY, **{"16": {"": 1.0}, "19": {"": 0.9}}),
        row(TWO, **{"16": {"": 1.0}}),
    ]
    sweep = Sweep(SIZE, rows)
    (pair,) = pairs_of(sweep, CHANGES["gravity in place of none"])
    assert differences([pair], "paper") == (["19"], ["17a"]) and differences([pair], "closed") == ([], [])
    page = page_of_readings(sweep)
    assert "| gravity in place of none, 1 pairs | 1: 19 (1) | 1: 17a (1) | 0: - | 0: - |" in page
    assert "constant friction in place" not in page  # no pair of readings differs in it


def test_data_and_page_are_written_and_what_was_kept_goes(tmp_path, monkeypatch):
    kept = tmp_path / "paper" / "readings.partial.jsonl"
    kept.parent.mkdir()
    kept.write_text("".join(json.dumps({"size": list(SIZE[1:])} | one._asdict()) + "\n" for one in ROWS))
    monkeypatch.setattr("active_surface.paper.readings.reproduction.sensitivity_of", lambda *_: Sensitivity([], [], []))
    monkeypatch.setattr("active_surface.paper.readings.reproduction.see", lambda *_: BUILDER)
    done = reproduce_readings(tmp_path, SIZE)
    assert [file.name for file in done.files] == ["paper-readings.md", "readings.json", "windows.png"]
    assert all(file.exists() for file in done.files) and not kept.exists()
    data = json.loads(done.files[1].read_text())
    assert len(data["rows"]) == 2 and data["rows"][0]["shares"]["paper"]["16"]["one cycle"] == 1.0
    assert data["devices"][0]["device"]["part"] == "silicon block" and data["losses"][1]["off"] == 3
    assert done.summary["best_reading"]["radius"] == 300e-6 and ("best", ONE.name) in done.lines
    assert builder_of(done.files[1]) == done.summary["builder"] == data["builder"]
    assert builder_of(tmp_path / "none.json") == []
