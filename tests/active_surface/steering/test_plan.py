"""Plans: the schedule of all legs is the legs' drives one after the other, and carries the part over the way-points."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from sweeps import PLATE, read_text

from active_surface.cli.program import main
from active_surface.steering import Route, Settings, Task, plan
from active_surface.steering.aiming import plan_over
from active_surface.steering.legs import Leg, scheduled
from coupling import read_case
from coupling.drives import build_drives
from coupling.run import build_friction, build_surface, follow_part

LATTICE = """\
[lattice]
rows = 2
columns = 3
pitch = "100 um"
stroke = "50 um"
frequency = "400 Hz"
delay = "0.5 ms"

"""
CASE = (PLATE[: PLATE.index("[[actuators]]")] + LATTICE + PLATE[PLATE.index("[part]") :]).replace(
    'duration = "5 ms"', 'duration = "20 ms"'
)
CASE = CASE.replace('["-140 um", "20 um"]', '["-70 um", "10 um"]')
THROUGH = ((-3e-5, 0.0), (2e-5, -1e-5), (4e-5, 4e-5))


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return read_text(tmp_path_factory.mktemp("case"), CASE)


@pytest.fixture(scope="module")
def surface(case):
    return build_surface(case)


def test_a_schedule_is_the_drives_of_its_legs_one_after_the_other(case):
    own = case.actuators
    first = [own[0].model_copy(update={"stroke": 1e-5, "cycles": 3, "delay": 0.0, "dwell": 2e-4}), *own[1:]]
    first[2] = own[2].model_copy(update={"stroke": 3e-5, "cycles": 1, "delay": 1.1e-3})
    second = [own[0].model_copy(update={"stroke": 2e-5, "frequency": 700.0, "cycles": 2, "delay": 3e-4}), *own[1:]]
    legs = [Leg(0.0, tuple(first), (0, 2)), Leg(0.0123, tuple(second), (0,))]
    assert legs[0].end == pytest.approx(3 / 400 + 6 * 2e-4) and legs[0]._replace(movers=(2,)).end == pytest.approx(
        3.6e-3
    )
    whole = scheduled(case, legs, 0.02)
    assert whole.run.duration == 0.02 and [bool(actuator.segments) for actuator in whole.actuators][:4] == [1, 0, 1, 0]
    times = np.linspace(0, 0.02, 4001)
    heights = [drive.evaluate(times)[0] for drive in build_drives(whole)]
    wanted = np.zeros((6, len(times)))
    for leg in legs:
        drives = build_drives(case.model_copy(update={"actuators": leg.actuators}))
        for k in leg.movers:
            wanted[k] += drives[k].evaluate(times - leg.start)[0]
    assert np.abs(wanted).max(axis=1).tolist() == pytest.approx([2e-5, 0, 3e-5, 0, 0, 0], rel=1e-3)
    assert np.abs(heights - wanted).max() < 1e-15


@pytest.mark.slow
@pytest.mark.compiled
def test_a_plan_carries_the_part_over_its_way_points_and_its_file_runs_the_same(case, tmp_path):
    told = []
    route = Route(case, THROUGH, Settings(scatter=20), "route")
    found = plan(route, tmp_path, tell=lambda done, of: told.append((done, of)))
    assert found.complete and not found.interrupted and max(found.distances) < 0.5e-6
    assert sorted(file.name for file in tmp_path.iterdir()) == ["route_plan.png", "route_planned.toml"]
    assert told.pop() == (found.paths, found.paths) and sorted(told) == told and told[-1][0] <= told[-1][1]
    again = read_case(tmp_path / "route_planned.toml")
    path = follow_part(again, build_surface(again), build_friction(again))
    assert path.position.tobytes() == found.trajectory.position.tobytes() and path.stays
    assert again.run.duration == found.arrivals[-1] == path.time[-1]
    assert found.reached == [True] * 3 and not found.failure
    for time, target in zip(found.arrivals, THROUGH, strict=True):
        there = path.at([time - 1e-4, time])
        assert np.hypot(*(there.position - target).T).max() < 0.5e-6 and not there.velocity.any()


def test_a_part_may_come_back_to_where_it_started(case):
    assert Route(case, (THROUGH[0], case.part.position)).leg(1, THROUGH[0]).target == case.part.position


@pytest.mark.slow
@pytest.mark.compiled
def test_a_way_point_where_the_part_rests_is_reached_without_a_leg(case, surface):
    settings = Settings(scatter=1, tolerance=2e-6)
    once, twice = (plan_over(surface, Route(case, (THROUGH[0],) * count + (THROUGH[1],), settings)) for count in (1, 2))
    assert once.complete and not twice.failure and twice.reached[:2] == [True, True]
    assert twice.arrivals[0] == twice.arrivals[1] == once.arrivals[0] and len(twice.arrivals) == 3
    assert twice.targets[-1] == THROUGH[1] and twice.distances[0] == twice.distances[1]


def test_what_the_start_cannot_reach_a_later_place_may(tmp_path):
    """One actuator after the other pushes the part along lines that it could not leave from the start."""
    text = PLATE.replace('["-75 um", "0 um"]', '["0 um", "0 um"]').replace('["75 um", "0 um"]', '["0 um", "100 um"]')
    third = text[text.index("[[actuators]]") : text.index("[part]")].split("[[actuators]]")[1]
    third = "[[actuators]]" + third.replace('"0 um"]', '"-100 um"]') + "[part]"
    (tmp_path / "base.toml").write_text(
        text.replace("[part]", third).replace('["-140 um", "20 um"]', '["100 um", "0 um"]')
    )
    case, ways = read_case(tmp_path / "base.toml"), ((0.0, 6e-5), (-5e-5, 2e-5))
    assert [actuator.position for actuator in case.actuators] == [(0.0, 0.0), (0.0, 1e-4), (0.0, -1e-4)]
    route = Route(case, ways, Settings(nearest=1))
    with pytest.raises(ValueError, match="cannot be reached: from this start"):
        Task(case, ways[1], Settings(nearest=1))
    assert route.leg(1, (1e-7, 6e-5)).target == ways[1]


@pytest.mark.slow
@pytest.mark.compiled
def test_legs_before_an_interruption_count(case, surface):
    def stop(done, of):
        if done > of / 3 + 10:
            raise KeyboardInterrupt

    found = plan_over(surface, Route(case, THROUGH, Settings(scatter=5, tolerance=2e-6)), tell=stop)
    assert found.interrupted and not found.complete
    assert 1 <= len(found.arrivals) == len(found.distances) < 3 and found.distances[0] < 2e-6


@pytest.mark.slow
@pytest.mark.compiled
def test_the_command_takes_all_points_after_through(tmp_path):
    (tmp_path / "base.toml").write_text(CASE)
    (tmp_path / "few.toml").write_text('[aim]\ncase = "base.toml"\npaths = 30\nscatter = 2\n')
    arguments = ["plan", "--quiet", "--through", "-30,0", "20 um,-10 um", str(tmp_path / "few.toml"), "--json"]
    done = CliRunner().invoke(main, [*arguments, "-o", str(tmp_path / "out")])
    assert done.exit_code == 1, done.output
    assert [leg["target"] for leg in json.loads(done.stdout)["legs"]] == [[-3e-5, 0.0], [2e-5, -1e-5]]
    run = ["run", str(tmp_path / "out" / "few_planned.toml"), "-q", "-o", str(tmp_path / "out")]
    assert CliRunner().invoke(main, run).exit_code == 0


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (["--through", "0,0", "400,0"], "way-point 1 must be inside the rim; got a point 100 um beyond it"),
        (["--through", "0,0,0"], "--through must be two lengths"),
        (["--through"], "through must be one way-point or more, as --through 20,0 or --by 20,0; got none"),
        (["--through", "0,0", "nowhere"], "--through must be two lengths"),
    ],
)
def test_way_points_that_make_no_sense_are_refused(tmp_path, points, message):
    (tmp_path / "base.toml").write_text(CASE)
    done = CliRunner().invoke(main, ["plan", str(tmp_path / "base.toml"), *points, "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and message in done.output and not (tmp_path / "out").exists()
