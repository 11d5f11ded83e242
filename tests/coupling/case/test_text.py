"""A case written down is the same case when it is read again, to the last bit."""

import os
from pathlib import Path

import pytest
from sweeps import LATTICE, PLATE

from coupling import read_case, read_parts
from coupling.case import Case
from coupling.case.writing.text import case_text, write_case

EXAMPLES = Path(__file__).parents[3] / "examples"
FILES = [
    file for file in sorted(EXAMPLES.rglob("*.toml")) if "[run]" in file.read_text() and "100x100" not in file.name
]

FRICTION = """\
[friction]
model = "table"
loads = ["-1 uN", "0 uN", "2.2 uN", "5 uN"]
limits = ["4 nN", "18.7 nN", "35 nN", "52 nN"]
"""
VIBRATES = 'density = "2330 kg/m^3"\ninertia = true\n'
SEGMENTS = """\
[[actuators]]
position = ["0 um", "33.3 um"]
repeats = "endless"

[[actuators.segments]]
stroke = "7.1 um"
frequency = "331.7 Hz"
cycles = 3

[[actuators.segments]]
cycle = "hold"
dwell = "0.123456789 ms"

[[actuators]]
position = ["0 um", "-33.3 um"]
table = [["0 ms", "0 um"], ["1.1 ms", "50.3 um"], ["3 ms", "-20 um"]]
delay = "0.1 us"

[[actuators]]
position = ["50 um", "-33.3 um"]
force = "1.23e-7 N"
frequency = "330 Hz"

"""


def told(case):
    """All of a case but its name and text, with whole paths of files."""
    found = case.model_dump(exclude={"name", "source"})
    for key in ("mesh", "motion"):
        if isinstance(found["plate"].get(key), str):
            found["plate"][key] = os.path.realpath(found["plate"][key])
    return found


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_every_example_comes_back(file, tmp_path):
    case = read_parts(file)[0]
    again = read_case(write_case(case, tmp_path / "deep" / "again.toml", "One line.\nAnother."))
    assert told(again) == told(case) and again.name == "again"
    assert again.source.startswith("# One line.\n# Another.\n\n[plate]\n")


@pytest.mark.parametrize(
    "text",
    [
        LATTICE,
        PLATE[: PLATE.index("[[actuators]]")] + SEGMENTS + PLATE[PLATE.index("[part]") :],
        PLATE[: PLATE.index("[friction]")] + FRICTION + PLATE[PLATE.index("[run]") :],
        PLATE + 'gravity = ["0.1 m/s^2", "0 m/s^2", "-9.8 m/s^2"]\nafter_detachment = "fly"\ntolerance = 1e-7\n',
        PLATE.replace('radius = "300 um"', 'radius = "300 um"\nsupports = { rim = "simply-supported" }'),
        PLATE.replace('radius = "300 um"', f'radius = "300 um"\n{VIBRATES}damping = 0.05'),
        PLATE.replace(
            'radius = "300 um"', f'radius = "300 um"\n{VIBRATES}damping = [["20 kHz", 0.02], ["80 kHz", 0.01]]'
        ),
    ],
)
def test_every_kind_of_table_comes_back(text, tmp_path):
    (tmp_path / "case.toml").write_text(text)
    case = read_case(tmp_path / "case.toml")
    (tmp_path / "again.toml").write_text(case_text(case, tmp_path))
    assert told(read_case(tmp_path / "again.toml")) == told(case)


@pytest.mark.parametrize("value", [1 / 3e5, 0.1 + 0.2, 1e-6 * (1 + 2**-52), 1e3 * (1 - 2**-53), 123456.789e-6, 2**-18])
def test_numbers_of_python_keep_all_their_bits(value, tmp_path):
    (tmp_path / "case.toml").write_text(PLATE)
    case = read_case(tmp_path / "case.toml")
    actuator = case.actuators[0].model_copy(update={"stroke": value, "frequency": value})
    part = case.part.model_copy(update={"mass": value})
    changed: Case = case.model_copy(update={"actuators": (actuator, case.actuators[1]), "part": part})
    again = read_case(write_case(changed, tmp_path / "again.toml"))
    assert (again.actuators[0].stroke, again.actuators[0].frequency, again.part.mass) == (value, value, value)
