"""Plans in a closed loop: a device with other friction is missed without measurements, and met with them."""

import math

import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.steering import Route, Settings, follow_plan, plan
from active_surface.steering.following import Progress, next_leg, progress_of
from active_surface.steering.read import read_measured
from coupling import read_case, run_case

THROUGH = ((-2e-5, 2e-5), (-3e-5, 5e-5))
SETTINGS = Settings(tolerance=1e-6, scatter=1, paths=2000)
BELOW = {
    "run.duration": 12e-3,
    "part.position": (0.0, -40e-6),
    "part.centre_height": 45e-6,
    "friction": {"model": "coulomb", "coefficient": 0.1, "adhesion": 1e-6},
    "actuators.*.stroke": 8e-6,
    "actuators.*.frequency": 2e3,
}  # of a part below both actuators, which drive it away
AWAY = ((2e-6, -46e-6), (6e-6, -52e-6))
MORE = 1.25  # times the friction of the case


class Device:
    """The program with other friction; it knows where its part is, whatever a case says."""

    def __init__(self, case, factor):
        self.place, self.coefficient = case.part.position, case.friction.coefficient * factor

    def drive(self, case):
        part = case.part.model_copy(update={"position": self.place})
        friction = case.friction.model_copy(update={"coefficient": self.coefficient})
        end = run_case(case.model_copy(update={"part": part, "friction": friction, "source": None})).trajectory
        self.place = tuple(end.position[-1].tolist())
        return self.place


@pytest.mark.slow
@pytest.mark.compiled
def test_the_closed_loop_meets_a_way_point_that_the_open_one_misses_with_a_device_of_other_friction(case):
    case = case.vary(BELOW)
    route = Route(case, AWAY, Settings(tolerance=0.5e-6, scatter=1, paths=2000, frequency=(1e3, 2.5e3), cycles=(1, 12)))
    opened = plan(route)
    assert opened.complete
    assert math.dist(Device(case, MORE).drive(opened.case), AWAY[-1]) > 2e-6
    device = Device(case, MORE)
    closed = follow_plan(route, device.drive, attempts=6)
    assert closed.complete and max(closed.distances) <= 0.5e-6
    assert closed.measured[-1] == device.place and len(closed.legs) == len(closed.measured) > 1
    for leg, start in zip(closed.legs[1:], closed.measured, strict=False):
        assert leg.case.part.position == start


@pytest.mark.slow
@pytest.mark.compiled
def test_the_command_aims_the_next_leg_from_where_the_part_was_measured(case, folder):
    file, out = folder / "measured.csv", folder / "out"
    file.write_text("x [um], y [um]\n")
    (folder / "aim.toml").write_text('[aim]\ncase = "base.toml"\ntolerance = "1 um"\nscatter = 2\npaths = 2000\n')
    words = ["plan", str(folder / "aim.toml"), "--through", "-20,20", "-30,50", "--measured", str(file)]
    done = CliRunner().invoke(main, [*words, "-o", str(out)])
    assert done.exit_code == 0, done.output
    assert read_case(out / "aim_leg_0_aimed.toml").part.position == case.part.position
    file.write_text("x [um], y [um]\n-18, 21\n")  # misses the first way-point, which is aimed at again
    done = CliRunner().invoke(main, [*words, "-o", str(out)])
    assert done.exit_code == 0 and "target      (-20, 20) um" in done.stdout
    assert read_case(out / "aim_leg_1_aimed.toml").part.position == pytest.approx((-18e-6, 21e-6))
    done = CliRunner().invoke(main, [*words, "-o", str(out), "--attempts", "1"])
    assert done.exit_code == 2 and "--overwrite replaces" in done.output
    file.write_text("x [um], y [um]\n-20, 20.5\n-30, 50.2\n")
    done = CliRunner().invoke(main, [*words, "-o", str(out)])
    assert done.exit_code == 0 and "no way-point is left" in done.stdout
    file.write_text("x [um], y\n-20, 20.5\n")
    done = CliRunner().invoke(main, [*words, "-o", str(out)])
    assert done.exit_code == 2 and "must give y in a unit of length" in done.output


def test_a_leg_without_a_place_is_refused(tmp_path):
    """Rows of a track without one are left out, but these are counted by leg."""
    file = tmp_path / "measured.csv"
    file.write_text("x [um], y [um]\n-20, 20.5\n, \n-30, 50.2\n")
    with pytest.raises(ValueError, match=r"must have a place in each row, one after each leg; got 1 without"):
        read_measured(file)


def test_a_way_point_is_done_within_the_tolerance_or_after_the_last_attempt(case):
    route = Route(case, THROUGH, SETTINGS)
    near, off = (-2e-5, 2.05e-5), (-2e-5, 3e-5)
    assert progress_of(route, []) == Progress((0.0, 4e-5))
    assert progress_of(route, [near]) == Progress(near, (near,), 0)
    assert progress_of(route, [off]) == Progress(off, (), 1)
    assert progress_of(route, [off] * 3) == Progress(off, (off,), 0)
    assert progress_of(route, [off], attempts=1) == Progress(off, (off,), 0)
    assert next_leg(route, [off]).target == THROUGH[0] and next_leg(route, [off]).case.part.position == off
    assert next_leg(route, [near]).target == THROUGH[1]
    assert next_leg(route, [near, THROUGH[1]]) is None
    with pytest.raises(ValueError, match="got 3 places, of which the last has no leg"):
        progress_of(route, [near, THROUGH[1], near])
    twice = Route(case, (THROUGH[0], THROUGH[0], THROUGH[1]), SETTINGS)
    assert progress_of(twice, [near]).way_point == 2
