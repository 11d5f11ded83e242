"""The Python of the README and of the page on Python runs, and prints what the page says."""

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
FIGURE = re.compile(r"-?\d[\d.e+-]*")
MAX_WORDS = 700


@pytest.mark.compiled
@pytest.mark.slow
@pytest.mark.parametrize("block", BLOCKS)
def test_python_of_the_readme_runs(block, tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})
    assert "The part rests between slips" in capsys.readouterr().out


@pytest.mark.compiled
@pytest.mark.slow
def test_main_job_prints_the_lines_of_the_readme(tmp_path):
    case = ROOT / "examples/transport.toml"
    printed = CliRunner().invoke(main, ["run", str(case), "--output", str(tmp_path)]).output
    lines = [FIGURE.sub("#", line) for line in printed.splitlines()]
    shown = re.search(r"```\n(outcome .*?)```", README, flags=re.DOTALL)[1].splitlines()
    assert len(shown) == 6 and shown[2].startswith("turn ")
    assert [line for line in shown if FIGURE.sub("#", line) not in lines] == []
    assert "warning" not in printed  # the run is within all bounds of the model
    # The model stretches to 1e-5 of the plate's height, which moves the path's end by less than 2e-3 um.
    for line in shown[:4]:
        (now,) = (other for other in printed.splitlines() if FIGURE.sub("#", other) == FIGURE.sub("#", line))
        assert list(map(float, FIGURE.findall(now))) == pytest.approx(list(map(float, FIGURE.findall(line))), abs=2e-3)


def test_readme_is_short_and_begins_with_what_to_do():
    assert len(README.split()) < MAX_WORDS
    first_screen = README.splitlines()[:24]
    assert any("make demo" in line for line in first_screen) and any("make test" in line for line in first_screen)


PAGE = (ROOT / "docs" / "python.md").read_text()


@pytest.mark.compiled
@pytest.mark.slow
def test_python_of_the_page_on_python_runs(tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    names = {}
    for program in re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL):
        exec(compile(program, "python.md", "exec"), names)
    assert {path.name for path in tmp_path.glob("*.png")} == {"pair.png", "path_and_plate.png", "path.png"}
    assert names["sweep"].dataset["distance"].max() > 10e-6  # m: the sweep of the page moves the part
    assert " Hz\n" in capsys.readouterr().out
