"""The response of a reduced plate to heights: the equilibria of an oracle, rates, and where there is none."""

import numpy as np
import pytest
from reduced_plates import one_correction, one_in_plane, one_plate, random_plate
from reduced_solver import reduced_equilibrium

from coupling.stretch import correction_drives
from coupling.stretch.response import POINTS, evaluate_response, find_response
from fem_plate.large_deflection import ReducedPlate
from particle import Drive


def box(*ends):
    """The corners of a box of heights."""
    return np.array(ends, dtype=float).T


def values(drives, times):
    return np.stack([drive.evaluate(times) for drive in drives], axis=1)


def test_one_drive_has_the_closed_form():
    found = find_response(one_plate(), box((-1.0, 1.2)), np.full(2, 1e-6))
    d = np.linspace(-1.0, 1.2, 301)
    truth = np.stack([one_correction(d), one_in_plane(d)], axis=1)
    assert np.abs(evaluate_response(found, d[:, None]) - truth).max() < 1e-6


@pytest.mark.parametrize("count", [1, 2, 3])
def test_heights_give_the_oracle_s_equilibria(count):
    plate, limit = random_plate(count, 5, 4, 3), 1e-5
    ends = [(-0.4, 1.0), (0.0, 0.7), (-0.6, 0.1)][:count]
    found = find_response(plate, box(*ends), np.full(8, limit))
    heights = np.random.default_rng(1).uniform(*box(*ends), (40, count))
    for row, value in zip(heights, evaluate_response(found, heights), strict=True):
        truth = reduced_equilibrium(plate, row)
        assert np.abs(value - np.concatenate([truth.corrections[0], truth.in_plane[0]])).max() < 0.02 * limit


@pytest.mark.parametrize("count", [1, 2, 3])
def test_drives_of_corrections_are_those_of_equilibria(count):
    plate = random_plate(count, 5, 4, 3)
    drives = [Drive(1.0, 300.0), Drive(-0.6, 400.0, delay=0.4e-3), Drive(0.3, 300.0 * 2**0.5)][:count]
    ends = [(0.0, 1.0), (-0.6, 0.0), (0.0, 0.3)][:count]
    exact = correction_drives(plate, drives, 10e-3, 1e-5)
    response = find_response(plate, box(*ends), np.full(8, 1e-7))
    found = correction_drives(plate, drives, 10e-3, 1e-5, response=response)
    assert found.error <= 1e-5 and found.in_plane_error <= 1e-5
    assert found.period == exact.period and found.pieces == exact.pieces
    times = np.random.default_rng(2).uniform(0, 10e-3, 200)
    for one, other in ((found.drives, exact.drives), (found.in_plane, exact.in_plane)):
        c, truth = values(one, times), values(other, times)
        off = np.abs(c - truth).max(axis=(1, 2)) / np.abs(truth).max(axis=(1, 2))
        assert (off < [2e-8, 4e-7, 2e-6]).all()
    largest = np.abs(values(exact.drives, times)).max(axis=(1, 2))
    for time in times[:20]:  # rates, at the equilibria themselves
        rates = [np.array([drive.evaluate(time)[order] for drive in drives]) for order in range(3)]
        truth = reduced_equilibrium(plate, *rates).corrections
        off = np.abs(values(found.drives, np.array([time]))[:, :, 0] - truth).max(axis=1)
        assert (off < [1e-5, 1e-3, 8e-3] * largest).all()


def test_a_closer_limit_takes_more_points():
    points = [
        round(len(find_response(one_plate(), box((-3.0, 3.0)), np.full(2, limit)).rows)) for limit in (1e-3, 1e-5)
    ]
    assert POINTS[0] <= points[0] < points[1] <= POINTS[-1]
    assert find_response(one_plate(), box((-3.0, 3.0)), np.full(2, 1e-12)) is None


def test_there_is_none_where_it_makes_no_sense():
    buckles = ReducedPlate([[1.0]], [[[-2.0, 0.0], [0.0, 1.0]]])
    assert find_response(buckles, box((0.0, 1.2)), np.full(1, 1e-3)) is None
    assert find_response(random_plate(4, 3, 3), box(*[(0.0, 0.1)] * 4), np.full(3, 1e-3)) is None
    assert find_response(random_plate(2, 3, 3), box((0.0, 0.1), (0.0, 0.0)), np.full(3, 1e-3)) is None
