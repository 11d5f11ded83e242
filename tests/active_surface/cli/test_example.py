"""The command `example`: every example with all that it reads, and no file replaced."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.examples import example_names

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def example(*words):
    return CliRunner().invoke(main, ["example", *words])


def test_all_examples_are_listed_with_what_they_are_about():
    names = {file.relative_to(EXAMPLES).with_suffix("").as_posix() for file in EXAMPLES.rglob("*.toml")}
    listed = example().output.splitlines()
    assert {line.split()[0] for line in listed} == names and len(listed) == len(names)
    assert all(len(line.split()) > 3 for line in listed)
    assert json.loads(example("--json").output)["examples"] == example_names()


@pytest.mark.parametrize("name", sorted(name for name in example_names() if "100x100" not in name))
def test_an_example_comes_with_all_that_it_reads(name, tmp_path):
    done = example(name)
    assert done.exit_code == 0 and f"wrote       {name}.toml\n" in done.output
    assert CliRunner().invoke(main, ["check", f"{name}.toml"]).exit_code == 0
    for file in (file for file in tmp_path.rglob("*") if file.is_file()):
        assert file.read_bytes() == (EXAMPLES / file.relative_to(tmp_path)).read_bytes()


@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("transport", "run transport.toml"),
        ("studies/starts", "sweep studies/starts.toml"),
        ("aims/to_target", "aim aims/to_target.toml"),
        ("aims/around_the_corner", "plan aims/around_the_corner.toml --through 230,240 200,240 200,210 200,180"),
    ],
)
def test_the_command_that_an_example_is_for_comes_next(name, command):
    assert example(name).output.splitlines()[-1] == f"next        active-surface {command}"


def test_what_is_there_is_not_replaced(tmp_path):
    assert example("studies/starts", "-q").output == ""
    done = example("studies/jittered_starts")
    assert "wrote       studies/jittered_starts.toml\nis there    studies/moderate.toml\n" in done.output
    Path("studies/moderate.toml").write_text("mine")
    done = example("studies/frequency_stroke")
    assert done.exit_code == 2
    assert "NAME must be one whose files are free; studies/moderate.toml is something else already" in done.output
    assert Path("studies/moderate.toml").read_text() == "mine" and not Path("studies/frequency_stroke.toml").exists()


@pytest.mark.parametrize("place", [Path.touch, lambda path: path.symlink_to("nowhere")], ids=["file", "dangling"])
def test_a_file_in_place_of_a_folder_leaves_nothing_half_written(tmp_path, place):
    place(Path("meshes"))
    done = example("l_with_hole")
    assert done.exit_code == 2 and "free; meshes is something else already" in done.output
    assert [file.name for file in tmp_path.iterdir()] == ["meshes"]


def test_a_name_that_is_none_leads_to_one():
    done = example("two_actuator")
    assert (
        done.exit_code == 2
        and "NAME must be one of the examples; got two_actuator; did you mean two_actuators?" in (done.output)
    )
    assert "there are annulus, " in example("zzzz").output
