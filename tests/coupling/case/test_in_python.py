"""Cases that are built in Python."""

from __future__ import annotations

import math
import pickle

import pytest
from case_files import JARGON, plate, python_case
from pydantic import ValidationError

from coupling.case import ActuatorCase, Case, CoulombCase, InputError, PartCase


@pytest.mark.parametrize(
    ("what", "gap", "inside"),
    [
        *(("part", 2e-9, True), ("part", 5e-10, False), ("part", 0, False)),
        *(("actuator", 7e-4, True), ("actuator", 5e-4, False), ("actuator", 0, False)),
    ],
)
def test_the_rim_itself_is_outside(what: str, gap: float, inside: bool) -> None:
    place = (0.6 * 300e-6 * (1 - gap), -0.8 * 300e-6 * (1 - gap))

    def build() -> Case:
        if what == "part":
            return python_case(part={"mass": 2e-9, "position": place})
        return python_case(actuators=[{"position": place, "stroke": 0, "frequency": 1}])

    if inside:
        build()
    else:
        with pytest.raises(InputError, match="inside the rim"):
            build()


@pytest.mark.parametrize(("apart", "distinct"), [(1e-6, True), (3e-12, True), (1e-13, False), (0, False)])
def test_actuators_need_points_of_their_own(apart: float, distinct: bool) -> None:
    actuators = [ActuatorCase(position=(x, 0), stroke=0, frequency=1) for x in (0, apart, 1e-4)]
    if distinct:
        python_case(actuators=actuators)
    else:
        with pytest.raises(InputError, match="must differ from"):
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
    with pytest.raises(InputError, match="^Input radius of DiscCase must be .*; got "):
        plate(radius=radius)


def test_an_actuator_is_checked_in_python_though_another_table_is_wrong() -> None:
    wrong = ActuatorCase(position=(1, 0), stroke=0, frequency=1)
    with pytest.raises(InputError) as caught:
        python_case(actuators=[wrong], run={"duration": -1})
    assert str(caught.value) == (
        "Input run.duration of Case must be greater than 0; got -1.0\n"
        "Input actuators[0].position of Case must be inside the rim; got a point 999700 um beyond it"
    )
    assert [field for field, _ in caught.value.problems] == ["run.duration", "actuators[0].position"]


def test_everything_wrong_is_said_at_once_in_the_words_of_files() -> None:
    with pytest.raises(InputError) as caught:
        python_case(plate={"shape": "dics"}, part={"mass": "3 s", "positon": (0, 0)}, friction={"model": "colomb"})
    said = str(caught.value).splitlines()
    assert 'Input part.mass of Case must be a mass such as "2e-9 kg"; got "3 s", a time' in said
    assert "Input part.positon of Case is not known; did you mean position?" in said
    wrong = [line for line in said if line.startswith("Input friction.model of Case must be")]
    assert wrong and wrong[0].endswith('; got "colomb"; did you mean "coulomb"?')
    assert any(line.endswith('; got "dics"; did you mean "disc"?') for line in said)
    assert not JARGON.search(str(caught.value))


def test_an_input_error_survives_pickling() -> None:
    with pytest.raises(InputError) as caught:
        PartCase(mass=-1, position=3)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def test_a_case_made_of_classes_is_varied() -> None:
    """Which law of friction it is was said by the class alone."""
    assert (
        python_case(friction=CoulombCase(coefficient=0.3)).vary({"friction.coefficient": 0.4}).friction.coefficient
        == 0.4
    )
