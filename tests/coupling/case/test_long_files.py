"""Mistakes in long files: each is reported with its line, in a time that grows with the length alone."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest
from case_files import ACTUATOR, FRICTION, GOOD, STROKE, changed, problems

ROOT = Path(__file__).parents[3]
LENGTH = 5000
MAX_SECONDS = 1.0  # of processor time
DRIVEN = STROKE + '\nfrequency = "300 Hz"\n'


def listed(text: str, wrong: str, at: int) -> str:
    return "[\n" + "".join(f"{wrong if k == at else text.format(k=k)},\n" for k in range(LENGTH)) + "]\n"


def forces() -> str:
    loads = listed('"{k} uN"', '"5 Hz"', LENGTH - 1).replace('"0 uN"', '"-1 uN"')
    return f'model = "table"\nloads = {loads}limits = ' + listed('"{k} nN"', "", -1)


def table() -> str:
    return "table = " + listed('["{k} ms", "{k} um"]', '["9 s", 3]', LENGTH - 1)


def actuators() -> str:
    places = [f'[[actuators]]\nposition = ["{k / 50} um", "-1 um"]\n{DRIVEN}' for k in range(LENGTH // 4)]
    places[-1] = places[-1].replace("300 Hz", "300 m")
    return "".join(places)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (
            changed((FRICTION, forces())),
            GOOD[: GOOD.index(FRICTION)].count("\n") + 2,
            "friction.loads[4999] must be a force",
        ),
        (changed((DRIVEN, table())), GOOD[: GOOD.index(DRIVEN)].count("\n") + 1, "actuators[0].table[4999][1] must be"),
        (
            changed(("[part]", actuators() + "[part]")),
            GOOD[: GOOD.index("[part]")].count("\n") + 5000,
            "frequency must be",
        ),
    ],
    ids=["friction", "drive", "actuators"],
)
def test_a_mistake_in_5000_lines_is_reported_within_a_second(
    text: str, line: int, message: str, tmp_path: Path
) -> None:
    assert ACTUATOR in text
    before = time.process_time()
    (problem,) = problems(tmp_path, text)
    assert time.process_time() - before < MAX_SECONDS
    assert problem.startswith(f"line {line} ") and message in problem


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
