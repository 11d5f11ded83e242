"""Plates that vibrate under tension, and with a table of damping, against exact radial series."""

import numpy as np
import pytest
from radial_vibration import FORCE, RadialDisc, strokes
from vibrating_discs import (
    DISC,
    FIRST,
    RADIUS,
    RIGIDITY,
    UNIT,
    R,
    case_of,
    off,
    on_radii,
    up_down,
)

from active_surface.studies.response import response
from coupling import build_surface

pytestmark = pytest.mark.compiled
TENSION, UNIT_TENSION = 30.0, RIGIDITY / RADIUS**2
TENSE = RadialDisc(tension=TENSION)
TENSE_FIRST = TENSE.omega[0] * UNIT / (2 * np.pi)  # Hz


def test_the_series_under_tension():
    """Its static force is that of the plate, its modes add up to its shape, and it goes over into that without."""
    for tension, ratio in ((10.0, 1.5998789), (100.0, 6.0058331)):
        tense = RadialDisc(stiffness=FORCE, tension=tension)
        assert 1 / tense.phi(np.zeros(1))[0] / (16 * np.pi) == pytest.approx(ratio, rel=1e-7)
    s, weights = np.polynomial.legendre.leggauss(100)
    r, dr = (1 + s) / 2, weights / 2
    whole = 2 * np.pi * (r * dr) @ TENSE.phi(r) ** 2
    assert TENSE.participation**2 @ TENSE.norms == pytest.approx(whole, rel=2e-4)  # falls as 1/count^2
    slack = RadialDisc(tension=1e-5, count=8)
    assert slack.omega == pytest.approx(DISC.omega[:8], rel=1e-6) and slack.phi(R) == pytest.approx(
        DISC.phi(R), rel=1e-6
    )
    membrane = RadialDisc(stiffness=FORCE, tension=1e8, count=5).omega / 1e4  # J0(k) = 0
    assert membrane == pytest.approx([2.40482556, 5.52007811, 8.65372791, 11.79153444, 14.93091771], rel=2e-4)


def test_frequencies_and_responses_under_tension():
    tense = {"tension": TENSION * UNIT_TENSION}
    frequencies = np.array([0.1, 0.5, 0.95, 1.0, 1.02, 2.0]) * TENSE_FIRST
    case = case_of(up_down(20e3), 1e-3, tense)
    found = response(case, on_radii(), frequencies)
    truth = TENSE.transfer(R, 2 * np.pi * frequencies / UNIT, 0.02)
    assert (np.abs(found.values[:, 0] - truth) < 1e-4 * np.abs(truth)).all()
    assert response(case, on_radii()).resonances[:2] == pytest.approx(TENSE.omega[:2] * UNIT / (2 * np.pi), rel=1e-6)


@pytest.mark.slow
def test_strokes_under_tension_move_the_disc_as_its_series():
    end = 4 / (0.3 * TENSE_FIRST)
    surface = build_surface(
        case_of(up_down(0.3 * TENSE_FIRST), end, {"tension": TENSION * UNIT_TENSION, "cell_size": 60e-6})
    )
    pieces, times = strokes(1e-6, 0.3 * TENSE_FIRST, 5), np.random.default_rng(6).uniform(0, end, 20)
    in_w, in_w_tt = off(surface, pieces, times, TENSE)
    assert in_w < 1e-5 and in_w_tt < 1e-3
    in_w, in_w_tt = off(surface, pieces, times)  # the same disc without tension
    assert in_w > 0.01 and in_w_tt > 0.1


TABLE = (
    (FIRST, 0.05),
    (2 * FIRST, 0.002),
    (6 * FIRST, 0.03),
)  # the second resonance is at 2.72 FIRST, the third at 5.33


def tabled(frequencies):
    """Damping ratios, on straight lines between the table's points and constant beyond."""
    (f_0, z_0), (f_1, z_1), (f_2, z_2) = TABLE
    first, second = (frequencies - f_0) / (f_1 - f_0), (frequencies - f_1) / (f_2 - f_1)
    lines = np.where(frequencies < f_1, z_0 + first * (z_1 - z_0), z_1 + second * (z_2 - z_1))
    return np.where(frequencies < f_0, z_0, np.where(frequencies > f_2, z_2, lines))


DAMPINGS = tabled(DISC.omega * UNIT / (2 * np.pi))


def test_responses_with_a_table_of_damping():
    own = DISC.omega[:3] * UNIT / (2 * np.pi)
    assert DAMPINGS[:3] == pytest.approx([0.05, 0.0070736, 0.0253079], rel=1e-4)
    frequencies = np.sort([*own, *(1.005 * own), *(0.98 * own), 0.3 * FIRST])
    found = response(case_of(up_down(20e3), 1e-3, {"damping": TABLE}), on_radii(), frequencies)
    truth = DISC.transfer(R, 2 * np.pi * frequencies / UNIT, DAMPINGS)
    assert (np.abs(found.values[:, 0] - truth) < 1e-3 * np.abs(truth)).all()
    assert found.dampings == pytest.approx(DAMPINGS[:3], rel=1e-5)


@pytest.mark.slow
def test_strokes_with_a_table_of_damping_move_the_disc_as_its_series():
    frequency = 0.55 * FIRST
    end = 6 / frequency
    surface = build_surface(case_of(up_down(frequency), end, {"damping": TABLE, "cell_size": 40e-6}))
    pieces, times = strokes(1e-6, frequency, 7), np.random.default_rng(7).uniform(0, end, 20)
    in_w, in_w_tt = off(surface, pieces, times, ratio=DAMPINGS)
    assert in_w < 1e-5 and in_w_tt < 1e-3
    assert off(surface, pieces, times, ratio=0.02)[1] > 0.05  # one ratio for all
