"""The case file reader: values in SI units, and messages that say where a mistake is and what would be right."""

from __future__ import annotations

import math
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from coupling.case import (
    ActuatorCase,
    Case,
    CaseError,
    ConstantCase,
    CoulombCase,
    KogutEtsionCase,
    PartCase,
    Problem,
    RunCase,
    read_case,
)
from coupling.plate_case import DiscCase
from coupling.units import Quantity

GOOD = """\
[plate]
shape = "disc"
radius = "300 um"
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"

[[actuators]]
position = ["0 um", "0 um"]
stroke = "150 um"
frequency = "300 Hz"

[[actuators]]  # on the x axis
position = [
    "0.15 mm",
    "0 um",
]
stroke = "-10 um"
frequency = "0.2 kHz"
cycles = 5
delay = "1 ms"

[part]
mass = "2e-9 kg"
position = ["100 um", "100 um"]

[friction]
model = "kogut-etsion"

[run]
duration = "50 ms"
"""
ACTUATOR = 'position = ["0 um", "0 um"]\n'
STROKE = 'stroke = "150 um"'
RADIUS = 'radius = "300 um"'
PART = 'position = ["100 um", "100 um"]'
FRICTION = 'model = "kogut-etsion"'
POISSON = "poisson_ratio = 0.3"
DURATION = 'duration = "50 ms"'

JARGON = re.compile(
    r"input should|extra inputs|field required|valid (dictionary|number|integer|string|tuple|list)|pydantic|https?:"
    r"|value error|type=|input_|discriminator|\btag\b|NoneType|\bdict\b|\bstr\b|\bfloat\b|\bint\b|Traceback|Ellipsis",
    re.IGNORECASE,
)


def changed(*changes: tuple[str, str]) -> str:
    """Return the good file with each old text replaced once."""
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def read(folder: Path, text: str) -> Case:
    file = folder / "test.toml"
    file.write_text(text, encoding="utf-8")
    return read_case(file)


def problems(folder: Path, text: str) -> list[str]:
    """Return the lines of the message about `text`, without the first."""
    with pytest.raises(CaseError) as caught:
        read(folder, text)
    first, *lines = str(caught.value).split("\n")
    count = len(caught.value.problems)
    assert first == f"{folder / 'test.toml'}: {count} mistake{'s' if count > 1 else ''}"
    assert len(lines) == count
    assert not JARGON.search("\n".join(lines)), lines
    return [line.strip() for line in lines]


