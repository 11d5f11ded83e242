"""The reference for air under a face against series, published and earlier results, and itself on finer grids."""

from __future__ import annotations

import numpy as np
import pytest
from reynolds import (
    FREE_PATH,
    SIDE,
    STROKE,
    VISCOSITY,
    Film,
    RoughContact,
    bgk_flow,
    extremes,
    flow,
    share_of_series,
    strokes,
    tilt_by_collocation,
)

from particle import KogutEtsion

pytestmark = pytest.mark.compiled
WEIGHT = 2e-9 * 9.80665  # N
PULL_OFF = 3.716020e-6  # N, rounded: what the strokes are measured in


@pytest.fixture(scope="module")
def contact() -> RoughContact:
    return RoughContact(KogutEtsion())


@pytest.fixture(scope="module")
def rest(contact):
    """Gap [m] and the contact's stiffness [N/m] under the part's weight."""
    gap = contact.gap(WEIGHT)
    return gap, -contact.slope(gap) * SIDE**2


def test_damping_and_tilt_are_those_of_the_membrane_s_series(contact, rest):
    m = np.arange(1.0, 2000, 2)
    squeeze, tilt = (
        12 * (c / np.pi**6 / np.outer(k, m) ** 2 / (k[:, None] ** 2 + m**2)).sum() for c, k in ((64, m), (16, m + 1))
    )
    assert squeeze == pytest.approx(0.421731045, abs=1e-9)
    assert tilt == pytest.approx(0.0116022885, abs=1e-10)
    assert tilt_by_collocation(10) == pytest.approx(tilt, rel=1e-6)
    gap, stiffness = rest
    share = Film(contact, lambda t: WEIGHT, points=8).share(1.0)
    damping = (stiffness / share).imag / (2 * np.pi)
    assert damping * gap**3 * flow(FREE_PATH / gap) / (VISCOSITY * SIDE**4) == pytest.approx(squeeze, rel=1e-6)


@pytest.mark.parametrize(
    ("frequency", "size", "degrees"), [(100, 0.997094, -3.80), (1e3, 0.796404, -31.51), (1e4, 0.191507, -36.66)]
)
def test_asperities_share_of_a_small_load(contact, rest, frequency, size, degrees):
    gap, stiffness = rest
    assert gap == pytest.approx(88.727749e-9, abs=1e-15)
    assert stiffness == pytest.approx(1340.28, abs=5e-3)
    share = Film(contact, lambda t: WEIGHT, points=8).share(frequency)
    assert share == pytest.approx(share_of_series(stiffness, gap, frequency), rel=5e-7)
    assert abs(share) == pytest.approx(size, abs=1e-6)
    assert np.degrees(np.angle(share)) == pytest.approx(degrees, abs=5e-3)


def span(times, gaps, loads) -> list[float]:
    """Least and largest load [uN] and gap [nm]."""
    return [1e6 * v for v in extremes(times, loads)] + [1e9 * v for v in extremes(times, gaps)]


# In the second millisecond: an earlier solution in two dimensions, where there is one, and this one with 14 points.
@pytest.mark.parametrize(
    ("size", "earlier", "finer"),
    [
        (0.9, (-2.2414, 2.6968, 87.148, 91.090), (-2.2413673, 2.6967713, 87.1478259, 91.0894922)),
        (1.5, (-3.2808, 4.5848, 86.343, 93.478), (-3.2807492, 4.5847887, 86.3429900, 93.4780044)),
        (4.0, None, (-3.7160197, 11.4738114, 84.3391609, 120.2846401)),
    ],
)
def test_asperities_under_strokes_up_to_beyond_pull_off(contact, size, earlier, finer):
    film = Film(contact, strokes(WEIGHT, size * PULL_OFF), points=6)
    found = span(*(v[2:] for v in film.history(STROKE * np.arange(5), tolerance=1e-6, samples=51)))
    assert found == pytest.approx(finer, rel=1e-5)
    assert earlier is None or found == pytest.approx(earlier, rel=3e-5)


@pytest.mark.parametrize(
    ("curvature", "finer"),
    [
        (1.0, (-0.26181680, 0.34147914, 88.5257775, 88.9729821)),
        (5.0, (-1.33558971, 2.25507452, 88.0869533, 90.4285744)),
    ],
)
def test_a_surface_that_bends_pumps_air(contact, curvature, finer):
    film = Film(contact, lambda t: WEIGHT, lambda t: curvature * np.sin(4e3 * np.pi * t), points=6)
    found = span(*(v[4:] for v in film.history(0.25e-3 * np.arange(9), samples=26)))
    assert found == pytest.approx(finer, rel=1e-5)


def test_flow_is_that_of_the_linearised_bgk_equation():
    width, slip = 20.0, 1.01619  # the slip along a wall of diffuse reflection: the flow for widths of many free paths
    wide = 1 + 6 * slip / width + 6 * (2 * slip**2 - 1) / width**2
    assert bgk_flow(np.sqrt(np.pi) / (2 * width), cells=400) == pytest.approx(wide, rel=2e-3)
    assert flow(0.7) == pytest.approx(bgk_flow(0.7), rel=0.01)
    free = np.array([0.05, 0.1, 0.3, 0.5, 0.736, 1.0, 2.0, 5.0])
    fit = flow(free) / [bgk_flow(k) for k in free] - 1
    assert fit == pytest.approx([-0.045, -0.048, -0.022, -0.002, 0.011, 0.019, 0.025, 0.013], abs=1e-3)
