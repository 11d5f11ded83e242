"""Where parts begin to be lost (figure 18): the first loss, what happens around it, and the curve through it."""

import numpy as np
import pytest

from active_surface.paper.figures.threshold import _at_stated, curve_answer, shares_around
from active_surface.paper.loss import Ends, first_loss, fits_of

FREQUENCIES = np.array([280.0, 300.0, 320.0, 340.0, 360.0])
NAN = float("nan")


def ends(*rows, starts=10):
    """By frequency: c all converge, l all are lost, o all go to and fro, s all stay, 1 one of them is lost."""
    letters = np.array([["l" if k == 0 and row == "1" else row for k in range(starts)] for row in rows])
    return Ends(np.isin(letters, ["c", "1"]), letters == "l", letters != "s")


def test_the_threshold_is_the_first_loss_of_more_than_one_start_in_ten():
    assert first_loss(FREQUENCIES, ends(*"cclll")) == 310.0
    assert first_loss(FREQUENCIES, ends(*"c1lcl")) == 310.0  # one start of ten is tolerated; bands above do not count
    assert first_loss(FREQUENCIES, ends(*"c1lll", starts=9)) == 290.0
    assert np.isnan(first_loss(FREQUENCIES, ends(*"ccccc"))) and first_loss(FREQUENCIES, ends(*"lllll")) == 270.0


def test_shares_around_a_threshold_count_parts_that_move():
    below, above = shares_around(FREQUENCIES, ends(*"sclcl"), 310.0)
    assert (below.hits, below.of, above.hits, above.of) == (10, 10, 20, 30)
    below, _ = shares_around(FREQUENCIES, ends(*"oclll"), 310.0)
    assert below.value == 0.5


@pytest.mark.parametrize(
    ("rows", "below", "above"), [("cclll", 1.0, 1.0), ("oclll", 0.5, 1.0), ("ccccl", 0.5, 1.0), ("cclcc", 1.0, 0.5)]
)
def test_18_asks_for_the_place_and_what_parts_do_on_either_side(rows, below, above):
    converge, leave = _at_stated(FREQUENCIES, {"paper": ends(*rows, starts=40)})
    assert converge.answers["paper"].met == below and leave.answers["paper"].met == above


def test_a_quadratic_must_be_as_near_as_thresholds_are_known():
    strokes = np.linspace(100e-6, 200e-6, 9)
    x = strokes / 150e-6
    square = fits_of(strokes, 900 - 900 * x + 320 * x**2, 150e-6)
    assert square.quadratic_misfit < 1e-6 < square.law_misfit and curve_answer(square, 20.0, x).met == 1
    law = fits_of(strokes, 320 * x**-1.6, 150e-6)
    assert law.law_misfit < 1e-6 and law.exponent == pytest.approx(-1.6) and law.quadratic_misfit < 10
    wild = fits_of(strokes, 320 + 100 * (-1.0) ** np.arange(9), 150e-6)
    assert wild.quadratic_misfit > 10 and curve_answer(wild, 20.0, x).met == 0
    assert fits_of(strokes, np.full(9, NAN), 150e-6) is None and curve_answer(None, 20.0, x).met == 0
