"""Natural frequencies against their closed frequency equations (A. W. Leissa, Vibration of Plates, NASA SP-160, 1969).

Discs: chapter 2. Squares: all sides simply supported in closed form, two opposite ones by Levy, else by Ritz's method
(chapter 4). The references are computed in `plate_modes`; the digits that Leissa prints are checked beside them.
"""

import numpy as np
import plate_modes
import pytest

from fem_plate import Plate, PlateSection
from meshes import annulus, disc, ellipse, rectangle

UNIT = PlateSection(youngs_modulus=12 * (1 - 0.3**2), poisson_ratio=0.3, thickness=1.0, density=1.0)
C, S, F = "clamped", "simply-supported", "free"
SIDES = ("left", "right", "bottom", "top")


def omega(mesh, supports, count, held=None):
    return 2 * np.pi * Plate(mesh, UNIT, supports).frequencies(count, held)


@pytest.mark.parametrize(
    "support, printed",
    [(C, [10.2158, 21.26, 21.26, 34.88]), (S, [4.935, 13.898, 13.898, 25.6]), (F, [5.36, 5.36, 9.0])],
)
def test_first_frequencies_of_the_disc(support, printed):
    """Leissa's tables 2.1, 2.3 and 2.5; some of his digits for nu = 0.33 and 0.3 are rounded."""
    found = omega(disc(1.0, 0.15), support, 6)
    assert found == pytest.approx(plate_modes.disc(support, 6), rel=5e-8)
    assert found[: len(printed)] == pytest.approx(printed, rel=1e-2)


@pytest.mark.parametrize("nu", [0.0, 0.45])
def test_poissons_ratio_of_a_free_disc(nu):
    section = PlateSection(12 * (1 - nu**2), nu, 1.0, 1.0)
    found = 2 * np.pi * Plate(disc(1.0, 0.2), section, "free").frequencies(4)
    assert found == pytest.approx(plate_modes.disc(F, 4, nu), rel=1e-7)


@pytest.mark.parametrize("support", [C, S, F])
def test_a_held_centre_of_the_disc(support):
    """Sqrt(lambda) = 22.7 in the literature for the clamped one: its third here."""
    found = omega(disc(1.0, 0.15), support, 4, [(0, 0)])
    assert found == pytest.approx(plate_modes.disc(support, 4, centre_held=True), rel=2e-8)
    if support == C:
        assert found[2] == pytest.approx(22.74, rel=1e-3)


def test_first_frequencies_of_the_simply_supported_square():
    found = omega(rectangle(1.0, 1.0, 0.1), S, 4)
    assert found == pytest.approx(np.pi**2 * np.array([2, 5, 5, 8]), rel=1e-7)


def test_first_frequencies_of_the_clamped_square():
    found = omega(rectangle(1.0, 1.0, 0.1), C, 4)
    assert found == pytest.approx(plate_modes.ritz_rectangle(1.0, 1.0, (C,) * 4)[0][:4], rel=1e-6)
    assert found == pytest.approx([35.992, 73.413, 73.413, 108.27], rel=1e-3)  # Leissa, table 4.28


def test_first_frequencies_of_the_free_square():
    found = omega(rectangle(1.0, 1.0, 0.1), F, 7)
    assert found == pytest.approx(plate_modes.ritz_rectangle(1.0, 1.0, (F,) * 4, degree=24)[0][3:10], rel=1e-6)


@pytest.mark.parametrize("supports", [(C, C), (C, S), (C, F), (S, F), (F, F)])
def test_first_frequencies_of_rectangles_by_levy(supports):
    found = omega(rectangle(2.0, 1.4, 0.15), dict(zip(SIDES, (S, S, *supports), strict=True)), 4)
    assert found == pytest.approx(plate_modes.levy_rectangle(2.0, 1.4, supports, 4), rel=2e-7)


def test_first_frequencies_of_the_cantilever():
    """Ritz comes from above, slowly: the clamped side's corners are singular."""
    found = omega(rectangle(2.0, 1.4, 0.2), {"left": C}, 4)
    bounds = plate_modes.ritz_rectangle(2.0, 1.4, (C, F, F, F), degree=24)[0][:4]
    assert ((found < bounds) & (found > bounds * (1 - 2e-5))).all()


@pytest.mark.parametrize("supports", [C, S, F])
def test_a_nearly_round_ellipse_is_nearly_a_disc(supports):
    """To first order a change of the axes by +-e moves the mean of a pair by nothing."""
    e = 1e-4
    found, truth = omega(ellipse(1 + e, 1 - e, 0.2), supports, 5), plate_modes.disc(supports, 5)
    first = 0 if supports == F else 1
    assert found[first : first + 2].mean() == pytest.approx(truth[first : first + 2].mean(), rel=1e-6)


@pytest.mark.parametrize("outer", [C, S])
def test_an_annulus_with_a_tiny_free_hole_is_nearly_a_disc(outer):
    found = omega(annulus(0.01, 1.0, 0.35), {"outer": outer}, 3)
    assert found == pytest.approx(plate_modes.disc(outer, 3), rel=2e-3)
