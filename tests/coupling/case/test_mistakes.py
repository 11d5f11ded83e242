"""Mistakes in case files: messages that say where one is and what would be right."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from case_files import (
    GOOD,
    JARGON,
    TEXTS,
    answered_otherwise,
    changed,
    plate,
    problems,
    python_case,
    read,
    text,
)
from click.testing import CliRunner

from active_surface.cli.program import main
from coupling.case import (
    ActuatorCase,
    Case,
    CaseError,
    CoulombCase,
    InputError,
    LatticeCase,
    MeshCase,
    PartCase,
    parse,
    read_case,
)
from coupling.suggestion import near

ROOT = Path(__file__).parents[3]
BROKEN = sorted((ROOT / "tests/broken").glob("*.toml"))


def test_each_mistake_is_named_with_its_line_and_nothing_else_is(tmp_path: Path) -> None:
    table = Path(__file__).with_name("mistakes.txt").read_text()
    assert answered_otherwise(table, partial(problems, tmp_path), **TEXTS) == []


def test_the_message_is_word_for_word_as_written_beside_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """And so are those in the documents; every line that is named has the field, and JSON has the same mistakes."""
    page = (ROOT / "docs/messages.md").read_text()
    shown = re.findall(r"(?ms)^```\n(\w+\.toml: \d+ mistakes?\n.*?)^```", page)
    assert len(BROKEN) == 12 and len(shown) == 3
    assert set(shown) <= {path.with_suffix(".txt").read_text() for path in BROKEN}
    for path in BROKEN:
        monkeypatch.chdir(path.parent)
        done = CliRunner().invoke(main, ["check", path.name])
        said = path.with_suffix(".txt").read_text()
        assert (done.exit_code, done.stdout, done.stderr) == (2, "", said)
        assert f"(../tests/broken/{path.name})" in page
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


WRONG_KEYS = (
    ('radius = "300 um"', 'raduis = "300 um"'),
    ("poisson_ratio = 0.3", "poisson_ratio = 0.5"),
    ('stroke = "150 um"', 'stroke = "150 Hz"\ndwell = "1 ms"\ncycle = "sine"'),
    ("cycles = 5", "cycles = 5.0"),
    ('[run]\nduration = "50 ms"', ""),
)
ROUNDS = [
    (
        WRONG_KEYS,
        "  the file  run is missing; it must be a table, written [run]\n"
        "  line 3    plate.raduis is not known; did you mean radius?\n"
        "  line 5    plate.poisson_ratio must be less than 0.5; got 0.5\n"
        '  line 10   actuators[0].stroke must be a length such as "150 um"; got "150 Hz", a frequency\n'
        "  line 22   actuators[1].cycles must be a whole number; got 5.0",
    ),
    # What depends on several keys of a table is said once each of these is right, whatever other tables have.
    (
        (*WRONG_KEYS[:2], ('stroke = "150 um"', 'stroke = "150 um"\ndwell = "1 ms"\ncycle = "sine"')),
        "  line 3   plate.raduis is not known; did you mean radius?\n"
        "  line 5   plate.poisson_ratio must be less than 0.5; got 0.5\n"
        '  line 11  actuators[0].dwell must not be given with cycle = "sine"; it is the rest after each stroke of '
        '"up-down"',
    ),
    # What depends on several tables is said once all of them are right.
    (
        (
            ('"0.15 mm"', '"0.4 mm"'),
            ('["100 um", "100 um"]', '["0 um", "-1 mm"]'),
            ("[run]", '[run]\nstart = "steady"'),
        ),
        "  line 14  actuators[1].position must be inside the rim; got a point 100 um beyond it\n"
        '  line 20  actuators[1].cycles must not be given with start = "steady" in [run], which takes a drive without '
        "end\n"
        "  line 25  part.position must be inside the rim; got a point 700 um beyond it\n"
        "  line 31  run.start must not be given without inertia = true in [plate]; only then do vibrations build up",
    ),
]


@pytest.mark.parametrize(("changes", "said"), ROUNDS)
def test_all_that_can_be_said_is_said_at_once(tmp_path: Path, changes: tuple[tuple[str, str], ...], said: str) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, changed(*changes))
    lines = said.split("\n")
    assert str(caught.value) == f"{tmp_path}/test.toml: {len(lines)} mistakes\n{said}"
    assert [re.sub(r"  (the file|line \d+) +", "", line) for line in lines] == [
        f"{problem.field} {problem.message}" for problem in caught.value.problems
    ]


def test_a_file_without_tables_lacks_each(tmp_path: Path) -> None:
    headers = ["[plate]", "[[actuators]]", "[part]", "[friction]", "[run]"]
    assert problems(tmp_path, "# nothing\n") == [
        f"0 {header.strip('[]')} is missing; it must be a table, written {header}" for header in headers
    ]


def test_lines_are_right_beside_dotted_keys_inline_tables_and_texts_with_brackets(tmp_path: Path) -> None:
    content = (
        '# a case\nplate.radius = "3 Hz"\n"plate"."shape" = "x"\npart = { mass = "1 s", size = """\n[" """ }\n'
        "actuators = [{ stroke = \"[1\"  },  # \"]\n{ cycles = 0 }]\n[run]\nduration = '''\n#{\n[plate]\n'''\n"
        "  # tab\n  frames = 1\n"
    )
    found = {line.split()[1]: int(line.split()[0]) for line in problems(tmp_path, content)}
    assert found == {
        **{"friction": 0, "plate.shape": 3, "part.mass": 4, "part.size": 4, "part.position": 4},
        **{"actuators[0].stroke": 6, "actuators[0].position": 6, "actuators[1].position": 6, "actuators[1].cycles": 6},
        **{"run.duration": 9, "run.frames": 14},
    }


