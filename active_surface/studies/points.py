"""Points: the values of the axes at every point of a study, each a pure function of its index."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from active_surface.arrays import FloatArray, IntArray
from active_surface.studies.axis import Axis

Sampling = Literal["grid", "list", "random", "sobol"]
SAMPLED, JITTERED = 0, 1  # independent streams of random numbers


@dataclass(frozen=True)
class Points:
    """The points of a study, each repeated with jittered starts: path k is repeat k % repeats of point k // repeats.

    A grid has its last axis running fastest.  count: of random and Sobol points.
    """

    axes: tuple[Axis, ...]
    sampling: Sampling
    count: int = 0
    repeats: int = 1
    jitter: float = 0.0  # m, starts are displaced by up to it
    seed: int = 0

    @property
    def dimensions(self) -> dict[str, int]:
        """The dimensions of the results and their lengths."""
        if self.sampling == "grid":
            sizes = {axis.name: len(axis.values) for axis in self.axes}
        else:
            sizes = {"point": self.count if self.sampling in ("random", "sobol") else len(self.axes[0].values)}
        return sizes | ({"repeat": self.repeats} if self.repeats > 1 else {})

    @property
    def longest(self) -> tuple[Axis, ...]:
        """The two axes with the most values, or the one, in their order."""
        return longest(self.axes)

    def __len__(self) -> int:
        """How many paths there are."""
        return math.prod(self.dimensions.values())

    def values(self, start: int, stop: int) -> list[tuple[Any, ...]]:
        """The values of the axes, in SI units, for paths `start` to `stop` - 1."""
        first, last = start // self.repeats, -(-stop // self.repeats)
        columns = self.columns(first, last)
        rows = list(zip(*(column.tolist() for column in columns), strict=True))
        return [rows[k // self.repeats - first] for k in range(start, stop)]

    def columns(self, first: int, last: int) -> list[NDArray[Any]]:
        """The values of each axis (n,) at points `first` to `last` - 1."""
        at = np.arange(first, last)
        if self.sampling == "grid":
            indices = np.unravel_index(at, [len(axis.values) for axis in self.axes])
            return [np.array(axis.values, axis.kind)[k] for axis, k in zip(self.axes, indices, strict=True)]
        if self.sampling == "list":
            return [np.array(axis.values, axis.kind)[at] for axis in self.axes]
        units = self._sobol(first, last) if self.sampling == "sobol" else self._random(at)
        return [axis.spread(units[:, k]) for k, axis in enumerate(self.axes)]

    def displacements(self, start: int, stop: int) -> FloatArray:
        """Displacements (n, 2) [m] of the starts of paths, uniform on a disc."""
        if self.jitter == 0:
            return np.zeros((stop - start, 2))
        draws = np.array([np.random.default_rng((self.seed, JITTERED, k)).random(2) for k in range(start, stop)])
        radius, angle = self.jitter * np.sqrt(draws[:, 0]), 2 * math.pi * draws[:, 1]
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)

    def _random(self, at: IntArray) -> FloatArray:
        rows = [np.random.default_rng((self.seed, SAMPLED, k)).random(len(self.axes)) for k in at.tolist()]
        return np.array(rows).reshape(len(at), len(self.axes))

    def _sobol(self, first: int, last: int) -> FloatArray:
        sequence = qmc.Sobol(len(self.axes), rng=self.seed)
        if first > 0:
            return sequence.fast_forward(first).random(last - first)
        # A first draw of other than a power of two points is warned about.
        return np.concatenate([sequence.random(1), sequence.random(last - 1)])


def longest(axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
    """The two axes with the most values, or the one, in their order."""
    chosen = sorted(axes, key=lambda axis: -len(axis.values))[:2]
    return tuple(axis for axis in axes if axis in chosen)
