"""Figures of the paper: each runs in a tiny mode and has its verdicts; names that the command takes."""

import csv
import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.paper import reproduction
from active_surface.paper.bench import MODELS, PARAMETERS, QUICK, TINY, Bench
from active_surface.paper.dead_zones import touched
from active_surface.paper.picture import draw
from active_surface.paper.reproduction import FIGURES, figures_of, found_of, page_of, reproduce, rounded, table_of
from active_surface.paper.statements import STATEMENTS
from active_surface.paper.verdict import BEYOND, NOT, PARTLY, REPRODUCED, Answer, Verdict

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def bench():
    return Bench(effort=TINY)


@pytest.fixture(autouse=True)
def coarse_swings(monkeypatch):
    monkeypatch.setattr("active_surface.paper.strokes.SWING_STEP", 2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("group", FIGURES)
def test_figure_runs_and_is_written(group, bench):
    found = found_of(group, bench)
    assert found.verdicts
    for verdict in found.verdicts:
        assert verdict.verdict in (REPRODUCED, PARTLY, NOT, BEYOND)
        assert verdict.statement and verdict.numbers
        assert set(verdict.answers) <= set(MODELS)
        assert all(answer.text and 0 <= answer.met <= 1 for answer in verdict.answers.values())
    assert all(axes.has_data() for axes in draw(found).axes)
    json.dumps(rounded([found.data, [verdict.as_dict() for verdict in found.verdicts]]), allow_nan=False)
    page = page_of([found], TINY)
    assert f"({reproduction.FOLDER}/{found.name}.png)" in page and f"({reproduction.FOLDER}/{found.name}.json)" in page
    rows = {row[0]: row for row in csv.reader(table_of([found]).splitlines())}
    for verdict in found.verdicts:
        figure = verdict.figure.replace(" um", " µm")
        assert f"| {figure} |" in page and len(rows[figure]) == len(rows["figure"]) and all(rows[figure])


@pytest.mark.slow
def test_some_figures_are_written_and_a_page_of_all_only(bench, monkeypatch, tmp_path):
    monkeypatch.setattr(reproduction, "Bench", lambda *_: bench)
    done = reproduce(["fig12", "FIG4"], tmp_path, TINY)
    assert [path.name for path in done.files] == ["fig3-4.png", "fig3-4.json", "fig11-12.png", "fig11-12.json"]
    assert {verdict.figure for verdict in done.verdicts} == {"3", "4", "4 (reversals)", "11", "12"}
    monkeypatch.setattr(reproduction, "FIGURES", {group: FIGURES[group] for group in (("fig3", "fig4"),)})
    assert reproduce([], tmp_path, TINY, replace(PARAMETERS)).files == done.files[:2]  # other parameters: no page
    *_, table, page = reproduce([], tmp_path, TINY).files
    assert table == tmp_path / "paper" / "verdicts.csv" and table.read_text().startswith(
        "figure,the paper,how it is judged"
    )
    assert "Statements that hold: paper's scheme, closed form, 2 of 3" in page.read_text()


def test_stored_page_and_table_are_those_of_the_stored_verdicts():
    """So a change of their texts is written without the minutes that the numbers take."""
    docs = Path(__file__).parents[3] / "docs"
    stored = []
    for group in FIGURES:
        name = "-".join(group).replace("-fig", "-")
        for one in json.loads((docs / "paper" / f"{name}.json").read_text())["verdicts"]:
            answers = {model: Answer(answer["text"], answer["met"]) for model, answer in one["answers"].items()}
            beyond = one["verdict"] == BEYOND
            stored.append(Verdict(one["figure"], one["statement"], answers, one["numbers"], beyond))
    assert [(one.figure, one.statement) for one in stored] == [(one.figure, one.says) for one in STATEMENTS]
    found = [SimpleNamespace(verdicts=stored)]
    assert (docs / "paper.md").read_text() == page_of(found, QUICK)
    assert (docs / "paper" / "verdicts.csv").read_text() == table_of(found)


def test_names_of_figures():
    assert figures_of([]) == figures_of(["all"]) == list(FIGURES)
    assert figures_of(["fig6", "fig5", "fig22"]) == [("fig5", "fig6"), ("fig22",)]
    assert figures_of(["17", "17a", "Fig17b", "fig. 19", "figure 17"]) == [("fig17", "fig19")]
    with pytest.raises(ValueError, match=r'\(1, 2 and 7 to 10 are drawings\); got "Fig7", "170"'):
        figures_of(["Fig7", "170", "17"])


def test_command_prints_verdicts_and_refuses_other_figures(tmp_path):
    done = CliRunner().invoke(main, ["reproduce", "fig13", "--json", "--output", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert [verdict["figure"] for verdict in json.loads(done.stdout)["verdicts"]] == ["13, 14", "13, 14 (Table 1)"]
    wrong = CliRunner().invoke(main, ["reproduce", "fig71", "figure 2", "--output", str(tmp_path / "new")])
    assert wrong.exit_code == 2 and '"fig71", "figure 2"' in wrong.output
    assert not (tmp_path / "new").exists()


def test_statements_have_one_row_each():
    figures = [one.figure for one in STATEMENTS]
    assert len(figures) == len(set(figures)) == 27 and [one.beyond for one in STATEMENTS].count(True) == 1


@pytest.mark.parametrize(
    ("pitch", "one", "two"), [(100e-6, 1.0, 0.0), (200e-6, 0.25, 0.0), (50e-6, 1.0, 1.0), (80e-6, 1.0, 0.4375)]
)
def test_a_square_part_touches_so_many_actuators(pitch, one, two):
    assert touched(pitch, 100e-6) == pytest.approx((one, two), abs=1e-9)
