"""Disturbances by field, the two measures of their distances, and the objective that other optimisers call."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from active_surface.steering import Settings, Task, objective, read_task
from active_surface.steering.robustness import REPORTED, conditional_value_at_risk, deviations, disturbed, draws
from coupling import run_case
from coupling.case import CaseError

TARGET = (-2e-5, 2e-5)
SIZES = {"part.mass": "3 %", "actuators.*.frequency": "2 Hz", "friction.limit": "2 nN", "actuators.0.delay": "10 us"}


def test_each_field_deviates_by_its_own_size(case):
    ways = draws(1500, deviations(case, SIZES), 2, REPORTED)
    cases = [disturbed(case, way.changes) for way in ways]
    masses = np.array([one.part.mass for one in cases]) / case.part.mass
    limits = np.array([one.friction.limit for one in cases]) - case.friction.limit
    rates = np.array([[actuator.frequency for actuator in one.actuators] for one in cases]) - [400, 300]
    delays = np.array([one.actuators[0].delay for one in cases])
    for values, size in ((masses - 1, 0.03), (limits, 2e-9), *((rate, 2.0) for rate in rates.T)):
        assert 0.99 * size < np.abs(values).max() <= size * (1 + 1e-9)
        assert np.std(values) == pytest.approx(size / np.sqrt(3), rel=0.06)
    assert abs(np.corrcoef(rates.T)[0, 1]) < 0.08
    assert delays.min() > 0 and 0.99e-5 < delays.max() <= 1e-5  # a negative one deviates the other way
    assert all(way.friction == 1 and way.shift == (0, 0) for way in ways)
    assert all(one.actuators[1].delay == case.actuators[1].delay for one in cases)


def test_what_cannot_deviate_is_refused_with_all_else(folder):
    (folder / "aim.toml").write_text(
        '[aim]\ncase = "base.toml"\ntarget = ["-20 um", "20 um"]\n[aim.disturbances]\n'
        'part.mas = "1 %"\n"plate.thickness" = "1 %"\n"actuators.*.stroke" = "2 Hz"\n'
        '"part.position" = "1 %"\n"friction.limit" = "120 %"\n"actuators.*.cycle" = "1 %"\n'
    )
    with pytest.raises(CaseError) as caught:
        read_task(folder / "aim.toml")
    text = str(caught.value)
    for message in (
        "part.mas must be a field of the case; part has no mas; did you mean mass?",
        "plate.thickness must be a field of the part, the friction, the air or what drives an actuator",
        'actuators.*.stroke must deviate by a share such as "2 %" or a quantity in m; got "2 Hz"',
        'part.position must be a length such as "1 um", of which nothing is a share; got "1 %"',
        'friction.limit must deviate by 0 or more, and by less than 100 %; got "120 %"',
        "actuators.*.cycle must be a field that is a number; got actuators.*.cycle, which is a text",
    ):
        assert message in text, text


def test_nested_tables_and_paths_are_the_same(folder):
    (folder / "aim.toml").write_text(
        '[aim]\ncase = "base.toml"\ntarget = ["-20 um", "20 um"]\n[aim.disturbances]\npart.mass = "2 %"\n'
    )
    assert read_task(folder / "aim.toml").settings.disturbances == {"part.mass": "2 %"}


def test_quantile_and_cvar_exclude_each_other(case):
    with pytest.raises(ValueError, match="cvar must not be given with quantile"):
        Task(case, TARGET, Settings(quantile=0.9, cvar=0.9))


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.95])
def test_the_cvar_is_the_minimum_of_rockafellar_and_uryasev(share):
    distances = np.random.default_rng(1).exponential(size=40)

    def above(level):
        return level + np.maximum(distances - level, 0).mean() / (1 - share)

    least = minimize_scalar(above, bounds=(0, distances.max()), method="bounded", options={"xatol": 1e-10}).fun
    assert conditional_value_at_risk(distances, share) == pytest.approx(least, rel=1e-7)
    if share == 0.9:
        assert conditional_value_at_risk(distances, share) == pytest.approx(np.sort(distances)[-4:].mean())


@pytest.mark.slow
@pytest.mark.compiled
def test_the_objective_is_the_distance_of_a_run_of_its_case(case):
    goal = objective(Task(case, TARGET, Settings()), threads=1)
    assert goal.names == tuple(f"actuators.{k}.{key}" for k in (0, 1) for key in ("frequency", "stroke", "cycles"))
    low, high = goal.bounds.T
    values = low + (high - low) * np.random.default_rng(5).random((12, len(low)))
    distances = goal(values)
    assert distances.shape == (12,) and goal(values[3]) == distances[3]
    settled = 0
    for row, distance in zip(values, distances, strict=True):
        path = run_case(goal.case(row)).trajectory
        if path.stays:
            settled += 1
            assert distance == pytest.approx(np.hypot(*(path.position[-1] - TARGET)), rel=1e-12)
    assert settled >= 6
    with pytest.raises(ValueError, match="values must be finite, one for each of the 6 knobs"):
        goal(values[:, :3])


@pytest.mark.compiled
def test_a_robust_objective_is_the_measure_of_disturbed_runs(case):
    values = None
    measures = []
    for settings in (Settings(), Settings(quantile=1.0), Settings(cvar=0.5)):
        goal = objective(Task(case, TARGET, settings))
        values = goal.bounds.mean(axis=1) if values is None else values
        measures.append(float(goal(values)))
    nominal, worst, half = measures
    assert half < worst and nominal < worst
