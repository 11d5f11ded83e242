"""Leaps: estimates of whole paths end where the paths do, within the error that they state."""

import math

import numpy as np
import pytest
from app_case import CASE, DEVICE

from active_surface.app.leaps import Course, leaped
from coupling import SolvedPlates, build_drives, build_friction, follow_part, read_case

SETTINGS = (
    {},
    {"actuators.0.stroke": "1.5 um"},
    {"actuators.0.stroke": "4 um", "actuators.3.stroke": "4 um", "actuators.6.stroke": "4 um"},
    {"actuators.0.delay": "60 us"},
    {f"actuators.{k}.frequency": "4.2 kHz" for k in range(9)},
    {"friction.coefficient": 0.3},
    {"friction.adhesion": "0.3 uN"},
    {"part.mass": "2 ug"},
    {"part.position.0": "-150 um", "part.position.1": "-230 um"},
    {"run.duration": "20 ms"},
)
NO_PERIOD = ({"actuators.0.frequency": "3.99 kHz"}, {"actuators.0.frequency": "4.05 kHz"})


def read(folder, text):
    (folder / "one.toml").write_text(text)
    return read_case(folder / "one.toml")


def both(case, plates):
    """An estimate, and the path itself."""
    surface, law = plates.scene(case).surface, build_friction(case)
    return leaped(case, surface, law), follow_part(case, surface, law)


@pytest.mark.compiled
def test_an_estimate_ends_where_the_path_does(tmp_path):
    case = read(tmp_path, CASE.replace('"3 ms"', '"60 ms"').replace('"60 um"', '"20 um"').replace("40 nN", "20 nN"))
    found, exact = both(case, SolvedPlates())
    assert exact.distance > 1e-6 and found.path.time[-1] == exact.time[-1]
    assert math.dist(found.path.position[-1], exact.position[-1]) <= found.error < 0.05 * exact.distance
    assert found.followed < 0.5 * found.periods and found.path.outcome is exact.outcome
    assert (np.diff(found.path.time) >= 0).all()


@pytest.mark.slow
@pytest.mark.compiled
def test_the_error_of_a_device_is_within_what_is_stated(tmp_path):
    case, plates = read(tmp_path, DEVICE), SolvedPlates()
    for changes in (*SETTINGS, *NO_PERIOD):
        found, exact = both(case.vary(changes), plates)
        gap = math.dist(found.path.position[-1], exact.position[-1])
        assert gap <= found.error, changes
        if changes in SETTINGS:
            assert gap <= 0.01 * exact.distance and found.error <= 0.05 * exact.distance, changes


@pytest.mark.compiled
def test_a_part_that_comes_off_before_any_leap_has_its_exact_path(tmp_path):
    case = read(tmp_path, CASE.replace('"3 ms"', '"60 ms"').replace("2e-9 kg", "2e-7 kg"))
    case = case.vary(
        {"friction": {"model": "coulomb", "coefficient": 0.2, "adhesion": "0 N"}, "actuators.0.stroke": "2 mm"}
    )
    found, exact = both(case, SolvedPlates())
    assert found.path.outcome is exact.outcome and exact.time[-1] < 1e-3
    np.testing.assert_allclose(found.path.position[-1], exact.position[-1], rtol=1e-5)


def test_periods_are_those_in_which_all_drives_repeat_themselves(tmp_path):
    case = read(tmp_path, CASE).vary({"actuators.0.cycles": 50, "actuators.0.delay": "1 ms", "run.duration": "80 ms"})
    course = Course.of(build_drives(case), case.run.duration)
    assert (course.begin, course.periods, course.common) == (1e-3, 50, True) and course.period == pytest.approx(1 / 900)
    drives = [*build_drives(case), *build_drives(case.vary({"actuators.0.frequency": "907 Hz"}))]
    assert not Course.of(drives, 80e-3).common and Course.of(drives, 80e-3).period == course.period
    assert Course.of(drives, 20.0).periods == 49  # the faster one ends
    assert Course.of([], 1.0).periods == 0
