"""A good case file, changes of it, and what is said about those that are wrong."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from coupling.case import Case, CaseError, CoulombCase, DiscCase, read_case

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
