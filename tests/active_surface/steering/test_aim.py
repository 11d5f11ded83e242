"""Aims: the drive that is found does what is said of it, whoever runs it and on however many threads."""

import dataclasses
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from active_surface.cli.program import main
from active_surface.steering import Settings, Task, aim
from active_surface.steering.aiming import aim_over
from active_surface.steering.knobs import Knobs
from active_surface.steering.objectives import SAMPLES
from active_surface.steering.paths import Paths, cost
from active_surface.steering.robustness import REPORTED, SEARCHED, deviations, draws
from coupling import read_case
from coupling.drives import build_drives
from coupling.run import build_friction, build_surface, follow_part
from particle import ConstantFriction, Micropart, Outcome, polynomial_surface, simulate

TARGET = (-2e-5, 2e-5)
QUICK = {"scatter": 20, "tolerance": 1e-6}


@pytest.mark.slow
@pytest.mark.compiled
def test_an_aim_reaches_its_target_and_its_case_file_the_same_point_to_the_bit(case, tmp_path):
    found = aim(Task(case, TARGET, Settings(scatter=3, tolerance=1e-6)), tmp_path, threads=1)
    assert found.reached and found.distance < 1e-6 and not found.interrupted
    assert found.trajectory.outcome is Outcome.STUCK and found.trajectory.stays
    assert sorted(file.name for file in tmp_path.iterdir()) == ["base_aim.png", "base_aimed.toml"]
    again = read_case(tmp_path / "base_aimed.toml")
    path = follow_part(again, build_surface(again), build_friction(again))
    assert path.position.tobytes() == found.trajectory.position.tobytes()
    assert np.hypot(*(path.position[-1] - TARGET)) == found.distance


@pytest.mark.slow
@pytest.mark.compiled
def test_an_aim_is_the_same_on_any_number_of_threads_and_another_with_another_seed(case, surface):
    one, two, other = (
        aim_over(surface, Task(case, TARGET, Settings(**QUICK, seed=seed)), threads)
        for seed, threads in ((0, 1), (0, 3), (1, 2))
    )
    assert one.case.actuators == two.case.actuators and one.paths == two.paths
    assert one.scatter.distance.tobytes() == two.scatter.distance.tobytes()
    assert one.case.actuators != other.case.actuators and other.reached


@pytest.mark.compiled
def test_a_target_beyond_all_bounds_is_missed_and_said_so_after_so_many_paths(case, surface):
    settings = Settings(**QUICK, frequency=(300.0, 400.0), cycles=(1, 1), paths=300)
    told = []
    far = (-1e-4, 1.5e-4)
    found = aim_over(surface, Task(case, far, settings), tell=lambda done, of: told.append((done, of)))
    assert not found.reached and 5e-5 < found.distance < math.dist(case.part.position, far)
    assert found.paths == 300
    assert told[-1] == (300, 300) and [done for done, _ in told] == sorted(done for done, _ in told)


@pytest.mark.compiled
def test_what_was_found_before_an_interruption_counts(case, surface):
    def stop(done, of):
        if done >= 100:
            raise KeyboardInterrupt

    found = aim_over(surface, Task(case, TARGET, Settings(scatter=5, tolerance=1e-12)), tell=stop)
    assert found.interrupted and not found.reached
    assert found.distance < math.dist(case.part.position, TARGET) and found.scatter is None

    def at_once(done, of):
        raise KeyboardInterrupt

    surface_before_any = Task(case, TARGET, Settings(scatter=5))
    assert aim_over(surface, surface_before_any, tell=at_once).interrupted


@pytest.mark.slow
def test_a_robust_aim_makes_the_quantile_small_that_is_asked_for(case, surface):
    surface = dataclasses.replace(surface, half_thickness=0.0)  # on the top face the plain aim happens to be as robust
    few = {"tolerance": 1e-6, "cycles": (1, 3)}  # so that drives end within the case's duration
    plain = aim_over(surface, Task(case, TARGET, Settings(**few)))
    robust = aim_over(surface, Task(case, TARGET, Settings(**few, quantile=0.9, paths=6000)))
    ways = draws(SAMPLES, deviations(case, None), 0, SEARCHED)

    def searched(found):
        paths = Paths(case, surface).of([(found.case.actuators, way) for way in ways])
        return np.quantile([cost(path, TARGET, case.run.duration, surface.size, 1e-6) for path in paths], 0.9)

    assert searched(robust) < 0.9 * searched(plain)
    assert robust.scatter.quantile(0.9) < plain.scatter.quantile(0.9)


