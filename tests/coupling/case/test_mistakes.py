"""Mistakes in case files: messages that say where one is and what would be right."""

from __future__ import annotations

import pickle
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from case_files import ACTUATOR, DURATION, FRICTION, GOOD, PART, POISSON, RADIUS, STROKE, changed, problems, read
from mistakes import answered_otherwise

from coupling.case import CaseError, Problem, read_case


def test_five_mistakes_at_once(tmp_path: Path) -> None:
    text = changed(
        (RADIUS, 'raduis = "300 um"'),
        (POISSON, "poisson_ratio = 0.5"),
        (STROKE, 'stroke = "150 Hz"'),
        ("cycles = 5", "cycles = 5.0"),
        ("[run]\n" + DURATION, ""),
    )
    with pytest.raises(CaseError) as caught:
        read(tmp_path, text)
    assert str(caught.value) == (
        f"{tmp_path}/test.toml: 5 mistakes\n"
        "  the file  run is missing; it must be a table, written [run]\n"
        "  line 3    plate.raduis is not known; did you mean radius?\n"
        "  line 5    plate.poisson_ratio must be less than 0.5; got 0.5\n"
        '  line 10   actuators[0].stroke must be a length such as "150 um"; got "150 Hz", a frequency\n'
        "  line 20   actuators[1].cycles must be a whole number; got 5.0"
    )
    assert caught.value.problems[3] == Problem(
        10, "actuators[0].stroke", 'must be a length such as "150 um"; got "150 Hz", a frequency'
    )


ROOT = Path(__file__).parents[3]
BROKEN = r"""
stroke = "150 um" ->  => line 8  actuators[0].stroke is missing; it must be a length such as "150 um"
shape = "disc" ->  => line 1  plate.shape is missing; it must be "disc", "rectangle", "annulus", "ellipse", "polygon" or
poisson_ratio = 0.3 ->  => line 1  plate.poisson_ratio is missing; it must be a number
position = ["100 um", "100 um"] ->  => two lengths, x and y, such as ["100 um", "100 um"]
[part] -> [prat] => line 23  prat is not known; did you mean part?
[plate] -> name = "x"\n[plate] => line 1  name is not known; a remark is a comment, which begins with #; write # x
stroke = "150 um" ++ colour = 1 => line 11  actuators[0].colour is not known; [[actuators]] has position, 
[plate] -> [[plate]] => line 1  plate must be a table, written [plate]; got a list of tables
radius = "300 um" -> [plate.radius] => plate.radius must be a length such as "150 um"; got a table
0.3 -> "0.3" => line 5  plate.poisson_ratio must be a number; got "0.3", in quotes
0.3 -> true => plate.poisson_ratio must be a number; got true
0.3 -> nan => plate.poisson_ratio must be a finite number; got nan
0.3 -> -0.1 => plate.poisson_ratio must be at least 0; got -0.1
cycles = 5 -> cycles = 0 => actuators[1].cycles must be at least 1; got 0
cycles = 5 -> cycles = true => actuators[1].cycles must be a whole number; got true
cycles = 5 ++ cycle = "up" => line 20  actuators[1].cycles must not be given with cycle = "up"
cycles = 5 -> cycle = "down" => actuators[1].cycle must be "up-down", "up", "sine" or "cosine"; got "down"
"disc" -> "square" => line 2  plate.shape must be "disc", "rectangle", "annulus", "ellipse", "polygon" or "platform"; go
"300 Hz" -> "0 Hz" => actuators[0].frequency must be greater than 0; got "0 Hz"
"1 ms" -> "-1 ms" => actuators[1].delay must be at least 0; got "-1 ms"
"300 um" -> "-3 um" => plate.radius must be greater than 0; got "-3 um"
radius = "300 um" ++ cell_size = "301 um" => plate.cell_size must not exceed half of the plate's smallest width, 300 um;
+ tolerance = 0.1 => line 32  run.tolerance must be at most 0.01; got 0.1
+ frames = 1 => run.frames must be at least 2; got 1
["100 um", "100 um"] -> "100 um" => line 25  part.position must be two lengths, x and y, such as
["100 um", "100 um"] -> ["1 um"] => such as ["100 um", "100 um"]; got ["1 um"]
["100 um", "100 um"] -> ["1 um", "2 um", "3 um"] => got ["1 um", "2 um", "3 um"]
["100 um", "100 um"] -> ["1 um", 2] => part.position[1] must be a length such as "150 um"; got 2, which has no unit
"0.15 mm" -> "0.15 ms" => line 14  actuators[1].position[0] must be a length
position = ["100 um", "100 um"] ++ velocity = 0 => part.velocity must be two velocities, x and y, such as ["0 m/s", "0 m
["100 um", "100 um"] -> ["300 um", "0 um"] => part.position must be inside the rim; got a point on it
"0.15 mm" -> "-0.3 mm" => line 14  actuators[1].position must be inside the rim; got a point on it
"0.15 mm" -> "0 m" => line 14  actuators[1].position must differ from actuators[0].position; got the same
model = "kogut-etsion" ->  => line 27  friction.model is missing; it must be "kogut-etsion", "constant", "coulomb" or "t
"kogut-etsion" -> 3 => line 28  friction.model must be "kogut-etsion", "constant", "coulomb" or "table"; got 3
[friction] -> [[friction]] => line 27  friction must be a table, written [friction]; got a list of tables
"kogut-etsion" -> "constant" => line 27  friction.limit is missing; it must be a force such as "2 uN"
model = "kogut-etsion" ++ limit = "1 N" => line 29  friction.limit is not known; it goes with model = "constant"
model = "kogut-etsion" ++ rougness = 1 => line 29  friction.rougness is not known; did you mean roughness?
model = "kogut-etsion" ++ asperity_beta = 0.01 => friction.asperity_beta must be greater than 0.01928; got 0.01
model = "kogut-etsion" ++ adhesion_energy = "0 J/m^2" => friction.adhesion_energy must be greater than 0
model = "kogut-etsion" ++ preset = "papers" => friction.preset must be "paper"; got "papers"
model = "kogut-etsion" ++ preset = "paper"\nplasticity_index = 2.5 => line 30  friction.plasticity_index must not be giv
model = "kogut-etsion" ++ coefficients = "unrounded"\npreset = "paper" => line 29  friction.coefficients must be "printe
"kogut-etsion" -> "coulomb"\ncoefficient = 0.3\nstatic_coefficient = 0.2 => friction.static_coefficient must be at least
"300 um" -> 300 um => line 3  is not valid TOML: a value with a unit needs quotes; write radius = "300 um"
"300 um" -> "300 um => line 3  is not valid TOML: a text lacks its closing quote
radius = "300 um" ++ radius = "300 um" => line 4  is not valid TOML: this is given twice
[part] -> [plate] => line 23  is not valid TOML: cannot declare [plate] twice
[[actuators]]  # -> [actuators]  # => line 13  actuators must be written [[actuators]], in double brackets
"""


