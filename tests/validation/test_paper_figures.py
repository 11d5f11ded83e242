"""Numbers of the paper's figures that do not depend on chance."""

from dataclasses import replace

import numpy as np
import pytest

from paper import deceleration, friction_logic, radial
from paper.models import CLOSED, MODELS, PAPER, Bench
from paper.parameters import PARAMETERS, TINY
from paper.sensitivity import moves_from, threshold

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


def test_figures_13_and_14_slow_down_by_20_9_with_the_preset_and_table_1_holds_the_part(bench):
    for verdict in deceleration.find(bench, TINY).verdicts:
        assert verdict.numbers["preset_at_zero_load"] == pytest.approx(20.9, abs=0.01)
        assert verdict.numbers["table_1_at_zero_load"] == pytest.approx(2334.4, abs=0.1)
        assert verdict.numbers["distance_with_table_1"] == [0.0, 0.0]
        for model in MODELS:
            assert verdict.numbers[f"deceleration_{model}"] == pytest.approx(20.98, abs=0.01)
            assert verdict.numbers[f"straightness_{model}"] > 0.9999


def test_figure_4_slips_and_sticks_when_the_paper_says(bench):
    _, four = friction_logic.find(bench, TINY).verdicts
    for model in (PAPER, CLOSED):
        assert four.numbers[f"slip_{model}"] == pytest.approx(2.41, abs=0.005)
        assert four.numbers[f"stick_{model}"] == pytest.approx(2.864, abs=0.005)


@pytest.mark.parametrize("stroke", [100e-6, 150e-6, 200e-6])
def test_figure_5_begins_at_another_frequency_for_every_stroke(stroke):
    begin = moves_from(Bench(replace(PARAMETERS, stroke=stroke)))
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


def test_figure_18_has_the_threshold_of_the_paper_at_150_um(bench):
    assert threshold(bench, PAPER, 1) == pytest.approx(320, abs=20)
