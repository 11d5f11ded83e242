"""The figures of the paper: each runs in a tiny mode and has its verdict."""

import json

import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

from active_surface.cli.program import main
from active_surface.paper import reproduction
from active_surface.paper.catalogue import MODULES, finder, modules_of
from active_surface.paper.figure_result import FigureResult
from active_surface.paper.figures.dead_zones import touched
from active_surface.paper.models import Bench
from active_surface.paper.page import page_of
from active_surface.paper.parameters import PARAMETERS, TINY
from active_surface.paper.reproduction import reproduce, rounded
from active_surface.paper.verdict import BEYOND, NOT, PARTLY, REPRODUCED, Answer, Verdict, of_checks

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def bench():
    return Bench()


@pytest.fixture(autouse=True)
def coarse_swings(monkeypatch):
    monkeypatch.setattr("active_surface.paper.figures.friction_logic.SWING_STEP", 2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("module", MODULES)
def test_figure_runs_and_is_written(module, bench):
    found = finder(module)(bench, TINY)
    assert found.verdicts and found.caption and found.title
    for verdict in found.verdicts:
        assert verdict.verdict in (REPRODUCED, PARTLY, NOT, BEYOND)
        assert verdict.statement and verdict.why and verdict.numbers
        assert set(verdict.answers) <= {"paper", "closed", "plate"}
        assert all(answer.text and 0 <= answer.met <= 1 for answer in verdict.answers.values())
    figure = Figure()
    found.draw(figure)
    assert all(axes.has_data() for axes in figure.axes) and any(axes.get_xlabel() for axes in figure.axes)
    json.dumps(rounded([found.data, [verdict.as_dict() for verdict in found.verdicts]]), allow_nan=False)
    assert found.name in page_of([found], TINY, PARAMETERS, "paper")


@pytest.mark.slow
def test_some_figures_are_written_and_a_page_of_all_only(bench, monkeypatch, tmp_path):
    monkeypatch.setattr(reproduction, "Bench", lambda _: bench)
    done = reproduce(["fig12", "FIG4"], tmp_path, TINY)
    assert [path.name for path in done.files] == ["fig3-4.png", "fig3-4.json", "fig11-12.png", "fig11-12.json"]
    assert all(path.exists() for path in done.files) and not (tmp_path / "paper.md").exists()
    assert {verdict.figure for verdict in done.verdicts} == {"3", "4", "4 (reversals)", "11", "12"}


def test_names_of_figures():
    assert modules_of([]) == modules_of(["all"]) == list(MODULES)
    assert modules_of(["fig6", "fig5", "fig22"]) == ["feasible_area", "accuracy"]
    assert modules_of(["17", "17a", "Fig17b", "fig. 19", "figure 17"]) == ["convergence"]
    with pytest.raises(ValueError, match=r'"Fig7" \(figures 1, 2 and 7 to 10 are drawings\), "170"'):
        modules_of(["Fig7", "170", "17"])


def test_command_prints_verdicts_and_refuses_other_figures(tmp_path):
    done = CliRunner().invoke(main, ["reproduce", "fig13", "--json", "--output", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert [verdict["figure"] for verdict in json.loads(done.stdout)["verdicts"]] == ["13, 14", "13, 14 (Table 1)"]
    wrong = CliRunner().invoke(main, ["reproduce", "fig71", "figure 2", "--output", str(tmp_path / "new")])
    assert wrong.exit_code == 2 and '"fig71" (did you mean "fig21"?)' in wrong.output and '"figure 2"' in wrong.output
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(("met", "said"), [((1, 0), REPRODUCED), ((0.5, 1), PARTLY), ((0, 1), NOT)])
def test_a_verdict_is_that_of_the_papers_own_scheme(met, said):
    answers = {model: Answer("", share) for model, share in zip(("paper", "closed"), met, strict=True)}
    verdict = Verdict("1", "", answers, "")
    assert verdict.verdict == said
    assert verdict.as_dict()["answers"]["closed"]["verdict"] == (NOT if met[1] == 0 else REPRODUCED)


def test_checks_and_what_is_beyond_the_paper():
    assert of_checks("", [True, False]).met == 0.5
    beyond = Verdict("1", "", {"plate": Answer("", 1.0)}, "", beyond=True)
    assert beyond.verdict == BEYOND


def test_what_is_beyond_the_paper_is_not_counted():
    answers = {"paper": Answer("", 1.0), "plate": Answer("cell", 0.0, "a detail")}
    rows = [Verdict(str(k), "", answers, "", beyond=k == 0) for k in range(3)]
    page = page_of([FigureResult("x", "", tuple(rows), {}, lambda _: None)], TINY, PARAMETERS, "paper")
    assert "Of 2 statements the paper's own scheme reproduces 2, 0 partly, 0 not" in page
    assert "| **no**: cell |" in page and "a detail." in page and "a detail" not in page.split("## Figures")[0]


@pytest.mark.parametrize(
    ("pitch", "one", "two"), [(100e-6, 1.0, 0.0), (200e-6, 0.25, 0.0), (50e-6, 1.0, 1.0), (80e-6, 1.0, 0.4375)]
)
def test_a_square_part_touches_so_many_actuators(pitch, one, two):
    assert touched(pitch, 100e-6) == pytest.approx((one, two), abs=1e-9)