def test_each_kind_of_mistake(tmp_path: Path) -> None:
    assert answered_otherwise(BROKEN, partial(problems, tmp_path), good=GOOD) == []


def test_places_are_checked_whatever_else_is_wrong(tmp_path: Path) -> None:
    text = changed(
        ("[plate]\n", '[plate]\ndensity = "1 s"\n'),
        (ACTUATOR, 'position = ["0.4 mm", "0 um"]\nspeed = 3\n'),
        ('"0.15 mm"', '"0.4 mm"'),
        (PART, 'position = ["0 um", "-1 mm"]'),
        ('mass = "2e-9 kg"\n', ""),
    )
    outside = "must be inside the rim; got a point"
    assert problems(tmp_path, text) == [
        'line 2   plate.density must be a density such as "2330 kg/m^3"; got "1 s", a time',
        f"line 10  actuators[0].position {outside} 0.1 mm beyond it",
        "line 11  actuators[0].speed is not known; "
        "[[actuators]] has position, force, stiffness, max_stroke, max_force, stroke, frequency, cycle, cycles, dwell, "
        "phase, ramp, "
        "table, segments, repeats, delay",
        f"line 16  actuators[1].position {outside} 0.1 mm beyond it",
        "line 16  actuators[1].position must differ from actuators[0].position; got the same point",
        'line 25  part.mass is missing; it must be a mass such as "2e-9 kg"',
        f"line 26  part.position {outside} 700 um beyond it",
    ]


def test_keys_of_the_friction_table_are_checked_whatever_else_is_wrong(tmp_path: Path) -> None:
    table = FRICTION + '\npreset = "paper"\nroughness = 3\nplasticity_index = 2\ncoefficients = "unrounded"'
    lines = [line.split()[:3] for line in problems(tmp_path, changed((FRICTION, table)))]
    assert lines == [
        ["line", "30", "friction.roughness"],
        ["line", "31", "friction.plasticity_index"],
        ["line", "32", "friction.coefficients"],
    ]


