"""Aims that begin at the case's own drives, and what stood at a bound."""

import math
from dataclasses import replace

import numpy as np
import pytest

from active_surface.steering import Settings, Task
from active_surface.steering.aiming import aim_over
from active_surface.steering.knobs import Knob, Knobs, Stop, own_drives
from active_surface.steering.report import hints, lines
from active_surface.steering.search import _smallest_step
from coupling import run_case
from coupling.case import find_field


@pytest.fixture(scope="module")
def own(case):
    """The case whose drives end within its run, and where its part ends."""
    ended = case.model_copy(update={"actuators": own_drives(case), "source": None})
    end = run_case(ended).trajectory.position[-1]
    return ended, (float(end[0]), float(end[1]))


def test_endless_drives_end_within_the_run(case):
    assert [actuator.cycles for actuator in own_drives(case)] == [8, 6]
    knobs = Knobs(case, Settings(), (0, 1), around=True)
    assert knobs.own is not None and knobs.actuators(knobs.own) == own_drives(case)
    assert Knobs(case, Settings(stroke=(0.0, 1e-6)), (0, 1), around=True).own is None


@pytest.mark.compiled
def test_a_target_where_the_case_ends_by_itself_takes_one_path(case, surface, own):
    aimed = aim_over(surface, Task(case, own[1], Settings(scatter=2)))
    assert aimed.reached and aimed.distance == 0.0 and aimed.paths == 1
    assert aimed.case.actuators == own_drives(case)


@pytest.mark.compiled
@pytest.mark.parametrize("shift", [(3e-6, 2e-6), (-3e-6, 4e-6)])
def test_an_aim_never_ends_farther_off_than_the_case_itself(case, surface, own, shift):
    target = own[1][0] + shift[0], own[1][1] + shift[1]
    few = aim_over(surface, Task(case, target, Settings(scatter=2, paths=3)))
    assert few.distance <= math.hypot(*shift) + 1e-12 and few.paths <= 3


@pytest.mark.compiled
def test_bounds_that_leave_out_the_own_drives_are_kept(case, surface, own):
    aimed = aim_over(surface, Task(case, own[1], Settings(scatter=2, cycles=(1, 2), paths=60)))
    assert max(actuator.cycles for actuator in aimed.legs[0].actuators) <= 2


@pytest.mark.compiled
def test_a_hint_names_what_stood_at_its_bound(case, surface, own):
    aimed = aim_over(surface, Task(case, own[1], Settings(scatter=1)))
    assert hints([], aimed) == [
        "none of the drives tried brings the part nearer; paths = 2 in [aim] tries more, and `plan` goes there in steps"
    ]

    assert hints([], replace(aimed, interrupted=True)) == [
        "Ctrl-C ended the search early; without it more drives are tried"
    ]
    still = case.vary({"actuators.1.stroke": 0.0})
    missed = replace(aimed, task=replace(aimed.task, case=still, target=(0.0, 0.0)))
    assert ("hint", "actuator 1 stayed at rest, as the case gives it no stroke") in lines(missed)

    shaken = replace(aimed, scatter=replace(aimed.scatter, distance=np.array([1e-6, np.inf])))
    said = ("hint", "1 of 2 disturbed runs lose the part; --robust 0.9 looks for drives with which it stays")
    assert (said in lines(shaken), said in lines(aimed)) == (True, False)

    def stop(actuator, key, low, high, highest=True):
        return Stop(Knob(find_field(case, None, f"actuators.{actuator}.{key}"), low, high), highest)

    strokes = [stop(k, "stroke", 0.0, 12e-6) for k in (0, 1)]
    slow, many = stop(1, "frequency", 60.0, 600.0, False), stop(1, "cycles", 1.0, 3.0)
    assert hints([*strokes, slow, many], aimed) == [
        'actuators 0 and 1 stood at their largest stroke, 12 um; stroke = ["0 um", "24 um"] in [aim] allows more',
        'actuator 1 stood at its smallest frequency, 60 Hz; --frequency "30 Hz:600 Hz" allows more',
        "actuator 1 stood at its largest number of cycles, 3; cycles = [1, 6] in [aim] allows more",
    ]


def test_stops_are_the_knobs_at_a_bound(case):
    knobs = Knobs(case, Settings(delay=(0.0, 1e-3)), (0,))
    low, high = np.array(knobs.bounds).T
    assert [(stop.knob.key, stop.highest) for stop in knobs.stops(high)] == [
        (key, True) for key in ("frequency", "stroke", "delay", "cycles")
    ]
    assert [(stop.knob.key, stop.highest) for stop in knobs.stops(low)] == [("frequency", False)]
    assert not knobs.stops((low + high) / 2)
    downwards = Knobs(case, Settings(stroke=(-12e-6, 0.0), frequency=(300.0, 300.0), cycles=(1, 1)), (0,))
    assert not downwards.stops(np.array([0.0]))  # it rests: wider bounds do not move it more
    assert [stop.highest for stop in downwards.stops(np.array([-12e-6]))] == [False]


def test_the_smallest_step_is_the_damped_pseudoinverses_where_there_is_room_and_stays_in_it_elsewhere():
    generator = np.random.default_rng(3)
    slopes, offset = generator.normal(size=(2, 7)), np.array([0.02, -0.03])
    damping = 1e-6 * np.linalg.norm(slopes, 2) ** 2

    def damped(matrix):
        return -matrix.T @ np.linalg.solve(matrix @ matrix.T + damping * np.eye(2), offset)

    room = np.array([[-1.0] * 7, [1.0] * 7])
    assert _smallest_step(slopes, offset, room) == pytest.approx(damped(slopes), abs=1e-6)
    room[:, :3] = 0.0  # these stand at both bounds
    step = _smallest_step(slopes, offset, room)
    assert np.abs(step[:3]).max() < 1e-9
    assert step[3:] == pytest.approx(damped(slopes[:, 3:]), abs=1e-6)