def plate(**changes: Any) -> DiscCase:
    values = {"shape": "disc", "radius": 3e-4, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
    return DiscCase(**{**values, **changes})


def python_case(**changes: Any) -> Case:
    values = {
        "plate": plate(),
        "actuators": [{"position": ("0 um", 1e-6), "stroke": "150 um", "frequency": 300}],
        "part": {"mass": 2e-9, "position": ["0.1 mm", "100 um"]},
        "friction": CoulombCase(coefficient=0.3),
        "run": {"duration": "50 ms"},
    }
    return Case(**{**values, **changes})


def test_good_file_is_read_to_si(tmp_path: Path) -> None:
    case = read(tmp_path, GOOD)
    assert case == Case(
        plate=plate(),
        actuators=(
            ActuatorCase(position=(0, 0), stroke=150e-6, frequency=300),
            ActuatorCase(position=(150e-6, 0), stroke=-10e-6, frequency=200, cycles=5, delay=1e-3),
        ),
        part=PartCase(mass=2e-9, position=(100e-6, 100e-6)),
        friction=KogutEtsionCase(),
        run=RunCase(duration=50e-3),
        name="test",
        source=GOOD,
    )


def test_defaults(tmp_path: Path) -> None:
    case = read(tmp_path, GOOD)
    assert (case.plate.supports, case.plate.density, case.plate.cell_size) == ("clamped", None, None)
    first = case.actuators[0]
    assert (first.cycle, first.cycles, first.delay) == ("up-down", None, 0.0)
    assert (case.part.velocity, case.part.size) == ((0.0, 0.0), None)
    assert (case.run.gravity, case.run.tolerance, case.run.frames) == (9.80665, 1e-9, None)
    assert case.friction.model_dump() == {
        "model": "kogut-etsion",
        "preset": None,
        "roughness": 20e-9,
        "contact_area": 1e-8,
        "hardness": 1.96133e9,
        "poisson_ratio": 0.3,
        "adhesion_energy": 1.0,
        "plasticity_index": 2.5,
        "asperity_beta": 0.0601,
        "intermolecular_distance": 0.3e-9,
        "coefficients": "printed",
    }


def test_every_key(tmp_path: Path) -> None:
    case = read(
        tmp_path,
        changed(
            (RADIUS, RADIUS + '\nsupports = "clamped"\ndensity = "2.33 g/cm^3"\ncell_size = "300 µm"'),
            (POISSON, "poisson_ratio = 0"),
            (STROKE, 'stroke = "0 um"\ncycle = "up"'),
            (PART, PART + '\nvelocity = ["1 mm/s", "-2 mm/s"]\nsize = "100 um"'),
            (DURATION, DURATION + '\ngravity = "-1 m/s²"\ntolerance = 1e-2\nframes = 2'),
        ),
    )
    assert case.plate.density == pytest.approx(2330)
    assert case.plate.cell_size == 300e-6
    assert case.plate.poisson_ratio == 0
    assert (case.actuators[0].stroke, case.actuators[0].cycle) == (0, "up")
    assert (case.part.velocity, case.part.size) == ((1e-3, -2e-3), 100e-6)
    assert (case.run.gravity, case.run.tolerance, case.run.frames) == (-1, 1e-2, 2)


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (FRICTION + '\npreset = "paper"', KogutEtsionCase(preset="paper")),
        (FRICTION + '\ncoefficients = "unrounded"', KogutEtsionCase(coefficients="unrounded")),
        ('model = "constant"\nlimit = "41.8 nN"', ConstantCase(limit=41.8e-9)),
        ('model = "constant"\nlimit = "0 N"', ConstantCase(limit=0)),
        ('model = "coulomb"\ncoefficient = 0.3', CoulombCase(coefficient=0.3, adhesion=0)),
        (
            'model = "coulomb"\ncoefficient = 0.3\nadhesion = "2 uN"\nstatic_coefficient = 0.3',
            CoulombCase(coefficient=0.3, adhesion=2e-6, static_coefficient=0.3),
        ),
    ],
)
def test_friction_models(tmp_path: Path, table: str, expected: object) -> None:
    assert read(tmp_path, changed((FRICTION, table))).friction == expected


def test_preset_sets_the_plasticity_index() -> None:
    assert KogutEtsionCase(preset="paper").plasticity_index == 4.9128
    assert KogutEtsionCase(preset="paper", coefficients="printed").coefficients == "printed"


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
        '  line 10   actuators[1].stroke must be a length such as "150 um"; got "150 Hz", a frequency\n'
        "  line 20   actuators[2].cycles must be a whole number; got 5.0"
    )
    assert caught.value.problems[3] == Problem(
        10, "actuators[1].stroke", 'must be a length such as "150 um"; got "150 Hz", a frequency'
    )


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ('"150 Hz"', ", a frequency"),
        ('"20 degC"', ", a temperature"),
        ('"5 K*m"', ", a quantity in K * m"),
        ('"50 %"', ", a plain number"),
        ('"150 umm"', ', but there is no unit "umm"; did you mean "150 um"?'),
        ('"150 UM"', ', but there is no unit "UM"; did you mean "150 um"?'),
        ('"5 frobs/umm"', ', but there is no unit "frobs"'),
        ('"150"', ", which has no unit"),
        ("150", ", which has no unit"),
        ("0", ", which has no unit"),
        ("nan", ", which has no unit"),
        ('"nan um"', ", which is not finite"),
        ('"-inf um"', ", which is not finite"),
        ('"1e999 um"', ", which is not finite"),
        ('"1e308 km"', ", which is not finite"),
        ('"1,5 mm"', "; write decimals with a point"),
        ('""', ", which is not a number and a unit"),
        ('"um"', ", which is not a number and a unit"),
        ('"far away"', ", which is not a number and a unit"),
        ('"\N{MINUS SIGN}5 um"', ", which is not a number and a unit"),
        ('"5 um; 3"', ", which is not a number and a unit"),
        ('"5 (um"', ", which is not a number and a unit"),
        ('"1/300 um"', ", which is not a number and a unit"),
        ("true", ""),
        ('["1 um"]', ""),
        ("1979-05-27", ""),
    ],
)
def test_wrong_lengths(tmp_path: Path, value: str, reason: str) -> None:
    found = problems(tmp_path, changed((STROKE, f"stroke = {value}")))
    assert found == [f'line 10  actuators[1].stroke must be a length such as "150 um"; got {value}{reason}']


