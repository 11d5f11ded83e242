"""Borders over frequency and stroke: against single runs of cases at points on either side of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.random import default_rng

from active_surface.studies.feasibility.chart import find_column, find_slip, make_chart
from active_surface.studies.feasibility.ground import make_ground
from active_surface.studies.feasibility.losses import CLOSE
from coupling import borders, build_drives, build_friction, build_part, build_scene
from coupling.case import (
    ActuatorCase,
    Case,
    ConstantCase,
    CoulombCase,
    KogutEtsionCase,
    PartCase,
    RunCase,
    largest_stroke,
    scaled_case,
)
from particle import Drive, Outcome, simulate

DISC = {
    "shape": "disc", "radius": 300e-6, "youngs_modulus": 169e9, "poisson_ratio": 0.3, "thickness": 5e-6,
    "density": 2330.0, "cell_size": 75e-6,
}  # fmt: skip
RECTANGLE = {name: value for name, value in DISC.items() if name not in ("shape", "radius")} | {
    "shape": "rectangle", "width": 600e-6, "height": 500e-6,
}  # fmt: skip
FRICTION = {
    "constant": ConstantCase(limit=8e-9),
    "coulomb": CoulombCase(coefficient=0.3, adhesion=3e-8, static_coefficient=0.36),
    "kogut-etsion": KogutEtsionCase(preset="paper"),
}


def case_of(kind):
    """A small case: a friction law over a disc, an array, a plate that stretches, or one with mass."""
    one = [ActuatorCase(position=(20e-6, 0.0), stroke=40e-6, frequency=400.0)]
    plate, actuators, law = DISC, one, FRICTION.get(kind, FRICTION["coulomb"])
    if kind == "array":
        plate = RECTANGLE
        places = [(x, y) for x in (-100e-6, 100e-6) for y in (-90e-6, 90e-6)]
        actuators = [
            ActuatorCase(position=place, stroke=40e-6 - 5e-6 * k, frequency=300.0 + 100.0 * (k % 2), delay=2e-4 * k)
            for k, place in enumerate(places)
        ]
    if kind == "von-karman":
        plate = DISC | {"theory": "von-karman"}
        actuators = [one[0].model_copy(update={"stroke": 8e-6, "frequency": 1000.0})]
    if kind == "inertia":
        plate = DISC | {"inertia": True}
        actuators = [one[0].model_copy(update={"stroke": 2e-6, "frequency": 8000.0})]
    duration = {"von-karman": 2e-3, "inertia": 4e-4, "face": 2.5e-3}.get(kind, 7.5e-3)
    part = PartCase(mass=2e-9, position=(-90e-6, 30e-6))
    if kind == "face":
        part = PartCase(
            mass=2e-9,
            position=(-90e-6, 30e-6),
            footprint="rectangle",
            sides=(90e-6, 60e-6),
            thickness=40e-6,
            heading=0.5,
        )
    return Case(
        plate=plate, actuators=actuators, part=part, friction=law,
        run=RunCase(duration=duration), name=kind,
    )  # fmt: skip


FAST, SLOW = ("constant", "coulomb", "kogut-etsion", "array"), ("von-karman", "inertia", "face")


def ground_of(case, frequencies, strokes):
    return make_ground(case, frequencies, strokes, case.run.duration, case.run.duration)


@pytest.fixture(scope="module")
def charts():
    """The ground and the chart of a case, from half to twice its frequency."""
    known = {}

    def of(kind):
        if kind not in known:
            strokes = (2.0**-10, 2.0 if kind == "von-karman" else 16.0)
            ground = ground_of(case_of(kind), (0.5, 2.0), strokes)
            count, most = (3, 5) if kind in SLOW else (5, 14)

            def find(k, beside):
                return find_column(ground, k, strokes, beside)

            known[kind] = ground, make_chart(find, np.geomspace(0.5, 2.0, count).tolist(), strokes, most)
        return known[kind]

    return of


def random_points(chart, count, seed):
    """Factors of frequency and stroke, log-uniform from below the lowest border to above the highest."""
    rng, points = default_rng(seed), []
    ends = np.array([(one.slips, one.all_lost) for one in chart.columns])
    ends = np.clip(ends, *chart.strokes)
    low, high = ends.min() / 1.5, min(ends.max() * 1.5, chart.strokes[1])
    while len(points) < count:
        k, s = (
            float(np.exp(rng.uniform(math.log(0.5), math.log(2.0)))),
            float(np.exp(rng.uniform(*np.log([low, high])))),
        )
        limits = chart.limits(k)
        if all(abs(math.log(s / border)) > 0.01 for border in (*limits.slips, *limits.lost) if border < math.inf):
            points.append((k, s))
    return points


def outcome_of(case, path):
    """As `Chart.state` has it, of a run of the case."""
    return "lost" if path.time[-1] < case.run.duration else "moves" if path.path_length > 0 else "rest"


def runs_of(case):
    """The paths of cases that differ from one in their drives only, as runs have them; all share its plate."""
    scene, part, friction = build_scene(case), build_part(case), build_friction(case)
    rest = case.run.duration, case.run.gravity, case.run.tolerance
    if case.plate.inertia or case.plate.theory == "von-karman":
        return lambda scaled: simulate(build_scene(scaled, shapes=scene.shapes).surface, part, friction, *rest)
    return lambda scaled: simulate(scene.surface.driven_by(build_drives(scaled)), part, friction, *rest)


def check_points(charts, kind, count, seed):
    ground, chart = charts(kind)
    states, run = {}, runs_of(ground.case)
    for k, s in random_points(chart, count, seed):
        case = scaled_case(ground.case, k, s)
        states[k, s] = chart.state(k, s), outcome_of(case, run(case))
    assert [point for point, (mine, its) in states.items() if mine not in ("either", its)] == []
    return states


def with_one_quick(*kinds):
    return [pytest.param(kind, marks=[] if kind == "coulomb" else pytest.mark.slow) for kind in kinds]


@pytest.mark.compiled
@pytest.mark.parametrize("kind", with_one_quick(*FAST, *SLOW))
def test_runs_lie_on_the_right_side_of_the_borders(charts, kind):
    states = check_points(charts, kind, 8 if kind in SLOW else 12, 7)
    assert sum(mine == "either" for mine, _ in states.values()) < len(states) / 3
    assert len({mine for mine, _ in states.values()} - {"either"}) >= 2


@pytest.mark.compiled
@pytest.mark.parametrize("kind", with_one_quick(*FAST, *SLOW))
def test_slip_begins_at_the_border_and_not_below(charts, kind):
    ground, chart = charts(kind)
    for column in chart.columns[::4]:
        below, above = ground.paths([(column.frequency, column.slips * (1 + off)) for off in (-3e-4, 3e-4)])
        assert below.path_length == 0 and below.outcome is Outcome.STUCK
        assert above.path_length > 0 or above.outcome in borders.LOST


@pytest.mark.compiled
def test_between_two_columns_alike_fewer_runs_find_the_same_border(charts):
    ground, chart = charts("coulomb")
    strokes = chart.strokes
    ends = [find_column(ground, k, strokes) for k in (0.9, 1.1)]
    alone, between = find_column(ground, 1.0, strokes), find_column(ground, 1.0, strokes, ends)
    assert abs(math.log(between.lost / alone.lost)) < math.log(CLOSE)
    kept = [sum(margin > 0 for margin in one.runs.values()) for one in (alone, between)]
    assert 0 < kept[1] < kept[0]
    wrong = [replace(one, lost=1.05 * one.lost, all_lost=1.05 * one.all_lost) for one in ends]
    assert find_column(ground, 1.0, strokes, wrong).lost == pytest.approx(alone.lost, rel=2e-4)  # from the slip again


@pytest.mark.compiled
def test_slip_of_a_constant_friction_is_where_the_largest_pull_reaches_it():
    """On a point of the mid-plane the pull is |g + k^2 s w_tt| s |grad w| / sqrt(1 + s^2 |grad w|^2)."""
    case = case_of("constant")
    case = case.model_copy(update={"plate": case.plate.model_copy(update={"top_face": False})})
    ground = ground_of(case, (1.0, 1.0), (1e-3, 16.0))
    times = np.linspace(0, 2.5e-3, 4001)
    states = [ground.surface.evaluate([case.part.position], float(time)) for time in times]
    w_tt = np.array([state.w_tt[0] for state in states])
    slope = np.array([np.hypot(*state.gradient[0]) for state in states])

    def largest(k, s):
        return (2e-9 * np.abs(9.80665 + k**2 * s * w_tt) * s * slope / np.sqrt(1 + (s * slope) ** 2)).max()

    for k in (0.7, 1.0, 3.0):
        slip = find_slip(ground, k, (1e-3, 16.0))
        assert largest(k, slip) == pytest.approx(8e-9, rel=3e-4)
        assert find_slip(ground, k, (1e-3, 0.9 * slip)) == math.inf
        assert find_slip(ground, k, (1.1 * slip, 16.0)) == 1.1 * slip


def test_a_scaled_case_has_the_drives_of_its_factors():
    kinds = [
        {"stroke": 4e-6, "frequency": 300.0, "delay": 1e-3, "dwell": 1e-4},
        {"table": ((0.0, 0.0), (1e-3, 5e-6), (4e-3, 0.0))},
        {"segments": ({"stroke": 3e-6, "frequency": 200.0, "dwell": 1e-4}, {"cycle": "hold", "dwell": 2e-3})},
    ]
    base = case_of("constant")
    actuators = tuple(ActuatorCase(position=(k * 5e-5, 0.0), **kind) for k, kind in enumerate(kinds))
    case = base.model_copy(update={"actuators": actuators})
    times = np.linspace(0, 0.02, 300)
    for before, after in zip(build_drives(case), build_drives(scaled_case(case, 2.5, 3.0)), strict=True):
        for order, (mine, its) in enumerate(zip(after.evaluate(times / 2.5), before.evaluate(times), strict=True)):
            assert mine == pytest.approx(3 * 2.5**order * its, rel=1e-9, abs=1e-9 * np.abs(its).max() * 2.5**order)
    assert largest_stroke(case) == (5e-6, "m") and scaled_case(case, 1.0, 1.0) is case
    assert isinstance(build_drives(scaled_case(case, 2.0, 1.0))[0], Drive)