def test_a_mistake_in_5000_rows_is_reported_with_its_line(tmp_path: Path) -> None:
    rows = "".join(f'["{k} ms", "{k} um"],\n' for k in range(5000))
    wrong = changed(('stroke = "150 um"\nfrequency = "300 Hz"', f'table = [\n{rows}["9 s", 3]]'))
    (problem,) = problems(tmp_path, wrong)
    assert problem.startswith("10 actuators[0].table[5000][1] must be")


def test_a_file_of_windows_has_the_same_lines(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(("\ufeff" + GOOD.replace("\n", "\r\n")).encode())
    assert read_case(tmp_path / "case.toml").part.mass == 2e-9
    (tmp_path / "case.toml").write_bytes(GOOD.replace("\n", "\r\n").replace('"50 ms"', "50").encode())
    with pytest.raises(CaseError, match="line 31  run.duration"):
        read_case(tmp_path / "case.toml")


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    contents: dict[str, tuple[bytes, str]] = {
        "test.toml": (b"", "run is missing"),
        "latin.toml": (
            '[plate]\nradius = "300 µm"\n'.encode("latin-1"),
            "line 2  is not UTF-8 text; got the byte 0xb5",
        ),
        "wide.toml": (GOOD.encode("utf-16"), "the file  is not UTF-8 text"),
        "binary.toml": (b"a = 1\0", "the file  is not UTF-8 text"),
        "long" * 51: (b"", "must have a name of at most 200 bytes"),
        "new\nline.toml": (b"", "must have a name that can be printed, .*; got U\\+000A in it"),
        "large.toml": (b" " * (2**24 + 1), "cannot be read: it has more than 16 MiB, the most that is read"),
    }
    for name, (data, said) in contents.items():
        (tmp_path / name).write_bytes(data)
        with pytest.raises(CaseError, match=said):
            read_case(tmp_path / name)
    with pytest.raises(CaseError, match="the file  must be named by a path, as text; got None"):
        read_case(None)
    (tmp_path / "digits.toml").write_text(GOOD.replace("cycles = 5", "cycles = 0x" + "f" * 5000))
    with pytest.raises(
        CaseError, match="line 20  .*cycles must be at most 1e.09; got a whole number of more than 300 dig"
    ):
        read_case(tmp_path / "digits.toml")
    for path, said in {
        "none.toml": "the file  cannot be read: no such file or directory$",
        "tset.toml": rf"no such file or directory; did you mean {tmp_path}/test.toml\?$",
        "": "is a folder; name a file in it$",
        "a\0b": "must have a name that can be printed",
        "\ud800": "must have a name that can be printed",
    }.items():
        with pytest.raises(CaseError, match=said):
            read_case(tmp_path / path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_or_a_device_is_no_file(tmp_path: Path) -> None:
    for name in ("pipe.csv", "pipe.toml"):
        os.mkfifo(tmp_path / name)
    with pytest.raises(CaseError, match="it is a pipe or a device, not a file"):
        read_case(tmp_path / "pipe.toml")
    for name in ("pipe.csv", "/dev/zero"):
        found = problems(tmp_path, f'{TEXTS["platform"]}motion = "{name}"\n')
        assert "it is a pipe or a device, not a file" in found[0]


BRACKETS = "[" * 60
PAIRS = ", ".join('["0.0 ms", "0.5 um"]' for _ in range(40))
POINTS = ", ".join(f'["{k} ms", "{k % 7} um"]' for k in range(3000))
DEEP = "must not have tables or lists nested more than 20 deep"


@pytest.mark.parametrize(
    ("line", "wrong"),
    [
        ("a = " + "[" * 5000 + "]" * 5000, DEEP),
        (".".join("a" * 3000) + " = 1", DEEP),
        ("[" + ".".join("a" * 3000) + "]", DEEP),
        ("a = " + "1" * 5000, "is not valid TOML: a number has too many digits"),
        (f'table = [{POINTS}, ["3000 ms]]', "is not valid TOML: "),
        (f"table = [{POINTS}$]", "is not valid TOML: "),
        (f'table = [{POINTS}, ["3000 ms" "1 um"]]', "is not valid TOML: "),
    ],
    ids=["lists", "keys", "tables", "digits", "text", "list", "comma"],
)
def test_texts_that_would_take_without_end(tmp_path: Path, line: str, wrong: str) -> None:
    (tmp_path / "case.toml").write_text(
        f"# {BRACKETS} 12\n[plate]\nb = [{PAIRS}]\n{line}\n\nc = [{PAIRS}] # {BRACKETS}"
    )
    with pytest.raises(CaseError) as caught:
        parse(tmp_path / "case.toml")
    (problem,) = caught.value.problems
    assert problem.message.startswith(wrong)
    assert problem.line == (4 if line.startswith("table") else None)


def test_meshes_are_refused_with_all_that_is_wrong(tmp_path: Path) -> None:
    nodes, cells = "3\n1 0 0 0\n2 400 0 0\n3 0 400 9\n", "1\n1 2 2 0 1 1 2 3\n"
    (tmp_path / "mesh.msh").write_text(
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{cells}$EndElements\n"
    )
    (tmp_path / "d.msh").mkdir()
    for name, said in {
        "mesh.msh": "must be a plane mesh of triangles with named boundaries; .*mesh.msh has 1 point off the plane of "
        r"the others, at \(0, 400, 9\); an unnamed boundary: 3 edges",
        "nowhere.msh": 'must be a file that can be read; got "nowhere.msh"',
        "d.msh": "must be .*d.msh",
        Path(__file__).as_posix(): "must be a .msh file of gmsh, a .vtu or",
    }.items():
        (problem,) = problems(tmp_path, text(f'mesh = "{name}"', "200 um, 60 um"))
        assert re.match(f"2 plate.mesh {said}", problem), problem


THIN = {"shape": "polygon", "corners": [(0, 0), (1e-4, 0), (1e-4, 1e-170)], "wafer": "100", "thickness": 1e-6}
IN_PYTHON: list[tuple[Callable[[], object], str]] = [
    (lambda: plate(radius=None), 'radius of DiscCase must be a length such as "150 um"; got None'),
    (lambda: plate(radius=float("nan")), 'radius of DiscCase must be a length such as "150 um"; got nan, which is not'),
    (lambda: plate(radius=-1.0), "radius of DiscCase must be greater than 0; got -1.0"),
    (lambda: plate(hue=1), "hue of DiscCase is not known; it has supports, theory"),
    (lambda: MeshCase(mesh="a", thickness=1.0), "youngs_modulus of MeshCase is missing"),
    (lambda: CoulombCase(mu=0.3), "mu of CoulombCase is not known; did you mean coefficient?"),
    (lambda: PartCase(mass=-1, position=3), "mass of PartCase must be greater than 0; got -1"),
    (lambda: ActuatorCase(position=(0, 0), table=[[0, 0], [1, 1]], ramp=2), "ramp of ActuatorCase must not be given"),
    (lambda: LatticeCase(rows=1, columns=2, pitch=1.0, stroke="t um", frequency=1), "stroke of LatticeCase must be an"),
    (lambda: python_case(run=3), "run of Case must be a table, written [run]; got 3"),
    (lambda: python_case(actuators=3), "actuators of Case must be written [[actuators]], in double brackets, once for"),
    (lambda: python_case(hue=1), "hue of Case is not known; the file has [plate], [[actuators]], [lattice], [part], ["),
    (lambda: python_case(name=1), "name of Case must be text; got 1"),
    (lambda: python_case(run={"duration": -1}), "run.duration of Case must be greater than 0; got -1"),
    (
        lambda: python_case(actuators=[ActuatorCase(position=(1, 0), stroke=0, frequency=1)]),
        "actuators[0].position of Case must be inside the rim; got a point 999700 um beyond it",
    ),
    (
        lambda: python_case(plate={"shape": "dics"}, part={"mass": "3 s", "positon": 3}, friction={"model": "colomb"}),
        'plate.shape of Case must be "disc", "rectangle", "annulus", "ellipse", "polygon" or "platform"; got "dics"; '
        'did you mean "disc"?\n'
        'Input part.mass of Case must be a mass such as "2e-9 kg"; got "3 s", a time\n'
        "Input part.positon of Case is not known; did you mean position?\n"
        'Input friction.model of Case must be "kogut-etsion", "constant", "coulomb" or "table"; got "colomb"; did you '
        'mean "coulomb"?',
    ),
    (lambda: python_case().vary({"part.mas": 1}), "part.mas of Case must be a field of the case; part has no mas; did"),
    (lambda: Case.model_validate(3), "of Case must be a table of its fields; got 3"),
    (lambda: PartCase.model_validate({"mass": 3}), "position of PartCase is missing; it must be two lengths, x and y"),
    (
        lambda: python_case().vary("x"),
        'changes of vary must give values by the paths of their fields, such as {"part.m',
    ),
    (lambda: python_case().vary({1: 2}), "changes of vary must give values by the paths of their fields, such as {"),
    (
        lambda: python_case().vary({"part.mass": 10**400}),
        'part.mass of Case must be a mass such as "2e-9 kg"; got a whol',
    ),
    (
        lambda: python_case().vary({"run.frames": 10**5000}),
        "run.frames of Case must be at most 1e+06; got a whole numb",
    ),
    (
        lambda: python_case().vary({"part": 3, "part.mass": 1}),
        "part.mass of Case must be in a table or list that has i",
    ),
    (
        lambda: python_case().vary({"actuators": [], "actuators.0.stroke": 1}),
        "actuators.0.stroke of Case must be in a table or list that has it; got [] there",
    ),
    (
        lambda: python_case().vary({"actuators[0].stroke": 3}),
        "actuators[0].stroke of Case must be a field of the case; got actuators[0].stroke; write actuators.0.stroke",
    ),
    (
        lambda: python_case(plate=THIN),
        "plate.corners of Case must be at most 1000 times as long as wide; got 5e+165 ti",
    ),
    (lambda: python_case().vary({"run": 3}), "run of Case must be a table, written [run]; got 3"),
    (
        lambda: python_case().vary({"lattice.rows": 3}),
        "lattice.rows of Case must be a field of the case; it has no [la",
    ),
    (
        lambda: python_case().vary({"actuators.1.stroke": 3}),
        "actuators.1.stroke of Case must be a field of the case; it",
    ),
    (
        lambda: python_case().vary({"actuators.*.strok": 1, "part.mass": "-1 g"}),
        "actuators.*.strok of Case must be a field of the case; actuators[0] has no strok; did you mean stroke?\n"
        'Input part.mass of Case must be greater than 0; got "-1 g"',
    ),
]


@pytest.mark.parametrize(("make", "said"), IN_PYTHON, ids=[said.split(" ")[0] for _, said in IN_PYTHON])
def test_python_is_answered_in_the_words_of_files(make: Callable[[], object], said: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value).startswith(f"Input {said}")
    assert not JARGON.search(str(caught.value).replace("None", ""))
    assert len(caught.value.problems) == str(caught.value).count("Input ")


def test_errors_survive_pickling(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, "")
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and again.problems == caught.value.problems
    with pytest.raises(InputError) as refused:
        PartCase(mass=-1, position=3)
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("circle", ["disc", "rectangle", "polygon"], "disc"),
        ("Fixed", ["clamped", "simply-supported", "free"], "clamped"),
        ("freq", ["force", "frequency"], "frequency"),
        ("E", ["youngs_modulus", "c11"], "youngs_modulus"),
        ("t", ["thickness", "duration"], "thickness"),
        ("d", ["thickness", "delay"], None),
        ("raduis", ["radius", "thickness"], "radius"),
        ("xylophone", ["radius", "thickness"], None),
    ],
)
def test_near_prefers_what_a_word_means_to_how_it_is_spelt(word: str, known: list[str], meant: str | None) -> None:
    assert near(word, known) == meant


