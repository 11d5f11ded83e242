"""Profiles put together from equation (2)."""

import numpy as np
import pytest

from active_surface.paper.profiles import NEAREST, SUPERPOSED, profile_outline, profile_surface
from fem_plate.analytic import central_load
from particle import Drive

PITCH, RADIUS, TIME = 150e-6, 300e-6, 0.7e-3
DRIVES = [Drive(100e-6, 300), Drive(50e-6, 450)]
HEIGHTS = [drive.evaluate(np.array([TIME]))[0].item() for drive in DRIVES]
FORCE = 16 * np.pi / RADIUS**2  # of height 1 at the centre, with rigidity 1


def profile(xy, centre):
    r = np.hypot(*(xy - centre).T)
    return np.where(r < RADIUS, central_load(np.minimum(r, RADIUS), RADIUS, 1.0, FORCE), 0.0)


def scattered(count):
    xy = np.random.default_rng(1).uniform([-RADIUS, -RADIUS], [PITCH + RADIUS, RADIUS], (count, 2))
    return xy[profile_outline(PITCH, RADIUS).gap(xy) > 0]


def test_superposed_profiles_add_up_but_for_a_thin_ring_at_their_rims():
    xy = scattered(2000)
    ours = profile_surface(SUPERPOSED, PITCH, RADIUS, DRIVES).evaluate(xy, TIME).w
    exact = HEIGHTS[0] * profile(xy, [0, 0]) + HEIGHTS[1] * profile(xy, [PITCH, 0])
    from_rim = np.min([np.abs(np.hypot(*(xy - [x, 0]).T) - RADIUS) for x in (0, PITCH)], axis=0)
    assert np.abs(ours - exact)[from_rim > 0.01 * RADIUS].max() < 1e-18
    assert np.abs(ours - exact).max() < 1e-4 * max(HEIGHTS)


def test_the_nearest_one_alone_jumps_half_way():
    xy = scattered(500)
    surface = profile_surface(NEAREST, PITCH, RADIUS, DRIVES)
    exact = np.where(xy[:, 0] < PITCH / 2, HEIGHTS[0] * profile(xy, [0, 0]), HEIGHTS[1] * profile(xy, [PITCH, 0]))
    assert np.abs(surface.evaluate(xy, TIME).w - exact).max() < 1e-18
    left, right = surface.evaluate(np.array([[PITCH / 2 - 1e-9, 0], [PITCH / 2 + 1e-9, 0]]), TIME).w
    assert abs(left - right) > 0.5 * abs(HEIGHTS[0] - HEIGHTS[1]) * profile(np.array([[PITCH / 2, 0]]), [0, 0])[0]


def test_the_rim_is_that_of_both_discs():
    outline = profile_outline(PITCH, RADIUS)
    xy = np.random.default_rng(2).uniform([-400e-6, -400e-6], [550e-6, 400e-6], (500, 2))
    inside = (np.hypot(*xy.T) < RADIUS) | (np.hypot(*(xy - [PITCH, 0]).T) < RADIUS)
    assert ((outline.gap(xy) > 0) == inside).all()


@pytest.mark.parametrize("pitch", [0.0, 300e-6, -1e-6])
def test_discs_must_overlap(pitch):
    with pytest.raises(ValueError, match="pitch"):
        profile_outline(pitch, RADIUS)