def test_an_angular_velocity_is_not_a_frequency(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, changed(('"300 Hz"', '"60 rpm"')))
    assert found.endswith('must be a frequency such as "300 Hz"; got "60 rpm", an angular velocity')


BROKEN = [
    # Keys and tables
    ((STROKE, ""), 'line 8  actuators[1].stroke is missing; it must be a length such as "150 um"'),
    (
        ('shape = "disc"', ""),
        'line 1  plate.shape is missing; it must be "disc", "rectangle", "annulus", "ellipse", "polygon" or "platf',
    ),
    ((POISSON, ""), "line 1  plate.poisson_ratio is missing; it must be a number"),
    ((PART, ""), 'two lengths, x and y, such as ["100 um", "100 um"]'),
    (("[part]", "[prat]"), "line 23  prat is not known; did you mean part?"),
    (
        ("[plate]", 'name = "x"\n[plate]'),
        "line 1  name is not known; the file has [plate], [[actuators]], [lattice], [part]",
    ),
    ((STROKE, STROKE + "\ncolour = 1"), "line 11  actuators[1].colour is not known; [[actuators]] has position, "),
    (("[plate]", "[[plate]]"), "line 1  plate must be a table, written [plate]; got a list of tables"),
    ((RADIUS, "[plate.radius]"), 'plate.radius must be a length such as "150 um"; got a table'),
    ((GOOD, "actuators = 3\nplate = 1\n" + GOOD[GOOD.index("[part]") :]), "line 2  plate must be a table, written"),
    # Numbers and choices
    ((POISSON, 'poisson_ratio = "0.3"'), 'line 5  plate.poisson_ratio must be a number; got "0.3", in quotes'),
    ((POISSON, "poisson_ratio = true"), "plate.poisson_ratio must be a number; got true"),
    ((POISSON, "poisson_ratio = nan"), "plate.poisson_ratio must be a finite number; got nan"),
    ((POISSON, "poisson_ratio = -0.1"), "plate.poisson_ratio must be at least 0; got -0.1"),
    (("cycles = 5", "cycles = 0"), "actuators[2].cycles must be at least 1; got 0"),
    (("cycles = 5", "cycles = true"), "actuators[2].cycles must be a whole number; got true"),
    (("cycles = 5", 'cycles = 5\ncycle = "up"'), 'line 20  actuators[2].cycles must not be given with cycle = "up"'),
    (("cycles = 5", 'cycle = "down"'), 'actuators[2].cycle must be "up-down", "up", "sine" or "cosine"; got "down"'),
    (
        ('shape = "disc"', 'shape = "square"'),
        'line 2  plate.shape must be "disc", "rectangle", "annulus", "ellipse", "polygon" or "platform"; got "square"',
    ),
    (('"300 Hz"', '"0 Hz"'), 'actuators[1].frequency must be greater than 0; got "0 Hz"'),
    (('"1 ms"', '"-1 ms"'), 'actuators[2].delay must be at least 0; got "-1 ms"'),
    ((RADIUS, 'radius = "-3 um"'), 'plate.radius must be greater than 0; got "-3 um"'),
    (
        (RADIUS, RADIUS + '\ncell_size = "301 um"'),
        'plate.cell_size must not exceed half of the plate\'s smallest width, 300 um; got "301 um"',
    ),
    ((DURATION, DURATION + "\ntolerance = 0.1"), "line 32  run.tolerance must be at most 0.01; got 0.1"),
    ((DURATION, DURATION + "\nframes = 1"), "run.frames must be at least 2; got 1"),
    # Positions
    ((PART, 'position = "100 um"'), "line 25  part.position must be two lengths, x and y, such as"),
    ((PART, 'position = ["1 um"]'), 'such as ["100 um", "100 um"]; got ["1 um"]'),
    ((PART, 'position = ["1 um", "2 um", "3 um"]'), 'got ["1 um", "2 um", "3 um"]'),
    ((PART, 'position = ["1 um", 2]'), 'part.position[2] must be a length such as "150 um"; got 2, which has no unit'),
    (('"0.15 mm"', '"0.15 ms"'), "line 14  actuators[2].position[1] must be a length"),
    (
        (PART, PART + "\nvelocity = 0"),
        'part.velocity must be two velocities, x and y, such as ["0 m/s", "0 m/s"]; got 0',
    ),
    ((PART, 'position = ["300 um", "0 um"]'), "part.position must be inside the rim; got a point on it"),
    (('"0.15 mm"', '"-0.3 mm"'), "line 14  actuators[2].position must be inside the rim; got a point on it"),
    (('"0.15 mm"', '"0 m"'), "line 14  actuators[2].position must differ from actuators[1].position; got the same"),
    # Friction
    ((FRICTION, ""), 'line 27  friction.model is missing; it must be "kogut-etsion", "constant", "coulomb" or "table"'),
    (
        (FRICTION, "model = 3"),
        'line 28  friction.model must be "kogut-etsion", "constant", "coulomb" or "table"; got 3',
    ),
    (("[friction]", "[[friction]]"), "line 27  friction must be a table, written [friction]; got a list of tables"),
    ((FRICTION, 'model = "constant"'), 'line 27  friction.limit is missing; it must be a force such as "2 uN"'),
    ((FRICTION, FRICTION + '\nlimit = "1 N"'), 'line 29  friction.limit is not known; [friction] with model = "kogut-'),
    ((FRICTION, FRICTION + "\nrougness = 1"), "line 29  friction.rougness is not known; did you mean roughness?"),
    ((FRICTION, FRICTION + "\nasperity_beta = 0.01"), "friction.asperity_beta must be greater than 0.01928; got 0.01"),
    ((FRICTION, FRICTION + '\nadhesion_energy = "0 J/m^2"'), "friction.adhesion_energy must be greater than 0"),
    ((FRICTION, FRICTION + '\npreset = "papers"'), 'friction.preset must be "paper"; got "papers"'),
    (
        (FRICTION, FRICTION + '\npreset = "paper"\nplasticity_index = 2.5'),
        'line 30  friction.plasticity_index must not be given with preset = "paper", which sets it to 4.9128',
    ),
    (
        (FRICTION, FRICTION + '\ncoefficients = "unrounded"\npreset = "paper"'),
        'line 29  friction.coefficients must be "printed" with preset = "paper"',
    ),
    (
        (FRICTION, 'model = "coulomb"\ncoefficient = 0.3\nstatic_coefficient = 0.2'),
        "friction.static_coefficient must be at least coefficient, 0.3; got 0.2",
    ),
    # Text that is not TOML
    (
        (RADIUS, "radius = 300 um"),
        "line 3  is not valid TOML: expected newline or end of document after a statement; a "
        'value with a unit needs quotes, "300 um"',
    ),
    ((RADIUS, 'radius = "300 um'), "line 3  is not valid TOML: a text lacks its closing quote"),
    ((RADIUS, RADIUS + "\n" + RADIUS), "line 4  is not valid TOML: this is given twice"),
    (("[part]", "[plate]"), "line 23  is not valid TOML: cannot declare [plate] twice"),
    (("[[actuators]]  #", "[actuators]  #"), "line 13  actuators must be written [[actuators]], in double brackets"),
]


