"""Texts that are not quite TOML: every line that is wrong is reported at once, with the line that is right."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from case_files import GOOD, problems

from coupling.case.parsing.repair import repaired
from coupling.case.parsing.toml_file import parse


@pytest.mark.parametrize(
    ("line", "right", "value"),
    [
        ("a = 300 um", 'a = "300 um"', "300 um"),
        ("a = 300um  # wide", 'a = "300um"  # wide', "300um"),
        ("a = 1e-9 kg", 'a = "1e-9 kg"', "1e-9 kg"),
        ("a = 2330 kg/m^3", 'a = "2330 kg/m^3"', "2330 kg/m^3"),
        ("a = 90°", 'a = "90°"', "90°"),
        ("a = [0 um, -50 um]", 'a = ["0 um", "-50 um"]', ["0 um", "-50 um"]),
        ("a = True", "a = true", True),
        ("a = FALSE", "a = false", False),
        ("a = yes", "a = true", True),
        ("a = 0,3", "a = 0.3", 0.3),
        ("a = .3", "a = 0.3", 0.3),
        ("a = 3.", "a = 3.0", 3.0),
        ("a = disc", 'a = "disc"', "disc"),
        ("a = von-karman", 'a = "von-karman"', "von-karman"),
        ("a: 3", "a = 3", 3),
        ('a := "x"', 'a = "x"', "x"),
        ("a = 3;", "a = 3", 3),
        ("a = 3 // three", "a = 3", 3),
        ('a = "300 um', 'a = "300 um"', "300 um"),
        ("a = '300 um\"", 'a = "300 um"', "300 um"),
        ("a = \"300 um'  # wide", 'a = "300 um"  # wide', "300 um"),
        ('a = ["0 um" "5 um"]', 'a = ["0 um", "5 um"]', ["0 um", "5 um"]),
        ("a = (1, 2)", "a = [1, 2]", [1, 2]),
        ("a =\N{NO-BREAK SPACE}3", None, 3),
    ],
)
def test_a_line_is_understood_and_said_as_it_must_be(line: str, right: str | None, value: object) -> None:
    with pytest.raises(tomllib.TOMLDecodeError):
        tomllib.loads(line)
    text, wrong = repaired(f"b = 1\n{line}\nc = 2\n")
    assert tomllib.loads(text) == {"a": value, "b": 1, "c": 2}
    assert [(one.line, one.message.partition("; write ")[2]) for one in wrong] == ([(2, right)] if right else [])


def test_every_line_is_reported_with_the_mistakes_in_its_tables(tmp_path: Path) -> None:
    text = GOOD.replace('"disc"', "“disc”").replace("poisson_ratio = 0.3", "poisson_ratio = 0,6")
    text = text.replace('duration = "50 ms"', "duration = 50 mm")
    assert text.count("“") == text.count("0,6") == text.count("50 mm") == 1
    found = problems(tmp_path, text)
    assert [line.split("  ")[0] for line in found] == ["line 2", "line 5", "line 5", "line 31", "line 31"]
    assert "curly quote “" in found[0] and "poisson_ratio = 0.6" in found[1] and "less than 0.5" in found[2]
    assert found[3].endswith('write duration = "50 mm"') and "a length" in found[4]


def test_curly_quotes_are_reported_once_and_are_no_mistake_in_texts_and_comments(tmp_path: Path) -> None:
    (first, *more) = repaired("a = “x”\nb = ‘y’\nc = „z“ # “\n")[1]
    assert more == [] and first == (1, "", 'has the curly quote “; write the straight one, ", here and in 2 more lines')
    assert repaired('a = "“x”" # ‘\n')[1] == []


@pytest.mark.parametrize("text", ["a = 1\na = 2", "a = [1, 2", "= 3", "a b = 3", "[plate\nx = 1"])
def test_what_is_not_clear_is_left_to_the_reader(text: str) -> None:
    left, wrong = repaired(text)
    assert left == text and len(wrong) == 1 and "; write" not in wrong[0].message


def test_single_brackets_become_double_ones() -> None:
    text, wrong = repaired("[actuators]\na = 1\n[actuators]\na = 2\n")
    assert tomllib.loads(text) == {"actuators": [{"a": 1}, {"a": 2}]}
    assert [(one.line, one.field) for one in wrong] == [(1, "actuators")]


def test_a_right_text_is_left_as_it_is(tmp_path: Path) -> None:
    assert repaired(GOOD) == (GOOD, [])
    (tmp_path / "good.toml").write_text(GOOD)
    assert parse(tmp_path / "good.toml").problems == ()