def test_commands_refuse_with_exit_code_2_and_leave_nothing(tmp_path: Path) -> None:
    file = tmp_path / "test.toml"
    wrong = {
        changed(("poisson_ratio = 0.3", "poisson_ratio = 0.5")): "plate.poisson_ratio must be less than 0.5",
        changed(('"kogut-etsion"', '"kogut-etsion"\nadhesion_energy = "1e3 J/m^2"')): "Inputs of KogutEtsion must give",
        changed(
            ('"kogut-etsion"', '"kogut-etsion"\nplasticity_index = 50.0')
        ): "Inputs of KogutEtsion must give a pull",
    }
    for content, said in wrong.items():
        file.write_text(content)
        for command in ("run", "check"):
            done = CliRunner().invoke(main, [command, str(file)])
            assert done.exit_code == 2 and isinstance(done.exception, SystemExit)
            assert said in done.output and "Traceback" not in done.output
    assert list(tmp_path.iterdir()) == [file]
    file.write_text(GOOD)
    done = CliRunner().invoke(main, ["response", str(file)])
    assert done.exit_code == 2 and "  plate.density must be given; got none" in done.output


def test_a_plate_may_move_where_that_is_asked_for(tmp_path: Path) -> None:
    (tmp_path / "free.toml").write_text(text("rectangle", plate='supports = "free"'))
    assert read_case(tmp_path / "free.toml", may_move=True).plate.supports == "free"
    (tmp_path / "free.toml").write_text(text("rectangle", "3 mm, 0 um", plate='supports = "free"'))
    with pytest.raises(CaseError, match="1 mistake\n.*position must be inside the rim"):
        read_case(tmp_path / "free.toml", may_move=True)


def test_a_good_case_is_checked_without_numerics_or_pictures() -> None:
    code = (
        "import sys; from active_surface.cli.program import main;"
        "main(['check', 'examples/two_actuators.toml'], standalone_mode=False);"
        "sys.exit(not {'numba', 'scipy', 'pint', 'matplotlib'}.isdisjoint(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.DEVNULL).returncode == 0
