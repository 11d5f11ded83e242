"""A wave carries the part of the ring: as fast as another integration, both ways, along a track that keeps it."""

import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from coupling import read_case

SCRIPT = Path(__file__).parents[2] / "docs/ring_wave_pictures.py"
pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def pictures():
    spec = importlib.util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules[SCRIPT.stem] = module  # where dataclasses look names up
    sys.path.insert(0, str(SCRIPT.parent))  # as when it is run: what its pages share stands beside it
    spec.loader.exec_module(module)
    sys.path.remove(str(SCRIPT.parent))
    yield module
    del sys.modules[SCRIPT.stem]


@pytest.fixture(scope="module")
def ring(pictures):
    return pictures.Ring.of(read_case(pictures.CASE))


@pytest.fixture(scope="module")
def alone(ring):
    return ring.driven(track=0.0)


def test_next_to_nothing_runs_back(ring):
    circle = [abs(value) for value in (ring.field.wave(ring.field.crest, n) for n in (-2, 2, 4, -8))]
    assert circle[0] == pytest.approx(21.7e-6, rel=0.01)
    assert circle[1] < 1e-4 * circle[0] and max(circle[2:]) < 1e-2 * circle[0]


@pytest.mark.parametrize("lift", [0.7, 0.85, 0.95])
def test_the_wave_carries_the_part_as_fast_as_scipy_says(alone, lift):
    one = alone.driven(lift / alone.lift, track=0.0)
    radius = one.field.crest
    assert one.speed(radius) == pytest.approx(one.by_scipy(radius), rel=0.06 if lift < 0.8 else 0.02)
    assert 0 < one.speed(radius) < one.sliding


def test_with_hardly_any_friction_it_is_as_fast_as_the_closed_form_says(pictures, alone):
    slippery = alone.case.friction.model_copy(update={"coefficient": 0.005})
    case = alone.case.model_copy(update={"friction": slippery})
    one = pictures.Ring(case, alone.surface, alone.responses)
    assert one.speed(one.field.crest) == pytest.approx(one.sliding, rel=0.02)


def test_on_the_track_it_is_carried_as_fast_as_scipy_says(ring):
    radius = ring.case.part.position[0]
    speed = ring.speed(radius)
    assert speed == pytest.approx(ring.by_scipy(radius), rel=0.01)
    assert ring.driven(way=-1).speed(radius) == pytest.approx(-speed, rel=1e-3)


def test_friction_holds_the_part_up_to_a_threshold_in_closed_form(alone):
    weak, strong = (alone.driven(share * alone.creeps / alone.lift, track=0.0) for share in (0.97, 1.03))
    radius = alone.field.crest
    still, moving = (one.follow(radius, 0.03) for one in (weak, strong))
    assert still.outcome == "stuck" and np.ptp(still.position, axis=0).max() == 0
    assert np.ptp(moving.position, axis=0).max() > 1e-9


def test_the_part_lifts_off_where_the_plate_sinks_faster_than_it_is_pressed_on(pictures, alone):
    load, sunk = pictures.lift_off(alone)
    assert load == pytest.approx(sunk, rel=1e-3)
    assert sunk == pytest.approx(alone.lift * alone.load, rel=0.02)


def test_only_the_track_keeps_parts_near_the_circle(ring, alone):
    def outward(one, radius):
        return math.hypot(*one.follow(radius, 0.15).position[-1]) - radius

    assert outward(alone, 5.8e-3) < -20e-6 and outward(alone, 6.6e-3) > 20e-6
    assert outward(ring, 5.4e-3) > 20e-6 and outward(ring, 6.8e-3) < -20e-6


@pytest.mark.slow
@pytest.mark.parametrize("radius", [5.4e-3, 7.0e-3])
def test_parts_beside_the_track_hop_to_it_and_stay_in_contact(pictures, ring, radius):
    path = ring.follow(radius, 0.9)
    assert 5.8e-3 < math.hypot(*path.position[-1]) < 6.4e-3
    assert 0 < pictures.landings(path)[-1] < 0.8
