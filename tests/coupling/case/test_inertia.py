"""Inertia, damping and steady states in case files: what they may be, and what is wrong with others."""

import re

import numpy as np
import pytest
from case_files import DURATION, STROKE, changed, plate, problems, python_case, read
from click.testing import CliRunner

from active_surface.cli import main
from coupling.case import InputError, find_field
from coupling.scene import damping_of
from coupling.stretch.schedule import schedule_of
from particle import Drive

THICKNESS = 'thickness = "5 um"'
VIBRATES = THICKNESS + '\ndensity = "2330 kg/m^3"\ninertia = true\n'
STEADY = (DURATION, DURATION + '\nstart = "steady"')
ENDLESS = ("cycles = 5\n", "")
A_RATIO = 'a ratio from 0 to below 1, or pairs of a frequency and a ratio, such as [["20 kHz", 0.02], ["80 kHz", 0.01]]'


def test_without_words_a_plate_has_no_inertia(tmp_path):
    case = read(tmp_path, changed())
    assert case.plate.inertia is False and case.plate.damping == 0.02 and case.run.start == "rest"


@pytest.mark.parametrize(
    "written, damping",
    [("0.1", 0.1), ("0", 0.0), ('[["20 kHz", 0.02], ["80 kHz", 0.01]]', ((20e3, 0.02), (80e3, 0.01)))],
)
def test_damping_is_a_ratio_or_pairs(tmp_path, written, damping):
    case = read(tmp_path, changed((THICKNESS, VIBRATES + f"damping = {written}")))
    assert case.plate.inertia is True and case.plate.damping == damping


@pytest.mark.parametrize(
    "written, message",
    [
        ("-0.1", f"must be {A_RATIO}; got -0.1"),
        ("1", f"must be {A_RATIO}; got 1"),
        ('"big"', f'must be {A_RATIO}; got "big"'),
        ("true", f"must be {A_RATIO}; got true"),
        ("nan", f"must be {A_RATIO}; got nan"),
        ("[]", f"must be {A_RATIO}; got []"),
        ('[["20 kHz"]]', f'must be {A_RATIO}; got [["20 kHz"]]'),
        ('[["80 kHz", 0.02], ["20 kHz", 0.01]]', 'must have increasing, positive frequencies; got "20 kHz"'),
        ('[["0 Hz", 0.02]]', 'must have increasing, positive frequencies; got "0 Hz"'),
        (
            "[[20, 0.02]]",
            'in each pair must be a frequency such as "300 Hz"; got 20, which has no unit; in SI units it is "20 Hz"',
        ),
        ('[["20 kHz", 1.5]]', 'must have ratios from 0 to below 1; got 1.5 at "20 kHz"'),
    ],
)
def test_wrong_damping_is_named(tmp_path, written, message):
    (problem,) = problems(tmp_path, changed((THICKNESS, VIBRATES + f"damping = {written}")))
    assert re.sub(r"^line \d+ +", "", problem) == f"plate.damping {message}"


@pytest.mark.parametrize(
    "plate, messages",
    [
        (
            "inertia = true",
            ['plate.density is missing; with inertia = true it must be a density such as "2330 kg/m^3"'],
        ),
        (
            'density = "2330 kg/m^3"\ndamping = 0.1',
            ["plate.damping must not be given without inertia = true; a plate without mass does not vibrate"],
        ),
        ('inertia = "yes"', ['plate.inertia must be true or false; got "yes"; write true, without quotes']),
        (
            "inertia = true\ndamping = 2",
            [
                f"plate.damping must be {A_RATIO}; got 2",
                'plate.density is missing; with inertia = true it must be a density such as "2330 kg/m^3"',
            ],
        ),
    ],
)
def test_what_inertia_takes(tmp_path, plate, messages):
    found = problems(tmp_path, changed((THICKNESS, f"{THICKNESS}\n{plate}")))
    assert sorted(re.sub(r"^line \d+ +", "", problem) for problem in found) == messages


