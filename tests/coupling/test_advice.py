"""Advice on arrays: which actuators to drive, before anything that a user does not control."""

from types import SimpleNamespace

import numpy as np
import pytest

from coupling import run_case
from coupling.advice import Choice, advice_text, advise, advised_case
from coupling.advice.choices import WAVES, choices_of
from coupling.case import (
    ActuatorCase,
    Case,
    CoulombCase,
    PartCase,
    RunCase,
    endless_case,
    groups_of,
    running_case,
)
from coupling.scene import lifts_of
from particle import Outcome

PLATE = {
    "shape": "rectangle",
    "width": 2.4e-3,
    "height": 2e-3,
    "supports": "clamped",
    "youngs_modulus": 169e9,
    "poisson_ratio": 0.064,
    "thickness": 1e-4,
    "density": 2330,
}


def array(frequency=1e3, **drive):
    places = [(5e-4 * x, 5e-4 * y) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    return Case(
        plate=PLATE,
        actuators=[ActuatorCase(position=place, stroke=5e-6, frequency=frequency, **drive) for place in places],
        part=PartCase(mass=1e-9, position=(0.0, 8e-5)),
        friction=CoulombCase(coefficient=0.2, adhesion=5e-7),
        run=RunCase(duration=15e-3),
        name="array",
    )


def test_lines_of_an_array_are_counted_from_the_left_and_from_below():
    case = array()
    assert groups_of(case, "columns") == {"column 0": (0, 3, 6), "column 1": (1, 4, 7), "column 2": (2, 5, 8)}
    assert groups_of(case, "rows")["row 0"] == (0, 1, 2) and groups_of(case, "all") == {"all": tuple(range(9))}
    assert groups_of(case, "each")["actuator 8"] == (8,)
    with pytest.raises(ValueError, match='must be "all", "columns", "rows" or "each"; got \'lines\''):
        groups_of(case, "lines")


def test_a_choice_lets_others_rest_or_run_behind():
    case = array()
    alone = Choice("column 0", (0, 3, 6)).of(case)
    assert [one.stroke for one in alone.actuators] == [5e-6, 0, 0] * 3
    wave = Choice("columns", tuple(range(9))).of(case)
    assert [one.delay for one in wave.actuators] == pytest.approx([0, 2.5e-4, 5e-4] * 3)
    with pytest.raises(ValueError, match="from 0 to 8; got 9"):
        running_case(case, [9])
    table = ActuatorCase(position=(0.0, 0.0), table=[(0.0, 0.0), (1e-3, 5e-6), (2e-3, 0.0)])
    resting = running_case(case.model_copy(update={"actuators": (table, *case.actuators[1:])}), [1]).actuators[0]
    assert resting.table is None and resting.stroke == 0


@pytest.mark.parametrize(
    "running, waves", [(range(9), ["columns", "rows"]), ([0, 3, 6], ["rows"]), ([0, 1], ["columns"]), ([4], [])]
)
def test_a_wave_is_over_lines_of_which_several_move(running, waves):
    case = array()
    shapes = SimpleNamespace(points=np.array([one.position for one in case.actuators]))
    scene = SimpleNamespace(lifts=lifts_of(running_case(case, running)), shapes=shapes, stretch=None, has_inertia=False)
    names = [choice.name for choice in choices_of(case, scene, case.part.position)]
    assert [name for name in names if name in WAVES] == waves


def test_drives_without_an_end_keep_their_strokes():
    ended = endless_case(array(cycles=5))
    assert all(one.cycles is None and one.stroke == 5e-6 for one in ended.actuators)
    with pytest.raises(ValueError, match=r'actuators\[0\].cycle must not be "up"'):
        endless_case(array(cycle="up"))


@pytest.mark.slow
@pytest.mark.compiled
def test_an_array_that_stands_still_is_led_to_lines_that_run_alone():
    still = run_case(array())
    assert still.trajectory.outcome is Outcome.STUCK and not still.trajectory.events
    ranked = advise(still)
    best = ranked[0]
    assert len(best.choice.running) < 9 and (best.friction, best.plasticity_index, best.place) == (1, None, None)
    assert [one.score for one in ranked] == sorted((one.score for one in ranked), reverse=True)
    moved = run_case(advised_case(still.case, best))
    assert moved.summary.distance == pytest.approx(best.distance, rel=1e-3) and best.distance > 2e-5
    assert moved.summary.largest_slope < 0.2 and moved.summary.largest_strain < 0.005
    assert moved.summary.quasi_static_error <= 0.05 * (1 + 1e-6)
    text = advice_text(still, best)
    assert f"with actuators {', '.join(map(str, best.choice.running[:-1]))} and {best.choice.running[-1]} alone" in text
    assert text.endswith(f"All 9 together pull with {still.summary.margins.slip.value:.2g} of the friction limit.")
