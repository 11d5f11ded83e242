"""The messages about twelve broken case files, word for word, and what a schema makes of these."""

from __future__ import annotations

import json
import re
import tomllib
from contextlib import suppress
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


def test_the_message_is_word_for_word_as_written_beside_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """And so is that in the documents; every line that is named has the field, and JSON has the same mistakes."""
    page = (ROOT / "docs/messages.md").read_text()
    assert len(BROKEN) == 12
    for path in BROKEN:
        monkeypatch.chdir(path.parent)
        done = CliRunner().invoke(main, ["check", path.name])
        said = path.with_suffix(".txt").read_text()
        assert (done.exit_code, done.stdout, done.stderr) == (2, "", said)
        assert said in page and f"(../tests/broken/{path.name})" in page
        lines = path.read_text().splitlines()
        for number, field in re.findall(r"(?m)^  line (\d+) +([\w.\[\]]+) (?:must|is not known)", said):
            assert field.split(".")[-1].partition("[")[0] in lines[int(number) - 1]
        done = CliRunner().invoke(main, ["check", path.name, "--json"])
        assert (done.exit_code, done.stderr) == (2, "")
        mistakes = json.loads(done.stdout)["mistakes"]
        assert f"{len(mistakes)} mistake" in said
        for mistake in mistakes:
            assert f"{mistake['field']} {mistake['message']}".strip() in said and mistake["file"] == path.name
            assert mistake["line"] is None or f"line {mistake['line']} " in said


def test_the_schema_refuses_them_where_it_can() -> None:
    checker = pytest.importorskip("jsonschema").Draft202012Validator(json_schema(CaseTables, "A case"))
    for path in BROKEN:
        with suppress(tomllib.TOMLDecodeError):
            wrong = list(checker.iter_errors(tomllib.loads(path.read_text())))
            assert wrong or path.stem in BEYOND_A_SCHEMA
