"""Margins of runs beside brute force, and advice: what it states is what runs with its factors do."""

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from sweeps import DISC, read_text
from sweeps import PLATE as OF_TWO

from common import quantity
from coupling import report, run_case
from coupling.advice import Setting, Trial, Trials, advice_text, advise, advised_case, no_advice
from coupling.borders import begins, thresholds_of, why_none
from coupling.case import (
    ActuatorCase,
    Case,
    ConstantCase,
    CoulombCase,
    KogutEtsionCase,
    PartCase,
    PlatformCase,
    RunCase,
    TableCase,
    friction_scales,
    more_plastic,
    ramped_case,
    scaled_case,
    scaled_friction,
    with_index,
)
from coupling.drives import build_drives
from coupling.margins import PathLoads, _actuators, event_actuators, margins_of
from coupling.run import build_friction, follow_part
from coupling.summary import summary_of
from particle import Drive, EventKind, Outcome, State

pytestmark = pytest.mark.compiled

PLATE = DISC | {"density": 2330, "cell_size": 8e-5}


def case_of(stroke=1e-6, frequency=3000, place=(1e-4, 5e-5), **update):
    fields = {
        "plate": PLATE,
        "actuators": [
            ActuatorCase(position=(0.0, 0.0), stroke=stroke, frequency=frequency),
            ActuatorCase(position=(-1.2e-4, 3e-5), stroke=stroke / 2, frequency=frequency),
        ],
        "part": PartCase(mass=2e-9, position=place),
        "friction": CoulombCase(coefficient=0.2, adhesion=2e-7),
        "run": RunCase(duration=3e-3),
    }
    return Case(**fields | update)


def found(result):
    """The trial run that advice found, and its case."""
    trial = advise(result)[0]
    return trial, advised_case(result.case, trial)


@pytest.fixture(scope="module")
def base():
    return run_case(case_of())


def driven(base, drives, friction, place):
    """A case of the same plate under other drives: case, scene and path."""
    case = base.case.model_copy(
        update={"friction": friction, "part": PartCase(mass=2e-9, position=place), "run": RunCase(duration=2e-3)}
    )
    scene = replace(base.scene, lifts=drives, surface=base.scene.surface.driven_by(drives))
    return case, scene, follow_part(case, scene.surface, build_friction(case))


def by_brute_force(case, scene, trajectory):
    """The two margins, each from 2000 samples and from 2000 more around the best of these."""
    friction = build_friction(case)
    law = friction.law
    mass = case.part.mass
    slips = [event.time for event in trajectory.events if event.kind is EventKind.SLIPS]

    def signals(times):
        at = trajectory.contact_at(times)
        held = law.static_ratio * friction.friction_limit(np.clip(at.normal_force, -law.pull_off, law.largest_load))
        stuck = (at.state == State.STICK) | np.isin(times, slips)
        ratio = np.where(stuck, mass * at.pull / np.maximum(held, 1e-300), -np.inf)
        touches = at.state != State.FLIGHT
        return ratio, np.where(touches, -(at.normal_force + law.pull_off) / law.pull_off, -np.inf)

    end, found = trajectory.time[-1], []
    coarse = np.union1d(np.linspace(0, end, 2000), slips)
    for k in (0, 1):
        values = signals(coarse)[k]
        best = int(values.argmax())
        fine = np.linspace(coarse[max(best - 1, 0)], coarse[min(best + 1, len(coarse) - 1)], 2000)
        found.append(max(values.max(), signals(fine)[k].max()))
    return found[0], -found[1]


@pytest.mark.parametrize("seed", range(3))
def test_margins_are_those_of_brute_force(base, seed):
    rng = np.random.default_rng(seed)
    cycles = rng.choice(["up-down", "sine", "up"], 2)
    drives = [
        Drive(rng.uniform(0.3e-6, 6e-6), rng.uniform(1000, 6000), str(cycle), delay=rng.uniform(0, 3e-4))
        for cycle in cycles
    ]
    friction = CoulombCase(coefficient=rng.uniform(0.05, 0.3), adhesion=10 ** rng.uniform(-7.5, -6))
    place = tuple(rng.uniform(-1.5e-4, 1.5e-4, 2))
    case, scene, trajectory = driven(base, drives, friction, place)
    margins = margins_of(scene, PathLoads(case, scene.surface, trajectory, build_friction(case)))
    slip, contact = by_brute_force(case, scene, trajectory)
    slips = [event for event in trajectory.events if event.kind is EventKind.SLIPS]
    if slips:
        assert margins.slip.value == 1 and margins.slip.time == slips[0].time
        assert slip <= 1 + 1e-6
    else:
        assert margins.slip.value == pytest.approx(slip, rel=1e-6)
    if trajectory.outcome is Outcome.DETACHED:
        assert margins.contact.value == 0 and margins.contact.time == trajectory.events[-1].time
    else:
        assert margins.contact.value == pytest.approx(contact, rel=1e-6, abs=1e-6)


