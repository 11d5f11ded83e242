"""Aims that begin with probes: what does not move is said at once, and a stuck array carries its part all the same."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import read_text

from active_surface.cli.program import main
from active_surface.steering import Route, Settings, Task, Unmoved, plan, read_route, read_task
from active_surface.steering.aiming import aim_over, plan_over
from active_surface.steering.knobs import Knobs
from active_surface.steering.report import plan_lines

DEVICE = """\
[plate]
shape = "rectangle"
width = "2 mm"
height = "1.6 mm"
supports = "clamped"
youngs_modulus = "169 GPa"
poisson_ratio = 0.064
thickness = "100 um"
density = "2330 kg/m^3"

[lattice]
rows = 3
columns = 3
pitch = "400 um"
stroke = "5 um"
frequency = "4 kHz"

[part]
mass = "1e-9 kg"
centre_height = "20 um"
position = ["-130 um", "70 um"]

[friction]
model = "coulomb"
coefficient = 0.05
adhesion = "3.5 uN"

[air]
pressure = "0 Pa"

[run]
duration = "15 ms"
"""


@pytest.mark.compiled
def test_a_part_that_nothing_moves_is_said_so_at_once_and_why(case, surface, folder):
    told = []
    task = Task(case, (-2e-5, 2e-5), Settings(stroke=(0.0, 1e-6)))
    with pytest.raises(Unmoved, match=r"the pull reaches 0\.\d+ of the friction limit.*advise base\.toml") as error:
        aim_over(surface, task, tell=lambda done, of: told.append(done))
    assert not told and "0 um of 28.3 um at the most" in str(error.value)
    text = (folder / "base.toml").read_text().replace('stroke = "60 um"', 'stroke = "1 um"')
    (folder / "base.toml").write_text(text)
    for words in (["aim", "--by", "-20,-20"], ["plan", "--by", "-20,-20", "0,5"]):
        done = CliRunner().invoke(main, [*words, str(folder / "base.toml"), "--json", "-o", str(folder)])
        assert done.exit_code == 1 and "nothing moves the part far" in json.loads(done.stdout)["failure"]
    sized = text.replace('mass = "2e-9 kg"', 'mass = "2e-9 kg"\nsize = "50 um"')
    (folder / "base.toml").write_text(f"{sized}[air]\nfilm = true\n")
    quick = ["--groups", "all", "--frequency", "4 kHz:4 kHz", "-o", str(folder)]
    done = CliRunner().invoke(main, ["aim", "--by", "-20,-20", str(folder / "base.toml"), *quick])
    assert done.exit_code == 1 and "nothing moves the part far" in done.stdout and "advise" not in done.stdout
    done = CliRunner().invoke(main, ["advise", str(folder / "base.toml")])
    assert done.exit_code == 2 and "  CASE must have air.film = false: advice is for parts without" in done.stderr


@pytest.fixture(scope="module")
def device(tmp_path_factory):
    return read_text(tmp_path_factory.mktemp("device"), DEVICE)


def test_groups_move_alike_and_a_search_has_them_together(device):
    columns = Knobs(device, Settings(groups="columns"), tuple(range(9)), together=True)
    assert [knob.field.path for knob in columns.knobs] == [
        "actuators.0,1,2,3,4,5,6,7,8.frequency",
        "actuators.0,1,2,3,4,5,6,7,8.cycles",
        *(f"actuators.{column}.stroke" for column in ("0,3,6", "1,4,7", "2,5,8")),
    ]
    drives = columns.actuators(np.array([5e3, 7, 1e-6, 2e-6, 3e-6]))
    assert [(one.frequency, one.cycles, one.stroke) for one in drives[3:6]] == [(5e3, 7, k * 1e-6) for k in (1, 2, 3)]
    rows, every = (Knobs(device, Settings(groups=groups), tuple(range(9))).groups for groups in ("rows", "all"))
    assert rows == [(0, 1, 2), (3, 4, 5), (6, 7, 8)] and every == [tuple(range(9))]


def test_targets_are_counted_from_the_start_and_way_points_from_the_one_before(tmp_path):
    (tmp_path / "base.toml").write_text(DEVICE)
    file = tmp_path / "base.toml"
    assert read_task(file, by=(150e-6, 0.0)).target == pytest.approx((20e-6, 70e-6))
    corner = (pytest.approx((-50e-6, 70e-6)), pytest.approx((-50e-6, 150e-6)))
    assert read_route(file, by=((80e-6, 0.0), (0.0, 80e-6)), groups="columns").through == corner
    aim_file = tmp_path / "corner.toml"
    aim_file.write_text('[aim]\ncase = "base.toml"\nby = [["80 um", "0 um"], ["0 um", "80 um"]]\n')
    assert read_route(aim_file).through == corner
    with pytest.raises(ValueError, match="one step for an aim; got 2"):
        read_task(aim_file)
    for wrong in ("6 kHz:1 kHz", "1 kHz", "0 Hz:1 Hz"):
        done = CliRunner().invoke(main, ["aim", str(file), "--by", "9,0", "--frequency", wrong])
        assert done.exit_code == 2 and "--frequency must be two frequencies" in done.output


@pytest.mark.compiled
def test_each_missed_leg_has_its_hint(case, surface):
    found = plan_over(surface, Route(case, ((-2e-5, 2e-5),), Settings(scatter=1, paths=20)))
    rows = plan_lines(found)
    assert not found.complete and [label for label, _ in rows][:2] == ["leg 0", "hint"]


@pytest.mark.slow
@pytest.mark.compiled
def test_a_stuck_array_carries_its_part_along_an_l(device):
    x, y = device.part.position
    found = plan(Route(device, ((x + 80e-6, y), (x + 80e-6, y + 80e-6)), Settings(scatter=1)))
    assert found.complete and found.paths < 600