def test_missing_tables(tmp_path: Path) -> None:
    assert problems(tmp_path, "# nothing\n") == [
        f"the file  {name} is missing; it must be a table, written {header}"
        for name, header in [
            ("plate", "[plate]"),
            ("actuators", "[[actuators]]"),
            ("part", "[part]"),
            ("friction", "[friction]"),
            ("run", "[run]"),
        ]
    ]


def test_no_actuators(tmp_path: Path) -> None:
    text = "actuators = []\n" + GOOD[: GOOD.index("[[")] + GOOD[GOOD.index("[part]") :]
    assert problems(tmp_path, text) == ["line 1  actuators must be at least one table, written [[actuators]]; got none"]


@pytest.mark.parametrize("count", [1, 2])
def test_actuators_in_single_brackets(tmp_path: Path, count: int) -> None:
    text = GOOD.replace("[[actuators]]", "[actuators]")
    if count == 1:
        text = text[: text.rindex("[actuators]")] + text[text.index("[part]") :]
    assert problems(tmp_path, text) == [
        "line 8  actuators must be written [[actuators]], in double brackets, once for each actuator; got [actuators]"
    ]


def test_lines_of_dotted_keys_and_inline_tables(tmp_path: Path) -> None:
    text = (
        '# a case\nplate.radius = "3 Hz"\n"plate"."shape" = "x"\npart = { mass = "1 s" }\n'
        'actuators = [{ stroke = "1 s" }]\n[run]\nduration = """\n[plate]\n"""\n  # tab\n  frames = 1\n'
    )
    found = {line.split()[2]: int(line.split()[1]) for line in problems(tmp_path, text) if line.startswith("line")}
    assert found["plate.thickness"] == 2
    assert found["plate.shape"] == 3
    assert found["part.mass"] == found["part.position"] == 4
    assert found["actuators[0].stroke"] == 5
    assert found["run.duration"] == 7
    assert found["run.frames"] == 11


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read_case(tmp_path / "none.toml")
    assert (
        str(caught.value) == f"{tmp_path}/none.toml: 1 mistake\n  the file  cannot be read: no such file or directory"
    )
    with pytest.raises(CaseError, match="is a folder"):
        read_case(str(tmp_path))
    (tmp_path / "latin.toml").write_bytes('[plate]\nradius = "300 µm"\n'.encode("latin-1"))
    with pytest.raises(CaseError, match="line 2  is not UTF-8 text; got the byte 0xb5"):
        read_case(tmp_path / "latin.toml")


def test_case_error_survives_pickling(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, "")
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    assert again.problems == caught.value.problems


@pytest.mark.parametrize(
    ("where", "text"),
    [
        ("friction.file", changed((FRICTION, 'model = "table"\nfile = "a\\u0000"'))),
        ("plate.motion", '[plate]\nshape = "platform"\nmotion = "a\\u0000"\n' + GOOD[GOOD.index("[part]") :]),
    ],
)
def test_a_null_byte_in_the_name_of_a_file_is_told_where_it_is(tmp_path: Path, where: str, text: str) -> None:
    (told,) = problems(tmp_path, text)
    assert f" {where} must be a file that can be read" in told and told.endswith("null character in it")


def test_a_mistake_in_5000_rows_is_reported_with_its_line(tmp_path: Path) -> None:
    rows = "".join(f'["{k} ms", "{k} um"],\n' for k in range(5000))
    text = changed((STROKE + '\nfrequency = "300 Hz"', f'table = [\n{rows}["9 s", 3]]'))
    (problem,) = problems(tmp_path, text)
    assert problem.startswith("line 10 ") and "actuators[0].table[5000][1] must be" in problem


def test_lines_are_right_beside_texts_with_brackets_and_comments(tmp_path: Path) -> None:
    text = changed(
        (STROKE, 'stroke = "[1"  # "]'),
        ("[part]", '[part]\nsize = """\n[\\""" '.replace('\\"""', '"""')),
        ('duration = "50 ms"', "duration = '''\n#{'''"),
    )
    lines = [int(problem.split()[1]) for problem in problems(tmp_path, text)]
    at = [text[: text.index(start)].count("\n") + 1 for start in ('stroke = "[1"', "size =", "duration =")]
    assert lines == at


def test_a_good_case_is_checked_without_numerics_or_pictures() -> None:
    code = (
        "import sys; from active_surface.cli.program import main;"
        "main(['check', 'examples/two_actuators.toml'], standalone_mode=False);"
        "sys.exit(not {'numba', 'scipy', 'pint', 'matplotlib'}.isdisjoint(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.DEVNULL).returncode == 0