def test_the_actuator_that_counts_is_the_one_that_moves_the_place_alone(base):
    for n in (0, 1):
        drives = [Drive(2e-6 if k == n else 1e-9, 3000) for k in (0, 1)]
        place = (-5e-5, 2e-5)
        case, scene, trajectory = driven(base, drives, CoulombCase(coefficient=0.3, adhesion=1e-6), place)
        margins = margins_of(scene, PathLoads(case, scene.surface, trajectory, build_friction(case)))
        assert margins.slip.actuator == margins.contact.actuator == n


def test_curves_hold_the_margins(base):
    curves = base.margin_curves
    margins = base.summary.margins
    assert np.nanmax(curves.slip) == pytest.approx(margins.slip.value, rel=1e-3)
    assert np.nanmin(curves.contact) == pytest.approx(margins.contact.value, rel=1e-3)


def test_a_summary_keeps_margins(base):
    figures = json.loads(json.dumps(base.summary.as_dict()))
    assert summary_of(figures) == base.summary


def test_of_actuators_that_count_the_same_to_rounding_the_first_is_named():
    pair = [ActuatorCase(position=(x, 0.0), stroke=s, frequency=300) for x, s in ((-1e-4, 1e-6), (1e-4, 1e-6 + 1e-15))]
    margins = run_case(case_of(place=(0.0, 8e-5), actuators=pair, run=RunCase(duration=1e-2))).summary.margins
    assert margins.slip.actuator == margins.contact.actuator == 0


@pytest.fixture(scope="module")
def stuck():
    return run_case(case_of(stroke=5e-6, frequency=300))


@pytest.mark.slow
def test_advice_on_a_part_that_stays_is_what_runs_do(stuck):
    assert stuck.trajectory.outcome is Outcome.STUCK and not stuck.trajectory.events
    thresholds, (trial, moving) = stuck.summary.thresholds, found(stuck)
    assert 1 < thresholds.slips_from < thresholds.comes_off_from
    surface, case = stuck.surface, stuck.case
    for factor, slips in ((thresholds.slips_from * 0.9999, False), (thresholds.slips_from * 1.0001, True)):
        path = follow_part(case, surface.scaled(factor), build_friction(case))
        assert (EventKind.SLIPS in [event.kind for event in path.events]) == slips
    moved = run_case(moving)
    assert moved.trajectory.outcome in (Outcome.STUCK, Outcome.MOVING)
    assert moved.summary.distance == pytest.approx(trial.distance, rel=1e-3)
    assert f"{thresholds.comes_off_from:.4g} times" in dict(report.lines(stuck.summary))["thresholds"]
    assert f"moves it by {quantity(trial.distance, 'm')} in" in advice_text(stuck, trial)
    assert summary_of(json.loads(json.dumps(stuck.summary.as_dict()))) == stuck.summary


@pytest.mark.parametrize("thickness, end", [(40e-6, None), (200e-6, Outcome.TIPPED)])
def test_thresholds_of_a_face_are_where_its_runs_slip_and_tip(base, thickness, end):
    face = {"footprint": "rectangle", "sides": (9e-5, 6e-5), "thickness": thickness, "heading": 0.4}
    part = PartCase(mass=2e-9, position=(1e-4, 5e-5), **face)
    case = case_of(part=part, stroke=5e-6, frequency=300, run=RunCase(duration=7e-3))
    scene = replace(base.scene, lifts=(lifts := build_drives(case)), surface=base.scene.surface.driven_by(lifts))
    friction = build_friction(case)
    thresholds = thresholds_of(case, scene, follow_part(case, scene.surface, friction), friction)

    def run(factor):
        return follow_part(case, scene.surface.scaled(factor), friction)

    if end is None:
        assert 1 < thresholds.slips_from < thresholds.comes_off_from
        for share, slips in ((0.9999, False), (1.0001, True)):
            kinds = [event.kind for event in run(thresholds.slips_from * share).events]
            assert (EventKind.SLIPS in kinds) == slips
    else:
        assert thresholds.comes_off_from <= thresholds.slips_from
        ends = [run(thresholds.comes_off_from * share).outcome for share in (0.9999, 1.0001)]
        assert ends == [Outcome.STUCK, end]


