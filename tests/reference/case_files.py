"""Case files for tests: good ones of each kind, changes of them, and what is said about those that are wrong."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from coupling.case import Case, CaseError, CoulombCase, DiscCase, read_case

MESH = Path(__file__).parents[1] / "data" / "l_with_hole.msh"
MATERIAL = """\
youngs_modulus = "169 GPa"
poisson_ratio = 0.3
thickness = "5 um"
"""
ACTUATORS = """\
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
"""
REST = """\
[part]
mass = "2e-9 kg"
position = ["100 um", "100 um"]

[friction]
model = "kogut-etsion"

[run]
duration = "50 ms"
"""
SHAPES = {
    "disc": 'shape = "disc"\nradius = "200 um"',
    "rectangle": 'shape = "rectangle"\nwidth = "400 um"\nheight = "200 um"',
    "annulus": 'shape = "annulus"\ninner_radius = "50 um"\nouter_radius = "200 um"',
    "ellipse": 'shape = "ellipse"\nsemi_axis_x = "100 um"\nsemi_axis_y = "200 um"',
    "polygon": 'shape = "polygon"\ncorners = [["-200 um", "-200 um"], ["200 um", "-200 um"], ["0 um", "200 um"]]',
    "regular": 'shape = "polygon"\nsides = 6\nradius = "200 um"\nrotation = "20 deg"',
    "mesh": f'mesh = "{MESH.as_posix()}"\nmesh_unit = "1 um"',
}
GOOD = f'[plate]\nshape = "disc"\nradius = "300 um"\n{MATERIAL}\n{ACTUATORS}\n{REST}'
FRAME = f'[plate]\nshape = "rectangle"\nwidth = "1 mm"\nheight = "0.8 mm"\n{MATERIAL}\n{REST}\n'
"""All but the actuators."""
ONE = FRAME + '[[actuators]]\nposition = ["0 um", "0 um"]\n'
"""All but the drive of the one actuator."""
DRIVE = 'stroke = "5 um"\nfrequency = "300 Hz"\n'
TABLE = 'table = [["0 ms", "1 um"], ["1 ms", "-50 um"], ["3 ms", "1 um"]]\n'
SEGMENTS = """\
delay = "2 ms"
repeats = "endless"
[[actuators.segments]]
stroke = "5 um"
frequency = "300 Hz"
cycles = 3
dwell = "0.1 ms"
[[actuators.segments]]
cycle = "hold"
dwell = "1 ms"
[[actuators.segments]]
stroke = "-2 um"
frequency = "1 kHz"
cycle = "up"
[[actuators.segments]]
stroke = "1 um"
frequency = "500 Hz"
cycle = "up"
cycles = 2
"""
PLACES = '[lattice]\nrows = 3\ncolumns = 4\npitch = ["150 um", "120 um"]\n'
PLATFORM = '[plate]\nshape = "platform"\n'
POINTS = 'model = "table"\nloads = ["-1 uN", "0 N", "5 uN"]\nlimits = ["10 nN", "20 nN", "50 nN"]'
JARGON = re.compile(
    r"input should|extra inputs|field required|valid (dictionary|number|integer|string|tuple|list)|pydantic|https?:"
    r"|value error|type=|input_|discriminator|\btag\b|NoneType|\bdict\b|\bstr\b|\bfloat\b|\bint\b|Traceback|Ellipsis",
    re.IGNORECASE,
)


def text(shape: str, *places: str, plate: str = "", drive: str = DRIVE, part: str = "60 um, 60 um") -> str:
    """A case with a plate of a shape, a key of SHAPES, and actuators at places, each such as "0 um, 9 um"."""
    places = places or ("60 um, -60 um",)
    points = ["[" + re.sub(r"[^ ,]+ \w+", r'"\g<0>"', place) + "]" for place in (*places, part)]
    actuators = "".join(f"[[actuators]]\nposition = {point}\n{drive}" for point in points[:-1])
    rest = REST.replace('["100 um", "100 um"]', points[-1])
    return f"[plate]\n{SHAPES.get(shape, shape)}\n{MATERIAL}{plate}\n{actuators}{rest}"


TEXTS = {
    "good": GOOD,
    **{shape: text(shape, plate="#") for shape in SHAPES},
    "frame": FRAME,
    "drive": ONE,
    "stroke": ONE + DRIVE,
    "table": ONE + TABLE,
    "segments": ONE + SEGMENTS,
    "places": FRAME + PLACES,
    "lattice": FRAME + PLACES + DRIVE,
    "platform": REST + PLATFORM,
    "many": FRAME + '[lattice]\nrows = 16\ncolumns = 16\npitch = "9.1 um"\n' + DRIVE,
    "vibrating": GOOD.replace("cycles = 5\n", "").replace("[[", 'density = "2330 kg/m^3"\ninertia = true\n\n[[', 1),
    "wafer": GOOD.replace(MATERIAL, 'thickness = "5 um"\nwafer = "100"\n'),
    "points": GOOD.replace('model = "kogut-etsion"', POINTS),
}
"""Good cases, and some that lack no more than a drive."""


def changed(*changes: tuple[str, str]) -> str:
    """The good file with each old text replaced once."""
    new = GOOD
    for old, by in changes:
        assert old in new
        new = new.replace(old, by, 1)
    return new


def wrong_texts(table: str, texts: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Each wrong text of a table, and what is said of it.

    A line is `change | change => what is said`. It changes the text that the last line `@name` or itself begins with,
    else the first: `old -> new`, `old ++ a line below`, `+ an end` or `+ name`. `\\n` is the end of a line.
    """
    base = next(iter(texts.values()))
    for line in table.splitlines():
        changes, arrow, said = line.partition(" => ")
        base = texts[line[1:]] if line.startswith("@") else base
        text = base
        for change in changes.replace("\\n", "\n").split(" | ") if arrow else ():
            if change in texts:
                text = texts[change]
            elif change.startswith("+ "):
                text += texts.get(change[2:], change[2:] + "\n")
            else:
                old, mark, new = change.partition(" ++ " if " ++ " in change else " -> ")
                assert mark and old in text, line
                end = text.index("\n", text.index(old)) if mark == " ++ " else 0
                text = f"{text[:end]}\n{new}{text[end:]}" if end else text.replace(old, new, 1)
        if arrow:
            yield text, said


