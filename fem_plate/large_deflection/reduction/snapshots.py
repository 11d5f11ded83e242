"""Columns of coefficients: several functions of the trial space, and what they do at samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fem_plate.large_deflection.membranes import Samples
from fem_plate.large_deflection.solution import DiscretePlate, Loads, Solution
from fem_plate.types import FloatArray


class Columns(NamedTuple):
    """k functions: v (unknowns, k) and extra coefficients (e, k)."""

    v: FloatArray
    extra: FloatArray

    def weighted(self, weights: FloatArray) -> Columns:
        """Their sums with weights (k, m)."""
        return Columns(self.v @ weights, self.extra @ weights)

    @staticmethod
    def joined(several: list[Columns]) -> Columns:
        """All functions of several."""
        return Columns(
            np.concatenate([c.v for c in several], axis=1), np.concatenate([c.extra for c in several], axis=1)
        )


def linear_shapes(discrete: DiscretePlate) -> Columns:
    """The plate under a unit of each stroke or force, without stretching."""
    equilibrium, count = discrete.equilibrium, len(discrete.equilibrium.held)
    extra = [equilibrium.linear_extra(Loads(unit, 0.0)) for unit in np.eye(count)]
    return Columns(np.zeros((discrete.model.unknowns, count)), np.stack(extra, axis=1))


def tangents(discrete: DiscretePlate, solution: Solution) -> Columns:
    """What a unit of each stroke or force adds to the plate."""
    equilibrium, trial = discrete.equilibrium, discrete.equilibrium.trial
    held, columns = equilibrium.held, []
    for unit in np.eye(len(held)):
        pushed = np.where(held, 0.0, unit)
        answer = solution.solver.solve(trial.at_actuators.T @ pushed, trial.heights.T @ pushed, unit[held])
        columns.append(answer[:2])
    return Columns(np.stack([v for v, _ in columns], axis=1), np.stack([e for _, e in columns], axis=1))


def bending_products(discrete: DiscretePlate, columns: Columns) -> FloatArray:
    """The bending energies, twice, of functions with each other, and those of the actuators' springs: (k, k)."""
    equilibrium, trial = discrete.equilibrium, discrete.equilibrium.trial
    v, extra = columns
    mixed = v.T @ (trial.cross @ extra)
    products = v.T @ (equilibrium.bending @ v) + mixed + mixed.T + extra.T @ trial.inner @ extra
    springs = equilibrium.held & (equilibrium.compliance > 0)
    heights = trial.at_actuators[springs] @ v + trial.heights[springs] @ extra
    products = products + heights.T @ (heights / equilibrium.compliance[springs, None])
    return np.asarray((products + products.T) / 2)


def slopes(
    discrete: DiscretePlate, sets: Sequence[Samples], known: Sequence[FloatArray], columns: Columns
) -> list[FloatArray]:
    """The slopes (k, 2 n, functions) at sets of samples; known: those of the extra functions there."""
    space, everything = discrete.model.space, discrete.model.space.all_unknowns(columns.v)
    extra = np.concatenate([columns.extra, np.zeros((1, columns.extra.shape[1]))])
    return [
        samples.gradient @ everything[space.dofs[samples.triangle]] + at @ extra
        for samples, at in zip(sets, known, strict=True)
    ]


def stacked(parts: Sequence[FloatArray]) -> FloatArray:
    """Stacked quantities (k, j n, c) of all sets of samples in one column each."""
    return np.concatenate([part.reshape(-1, part.shape[-1]) for part in parts])


def unstacked(samples: Sequence[Samples], columns: FloatArray) -> list[FloatArray]:
    """Tensors (k, 3 n, c) at each set of samples."""
    ends = np.cumsum([3 * s.weights.size for s in samples])
    return [
        part.reshape(len(s.weights), -1, columns.shape[1])
        for s, part in zip(samples, np.split(columns, ends[:-1]), strict=True)
    ]
