"""Where parts begin to be lost (figure 18): the best split, its exceptions and the curve through it."""

import numpy as np
import pytest

from active_surface.paper.figures.threshold import _at_stated, _curve, exceptions, mixed, thresholds
from active_surface.paper.split import Ends, best_split, first_loss, fits_of

FREQUENCIES = np.array([200.0, 220.0, 240.0, 260.0, 280.0])
NAN = float("nan")


def ends(*rows):
    """By frequency one letter a start: c converges, l is lost, o neither."""
    letters = np.array([list(row) for row in rows])
    return Ends(letters == "c", letters == "l")


def test_a_sharp_threshold_tells_all():
    sharp = ends("cc", "cc", "ll", "ll", "ll")
    split = best_split(FREQUENCIES, *sharp)
    assert split == (230.0, 1.0, 1.0, 1.0)
    assert mixed(FREQUENCIES, *sharp) is None and exceptions(FREQUENCIES, sharp, split) == ([], [])


def test_a_band_in_which_all_converge_again_is_seen_and_costs():
    """The first loss at 240 Hz is not the end of it: at 260 Hz all converge."""
    bands = ends("cc", "cc", "ll", "cc", "ll")
    split = best_split(FREQUENCIES, *bands)
    assert split.predicted == pytest.approx(0.8) and mixed(FREQUENCIES, *bands) == (240.0, 260.0)
    assert exceptions(FREQUENCIES, bands, split._replace(frequency=230.0)) == ([], [260.0])
    assert exceptions(FREQUENCIES, bands, split._replace(frequency=270.0)) == ([240.0], [])
    assert first_loss(FREQUENCIES, bands.lost) == 230.0


def test_the_first_loss_counts_a_start_that_is_never_lost():
    assert first_loss(FREQUENCIES, ends("cc", "lc", "cc", "cc", "lc").lost) == pytest.approx((210.0 + 290.0) / 2)


def test_to_and_fro_is_told_by_no_threshold():
    assert best_split(FREQUENCIES, *ends("oo", "cc", "co", "ll", "ll")).predicted == pytest.approx(0.7)
    assert np.isnan(best_split(FREQUENCIES, *ends("oo", "oo", "oo", "oo", "oo")).frequency)
    assert best_split(FREQUENCIES, *ends("cc", "cc", "cc", "cc", "cc")).frequency == 290.0
    assert best_split(FREQUENCIES, *ends("ll", "ll", "ll", "ll", "ll")).frequency == 190.0


def test_thresholds_scatter_over_single_starts():
    converges, lost = (rows[None] for rows in ends("cc", "cc", "cl", "cl", "ll"))
    found = thresholds(np.array([150e-6]), FREQUENCIES, Ends(converges, lost))
    assert found.scatter[0] == pytest.approx((234.0, 266.0)) and found.fits is None


@pytest.mark.parametrize(
    ("frequency", "below", "above", "met"),
    [(330.0, 0.95, 1.0, 1.0), (345.0, 0.95, 1.0, 2 / 3), (330.0, 0.6, 0.8, 1 / 3)],
)
def test_18_asks_for_the_place_and_for_what_parts_do_on_either_side(frequency, below, above, met):
    split = best_split(FREQUENCIES, *ends("c", "c", "l", "l", "l"))._replace(
        frequency=frequency, below=below, above=above
    )
    assert _at_stated(split, (300.0, 340.0), 20, None, ([], []), {}).met == pytest.approx(met)


def test_quadratic_and_power_law_are_told_apart():
    strokes = np.linspace(100e-6, 200e-6, 9)
    x = strokes / 150e-6
    square = fits_of(strokes, 900 - 900 * x + 320 * x**2, 150e-6)
    assert square.quadratic_misfit < 1e-6 < square.law_misfit and _curve(square, {}).met == 1
    law = fits_of(strokes, 320 * x**-1.6, 150e-6)
    assert law.law_misfit < 1e-6 and law.exponent == pytest.approx(-1.6) and _curve(law, {}).met == 0.5
    wild = fits_of(strokes, 320 + 100 * (-1.0) ** np.arange(9), 150e-6)
    assert wild.quadratic_misfit > 10 and _curve(wild, {}).met < 1
    assert fits_of(strokes, np.full(9, NAN), 150e-6) is None and _curve(None, {}).met == 0
