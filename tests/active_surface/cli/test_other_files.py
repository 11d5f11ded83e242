"""Files that are no case, and names that are no files: each is named as what it is, with what to do."""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from active_surface.cli.command import Answer
from active_surface.cli.program import main
from coupling.suggestion import near_file

EXAMPLES = Path(__file__).parents[3] / "examples"
GOOD = (EXAMPLES / "one_actuator.toml").read_text(encoding="utf-8")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("one_actuator.toml", "two_actuators.toml", "transport.toml"):
        (tmp_path / "examples").mkdir(exist_ok=True)
        shutil.copy(EXAMPLES / name, tmp_path / "examples" / name)
    shutil.copytree(EXAMPLES / "studies", tmp_path / "examples/studies")
    shutil.copytree(EXAMPLES / "aims", tmp_path / "examples/aims")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(*words: str) -> str:
    done = CliRunner().invoke(main, words, prog_name="active-surface")
    assert (done.exit_code, done.stdout) == (2, ""), done.output
    assert "Traceback" not in done.stderr
    return done.stderr


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("exampels/transport.toml", "examples/transport.toml"),
        ("exmaples/transprot.toml", "examples/transport.toml"),
        ("examples/transport", "examples/transport.toml"),
        ("examples/transport.tmol", "examples/transport.toml"),
        ("examples/two_actuator.toml", "examples/two_actuators.toml"),
        ("examples/studies/moderat", "examples/studies/moderate.toml"),
        ("elsewhere/nothing.toml", None),
        ("zebra.toml", None),
    ],
)
def test_a_file_that_is_not_there_leads_to_the_one_that_is_meant(folder: Path, written: str, meant: str | None) -> None:
    assert near_file(Path(written)) == (Path(meant) if meant else None)
    hint = f"; did you mean {meant}?" if meant else ""
    assert refused("check", written) == (
        f"{written}: 1 mistake\n  the file  cannot be read: no such file or directory{hint}\n"
    )


OTHERS = [
    ("first.plate.vtkhdf", b"\x89HDF\r\n\x1a\n", "; `active-surface view first.plate.vtkhdf` shows a result"),
    ("points.csv", b"load [uN], limit [nN]\n", "is not valid TOML"),
    ("wide.toml", GOOD.encode("utf-16"), "is not UTF-8 text, as cases, studies and aims must be"),
    ("latin.toml", "# 5 µm\n".encode("latin-1"), "is not UTF-8 text; got the byte 0xb5; save it as UTF-8"),
    ("zipped.toml", b"PK\x03\x04\0\0", "is not UTF-8 text"),
]


@pytest.mark.parametrize("command", ["check", "run", "feasibility", "response"])
def test_another_file_is_named_as_what_it_is(folder: Path, command: str) -> None:
    for name, content, said in OTHERS if command == "check" else OTHERS[:1]:
        (folder / name).write_bytes(content)
        message = refused(command, name)
        assert message.startswith(f"{name}: 1 mistake\n") and said in message and len(message.splitlines()) == 2


def test_a_byte_order_mark_and_tabs_are_no_mistake(folder: Path) -> None:
    (folder / "mark.toml").write_bytes(b"\xef\xbb\xbf" + GOOD.replace(" = ", "\t=\t").encode())
    assert CliRunner().invoke(main, ["check", "mark.toml"]).exit_code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["examples/transport.toml"], "is a case; write active-surface run examples/transport.toml"),
        (["examples/studies/starts.toml"], "is a study; write active-surface sweep examples/studies/starts.toml"),
        (["examples/aims/to_target.toml"], "is an aim; write active-surface aim examples/aims/to_target.toml"),
        (["examples"], "is a folder; name a file in it"),
        (["run", "examples/studies/starts.toml"], "a study; write active-surface sweep examples/studies/starts.toml"),
        (["run", "examples/aims/to_target.toml"], "an aim; write active-surface aim examples/aims/to_target.toml"),
        (["sweep", "examples/transport.toml"], "a case; write active-surface run examples/transport.toml"),
        (["sweep", "examples/aims/to_target.toml"], "an aim; write active-surface aim examples/aims/to_target.toml"),
        (
            ["aim", "examples/studies/starts.toml"],
            "CASE must be an aim or a case; got examples/studies/starts.toml, a study; "
            "write active-surface sweep examples/studies/starts.toml",
        ),
        (
            ["plan", "examples/studies/starts.toml", "--through", "0,0"],
            "a study; write active-surface sweep examples/studies/starts.toml",
        ),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_file_without_its_command_or_with_another_is_told_which(folder: Path, words: list[str], said: str) -> None:
    message = refused(*words)
    assert said in message and len(message.splitlines()) == 2


