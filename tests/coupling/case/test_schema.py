"""The schemas of files, and their templates."""

from __future__ import annotations

import json
import re
import shutil
import tomllib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.steering import AimTables
from active_surface.studies import StudyTables
from coupling.case import CaseTables
from coupling.case.table import Table, tables_in

EXAMPLES = Path(__file__).parents[3] / "examples"
KINDS = ("case", "study", "aim")
MODELS = {"case": CaseTables, "study": StudyTables, "aim": AimTables}


def schema(kind: str) -> dict:
    done = CliRunner().invoke(main, ["schema", kind])
    assert done.exit_code == 0
    return json.loads(done.stdout)


def checker(kind: str) -> Any:
    validator = pytest.importorskip("jsonschema").Draft202012Validator
    validator.check_schema(schema(kind))
    return validator(schema(kind))


def template(kind: str) -> str:
    done = CliRunner().invoke(main, ["schema", kind, "--template"])
    assert done.exit_code == 0
    return done.stdout


def all_tables(table: type[Table]) -> Iterator[type[Table]]:
    """Yield a table and all those in its fields, some of them several times."""
    yield table
    for field in table.model_fields.values():
        for inner in tables_in(field.annotation):
            yield from all_tables(inner)


def kind_of(path: Path) -> str:
    tables = tomllib.loads(path.read_text())
    return next((kind for kind in ("study", "aim") if kind in tables), "case")


def test_examples_are_right_by_their_schema() -> None:
    checkers = {kind: checker(kind) for kind in KINDS}
    for path in sorted(EXAMPLES.rglob("*.toml")):
        checkers[kind_of(path)].validate(tomllib.loads(path.read_text()))


@pytest.mark.parametrize("kind", KINDS)
def test_no_field_is_without_a_text(kind: str) -> None:
    for table in all_tables(MODELS[kind]):
        assert all(field.description for field in table.model_fields.values()), table
    assert '"default"' not in json.dumps(schema(kind))  # which Python has in SI units


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"300 um"', "300"),
        ('"300 um"', '"300"'),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.5"),
        ("thickness", "thicknes"),
        ('"disc"', '"dics"'),
        ('["0 um", "0 um"]', '["0 um"]'),
        ("[[actuators]]", "[[actuator]]"),
        ("[run]", "[runs]"),
        ("frames = 2", "frames = 1"),
    ],
)
def test_what_a_schema_refuses(old: str, new: str) -> None:
    text = (EXAMPLES.parent / "tests/broken/ranges.toml").read_text()
    for wrong, right in (
        ("0.6", "0.3"),
        ('"-5 um"', '"5 um"'),
        ('"0 Hz"', '"3 Hz"'),
        ("= 0.1\n", "= 1e-9\n"),
        ("= 1\n", "= 2\n"),
    ):
        text = text.replace(wrong, right)
    cases = checker("case")
    assert cases.is_valid(tomllib.loads(text))
    assert old in text
    assert not cases.is_valid(tomllib.loads(text.replace(old, new, 1)))


@pytest.mark.parametrize("kind", KINDS)
def test_a_template_is_fine_as_it_is(kind: str, tmp_path: Path) -> None:
    text = template(kind)
    checker(kind).validate(tomllib.loads(text))
    path = tmp_path / "template.toml"
    path.write_text(text)
    for name in ("one_actuator.toml", "array_3x3.toml"):
        shutil.copy(EXAMPLES / name, tmp_path)
    done = CliRunner().invoke(main, ["check", str(path)])
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize("kind", KINDS)
def test_every_field_stands_in_a_template_as_toml_with_its_text(kind: str) -> None:
    text = template(kind)
    prose = " ".join(line.removeprefix("#").strip() for line in text.splitlines())
    for table in all_tables(MODELS[kind]):
        if table.model_config["extra"] == "forbid":
            for key, field in table.model_fields.items():
                assert f"\n{key} = " in text or f"\n#{key} = " in text or f"{key}]" in text, key
                assert field.description in prose
    for line in text.splitlines():
        if line.startswith("#") and not line.startswith("# ") and " = " in line and not line.startswith("#   "):
            tomllib.loads(line.removeprefix("#"))


def test_a_template_says_what_a_field_is_without_being_given() -> None:
    text = template("case").replace("\n#   ", " ")
    fields = list(re.finditer(r"\. ((?:Required|Optional)[^\n]*)\n#?(\w+) = ", text))
    said = {match[2]: match[1] for match in reversed(fields)}  # where a name comes twice, of the first
    assert said["supports"] == 'Optional, by default "clamped": "clamped", "simply-supported" or "free".'
    assert said["pressure"] == 'Optional, by default "0 Pa": a pressure such as "100 Pa".'
    assert said["top_face"] == "Optional, by default true: true or false."
    assert said["density"].startswith("Optional: a density such as")
    assert said["thickness"].startswith("Required: a length such as")
    assert "Default" not in text


def test_a_schema_refuses_broken_files_but_for_what_depends_on_other_fields_files_or_the_plate() -> None:
    for path in sorted((EXAMPLES.parent / "tests/broken").glob("*.toml")):
        with suppress(tomllib.TOMLDecodeError):
            wrong = list(checker("case").iter_errors(tomllib.loads(path.read_text())))
            assert wrong or path.stem in {"contradictions", "formulas", "measured_points", "outside"}


def test_page_of_the_case_file_has_every_field() -> None:
    page = (EXAMPLES.parent / "docs/case-file.md").read_text()
    fields = {name for table in all_tables(CaseTables) for name in table.model_fields} - set(CaseTables.model_fields)
    assert fields and [name for name in fields if f"`{name}`" not in page] == []
    assert all(f"[{name}]" in page for name in CaseTables.model_fields)
    for block in re.findall(r"```toml\n(.*?)```", page, flags=re.DOTALL):
        tomllib.loads(block)