def test_a_border_is_found_from_any_start_or_lies_beyond_an_end():
    def excess(x):
        return x**3 - 0.343

    for start in (-3.0, 0.1, 0.7, 2.0):
        assert begins(excess, start, (-3.0, 2.0), 0.4, 1e-9) == pytest.approx(0.7, abs=1e-8)
    assert begins(excess, 0.0, (-3.0, 0.5), 0.4, 1e-9) == math.inf
    assert begins(excess, 1.0, (0.8, 2.0), 0.4, 1e-9) == -math.inf


def test_advice_on_a_platform_becomes_a_case():
    motion = {
        "x": {"stroke": "0.3 um", "frequency": "100 Hz", "delay": "0.1 ms"},
        "z": {"stroke": 0.0, "frequency": 90},
    }
    still = run_case(
        Case(
            plate={"shape": "platform", "motion": motion},
            part=PartCase(mass=2e-9, position=(0.0, 0.0)),
            friction=CoulombCase(coefficient=0.3),
            run=RunCase(duration=0.05),
        )
    )
    trial, moving = found(still)
    assert still.trajectory.distance == 0
    axis = moving.plate.motion.x
    assert axis.frequency == pytest.approx(100 * trial.frequency) and axis.stroke == pytest.approx(3e-7 * trial.stroke)
    assert axis.delay == pytest.approx(1e-4 / trial.frequency)
    moved = run_case(moving)
    assert moved.summary.distance == pytest.approx(trial.distance, rel=1e-3)


@pytest.mark.slow
def test_a_part_that_went_somewhere_is_not_called_stuck():
    still = run_case(case_of(stroke=5e-6, frequency=300)).summary
    assert dict(report.lines(still))["outcome"].startswith("stuck. ")
    went = replace(still, path_length=12.3e-6, slips=3, path_error=1e-9)
    assert dict(report.lines(went))["outcome"].startswith("travelled 12.3 um in 3 slips. The part ")
    thrown = replace(went, slips=0)  # it slid from the start on
    assert dict(report.lines(thrown))["outcome"].startswith("travelled 12.3 um. ")
    unsure = replace(went, path_error=2e-5)
    assert dict(report.lines(unsure))["outcome"].startswith("stuck. ")


@pytest.mark.slow
def test_forces_that_begin_at_once_are_advised_to_grow():
    force = ActuatorCase(position=(0.0, 0.0), force=2e-4, frequency=5e3, cycle="sine")
    shaken = run_case(
        case_of(
            plate=PLATE | {"inertia": True, "damping": 0.2},
            place=(1.5e-4, 0.0),
            actuators=[force],
            friction=CoulombCase(coefficient=0.02, adhesion=2e-7),
        )
    )
    assert shaken.trajectory.outcome is Outcome.DETACHED
    trial, moving = found(shaken)
    assert trial.ramp == 3 and 0 < shaken.summary.thresholds.comes_off_from < trial.stroke
    assert "forces that grow over 3 cycles (ramp = 3)" in advice_text(shaken, trial)
    assert moving.actuators[0].ramp == 3
    moved = run_case(moving)
    assert moved.trajectory.outcome in (Outcome.STUCK, Outcome.MOVING)
    assert moved.summary.distance == pytest.approx(trial.distance, rel=1e-3)


def test_only_forces_that_begin_at_once_grow():
    sine = {"position": (0.0, 0.0), "force": 1e-4, "frequency": 5e3, "cycle": "sine"}
    late, short = sine | {"position": (5e-5, 0.0), "delay": 1e-3}, sine | {"position": (-5e-5, 0.0), "cycles": 5}
    others = [
        {"position": (0.0, 8e-5), "stroke": 1e-6, "frequency": 5e3, "cycle": "sine"},
        {"position": (0.0, -8e-5), "force": 1e-4, "frequency": 5e3},
    ]
    waves = [ActuatorCase(**fields) for fields in [sine, late, short, *others]]

    def ramps(**plate):
        case = ramped_case(case_of(plate=PLATE | plate, actuators=waves), 3.0)
        return [actuator.ramp for actuator in case.actuators]

    assert ramps() == [0, 3, 0, 0, 0]
    assert ramps(inertia=True) == [3, 3, 0, 0, 0]
    assert ramped_case(case_of(), 3.0) is None


