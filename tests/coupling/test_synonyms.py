"""Synonyms: what other words lead to, that no row is dead, and that what is offered is right."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from sweeps import DISC_PLATE, toml

from active_surface.cli.program import main
from active_surface.steering import AimTables
from active_surface.studies import StudyTables, read_study
from coupling import synonyms
from coupling.case import ActuatorCase, CaseError, CaseTables, InputError, Table, read_case
from coupling.case.friction.laws import CoulombCase
from coupling.case.table import all_tables
from coupling.suggestion import near
from coupling.synonyms import _CHOICES, _ROWS, plain

FILES = (CaseTables, StudyTables, AimTables)
MODELS = list(dict.fromkeys(model for file in FILES for model in all_tables(file)))
COLUMNS = {"time", "x", "y", "z", "loads", "limits"}

CASE = (
    DISC_PLATE
    + 'density = "2330 kg/m^3"\ninertia = true\n\n'
    + toml(
        actuators=[{"position": ["0 um", "0 um"], "stroke": "10 um", "frequency": "500 Hz", "cycle": "sine"}],
        part={"mass": "2e-9 kg", "position": ["100 um", "50 um"]},
        friction={"model": "coulomb", "coefficient": 0.3},
        run={"duration": "50 ms"},
    )
)


def problems(folder: Path, text: str) -> list[str]:
    (folder / "case.toml").write_text(text, encoding="utf-8")
    try:
        read_case(folder / "case.toml")
    except CaseError as error:
        return [f"{problem.field} {problem.message}" for problem in error.problems]
    return []


@pytest.mark.parametrize(
    ("right", "written", "offered"),
    [
        ('radius = "300 um"', 'diameter = "600 um"', 'radius = "300 um"'),
        ('radius = "300 um"', 'D = "0.6 mm"', 'radius = "0.3 mm"'),
        ('youngs_modulus = "169 GPa"', 'E = "169 GPa"', 'youngs_modulus = "169 GPa"'),
        ("poisson_ratio = 0.3", "nu = 0.3", "poisson_ratio = 0.3"),
        ('thickness = "5 um"', 't = "5 um"', 'thickness = "5 um"'),
        ('density = "2330 kg/m^3"', 'rho = "2330 kg/m^3"', 'density = "2330 kg/m^3"'),
        ("inertia = true", "inertia = true\nQ = 50", "damping = 0.01"),
        ("inertia = true", 'inertia = true\nresidual_stress = "10 MPa"', 'tension = "50 N/m"'),
        ("inertia = true", 'inertia = true\nboundary = "fixed"', 'supports = "clamped"'),
        ('frequency = "500 Hz"', 'period = "2 ms"', 'frequency = "500 Hz"'),
        ('frequency = "500 Hz"', 'T = "2 ms"', 'frequency = "500 Hz"'),
        ('frequency = "500 Hz"', 'omega = "3141.592653589793 rad/s"', 'frequency = "500 Hz"'),
        ('frequency = "500 Hz"', 'freq = "500 Hz"', 'frequency = "500 Hz"'),
        ('stroke = "10 um"', 'amplitude = "10 um"', 'stroke = "10 um"'),
        ('stroke = "10 um"', 'peak_to_peak = "20 um"', 'stroke = "10 um"'),
        ('stroke = "10 um"', 'amplitude = "1 mN"', 'force = "1 mN"'),
        ('cycle = "sine"', 'waveform = "sinusoidal"', 'cycle = "sine"'),
        ('cycle = "sine"', 'cycle = "sine"\nphi = "90 deg"', 'phase = "90 deg"'),
        ('cycle = "sine"', 'cycle = "sine"\nphase_deg = 90', 'phase = "90 deg"'),
        ('cycle = "sine"', 'cycle = "sine"\nduration = "10 ms"', "cycles = 5"),
        ("coefficient = 0.3", "mu = 0.3", "coefficient = 0.3"),
        ("coefficient = 0.3", "μ = 0.3".replace("μ", '"μ"'), "coefficient = 0.3"),
        ("coefficient = 0.3", "coefficient = 0.3\nmu_s = 0.4", "static_coefficient = 0.4"),
        ('mass = "2e-9 kg"', 'weight = "2 ug"', 'mass = "2 ug"'),
        ('duration = "50 ms"', 't_end = "50 ms"', 'duration = "50 ms"'),
        ('duration = "50 ms"', 'duration = "50 ms"\ng = "9.81 m/s^2"', 'gravity = "9.81 m/s^2"'),
        ('duration = "50 ms"', 'duration = "50 ms"\nscheme = "fixed"\ndt = "1 us"', 'time_step = "1 us"'),
    ],
)
def test_a_word_leads_to_what_is_meant_and_that_is_right(
    tmp_path: Path, right: str, written: str, offered: str
) -> None:
    text = CASE.replace(right, written)
    (found,) = problems(tmp_path, text)
    assert found.endswith(f"is not known; write {offered}")
    wrong = written.split("\n")[-1]
    assert problems(tmp_path, text.replace(wrong, offered)) == []


@pytest.mark.parametrize(
    ("right", "written", "expected"),
    [
        # In an up-down stroke an amplitude may be half of the way or all of it.
        ('stroke = "10 um"\n', 'amplitude = "10 um"\ndwell = "0 s"\n', "did you mean stroke?"),
        ('duration = "50 ms"', 'duration = "50 ms"\ndt = "1 us"', 'leave it out: the default scheme, "events"'),
        ('frequency = "500 Hz"', 'frequency = "500 Hz"\nperiod = "2 ms"', "frequency is given already; leave out one"),
        ('frequency = "500 Hz"', 'period = "2 mm"', "did you mean frequency? It is 1 over the period"),
        ('frequency = "500 Hz"', 'freq = "500 hz"', 'there is no unit "hz"; did you mean "500 Hz"?'),
        ('mass = "2e-9 kg"', 'weight = "20 nN"', 'did you mean mass? It must be a mass such as "2e-9 kg"; got "20 nN"'),
        ('mass = "2e-9 kg"', 'mass = "2e-9 kg"\ngravity = "1 m/s^2"', "part.gravity is not known; it belongs to [run]"),
        ("coefficient = 0.3", "coefficient = 0.3\nlimit = 3", 'it goes with model = "constant"'),
        ('cycle = "sine"', 'waveform = "square"', 'did you mean cycle? It must be "up-down", "up", "sine" or "cosine"'),
    ],
)
def test_where_the_value_does_not_follow_none_is_offered(
    tmp_path: Path, right: str, written: str, expected: str
) -> None:
    text = CASE.replace(right, written)
    if "dwell" in written:
        text = text.replace('cycle = "sine"\n', "")
    found = problems(tmp_path, text)
    assert [message for message in found if expected in message and "; write" not in message], found


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("circle", ["disc", "rectangle", "polygon"], "disc"),
        ("Hexagon", ["disc", "rectangle", "polygon"], "polygon"),
        ("fixed", ["clamped", "simply-supported", "free"], "clamped"),
        ("pinned", ["clamped", "simply-supported", "free"], "simply-supported"),
        ("fixed", ["immovable", "movable"], "immovable"),
        ("nonlinear", ["linear", "von-karman"], "von-karman"),
        ("freq", ["force", "frequency"], "frequency"),
        ("time", ["time_step", "duration"], "duration"),
        ("simulate", [*main.commands], "run"),
        ("movie", [*main.commands], "animate"),
        ("raduis", ["radius", "thickness"], "radius"),
        ("xylophone", ["radius", "thickness"], None),
    ],
)
def test_near_prefers_what_a_word_means_to_how_it_is_spelt(word: str, known: list[str], meant: str | None) -> None:
    assert near(word, known) == meant


STUDY = """[sweep]
base = "case.toml"
method = "factorial"