@pytest.mark.compiled
def test_the_scatter_is_of_disturbed_runs_of_the_found_case(case, surface):
    found = aim_over(surface, Task(case, TARGET, Settings(**QUICK)))
    way = draws(7, deviations(case, None), 0, REPORTED)[6]
    actuators = tuple(
        actuator.model_copy(update={"stroke": actuator.stroke * factor})
        for actuator, factor in zip(found.case.actuators, strokes_of(way), strict=True)
    )
    driven = surface.driven_by(build_drives(found.case.model_copy(update={"actuators": actuators})))
    x, y = case.part.position
    part = Micropart(case.part.mass, (x + way.shift[0], y + way.shift[1]))
    end = simulate(driven, part, ConstantFriction(case.friction.limit * way.friction), 20e-3).position[-1]
    assert found.scatter.ends[6].tobytes() == end.tobytes()
    assert found.scatter.distance[6] == np.hypot(*(end - TARGET))


def strokes_of(way):
    return [1 + change.amount for change in way.changes]


def test_disturbances_are_within_their_bounds_and_a_function_of_their_number(case):
    three = deviations(case.model_copy(update={"actuators": (case.actuators[0],) * 3}), None)
    many = draws(2000, three, 5, REPORTED)
    assert draws(10, three, 5, REPORTED) == many[:10] != draws(10, three, 5, SEARCHED)
    friction = np.array([way.friction for way in many])
    strokes = np.array([strokes_of(way) for way in many])
    shifts = np.hypot(*np.array([way.shift for way in many]).T)
    for factors in (friction, *strokes.T):
        assert 0.99 <= factors.min() < 0.9901 and 1.0099 < factors.max() <= 1.01
        assert np.std(factors) == pytest.approx(0.01 / math.sqrt(3), rel=0.05)
    assert 0.99e-6 < shifts.max() <= 1e-6 and np.mean(shifts < 0.5e-6) == pytest.approx(0.25, abs=0.03)
    assert abs(np.corrcoef(strokes.T)[0, 1]) < 0.08


def test_knobs_stay_in_their_bounds_and_end_in_time(case):
    delayed = case.actuators[1].model_copy(update={"delay": 2e-3, "dwell": 1e-3})
    delayed_case = case.model_copy(update={"actuators": (case.actuators[0], delayed)})
    knobs = Knobs(delayed_case, Settings(cycles=(1, 50)), (0, 1))
    keys = [(knob.actuators, knob.key) for knob in knobs.knobs]
    assert keys == [((0,), "frequency"), ((0,), "stroke"), ((0,), "cycles")] + [
        ((1,), key) for key in ("frequency", "stroke", "delay", "cycles")
    ]
    low, high = np.array(knobs.bounds).T
    assert low.tolist() == [80, 0, 1, 60, 0, 0, 1]
    assert high == pytest.approx([800, 60e-6, 17, 600, 60e-6, 4e-3, 13])
    for values in (low, high, *np.random.default_rng(0).uniform(low, high, (50, len(low)))):
        for k, actuator in enumerate(knobs.actuators(values)):
            period = 1 / actuator.frequency + 2 * actuator.dwell
            assert actuator.cycles == 1 or actuator.delay + actuator.cycles * period <= 20e-3 * (1 + 1e-9)
            own = (case.actuators[0], delayed)[k]
            assert 0.2 <= actuator.frequency / own.frequency <= 2 and 0 <= actuator.stroke <= own.stroke


def test_those_that_do_not_take_part_are_at_rest_and_equal_bounds_leave_no_knob(case):
    knobs = Knobs(case, Settings(frequency=(300, 300), cycles=(2, 2)), (1,))
    assert [(knob.actuators, knob.key) for knob in knobs.knobs] == [((1,), "stroke")]
    still, moving = knobs.actuators(np.array([2e-5]))
    (drive,) = build_drives(case.model_copy(update={"actuators": (still,)}))
    assert (
        not build_drives(case.model_copy(update={"actuators": (still,)}))[0].evaluate(np.linspace(0, 0.02, 99))[0].any()
    )
    assert (moving.stroke, moving.frequency, moving.cycles) == (2e-5, 300, 2)


