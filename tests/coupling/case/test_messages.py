"""The messages about twelve broken case files, word for word, and what a schema makes of these."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling.case import CaseTables
from coupling.case.writing.schema import json_schema

ROOT = Path(__file__).parents[3]
BROKEN = sorted((ROOT / "tests/broken").glob("*.toml"))
BEYOND_A_SCHEMA = {"contradictions", "formulas", "measured_points", "outside"}
"""Of these it finds some mistakes at most: they depend on other fields, other files or the plate."""


def test_there_are_twelve() -> None:
    assert len(BROKEN) == 12


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_the_message_is_word_for_word_as_written_beside_the_file(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    done = CliRunner().invoke(main, ["check", path.name])
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == path.with_suffix(".txt").read_text()


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_the_documents_show_the_file_and_its_message(path: Path) -> None:
    page = (ROOT / "docs/messages.md").read_text()
    assert path.with_suffix(".txt").read_text() in page
    assert f"(../tests/broken/{path.name})" in page


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_every_line_that_is_named_has_the_field(path: Path) -> None:
    lines = path.read_text().splitlines()
    told = re.findall(r"(?m)^  line (\d+) +([\w.\[\]]+) (?:must|is not known)", path.with_suffix(".txt").read_text())
    for number, field in told:
        assert field.split(".")[-1].partition("[")[0] in lines[int(number) - 1]


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_json_has_the_same_mistakes(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    done = CliRunner().invoke(main, ["check", path.name, "--json"])
    assert (done.exit_code, done.stderr) == (2, "")
    told = path.with_suffix(".txt").read_text()
    mistakes = json.loads(done.stdout)["mistakes"]
    assert f"{len(mistakes)} mistake" in told
    for mistake in mistakes:
        assert f"{mistake['field']} {mistake['message']}".strip() in told
        assert mistake["file"] == path.name
        assert mistake["line"] is None or f"line {mistake['line']} " in told


@pytest.mark.parametrize("path", BROKEN, ids=lambda path: path.stem)
def test_the_schema_refuses_them_where_it_can(path: Path) -> None:
    try:
        tables = tomllib.loads(path.read_text())
    except tomllib.TOMLDecodeError:
        return
    checker = pytest.importorskip("jsonschema").Draft202012Validator(json_schema(CaseTables, "A case"))
    wrong = list(checker.iter_errors(tables))
    assert wrong or path.stem in BEYOND_A_SCHEMA