@pytest.mark.parametrize(("change", "expected"), BROKEN)
def test_each_kind_of_mistake(tmp_path: Path, change: tuple[str, str], expected: str) -> None:
    found = problems(tmp_path, changed(change))
    assert any(expected in line for line in found), found


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
        f"line 10  actuators[1].position {outside} 0.1 mm beyond it",
        "line 11  actuators[1].speed is not known; "
        "[[actuators]] has position, force, stiffness, stroke, frequency, cycle, cycles, dwell, table, segments, "
        "repeats, delay",
        f"line 16  actuators[2].position {outside} 0.1 mm beyond it",
        "line 16  actuators[2].position must differ from actuators[1].position; got the same point",
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
    assert problems(tmp_path, "") == [
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
    assert found["actuators[1].stroke"] == 5
    assert found["run.duration"] == 7
    assert found["run.frames"] == 11


@pytest.mark.parametrize(
    ("distance", "inside"), [(299.999, True), (300 * (1 - 2e-9), True), (300 * (1 - 5e-10), False), (300, False)]
)
def test_the_rim_itself_is_outside(distance: float, inside: bool) -> None:
    def build() -> Case:
        return python_case(
            actuators=[{"position": (0.6e-6 * distance, -0.8e-6 * distance), "stroke": 0, "frequency": 1}]
        )

    if inside:
        build()
    else:
        with pytest.raises(ValidationError, match="inside the rim"):
            build()


@pytest.mark.parametrize(("apart", "distinct"), [(1e-6, True), (3e-12, True), (1e-13, False), (0, False)])
def test_actuators_need_points_of_their_own(apart: float, distinct: bool) -> None:
    actuators = [ActuatorCase(position=(x, 0), stroke=0, frequency=1) for x in (0, apart, 1e-4)]
    if distinct:
        python_case(actuators=actuators)
    else:
        with pytest.raises(ValidationError, match="must differ from"):
            python_case(actuators=actuators)


def test_building_in_python() -> None:
    case = python_case()
    assert case.actuators[0].position == (0.0, 1e-6)
    assert case.actuators[0].stroke == 150e-6
    assert case.part.position == (1e-4, 1e-4)
    assert (case.name, case.source) == ("case", None)
    assert python_case(name="other").name == "other"
    with pytest.raises(ValidationError, match="frozen"):
        case.name = "new"


@pytest.mark.parametrize("radius", ["3 Hz", "3", math.nan, True, -1.0, None, [1.0]])
def test_wrong_values_in_python(radius: object) -> None:
    with pytest.raises(ValidationError):
        plate(radius=radius)


def test_an_actuator_is_checked_in_python_though_another_table_is_wrong() -> None:
    wrong = ActuatorCase(position=(1, 0), stroke=0, frequency=1)
    with pytest.raises(ValidationError) as caught:
        python_case(actuators=[wrong], run={"duration": -1})
    assert {error["loc"] for error in caught.value.errors()} == {("actuators", 0, "position"), ("run", "duration")}


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read_case(tmp_path / "none.toml")
    assert (
        str(caught.value) == f"{tmp_path}/none.toml: 1 mistake\n  the file  cannot be read: no such file or directory"
    )
    with pytest.raises(CaseError, match="cannot be read: is a directory"):
        read_case(str(tmp_path))
    (tmp_path / "latin.toml").write_bytes('[plate]\nradius = "300 µm"\n'.encode("latin-1"))
    with pytest.raises(CaseError, match="line 2  is not UTF-8 text; got the byte 0xb5"):
        read_case(tmp_path / "latin.toml")


def test_windows_text(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_bytes(("\ufeff" + GOOD.replace("\n", "\r\n")).encode())
    assert read_case(tmp_path / "case.toml").part.mass == 2e-9
    (tmp_path / "case.toml").write_bytes(GOOD.replace("\n", "\r\n").replace('"50 ms"', "50").encode())
    with pytest.raises(CaseError, match="line 31  run.duration"):
        read_case(tmp_path / "case.toml")


def test_case_error_survives_pickling(tmp_path: Path) -> None:
    with pytest.raises(CaseError) as caught:
        read(tmp_path, "")
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    assert again.problems == caught.value.problems


@pytest.mark.parametrize(
    ("unit", "text", "value"),
    [
        ("m", "150um", 150e-6),
        ("m", " .5 µm ", 0.5e-6),
        ("m", "1_000 nm", 1e-6),
        ("m", "+1 in", 0.0254),
        ("m^2", "1e4 um²", 1e-8),
        ("Hz", "300 1/s", 300),
        ("m/s", "5 m·s⁻¹", 5),
        ("J/m^2", "50 mN/m", 0.05),
        ("kg/m^3", "2.33 g / cm**3", 2330),
    ],
)
def test_units(unit: str, text: str, value: float) -> None:
    assert Quantity(unit, "").parse(text) == pytest.approx(value, rel=1e-15)


def test_import_does_not_load_pint() -> None:
    code = "import coupling.case, sys; sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], cwd=Path(__file__).parents[2]).returncode == 0
