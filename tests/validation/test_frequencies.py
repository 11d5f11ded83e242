"""Natural frequencies of the clamped disc against the roots of its frequency equation (Leissa, 1969)."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ive, jv

from fem_plate import Plate, PlateSection
from meshes import disc

RADIUS = 300e-6


def root(order: int, low: float, high: float) -> float:
    """k a from J_n(k) I_n+1(k) + I_n(k) J_n+1(k) = 0."""
    return brentq(lambda k: jv(order, k) * ive(order + 1, k) + ive(order, k) * jv(order + 1, k), low, high, xtol=1e-14)


@pytest.fixture(scope="module")
def plate(section: PlateSection) -> Plate:
    return Plate(disc(RADIUS, RADIUS / 8), section)


def hertz(section: PlateSection, k: np.ndarray) -> np.ndarray:
    return k**2 / (2 * np.pi * RADIUS**2) * np.sqrt(section.rigidity / (section.density * section.thickness))


def test_first_six_frequencies_of_the_clamped_disc(plate, section):
    k = np.array([root(0, 3, 3.5), *2 * [root(1, 4.4, 4.8)], *2 * [root(2, 5.7, 6.1)], root(0, 6.2, 6.5)])
    assert plate.frequencies(6) == pytest.approx(hertz(section, k), rel=2e-8)


def test_a_held_centre_leaves_the_modes_that_do_not_move_it(plate, section):
    k = root(1, 4.4, 4.8)
    assert plate.frequencies(2, held=[(0, 0)]) == pytest.approx(hertz(section, np.array([k, k])), rel=1e-8)


def test_a_held_centre_stiffens_the_symmetric_mode(plate, section):
    """sqrt(lambda) = 22.7 in the literature; point supports are followed to three digits."""
    third = plate.frequencies(3, held=[(0, 0)])[2]
    assert third / hertz(section, np.array(1.0)) == pytest.approx(22.74, rel=1e-3)


def test_same_bits_every_time(plate):
    assert (plate.frequencies(3) == plate.frequencies(3)).all()


def test_without_density_it_says_what_is_missing():
    bare = Plate(disc(RADIUS, RADIUS / 4), PlateSection(169e9, 0.3, 5e-6))
    with pytest.raises(ValueError, match="density"):
        bare.frequencies(1)


def test_a_held_point_beyond_the_rim_is_refused(plate):
    with pytest.raises(ValueError, match="inside the rim"):
        plate.frequencies(1, held=[(2 * RADIUS, 0)])