def test_a_plate_of_many_actuators_cannot_vibrate():
    places = [
        {"position": (1e-6 * (k % 16) - 8e-6, 1e-6 * (k // 16)), "stroke": 1e-6, "frequency": 300} for k in range(251)
    ]
    plate = python_case().plate.model_copy(update={"density": 2330.0, "inertia": True})
    with pytest.raises(
        ValueError, match=r"plate.inertia of Case must be false with more than 250 actuators.*got 251; a piece"
    ):
        python_case(plate=plate, actuators=places)


@pytest.mark.parametrize(
    ("frequencies", "period"),
    [(("2 kHz", "1.5 kHz"), None), (("2 kHz", "1745.943 Hz"), "0.5"), (("700 Hz", "2 kHz", "1745.943 Hz"), "10")],
)
def test_a_stretching_plate_has_a_steady_state_where_its_drives_have_a_common_period(frequencies, period):
    """Without one, breakpoints were listed until memory ended."""
    actuators = [
        {"position": (f"{90 * k - 90} um", "30 um"), "stroke": "1 um", "frequency": frequency}
        for k, frequency in enumerate(frequencies)
    ]
    vibrating = plate(density="2330 kg/m^3", theory="von-karman", inertia=True)

    def made():
        return python_case(plate=vibrating, actuators=actuators, run={"duration": "1 ms", "start": "steady"})

    if period is None:
        assert made().run.start == "steady"
        return
    with pytest.raises(InputError, match=rf"got a period of 0.5727564 ms, and {period} ms of those") as error:
        made()
    assert f"actuators[{len(frequencies) - 1}].frequency" in str(error.value)
    drives = [Drive(1e-6, float(word)) for word in (2000.0, 1745.943)]
    assert schedule_of(drives, np.inf).loop == -1 and schedule_of(drives, 1e-3).edges[-1] == 1e-3


def test_a_steady_state_takes_inertia_and_drives_without_end(tmp_path):
    assert read(tmp_path, changed((THICKNESS, VIBRATES), STEADY, ENDLESS)).run.start == "steady"
    inert, ending = sorted(problems(tmp_path, changed(STEADY)), key=lambda line: "actuators" in line)
    assert "run.start must not be given without inertia = true in [plate]" in inert
    assert 'actuators[1].cycles must not be given with start = "steady" in [run]' in ending
    once = changed((THICKNESS, VIBRATES), (STROKE, STROKE + '\ncycle = "up"'), STEADY)
    up, cycles = problems(tmp_path, once)
    assert 'actuators[0].cycle must not be "up" with start = "steady"' in up and "actuators[1].cycles" in cycles
    ramped = changed((THICKNESS, VIBRATES), (STROKE, STROKE + '\ncycle = "sine"\nramp = 2'), STEADY, ENDLESS)
    (ramp,) = problems(tmp_path, ramped)
    assert 'actuators[0].ramp must not be given with start = "steady" in [run], in which no drive begins' in ramp
    table = 'table = [["0 ms", "0 um"], ["1 ms", "1 um"], ["2 ms", "0 um"]]\nrepeats = 3'
    (repeats,) = problems(
        tmp_path, changed((THICKNESS, VIBRATES), (f'{STROKE}\nfrequency = "300 Hz"', table), STEADY, ENDLESS)
    )
    assert 'actuators[0].repeats must be "endless" with start = "steady"' in repeats


def test_the_commands_refuse_with_exit_code_2(tmp_path):
    file = tmp_path / "test.toml"
    file.write_text(changed((THICKNESS, VIBRATES + "damping = 2"), STEADY))
    for command in (["run"], ["response"]):
        result = CliRunner().invoke(main, [*command, str(file), "--output", str(tmp_path / "output")])
        assert result.exit_code == 2
        assert "plate.damping must be a ratio" in result.output and "actuators[1].cycles" in result.output
    file.write_text(changed())
    result = CliRunner().invoke(main, ["response", str(file)])
    assert result.exit_code == 2 and "  plate.density must be given; got none" in result.output


def test_a_table_of_damping_goes_on_beyond_its_ends():
    plate = python_case().plate.model_copy(update={"damping": ((20e3, 0.02), (80e3, 0.01))})
    ratios = damping_of(plate)(np.array([1e3, 20e3, 50e3, 80e3, 1e6]))
    assert ratios == pytest.approx([0.02, 0.02, 0.015, 0.01, 0.01], rel=1e-12)


def test_a_platform_has_no_steady_state(tmp_path):
    platform = '[plate]\nshape = "platform"\nmotion.z = { stroke = "1 um", frequency = "900 Hz" }\n'
    text = changed(STEADY)
    text = platform + text[text.index("[part]") :]
    (problem,) = problems(tmp_path, text)
    assert 'run.start must be "rest" with shape = "platform", which does not vibrate; got "steady"' in problem


def test_a_single_damping_ratio_is_a_field_that_can_be_varied():
    vibrating = python_case(plate=plate(density="2330 kg/m^3", inertia=True))
    field = find_field(vibrating, None, "plate.damping")
    assert (field.kind, field.unit, field.base) == ("number", "1", 0.02) and field.read(0.05) == 0.05
    with pytest.raises(ValueError, match="a ratio from 0 to below 1"):
        field.read(1.5)
    pairs = python_case(plate=plate(density="2330 kg/m^3", inertia=True, damping=[["20 kHz", 0.02], ["80 kHz", 0.01]]))
    with pytest.raises(ValueError, match="must be a single value; got plate.damping"):
        find_field(pairs, None, "plate.damping")


def test_a_free_plate_on_three_actuators_only_tilts():
    places = (("150 um", "0 um"), ("-100 um", "120 um"), ("-80 um", "-130 um"), ("10 um", "20 um"))
    actuators = [{"position": at, "stroke": "1 um", "frequency": "1 kHz"} for at in places]
    free = plate(supports="free", theory="von-karman")
    with pytest.raises(InputError, match=r'theory of Case must be "linear" on a free plate with three actuators'):
        python_case(plate=free, actuators=actuators[:3])
    assert python_case(plate=free, actuators=actuators).plate.theory == "von-karman"
