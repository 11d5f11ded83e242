"""What the quick start and the how-to pages show, works: their Python runs, their case files and output are right."""

import re
import shutil
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling import read_case

ROOT = Path(__file__).parents[2]
QUICK_START = ROOT / "docs/quick-start.md"
PAGES = [QUICK_START, *sorted((ROOT / "docs/howto").glob("*.md"))]


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(), flags=re.DOTALL)


FIRST = blocks(QUICK_START, "toml")[0]
PYTHON = [
    pytest.param(page, block, marks=[pytest.mark.slow] * (page != QUICK_START), id=f"{page.stem}-{number}")
    for page in PAGES
    for number, block in enumerate(blocks(page, "python"))
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
    for library in re.findall(r"^(?:import|from) (optuna|pymoo)", block, flags=re.MULTILINE):
        pytest.importorskip(library)
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


def test_the_table_of_own_friction_is_that_of_its_case(folder):
    page = ROOT / "docs/howto/own-friction.md"
    inline, file = (tomllib.loads(block)["friction"] for block in blocks(page, "toml"))
    rows = re.findall(r"^\| (-?\d+) \| (\d+) \|$", page.read_text(), flags=re.MULTILINE)
    case = (
        FIRST.split("[friction]")[0] + "[friction]\nmodel = 'table'\nfile = 'friction.csv'\n[run]\nduration = '1 ms'\n"
    )
    (folder / file["file"]).write_text(re.search(r"```\n(load .*?)```", page.read_text(), flags=re.DOTALL)[1])
    (folder / "case.toml").write_text(case)
    law = read_case(folder / "case.toml").friction
    assert law.loads == pytest.approx([1e-6 * float(load) for load, _ in rows])
    assert law.limits == pytest.approx([1e-9 * float(limit) for _, limit in rows])
    assert inline["loads"] == [f"{load} uN" for load, _ in rows]
