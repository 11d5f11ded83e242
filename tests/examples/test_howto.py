"""What the quick start and the how-to pages show, works: their Python runs, their case files and output are right."""

import re
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling import read_case

ROOT = Path(__file__).parents[2]
QUICK_START = ROOT / "docs/quick-start.md"
TUTORIAL = ROOT / "docs/tutorial.md"
AIM = ROOT / "docs/aim.md"
CONTACT = ROOT / "docs/contact.md"
PAGES = [QUICK_START, TUTORIAL, CONTACT, *sorted((ROOT / "docs/howto").glob("*.md"))]


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), flags=re.DOTALL)


FIRST = blocks(QUICK_START, "toml")[0]
PYTHON = [
    pytest.param(page, block, marks=[pytest.mark.slow] * (page != QUICK_START), id=f"{page.stem}-{number}")
    for page in [*PAGES, AIM]
    for number, block in enumerate(blocks(page, "python"))
    if "read_task" not in block  # which takes minutes, and runs in test_aim_examples
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the examples, whose studies have fewer points, and the first case."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    for study in (tmp_path / "examples" / "studies").glob("*.toml"):
        study.write_text(re.sub(r"(count|points|repeats) = \d+", r"\1 = 3", study.read_text()))
    (tmp_path / "first.toml").write_text(FIRST)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.compiled
@pytest.mark.parametrize("page, block", PYTHON)
def test_python_runs(page, block, folder, capsys):
    exec(compile(block, page.name, "exec"), {})
    assert capsys.readouterr().out.strip()


def test_toml_is_toml():
    assert all(tomllib.loads(block) for page in PAGES for block in blocks(page, "toml"))


@pytest.mark.slow
@pytest.mark.compiled
def test_first_case_prints_what_the_quick_start_says(folder):
    printed = CliRunner().invoke(main, ["run", "first.toml"]).output
    end = re.compile(r"^(outcome|end|distance|contact|wrote) .*$", flags=re.MULTILINE)
    assert [line[0] for line in end.finditer(printed)] == [line[0] for line in end.finditer(QUICK_START.read_text())]
    assert "warning" not in printed


def test_mistakes_are_told_as_the_quick_start_says(folder):
    wrong = FIRST.replace('"10 um"', '"10 s"').replace("frequency", "frequncy")
    (folder / "first.toml").write_text(wrong)
    result = CliRunner().invoke(main, ["check", "first.toml"])
    assert result.exit_code == 2
    assert result.output.strip() in QUICK_START.read_text()


def test_measured_friction_is_the_same_from_a_list_and_from_a_file(folder):
    inline, file = (tomllib.loads(block)["friction"] for block in blocks(CONTACT, "toml"))
    case = (
        FIRST.split("[friction]")[0] + "[friction]\nmodel = 'table'\nfile = 'friction.csv'\n[run]\nduration = '1 ms'\n"
    )
    (folder / file["file"]).write_text(re.search(r"```\n(load .*?)```", CONTACT.read_text(), flags=re.DOTALL)[1])
    (folder / "case.toml").write_text(case)
    law = read_case(folder / "case.toml").friction
    assert inline["loads"] == [f"{load:g} uN" for load in 1e6 * np.array(law.loads)]
    assert inline["limits"] == [f"{limit:g} nN" for limit in 1e9 * np.array(law.limits)]


PRINTED = re.compile(r"^(outcome|end|distance|contact|margins| {12}contact|thresholds) .*$", flags=re.MULTILINE)


def tutorial_cases():
    """The cases of the tutorial by the file's name, as a reader changes the first."""
    device, column, _, corner = blocks(TUTORIAL, "toml")
    cases = {"device": device}
    for name, change in (("column", column), ("corner", corner)):
        lines = {line.split(" = ")[0]: line for line in change.splitlines()}
        new = re.sub(r"^(stroke|frequency) = .*\n", "", device, flags=re.MULTILINE)
        cases[name] = new.replace("[lattice]", "\n".join(["[lattice]", *lines.values()]))
    cases["corner"] = cases["corner"].replace('"15 ms"', '"60 ms"')
    return cases


def test_the_tutorial_begins_with_an_example():
    assert tomllib.loads(tutorial_cases()["device"]) == tomllib.loads((ROOT / "examples/device.toml").read_text())


@pytest.mark.slow
@pytest.mark.compiled
def test_the_tutorial_prints_what_its_commands_print(folder):
    page = TUTORIAL.read_text()
    for name, case in tutorial_cases().items():
        (folder / f"{name}.toml").write_text(case)
        printed = CliRunner().invoke(main, ["run", f"{name}.toml"]).output
        assert "warning" not in printed or name == "corner"
        shown = [line[0] for line in PRINTED.finditer(printed)]
        if name == "column":  # its margins are left out
            shown = shown[:4]
        elif name == "corner":
            (end,) = re.findall(r"end +\((.+), (.+)\) um at 60.0000 ms", printed)
            assert np.array(end, float) == pytest.approx(np.array([-38.8320, -43.9434]), abs=4e-4)  # um, as it says
            shown = []
        assert [line for line in shown if line not in page] == []


@pytest.mark.slow
@pytest.mark.compiled
def test_the_notebook_runs():
    nbclient = pytest.importorskip("nbclient")
    notebook = pytest.importorskip("nbformat").read(ROOT / "docs/tutorial.ipynb", 4)
    printed = notebook.cells[3]["outputs"][0]["text"]
    nbclient.NotebookClient(notebook, timeout=600).execute()
    assert notebook.cells[3]["outputs"][0]["text"] == printed
    assert all(cell["outputs"] for cell in notebook.cells if cell["cell_type"] == "code")
