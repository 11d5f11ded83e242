"""Aims of a part with a face, which is to be turned as well."""

import math

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE

from active_surface.cli import main
from active_surface.steering import Settings, Task, aim, read_route, read_task
from active_surface.steering.paths import cost
from active_surface.steering.report import figures, lines
from active_surface.steering.task import Turn, offset
from coupling import CaseError, run_case
from coupling.case import Case, write_case
from particle import Body, CoulombAdhesion, Footprint, polynomial_surface, simulate

TARGET, HEADING = (10e-6, 31e-6), math.radians(-0.4)  # m, rad
DRIVE = {"stroke": "12 um", "frequency": "1 kHz", "delay": "0.2 ms"}
TABLES = {
    "name": "turned",
    "plate": {
        "shape": "disc",
        "radius": "300 um",
        "youngs_modulus": "169 GPa",
        "poisson_ratio": 0.3,
        "thickness": "5 um",
        "cell_size": "80 um",
    },
    "actuators": [{"position": place} | DRIVE for place in (["-75 um", "0 um"], ["75 um", "0 um"], ["0 um", "90 um"])],
    "part": {
        "footprint": "rectangle",
        "sides": ["80 um", "30 um"],
        "thickness": "10 um",
        "density": "2330 kg/m^3",
        "position": ["10 um", "30 um"],
    },
    "friction": {"model": "coulomb", "coefficient": 0.01, "adhesion": "40 nN"},
    "run": {"duration": "4 ms", "tolerance": 1e-7},
}


@pytest.fixture(scope="module")
def turning():
    return Case.model_validate(TABLES)


@pytest.mark.slow
@pytest.mark.compiled
def test_a_part_comes_to_its_target_with_its_heading_and_a_run_of_its_case_says_the_same(turning):
    settings = Settings(tolerance=2e-8, scatter=1, paths=600, cycles=(1, 2))
    found = aim(Task(turning, TARGET, settings, heading=HEADING))
    path = run_case(found.case).trajectory
    way, left = path.position[-1] - TARGET, path.heading[-1] - HEADING
    assert found.reached and abs(left) < math.radians(0.05) and np.hypot(*way) < 2e-8
    gyration = math.sqrt((80e-6**2 + 30e-6**2) / 12)  # of a rectangle
    assert found.distance == pytest.approx(math.hypot(*way, gyration * left), rel=1e-9)
    assert found.scatter.distance[0] >= np.hypot(*(found.scatter.ends[0] - TARGET))
    told, rows = figures(found), dict(lines(found))
    assert told["end_heading"] == path.heading[-1] and told["heading_missed"] == pytest.approx(left)
    assert rows["heading"].startswith(f"{math.degrees(path.heading[-1]):.4f} deg, off -0.4 deg by ")
    assert "(10 um, 31 um) with the heading -0.4 deg" in found.head


def test_a_miss_is_a_length_in_place_and_heading_whatever_whole_turns():
    turn = Turn(math.radians(170), 3e-5)
    for heading in (-170.0, 190.0, -530.0):
        off = offset((1e-5, 0.0), turn, (1.2e-5, 1e-6), math.radians(heading))
        assert off == pytest.approx([2e-6, 1e-6, 3e-5 * math.radians(20)])
    spinning = Body(Footprint.disc(5e-5), 1e-5, 1e-9, position=(0.0, 0.0), spin=40.0)
    path = simulate(polynomial_surface([[0.0]], size=1e-3), spinning, CoulombAdhesion(1e-4), 1e-3)
    still_turns = (
        math.hypot(*offset((0.0, 0.0), turn, path.position[-1], path.heading[-1])) + 1e-3 * 3e-5 * path.spin[-1]
    )
    assert cost(path, (0.0, 0.0), 1e-3, 1e-4, 1e-7, turn) == pytest.approx(still_turns)
    assert cost(path, (0.0, 0.0), 1e-3, 1e-4, 1e-7) == pytest.approx(1e-5)  # of a part that has not come to rest


def test_a_leg_begins_with_the_heading_that_the_one_before_leaves(turning):
    spinning = Body(Footprint.disc(5e-5), 1e-5, 1e-9, position=(2e-5, 0.0), spin=40.0)
    path = simulate(polynomial_surface([[0.0]], size=1e-3), spinning, CoulombAdhesion(0.3), 1e-2)
    part = Task(turning, TARGET, heading=0.5).within(2e-3, path).case.part
    assert part.heading == path.heading[-1] > 1e-3 and part.position == tuple(path.position[-1]) and part.spin == 0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"heading": math.nan}, "heading must be a finite angle in rad; got nan"),
        ({"target": (10e-6, 30e-6), "heading": 1e-4}, "its heading included: it is there already"),
    ],
)
def test_a_heading_that_makes_no_sense_is_refused(turning, changes, said):
    with pytest.raises(ValueError, match=said):
        Task(**{"case": turning, "target": TARGET} | changes)
    assert Task(turning, (10e-6, 30e-6), heading=0.2).away == pytest.approx(
        0.2 * turning.part.gyration
    )  # turns in place


def test_only_a_footprint_has_a_heading_and_no_way_point(turning, tmp_path):
    (tmp_path / "point.toml").write_text(PLATE)
    write_case(turning, tmp_path / "face.toml")
    said = "heading must not be given for a part without a footprint, a point that does not turn"
    refused = CliRunner().invoke(main, ["aim", str(tmp_path / "point.toml"), "--target", "0,0", "--heading", "30 deg"])
    assert refused.exit_code == 2 and said in " ".join(refused.stderr.split())
    refused = CliRunner().invoke(main, ["aim", str(tmp_path / "face.toml"), "--target", "0,0", "--heading", "nan"])
    assert refused.exit_code == 2 and '--heading must be an angle such as 30 (deg) or "0.5 rad"' in refused.stderr
    file = tmp_path / "aim.toml"
    file.write_text('[aim]\ncase = "face.toml"\ntarget = ["10 um", "31 um"]\nheading = "30 deg"\n')
    assert read_task(file).heading == pytest.approx(math.pi / 6) and read_task(file, heading=0.5).heading == 0.5
    with pytest.raises(ValueError, match=r"heading in \[aim\] must not be given for a plan"):
        read_route(file, [TARGET])
    file.write_text('[aim]\ncase = "point.toml"\nheading = "30 deg"\n')
    with pytest.raises(CaseError, match="aim.heading must not be given for a part without a footprint"):
        read_task(file, TARGET)
