"""The phase and the ramp of drives as axes of a study."""

import math

import pytest
from sweeps import PLATE

from coupling import read_case
from coupling.case import find_field

CASE = PLATE.replace('"400 Hz"', '"400 Hz"\ncycle = "sine"')
CASE = CASE.replace('"300 Hz"', '"300 Hz"\ncycle = "cosine"\nphase = "20 deg"')


@pytest.fixture
def case(tmp_path):
    (tmp_path / "wave.toml").write_text(CASE)
    return read_case(tmp_path / "wave.toml")


@pytest.mark.parametrize(
    ("path", "value", "unit", "read"),
    [
        ("actuators.1.phase", "90 deg", "rad", math.pi / 2),
        ("actuators.*.phase", "1 turn", "rad", 2 * math.pi),
        ("actuators.*.ramp", 3, "1", 3.0),
        ("actuators.0.ramp", 0.5, "1", 0.5),
    ],
)
def test_phase_and_ramp_can_be_varied(case, path, value, unit, read):
    field = find_field(case, None, path)
    assert (field.unit, field.kind, field.read(value)) == (unit, "number", pytest.approx(read))
    (key,) = {location[-1] for location in field.locations}
    varied = case.vary({path: field.read(value)})
    for k, actuator in enumerate(varied.actuators):
        expected = read if ("actuators", k, key) in field.locations else getattr(case.actuators[k], key)
        assert getattr(actuator, key) == pytest.approx(expected)


def test_a_wrong_phase_is_refused_in_words(case):
    with pytest.raises(ValueError, match='must be an angle such as "90 deg"; got "3 um", a length'):
        find_field(case, None, "actuators.0.phase").read("3 um")
