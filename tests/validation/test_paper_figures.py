"""Numbers of the paper's figures that do not depend on chance."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from active_surface.paper.figures import deceleration, friction_logic, radial, threshold
from active_surface.paper.figures.feasible_area import onset
from active_surface.paper.figures.radial import one_cycle
from active_surface.paper.models import CLOSED, MODELS, PAPER, Bench
from active_surface.paper.parameters import PARAMETERS, TINY

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def bench():
    return Bench()


def test_figure_11_has_a_constant_ratio_and_figure_12_a_straight_path_to_1e_9(bench):
    eleven, twelve = radial.find(bench, TINY).verdicts
    assert eleven.verdict == twelve.verdict == "reproduced"
    for model in MODELS:
        assert eleven.numbers[f"ratio_{model}"] < 1e-9
        assert twelve.numbers[f"bend_{model}"] < 1e-9


def test_figures_13_and_14_slow_down_along_one_line_and_table_1_gives_another_value(bench):
    slows, value = deceleration.find(bench, TINY).verdicts
    assert slows.verdict == "reproduced" and value.verdict == "not"
    assert value.numbers["preset_at_zero_load"] == pytest.approx(20.9, abs=0.01)
    assert value.numbers["table_1_at_zero_load"] == pytest.approx(2334.4, abs=0.1)
    assert value.numbers["distance_with_table_1"] == [0.0, 0.0]
    for model in MODELS:
        assert [one["rate"] for one in slows.numbers[model]] == pytest.approx([20.90, 20.90], abs=0.01)
    for name, rates in (("held_up", [19.68, 19.08]), ("with_gravity", [20.98, 20.98])):
        assert [one["rate"] for one in slows.numbers[name]] == pytest.approx(rates, abs=0.01)
    weighty = Bench(replace(PARAMETERS, gravity=9.80665))
    assert deceleration.slows_as_stated(bench, CLOSED, one_cycle(bench)) == 1.0
    assert deceleration.slows_as_stated(weighty, CLOSED, one_cycle(weighty)) == 0.0


def test_figure_4_slips_and_turns_when_the_paper_says_and_is_at_rest_once_after_each_reversal(bench):
    _, four, reversals = friction_logic.find(bench, TINY).verdicts
    assert four.verdict == "reproduced" and reversals.verdict == "partly"
    cubic, linear = (four.numbers[platform.name] for platform in friction_logic.PLATFORMS)
    for model in (PAPER, CLOSED):
        for own, pause in ((cubic, 0.0), (linear, 0.38)):
            found = own[model]
            assert found["slips"] == pytest.approx(2.41, abs=0.005)  # the platforms' friction was chosen for that
            assert found["sticks"] == pytest.approx(2.87, abs=0.01)
            assert found["turns"] and found["again"] - found["sticks"] == pytest.approx(pause, abs=0.01)
    assert cubic["reversals"][-3:] == pytest.approx(np.pi / 6.25 * np.array([5, 6, 7]), abs=1e-6)
    assert linear["reversals"][-2:] == pytest.approx([2.49, 3.46], abs=0.01)


@pytest.mark.parametrize("stroke", [100e-6, 150e-6, 200e-6])
def test_figure_5_begins_at_another_frequency_for_every_stroke(stroke):
    begin = onset(Bench(), CLOSED, stroke, 50)
    assert begin == pytest.approx(least_frequency(stroke), rel=0.03)
    assert (begin < 150) == (stroke > 100e-6)


def least_frequency(stroke):
    """The lowest frequency that slips, of constant friction Q(mg), by a fine search over place and time."""
    q = np.linspace(0.01, 0.99, 400)
    s = np.linspace(0.01, 0.99, 400)[:, None]
    phi, slope = 1 - q**2 + 2 * q**2 * np.log(q), 4 * q * np.log(q) / PARAMETERS.radius
    rise, pull = 10 * s**3 - 15 * s**4 + 6 * s**5, 60 * s - 180 * s**2 + 120 * s**3
    limit = float(PARAMETERS.friction.friction_limit(0.0)) / PARAMETERS.mass
    low, high = 10.0, 2000.0
    while high - low > 0.1:
        middle = (low + high) / 2
        slips = False
        for way, acceleration in ((rise, pull), (1 - rise, -pull)):
            g = stroke * way * slope
            b = PARAMETERS.gravity + stroke * (2 * middle) ** 2 * acceleration * phi
            slips |= bool((np.abs(b * g) / np.sqrt(1 + g**2) > limit).any())
        low, high = (low, middle) if slips else (middle, high)
    return high


class Falling:
    """Speeds up for 1.25 ms, then slows down by 2 m/s^2."""

    at_rest_since, time = None, np.array([0.0, 5e-3])

    def at(self, times):
        speed = np.where(times < 1.25e-3, 100 * times, 1 - 2 * times)
        return SimpleNamespace(velocity=np.stack([speed, 0 * speed], axis=1), friction_force=2 + 0 * times)


def test_each_stroke_in_1_over_f_makes_the_cycle_twice_as_long():
    bench = Bench(replace(PARAMETERS, period_share=0.5))
    drive = one_cycle(bench)
    assert drive.frequency == 800 and bench.duration(drive) == pytest.approx(30 / 800)
    part = SimpleNamespace(trajectory=Falling())
    assert deceleration.slowing(part, 1.0, drive).rate == pytest.approx(2.0)
    assert deceleration.slowing(part, 1.0, drive).straight == pytest.approx(1.0)


@pytest.mark.parametrize(("model", "count"), [(PAPER, 4), (CLOSED, 10)])
def test_figure_18_has_the_threshold_of_the_paper_at_150_um(bench, model, count):
    assert threshold.loss_from(bench, model, 150e-6, 20.0, count) == pytest.approx(320, abs=20)