def test_every_command_refuses_a_file_that_is_not_there(folder: Path) -> None:
    needed = {"aim": ["--target", "0,0"], "plan": ["--through", "0,0"], "identify": ["--track", "none.csv"]}
    needed |= {
        "compare": ["none.toml"],
        "export": ["--format", "csv"],
        "influence": ["-l", "npz"],
        "fit": ["none.toml"],
    }
    before = sorted(folder.rglob("*"))
    for name in sorted({*main.commands} - {"completion", "reproduce", "schema", "verify"}):
        assert "none" in refused(name, "none.toml", *needed.get(name, [])), name
    assert sorted(folder.rglob("*")) == before


@pytest.mark.skipif(sys.platform == "win32", reason="has no such names")
@pytest.mark.parametrize("name", [b"a\xff.toml", b"a\x1b[31mred.toml", b"a\nb.toml"])
def test_a_name_that_cannot_be_printed_is_refused_and_does_not_reach_the_terminal(folder, name):
    Path(os.fsdecode(name)).write_text(GOOD)
    said = refused("check", os.fsdecode(name))
    assert "the file  must have a name that can be printed, as its results have it, too; got U+" in said
    assert "\x1b" not in said
    assert "\x1b" not in refused("run", os.fsdecode(name[:-1]))  # which names the file that is meant


@pytest.mark.parametrize("stem", ["no\xa0break", "a\u200db", "größe 5 µm"])
def test_other_names_are_taken(folder, stem):
    Path(f"{stem}.toml").write_text(GOOD)
    assert CliRunner().invoke(main, ["check", f"{stem}.toml"]).exit_code == 0


def test_a_terminal_gets_no_commands_from_what_was_found(folder, capsys):
    Answer({}, [("label", "a\x1b[31m")], ["b\x9b\u202e"], [Path("c\x1b[0m")]).show(False, False)
    said = capsys.readouterr().out
    assert "a\\u001b[31m" in said and "b\\u009b\\u202e" in said and "c\\u001b[0m" in said and "\x1b[31m" not in said
    broken = GOOD.replace('shape = "disc"', 'shape = "\\u009b\\u202e"')
    Path("case.toml").write_text(broken)
    done = CliRunner().invoke(main, ["check", "case.toml", "--json"])
    assert "\x9b" not in done.stdout and "\x9b\u202e" in json.loads(done.stdout)["mistakes"][0]["message"]


def test_a_name_leaves_room_for_those_of_results(folder):
    said = "must have a name of at most 200 bytes, as its results have it, too; got 210\n"
    Path("é" * 100 + ".toml").write_text(GOOD)
    assert CliRunner().invoke(main, ["check", "é" * 100 + ".toml"]).exit_code == 0
    Path("é" * 105 + ".toml").write_text(GOOD)
    assert refused("check", "é" * 105 + ".toml").endswith(said)


def test_texts_of_a_file_do_not_reach_the_terminal_as_commands(folder):
    Path("case.toml").write_text(GOOD.replace('shape = "disc"', 'shape = "\\u001b[2J\\u202e"'))
    said = refused("check", "case.toml")
    assert "\\u001b[2J\\u202e" in said and "\x1b" not in said