def test_a_measured_motion_is_not_scaled():
    measured = Case.model_construct(plate=PlatformCase.model_construct(motion="shaker.csv"), name="shaken")
    with pytest.raises(ValueError, match=r"the motion of its platform is measured, shaker.csv"):
        advised_case(measured, Trial(2.0, 1.0, 1.0, None, 1e-6, 1e-3, 0.0))
    assert scaled_case(measured, 2.0, 3.0) is measured


def test_scaled_numbers_are_short():
    case = case_of(stroke=1e-9, frequency=0.7e3)
    assert scaled_case(case, 3.0, 3.0).actuators[0].stroke == 3.0000000000000004e-09
    short = scaled_case(case, 3.0, 3.0, shortly=True).actuators[0]
    assert (short.stroke, short.frequency) == (3e-9, 2100.0)
    assert scaled_friction(TableCase(loads=(0.0, 1e-7, 2e-7), limits=(0.0, 1e-9, 2e-9)), 3.0).limits == (
        0.0,
        3e-9,
        6e-9,
    )


@pytest.mark.slow
def test_thresholds_state_the_pull_just_before_a_part_comes_off_unslipped():
    sticky = run_case(case_of(stroke=2e-6, frequency=300, friction=KogutEtsionCase()))
    thresholds = sticky.summary.thresholds
    assert thresholds.comes_off_from > 1
    near = run_case(scaled_case(sticky.case, 0.98 * thresholds.comes_off_from, 1.0)).summary
    assert near.margins.slip.value == pytest.approx(thresholds.holds, rel=1e-4) and 0 < thresholds.holds < 1
    said = dict(report.lines(sticky.summary))["thresholds"]
    assert f"the pull is {thresholds.holds:.2g} of the friction limit" in said


@pytest.mark.slow
def test_advice_on_a_part_that_is_lost_keeps_it():
    lost = run_case(case_of(stroke=4e-6, frequency=20_000))
    assert lost.trajectory.outcome is Outcome.DETACHED
    trial = found(lost)[0]
    assert lost.summary.thresholds.comes_off_from < 1 and trial.frequency < 1 and trial.distance > 0


@pytest.mark.slow
def test_trials_beyond_the_bounds_of_the_model_come_last_and_say_so(base):
    free, bounded = advise(base, math.inf)[0], advise(base, 1.0)[0]
    assert bounded.stroke == 1 or bounded.friction == 1
    assert "linear theory at 6 times the thickness" in advice_text(base, replace(free, stroke=30.0))


@pytest.mark.slow
def test_less_friction_is_a_trial_with_scaled_limits(stuck):
    case = stuck.case
    trials = Trials(stuck, largest_stroke=1.0)
    setting = Setting(0.5, 0.8)
    trial = trials.trial(trials.part, math.sqrt(math.prod(trials.thresholds(trials.part, setting))), setting)
    assert trial.distance > 0
    advised = advised_case(case, trial)
    assert advised.friction.coefficient == pytest.approx(0.8 * case.friction.coefficient)
    assert run_case(advised).summary.distance == pytest.approx(trial.distance, rel=1e-3)
    text = advice_text(stuck, trial)
    assert f"0.8 times the friction (coefficient = {advised.friction.coefficient:.3g})" in text


def test_friction_is_scaled_where_a_key_holds_it():
    static = CoulombCase(coefficient=0.3, static_coefficient=0.4, adhesion=1e-8)
    assert scaled_friction(static, 0.5) == CoulombCase(coefficient=0.15, static_coefficient=0.2, adhesion=1e-8)
    table = TableCase(loads=(-1e-8, 0.0, 1e-7), limits=(0.0, 1e-9, 3e-9))
    half = scaled_friction(table, 0.5)
    assert half.loads == table.loads and half.limits == pytest.approx((0.0, 5e-10, 1.5e-9))
    assert friction_scales(KogutEtsionCase(preset="paper")) is None
    with pytest.raises(ValueError, match="no key scales"):
        scaled_friction(KogutEtsionCase(preset="paper"), 0.5)


@pytest.mark.slow
def test_kogut_and_etsion_is_led_to_surfaces_that_hold_less():
    sticky = run_case(case_of(stroke=2e-6, frequency=300, friction=KogutEtsionCase()))
    trial, moving = found(sticky)
    assert trial.plasticity_index > sticky.case.friction.plasticity_index
    assert f"friction.plasticity_index = {trial.plasticity_index:g}" in advice_text(sticky, trial)
    assert run_case(moving).summary.distance == pytest.approx(trial.distance, rel=1e-3)
    assert more_plastic(KogutEtsionCase(preset="paper")) == () == more_plastic(CoulombCase(coefficient=0.2))
    with pytest.raises(ValueError, match="got coulomb"):
        with_index(CoulombCase(coefficient=0.2), 3.0)


