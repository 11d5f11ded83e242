"""Blocks of shared and own fields, against plain dense algebra."""

from __future__ import annotations

import numpy as np
import pytest

from active_surface.identification.blocks import Blocks

SIZES, SHARED, OWN = (7, 12, 9), 2, 3
COUNT = SHARED + len(SIZES) * OWN


def dense(blocks: Blocks, slope: np.ndarray) -> np.ndarray:
    """The slopes (m, n) with a column for each parameter, most of them 0."""
    matrix = np.zeros((sum(SIZES), COUNT))
    for columns, rows in zip(blocks.columns, blocks.rows, strict=True):
        matrix[rows, columns] = slope[rows]
    return matrix


@pytest.fixture
def blocks() -> Blocks:
    return Blocks.of(SIZES, SHARED, OWN)


@pytest.mark.parametrize("damping", [0.0, 0.03, 10.0])
def test_a_step_is_that_of_dense_least_squares(blocks, damping):
    generator = np.random.default_rng(1)
    slope, residuals = generator.normal(size=(sum(SIZES), SHARED + OWN)), generator.normal(size=sum(SIZES))
    weights = generator.uniform(0.1, 10, sum(SIZES))
    matrix = np.sqrt(weights)[:, None] * dense(blocks, slope)
    brake = np.sqrt(damping * (matrix**2).sum(axis=0))
    right = np.concatenate([-np.sqrt(weights) * residuals, np.zeros(COUNT)])
    expected = np.linalg.lstsq(np.vstack([matrix, np.diag(brake)]), right, rcond=None)[0]
    change = blocks.step(slope, residuals, weights, damping)
    np.testing.assert_allclose(change, expected, rtol=1e-9, atol=1e-11)
    np.testing.assert_allclose(blocks.along(slope, change), dense(blocks, slope) @ change, rtol=1e-12, atol=1e-12)


def test_a_field_without_effect_stays(blocks):
    """An own field of the second track, and a shared one, do nothing: a step leaves them."""
    generator = np.random.default_rng(2)
    slope, residuals = generator.normal(size=(sum(SIZES), SHARED + OWN)), generator.normal(size=sum(SIZES))
    slope[blocks.rows[1], SHARED + 1] = slope[:, 0] = 0
    still = [0, blocks.columns[1, SHARED + 1]]
    for damping in (0.0, 1.0):
        change = blocks.step(slope, residuals, np.ones(sum(SIZES)), damping)
        assert np.abs(change[still]).max() == 0
        assert np.delete(np.abs(change), still).min() > 0


@pytest.mark.parametrize(("shared", "own"), [(0, 2), (2, 0)])
def test_all_fields_may_be_own_or_shared(shared, own):
    blocks = Blocks.of(SIZES, shared, own)
    generator = np.random.default_rng(3)
    slope, residuals = generator.normal(size=(sum(SIZES), 2)), generator.normal(size=sum(SIZES))
    change = blocks.step(slope, residuals, np.ones(sum(SIZES)), 0.0)
    groups = blocks.rows if own else [slice(None)]
    expected = [np.linalg.lstsq(slope[rows], -residuals[rows], rcond=None)[0] for rows in groups]
    np.testing.assert_allclose(change, np.concatenate(expected), rtol=1e-9)


def test_two_trials_a_slot_give_the_slopes_of_all_tracks(blocks):
    """Of residuals that are linear in the parameters, also at a bound; fixed parameters have none."""
    generator = np.random.default_rng(4)
    slope = generator.normal(size=(sum(SIZES), SHARED + OWN))
    matrix, shares, free = dense(blocks, slope), generator.uniform(0.2, 0.8, COUNT), np.ones(COUNT, dtype=bool)
    shares[5], free[[1, 8]] = 1.0, False
    rows = blocks.differences(shares, free, 0.01)
    assert len(rows) == 2 * (SHARED - 1 + OWN) and rows.min() >= 0 and rows.max() <= 1
    found = blocks.slopes(rows, rows @ matrix.T, free)
    np.testing.assert_allclose(dense(blocks, found)[:, free], matrix[:, free], rtol=1e-9, atol=1e-10)
    assert np.abs(dense(blocks, found)[:, ~free]).max() == 0


def test_information_is_the_sum_of_slopes_times_themselves(blocks):
    generator = np.random.default_rng(5)
    slope, weights = generator.normal(size=(sum(SIZES), SHARED + OWN)), np.array([1.0, 4.0, 0.2])
    matrix, each = dense(blocks, slope), np.repeat(weights, SIZES)
    found = blocks.information(slope, weights)
    np.testing.assert_allclose(found.sum(axis=0), matrix.T @ (each[:, None] * matrix), rtol=1e-12, atol=1e-12)
    assert blocks.freedom.sum() == pytest.approx(sum(SIZES) - COUNT)
