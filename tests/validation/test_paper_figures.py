"""Numbers of the paper's figures that do not depend on chance."""

import numpy as np
import pytest

from active_surface.paper.bench import CLOSED, MODELS, PAPER, PARAMETERS, Bench
from active_surface.paper.feasible_area import onset
from active_surface.paper.reproduction import found_of
from active_surface.paper.strokes import PLATFORMS
from active_surface.paper.threshold import loss_from

pytestmark = pytest.mark.compiled


@pytest.fixture(scope="module")
def bench():
    return Bench()


def test_figure_11_has_a_constant_ratio_and_figure_12_a_straight_path_to_1e_9(bench):
    eleven, twelve = found_of(("fig11", "fig12"), bench).verdicts
    assert eleven.verdict == twelve.verdict == "reproduced"
    for model in MODELS:
        assert eleven.numbers[model]["ratio"] < 1e-9 and twelve.numbers[model]["bend"] < 1e-9


def test_figures_13_and_14_slow_down_along_one_line_and_table_1_gives_another_value(bench):
    slows, value = found_of(("fig13", "fig14"), bench).verdicts
    assert slows.verdict == "reproduced" and value.verdict == "not"
    table = value.numbers[PAPER]
    assert table["preset_at_zero_load"] == pytest.approx(20.9, abs=0.01)
    assert table["at_zero_load"] == pytest.approx(2334.4, abs=0.1) and table["distance"] == [0.0, 0.0]
    rates = dict.fromkeys(MODELS, [20.90, 20.90]) | {"held_up": [19.68, 19.08], "with_gravity": [20.98, 20.98]}
    for name, both in rates.items():
        assert slows.numbers[name]["rate"] == pytest.approx(both, abs=0.01)


def test_figure_4_slips_and_turns_when_the_paper_says_and_is_at_rest_once_after_each_reversal(bench):
    _, four, reversals = found_of(("fig3", "fig4"), bench).verdicts
    assert four.verdict == "reproduced" and reversals.verdict == "partly"
    other = PLATFORMS[1].name
    for model in (PAPER, CLOSED):
        for name, pause in ((model, 0.0), (f"{other}: {model}", 0.38)):
            found = four.numbers[name]
            assert found["slips"] == pytest.approx(2.41, abs=0.005)  # the platforms' friction was chosen for that
            assert found["sticks"] == pytest.approx(2.87, abs=0.01)
            assert found["turns"] and found["again"] - found["sticks"] == pytest.approx(pause, abs=0.01)
    cubic, linear = (reversals.numbers[name] for name in (PAPER, f"{other}: {PAPER}"))
    assert cubic["reversals"][-3:] == pytest.approx(np.pi / 6.25 * np.array([5, 6, 7]), abs=1e-6)
    assert linear["reversals"][-2:] == pytest.approx([2.49, 3.46], abs=0.01)


@pytest.mark.parametrize("stroke", [100e-6, 150e-6, 200e-6])
def test_figure_5_begins_at_another_frequency_for_every_stroke(stroke):
    begin = onset(Bench(), CLOSED, stroke)
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


@pytest.mark.parametrize(("model", "count"), [(PAPER, 4), (CLOSED, 10)])
def test_figure_18_has_the_threshold_of_the_paper_at_150_um(bench, model, count):
    assert loss_from(bench, model, 150e-6, 20.0, count) == pytest.approx(320, abs=20)