@pytest.mark.slow
def test_advice_on_a_constant_friction_says_where_the_plate_would_pull():
    light, strong = (
        run_case(case_of(stroke=5e-6, frequency=300, friction=ConstantCase(limit=limit))) for limit in (2e-9, 4e-8)
    )
    held, trials = advise(light)[0], Trials(strong, 1.0)
    pulled = trials.trial(trials.part, 2 * trials.thresholds(trials.part, Setting()).slips, Setting())
    assert held.smallest_load >= 0 > pulled.smallest_load
    assert "would have to pull" not in advice_text(light, held)
    assert f"a load of {quantity(pulled.smallest_load, 'N')}" in advice_text(strong, pulled)


@pytest.mark.slow
def test_a_part_on_level_ground_is_sent_elsewhere():
    middle = run_case(
        case_of(place=(0.0, 0.0), actuators=[ActuatorCase(position=(0.0, 0.0), stroke=5e-6, frequency=300)])
    )
    trial = advise(middle)[0]
    assert math.hypot(*trial.place) > 1e-5
    assert "nothing pulls the part aside" in dict(report.lines(middle.summary))["margins"]


def test_without_trials_it_is_said_why(base):
    path, farther = base.trajectory, base.trajectory.position + np.linspace(0, 1e-5, len(base.trajectory.time))[:, None]
    moving = replace(path, outcome=Outcome.MOVING, position=farther)
    still = replace(base.scene, lifts=[Drive(0.0, 3000)] * 2)
    pushed = base.case.model_copy(update={"part": base.case.part.model_copy(update={"velocity": (1e-3, 0.0)})})
    for case, scene, trajectory, why in (
        (base.case, base.scene, path, ""),
        (base.case, base.scene, moving, "The part moves already, and stays on."),
        (base.case, base.scene, replace(path, outcome=Outcome.LEFT_PLATE), Outcome.LEFT_PLATE.sentence),
        (base.case, still, path, "No drive moves."),
        (pushed, base.scene, path, "The part is on the move from the start"),
    ):
        text = no_advice(replace(base, case=case, scene=scene, trajectory=trajectory))
        assert text.startswith(why) and bool(text) == bool(why)


@pytest.mark.slow
def test_a_place_that_rounds_off_the_plate_is_not_tried():
    """An actuator 0.2 um from the rim: places around it of three digits lie on the rim."""
    rim = [ActuatorCase(position=(2.998e-4, 0.0), stroke=1e-6, frequency=1000)]
    result = run_case(case_of(place=(1e-5, 0.0), actuators=rim, friction=ConstantCase(limit=1.0)))
    assert advise(result) == [] and advice_text(result, None) == "No trial run kept it and carried it along."


def test_actuators_of_events_are_those_of_each_at_its_own_time(tmp_path, monkeypatch):
    result = run_case(read_text(tmp_path, OF_TWO).vary({"run.duration": "20 ms"}))
    path = result.loads
    alone = [
        int(_actuators(result.scene, path, np.array([event.position]), np.array([event.time]), event.kind)[0])
        if event.kind in (EventKind.SLIPS, EventKind.DETACHES)
        else -1
        for event in result.trajectory.events
    ]
    assert {0, 1} <= set(alone)
    for most in (500_000, 1):
        monkeypatch.setattr("coupling.margins.MAX_SHARES", most)
        assert event_actuators(result.scene, path).tolist() == alone


def test_a_run_that_hit_its_limit_of_work_gets_no_trials_and_says_so():
    limit = Outcome.WORK_LIMIT
    scene = SimpleNamespace(lifts=[Drive(1e-6, 100.0)], base=())
    assert why_none(case_of(), scene, SimpleNamespace(outcome=limit, sentence=limit.sentence)) == limit.sentence


@pytest.mark.slow
def test_the_actuator_of_an_event_is_that_of_the_margin_at_its_time():
    result = run_case(case_of(stroke=4e-6, frequency=4000))
    events, margins = result.trajectory.events, result.summary.margins
    found = event_actuators(result.scene, result.loads)
    assert len(found) == len(events)
    slips = [k for k, event in enumerate(events) if event.kind is EventKind.SLIPS]
    assert slips and events[slips[0]].time == margins.slip.time and found[slips[0]] == margins.slip.actuator
    for k, event in enumerate(events):
        if event.kind is EventKind.DETACHES:
            assert found[k] == margins.contact.actuator
        elif event.kind is not EventKind.SLIPS:
            assert found[k] == -1