[[axis]]
parameter = "actuators.0.freq"
min = "200 Hz"
max = "400 Hz"
n = 5
scale = "log"
"""
AIM = """[aim]
base = "case.toml"
goal = ["10 um", "20 um"]
freq = ["100 Hz", "500 Hz"]
iterations = 1000
robust = 0.9
"""


@pytest.mark.parametrize(
    ("text", "offered"),
    [
        (
            STUDY,
            [
                "sweep is not known; did you mean study?",
                'sweep.base is not known; write case = "case.toml"',
                'sweep.method is not known; write sampling = "grid"',
                "axis is not known; did you mean axes?",
                'axis[0].parameter is not known; write field = "actuators.0.freq"',
                'axis[0].min is not known; write range = ["200 Hz", "400 Hz"]',
                'axis[0].max is not known; write range = ["200 Hz", "400 Hz"]',
                "axis[0].n is not known; write count = 5",
                'axis[0].scale is not known; write spacing = "logarithmic"',
            ],
        ),
        (
            AIM,
            [
                'aim.base is not known; write case = "case.toml"',
                'aim.goal is not known; write target = ["10 um", "20 um"]',
                'aim.freq is not known; write frequency = ["100 Hz", "500 Hz"]',
                "aim.iterations is not known; write paths = 1000",
                "aim.robust is not known; write quantile = 0.9",
            ],
        ),
    ],
    ids=["study", "aim"],
)
def test_studies_and_aims_are_understood_as_well(tmp_path: Path, text: str, offered: list[str]) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    (tmp_path / "other.toml").write_text(text)
    done = CliRunner().invoke(main, ["check", str(tmp_path / "other.toml"), "--json"])
    assert [f"{one['field']} {one['message']}" for one in json.loads(done.stdout)["mistakes"]] == offered


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        ("actuators[0].frequency", "got actuators[0].frequency; write actuators.0.frequency"),
        ("actuators.0.freq", "actuators[0] has no freq; did you mean frequency?"),
        ("plate.diameter", "plate has no diameter; did you mean radius? Its values are not those of the diameter"),
    ],
)
def test_the_field_of_an_axis_is_understood(tmp_path: Path, field: str, expected: str) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    text = f'[study]\ncase = "case.toml"\n[[axes]]\nfield = "{field}"\nvalues = ["200 um", "400 um"]\n'
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(CaseError) as caught:
        read_study(tmp_path / "study.toml")
    assert expected in str(caught.value)


def test_python_is_answered_with_numbers_and_no_key_is_missing_that_has_another_name() -> None:
    with pytest.raises(InputError) as caught:
        CoulombCase(mu=0.3)  # type: ignore[call-arg]
    assert caught.value.problems == [("mu", "is not known; write coefficient = 0.3")]
    with pytest.raises(InputError) as caught:
        ActuatorCase(position=(0.0, 0.0), amplitude=1e-5, period=0.002)  # type: ignore[call-arg]
    assert dict(caught.value.problems) == {
        "amplitude": "is not known; did you mean stroke or force?",  # a number does not tell which
        "period": "is not known; write frequency = 500.0",
    }


def test_every_row_stands_for_what_some_table_has() -> None:
    keys: list[set[str]] = [{*model.model_fields} for model in MODELS] + [COLUMNS]
    dead = [row for row in _ROWS if not any({*row[1].split()} <= there for there in keys)]
    assert dead == []


def test_every_choice_is_one() -> None:
    there = {word for file in FILES for word in re.findall(r'"([\w-]+)"', str(choices_in(file)))}
    commands = {*main.commands} | {word for c in main.commands.values() for p in c.params for word in p.opts}
    assert [choice for _, choice in _CHOICES if choice not in there | commands | {"inner", "outer", "rim"}] == []


def choices_in(file: type[Table]) -> Any:
    from coupling.case import json_schema

    return re.sub("'", '"', str(json_schema(file, "")))


def test_words_are_in_plain_letters_and_stand_in_a_row_once() -> None:
    for words, *_ in [*_ROWS, *_CHOICES]:
        assert [plain(word) for word in words.split()] == words.split()
        assert len({*words.split()}) == len(words.split())


def test_a_word_is_never_led_to_where_its_key_is_not_known() -> None:
    for words, *_ in _ROWS:
        for word in words.split():
            for synonym in synonyms.synonyms(word, CoulombCase.model_fields):
                assert {*synonym.keys} <= {*CoulombCase.model_fields}


@pytest.mark.parametrize(("sides", "name"), [(3, "triangle"), (5, "pentagon"), (6, "hexagon"), (8, "octagon")])
def test_a_regular_polygon_by_its_name_and_side(tmp_path: Path, sides: int, name: str) -> None:
    text = CASE.replace('shape = "disc"', f'shape = "{name}"').replace('radius = "300 um"', 'side = "900 um"')
    shape, side = problems(tmp_path, text)
    assert shape.endswith(f'got "{name}"; write shape = "polygon" and sides = {sides}')
    radius = float(re.search(r'write radius = "([\d.]+) um"', side)[1])  # type: ignore[index]
    assert 2 * radius * math.sin(math.pi / sides) == pytest.approx(900, rel=1e-8)