@pytest.mark.compiled
def test_a_search_with_nothing_to_turn_or_with_cycles_only_ends(case, surface):
    fixed = {"frequency": (300, 300), "stroke": (5e-5, 5e-5), "scatter": 3, "paths": 100, "quantile": 0.9}
    found = aim_over(surface, Task(case, TARGET, Settings(**fixed, cycles=(2, 2))))
    assert [actuator.cycles for actuator in found.case.actuators] == [2, 2] and found.paths <= SAMPLES
    found = aim_over(surface, Task(case, TARGET, Settings(**fixed, cycles=(1, 3))))
    assert {actuator.cycles for actuator in found.case.actuators} <= {1, 2, 3}


def test_a_part_that_is_lost_costs_more_than_one_that_moves_and_that_more_than_one_at_rest():
    tilted = polynomial_surface([[0.0, 0.0], [0.5, 0.0]])
    part = Micropart(2e-9, (0.0, 0.0))
    rest, slide = (simulate(tilted, part, ConstantFriction(limit), 1e-3) for limit in (1e-6, 1e-9))
    assert (rest.outcome, slide.outcome) == (Outcome.STUCK, Outcome.MOVING)
    assert cost(rest, (3e-6, 4e-6), 1e-3, 3e-4, 1e-7) == pytest.approx(5e-6)
    off = np.hypot(*(slide.position[-1] - (3e-4, 4e-4)))
    assert cost(slide, (3e-4, 4e-4), 1e-3, 3e-4, 1e-7) == pytest.approx(off + 1e-3 * np.hypot(*slide.velocity[-1]))
    assert cost(slide, slide.position[-1], 1e-3, 1e-9, 1e-7) == 2e-7
    assert cost(slide, slide.position[-1], 1e-3, 1.0, 1e-7) == pytest.approx(0.1)
    size = 3e-4  # of a plate, so that no two places on it are farther apart than twice that
    lost, later = (
        dataclasses.replace(rest, outcome=Outcome.LEFT_PLATE, time=rest.time[-1:] * when) for when in (0.1, 0.9)
    )
    for fast in (0.1, 100.0):
        moves = dataclasses.replace(slide, position=np.array([[0.0, 2 * size]]), velocity=np.array([[fast, 0.0]]))
        assert 2 * size < cost(moves, (0.0, 0.0), 1e-3, size, 1e-7) < cost(later, (0.0, 0.0), 1e-3, size, 1e-7)
    assert cost(later, (0.0, 0.0), 1e-3, size, 1e-7) < cost(lost, (0.0, 0.0), 1e-3, size, 1e-7)


@pytest.mark.slow
@pytest.mark.compiled
def test_the_command_says_what_was_found(folder):
    arguments = ["aim", str(folder / "base.toml"), "--target", "-20,20", "-o", str(folder / "out")]
    done = CliRunner().invoke(main, [*arguments, "--json"])
    told = json.loads(done.stdout)
    assert done.exit_code == 0 and told["reached"] and set(told["legs"][0]["drives"]) == {"0", "1"}
    assert told["scatter"]["count"] == 100 and told["scatter"]["median"] <= told["scatter"]["nine_in_ten"]
    before = [(folder / "out" / f"base_{name}").read_bytes() for name in ("aimed.toml", "aim.png")]
    done = CliRunner().invoke(main, [*arguments, "--threads", "1"])
    assert done.exit_code == 2 and "which has base_aimed.toml and base_aim.png: --overwrite replaces" in done.output
    done = CliRunner().invoke(main, [*arguments, "--overwrite"])
    assert [(folder / "out" / f"base_{name}").read_bytes() for name in ("aimed.toml", "aim.png")] == before
    assert done.exit_code == 0 and "within the 0.5 um tolerance" in done.stdout
    assert [line.split()[0] for line in done.stdout.splitlines()].count("actuator") == 2


@pytest.mark.parametrize("target", ["-90", "400,0", "0,400 kg"])
def test_a_target_that_makes_no_sense_leaves_nothing_behind(folder, target):
    done = CliRunner().invoke(main, ["aim", str(folder / "base.toml"), "--target", target, "-o", str(folder / "out")])
    assert done.exit_code == 2 and "target must" in done.output and len(done.output.splitlines()) == 2
    assert not (folder / "out").exists()