def answered_otherwise(
    table: str, problems: Callable[[str], list[str]], /, **texts: str
) -> list[tuple[str, list[str]]]:
    """What is not said of the wrong texts of a table, or not alone, and what is said in its place.

    In what is said " && " joins mistakes, and " ... " stands for anything.
    """
    return [
        (said, found)
        for text, said in wrong_texts(table, texts)
        if not _are(found := problems(text), said.split(" && "))
    ]


def _are(found: list[str], said: list[str]) -> bool:
    patterns = [r"(?<!\d)" + ".*".join(map(re.escape, one.split(" ... "))) for one in said]
    return len(found) == len(said) and all(map(re.search, patterns, found))


def read(folder: Path, text: str) -> Case:
    """The case with that text."""
    file = folder / "test.toml"
    file.write_text(text, encoding="utf-8")
    return read_case(file)


def problems(folder: Path, text: str) -> list[str]:
    """The mistakes of a text, each with its line, 0 for the file, its field and what is wrong."""
    with pytest.raises(CaseError) as caught:
        read(folder, text)
    found = [f"{problem.line or 0} {problem.field} {problem.message}" for problem in caught.value.problems]
    assert not JARGON.search("\n".join(found)), found
    return found


def plate(**changes: Any) -> DiscCase:
    """A disc."""
    values = {"shape": "disc", "radius": 3e-4, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6}
    return DiscCase(**{**values, **changes})


def python_case(**changes: Any) -> Case:
    """A case made in Python; with a lattice or platform it has no other actuators."""
    values = {
        "plate": plate(),
        "actuators": [{"position": ("0 um", 1e-6), "stroke": "150 um", "frequency": 300}],
        "part": {"mass": 2e-9, "position": ["0.1 mm", "100 um"]},
        "friction": CoulombCase(coefficient=0.3),
        "run": {"duration": "50 ms"},
    }
    if "lattice" in changes or dict(changes.get("plate", ())).get("shape") == "platform":
        del values["actuators"]
    return Case(**{**values, **changes})
