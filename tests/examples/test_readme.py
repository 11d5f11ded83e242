"""The Python of the README and of the page on Python runs, and prints what the page says."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.DOTALL)


@pytest.mark.compiled
@pytest.mark.parametrize("block", BLOCKS)
def test_python_of_the_readme_runs(block, tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})
    assert "rests on the surface" in capsys.readouterr().out


ROWS = re.compile(r"(\d+) rows")
PAGE = (ROOT / "docs" / "python.md").read_text()


@pytest.mark.compiled
@pytest.mark.parametrize("number", range(PAGE.count("```python")))
def test_python_of_the_page_on_python_runs(number, tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    found = re.findall(r"```python\n(.*?)```(?:\n\nprints\n\n```\n(.*?)```)?", PAGE, flags=re.DOTALL)
    exec(compile(found[number][0], "python.md", "exec"), {})
    said, wanted = capsys.readouterr().out, found[number][1]
    assert ROWS.sub("rows", said) == ROWS.sub("rows", wanted)
    # A step more or less is a matter of rounding, which is that of the processor.
    assert [int(n) for n in ROWS.findall(said)] == pytest.approx([int(n) for n in ROWS.findall(wanted)], abs=2)
    assert list(tmp_path.glob("*.p*"))
