"""The fields on the page: every example has them, and what they show is the value that the case has."""

import math

import pytest

from active_surface.app.knobs import ALL, CHOICES, allowed, changes_of, knobs_of
from active_surface.app.opened import example_cases
from active_surface.examples import examples_folder
from coupling.case import InputError, find_field, read_case

CASES = [name for name in example_cases() if "100x100" not in name]


def knobs(case, selected="0"):
    return [knob for group in knobs_of(case, selected) for knob in group["knobs"]]


def test_a_field_shows_the_value_of_the_case_and_its_slider_reaches_it():
    for name in CASES:
        case = read_case(examples_folder() / f"{name}.toml")
        shown = knobs(case)
        assert {"part.mass", "part.position.0", "run.duration"} <= {knob["path"] for knob in shown}
        for knob in shown:
            assert allowed(case, knob["path"]) and knob["help"]
            again = case.vary(changes_of(case, knob["path"], knob["text"]))
            if knob["path"] in CHOICES:
                assert knob["text"] in knob["choices"]
                continue
            base = find_field(case, None, knob["path"]).base
            assert math.isclose(find_field(again, None, knob["path"]).base, base, rel_tol=1e-11, abs_tol=1e-18)
            assert knob["low"] <= knob["value"] <= knob["high"] and knob["low"] < knob["high"]


def test_texts_of_the_ends_of_sliders_are_read():
    case = read_case(examples_folder() / "two_actuators.toml")
    for knob in knobs(case):
        if knob["scale"] == "choice":
            continue
        for end in ("low", "high"):
            text = f"{knob[end]:.4g} {knob['unit']}".strip()
            try:
                case.vary(changes_of(case, knob["path"], text))
            except InputError as error:  # a place off the plate is read, and refused for that
                assert all("inside the rim" in message or "must" in message for _, message in error.problems)


def test_a_length_takes_any_unit_and_a_plain_number_none():
    case = read_case(examples_folder() / "two_actuators.toml")
    assert case.vary(changes_of(case, "friction.roughness", "0.1 um")).friction.roughness == 1e-7
    with pytest.raises(ValueError, match="must be a number such as 0.3, without a unit"):
        changes_of(case, "friction.plasticity_index", "0.1 um")
    with pytest.raises(ValueError, match="must be a whole number such as 5, without a unit"):
        changes_of(case, "actuators.0.cycles", "5 s")


def test_a_change_of_all_actuators_goes_to_each():
    case = read_case(examples_folder() / "two_actuators.toml")
    by_path = {knob["path"]: knob for knob in knobs(case, ALL)}
    assert by_path["actuators.*.stroke"]["text"] == "150 um"
    assert by_path["actuators.*.frequency"]["value"] is None and by_path["actuators.*.frequency"]["text"] == ""
    changed = case.vary(changes_of(case, "actuators.*.frequency", "1 kHz"))
    assert [one.frequency for one in changed.actuators] == [1000.0, 1000.0]


def test_the_plasticity_index_takes_the_place_of_a_preset():
    case = read_case(examples_folder() / "two_actuators.toml")
    changed = case.vary(changes_of(case, "friction.plasticity_index", "3"))
    assert changed.friction.preset is None and changed.friction.plasticity_index == 3


@pytest.mark.parametrize(
    "path", ["plate.mesh", "plate.motion", "friction.file", "plate.shape", "name", "run.frames", "x"]
)
def test_the_page_changes_no_names_of_files(path):
    assert not allowed(read_case(examples_folder() / "two_actuators.toml"), path)


def test_a_part_with_a_face_turns_and_its_own_area_counts():
    point = read_case(examples_folder() / "two_actuators.toml")
    rough = {"friction": {"model": "kogut-etsion", "preset": "paper"}}
    faced = read_case(examples_folder() / "face.toml").vary(rough)
    only_one = {"part.heading", "part.sides.0", "part.sides.1", "part.thickness", "friction.contact_area"}
    assert only_one & {knob["path"] for knob in knobs(point)} == {"friction.contact_area"}
    assert only_one - {knob["path"] for knob in knobs(faced)} == {"friction.contact_area"}
    turned = faced.vary(changes_of(faced, "part.heading", "-30 deg") | changes_of(faced, "part.sides.0", "50 um"))
    assert turned.part.heading == pytest.approx(-math.pi / 6) and turned.part.sides == (50e-6, 100e-6)


def test_fields_have_their_units_and_take_any():
    case = read_case(examples_folder() / "transport.toml")
    units = {"actuators.0.stroke": "m", "actuators.*.frequency": "Hz", "plate.youngs_modulus": "Pa", "part.mass": "kg"}
    assert {path: find_field(case, None, path).unit for path in units} == units
    assert find_field(case, None, "actuators.0.stroke").read("5 um") == 5e-6
