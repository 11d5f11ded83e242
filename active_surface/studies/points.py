"""Points: the values of the axes at every point of a study, each a pure function of its number.

A point is known by its content, the values in which it differs from the base case. Displacements of starts follow from
content and repeat, so that they stay when a study grows.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from active_surface.arrays import FloatArray, IntArray
from active_surface.studies.axes import Axis

Sampling = Literal["grid", "list", "random", "sobol"]
SAMPLED, JITTERED = 0, 1  # independent streams of random numbers
DRAWN: Final = ("random", "sobol")
DIGEST: Final = 16  # bytes
SPREAD: Final = 48  # points whose drives stand for those of all


@dataclass(frozen=True)
class Points:
    """The points of a study, each repeated with jittered starts: path k is repeat k % repeats of point k // repeats.

    A grid has its last axis running fastest.  count: of random and Sobol points.  listed: whether the axes have the
    values of these points, as in a file of results, so that none are drawn.
    """

    axes: tuple[Axis, ...]
    sampling: Sampling
    count: int = 0
    repeats: int = 1
    jitter: float = 0.0  # m, starts are displaced by up to it
    seed: int = 0
    listed: bool = False

    @property
    def dimensions(self) -> dict[str, int]:
        """The dimensions of the results and their lengths."""
        if self.sampling == "grid":
            sizes = {axis.name: len(axis.values) for axis in self.axes}
        else:
            sizes = {"point": self.count if self.drawn else len(self.axes[0].values)}
        return sizes | ({"repeat": self.repeats} if self.repeats > 1 else {})

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the results."""
        return tuple(self.dimensions.values())

    @property
    def longest(self) -> tuple[Axis, ...]:
        """The two axes with the most values, or the one, in their order."""
        return longest(self.axes)

    def __len__(self) -> int:
        """How many paths there are."""
        return math.prod(self.shape)

    @property
    def drawn(self) -> bool:
        """Whether the points are drawn from random numbers."""
        return self.sampling in DRAWN

    @property
    def stream(self) -> tuple[float, int | None]:
        """The jitter [m], and the seed where something is drawn."""
        return self.jitter, self.seed if self.drawn or self.jitter else None

    def values(self, numbers: Iterable[int]) -> list[tuple[Any, ...]]:
        """The values of the axes, in SI units, for paths of these numbers."""
        points, places, _ = self._apart(numbers)
        rows = list(zip(*(column.tolist() for column in self.columns(points)), strict=True))
        return [rows[place] for place in places]

    def columns(self, points: Iterable[int]) -> list[NDArray[Any]]:
        """The values of each axis (n,) at points of these numbers (n,)."""
        at = _whole(points)
        if self.sampling == "grid":
            indices = np.unravel_index(at, [len(axis.values) for axis in self.axes])
            return [axis.array[k] for axis, k in zip(self.axes, indices, strict=True)]
        if self.sampling == "list" or self.listed:
            return [axis.array[at] for axis in self.axes]
        units = self._sobol(at) if self.sampling == "sobol" else self._random(at)
        return [axis.spread(units[:, k]) for k, axis in enumerate(self.axes)]

    def samples(self) -> list[tuple[Any, ...]]:
        """The values where all axes are lowest, where all are highest, and at points spread between."""
        rows = np.unique(np.linspace(0, len(self) // self.repeats - 1, SPREAD).astype(np.int64))
        ends = [tuple(axis.end(which) for axis in self.axes) for which in (0, -1)]
        return [*ends, *self.values(rows * self.repeats)]

    def largest(self, path: str) -> list[float]:
        """The largest value of each axis over a field whose path ends with this one."""
        axes = [axis for axis in self.axes if f".{axis.field.path}".endswith(f".{path}")]
        return [max(axis.values or (axis.low, axis.high)) for axis in axes]

    def keys(self, numbers: Iterable[int], base: bytes) -> list[bytes]:
        """A digest (n,) of what each of these paths follows from: a base that all share, its point and its repeat."""
        points, places, repeats = self._apart(numbers)
        identities = self._identities(points)
        return [
            hashlib.sha256(base + identities[place] + repeat.to_bytes(4)).digest()[:DIGEST]
            for place, repeat in zip(places, repeats, strict=True)
        ]

    def _identities(self, at: IntArray) -> list[bytes]:
        """What tells each of these points from others (n,): a digest of its content.

        With a jitter points of one content are told apart, those of a list by their order, drawn ones by their numbers.
        """
        contents = self._contents(at)
        if self.jitter and self.sampling != "grid":
            marks = at.tolist() if self.drawn else [self._earlier[k] for k in at.tolist()]
            contents = [f"{content}{mark or ''}" for content, mark in zip(contents, marks, strict=True)]
        return [hashlib.sha256(content.encode()).digest()[:DIGEST] for content in contents]

    def _contents(self, at: IntArray) -> list[str]:
        """The fields in which each of these points (n,) differs from the case, with their values.

        Axes in any order, and one more along which a point has the value of the case, lead to the same.
        """
        parts = []
        for axis, column in sorted(zip(self.axes, self.columns(at), strict=True), key=lambda pair: pair[0].field.path):
            base = repr(axis.field.base)
            texts = (repr(value) for value in column.tolist())
            parts.append(["" if text == base else f"{axis.field.path}={text}\n" for text in texts])
        return ["".join(row) for row in zip(*parts, strict=True)]

    def displacements(self, numbers: Iterable[int]) -> FloatArray:
        """Displacements (n, 2) [m] of the starts of paths of these numbers (n,), uniform on a disc."""
        points, places, repeats = self._apart(numbers)
        if self.jitter == 0:
            return np.zeros((len(places), 2))
        streams = [(self.seed, JITTERED, int.from_bytes(identity)) for identity in self._identities(points)]
        draws = np.array(
            [
                np.random.default_rng((*streams[place], repeat)).random(2)
                for place, repeat in zip(places, repeats, strict=True)
            ]
        ).reshape(-1, 2)
        radius, angle = self.jitter * np.sqrt(draws[:, 0]), 2 * math.pi * draws[:, 1]
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)

    def _apart(self, numbers: Iterable[int]) -> tuple[IntArray, list[int], list[int]]:
        """The points (m,) of paths, each once, and for each path (n,) the place of its point there and its repeat."""
        every = _whole(numbers)
        points, places = np.unique(every // self.repeats, return_inverse=True)
        return points, places.tolist(), (every % self.repeats).tolist()

    @cached_property
    def _earlier(self) -> list[int]:
        """For each point of a list how many before it are the same."""
        seen: Counter[str] = Counter()
        numbers = []
        for content in self._contents(np.arange(len(self.axes[0].values))):
            numbers.append(seen[content])
            seen[content] += 1
        return numbers

    def _random(self, at: IntArray) -> FloatArray:
        rows = [np.random.default_rng((self.seed, SAMPLED, k)).random(len(self.axes)) for k in at.tolist()]
        return np.array(rows).reshape(len(at), len(self.axes))

    def _sobol(self, at: IntArray) -> FloatArray:
        if len(at) == 0:
            return np.empty((0, len(self.axes)))
        first, last = int(at.min()), int(at.max()) + 1
        from scipy.stats import qmc  # here, because it takes a while

        sequence = qmc.Sobol(len(self.axes), rng=self.seed)
        if first > 0:
            return sequence.fast_forward(first).random(last - first)[at - first]
        # A first draw of other than a power of two points is warned about.
        return np.concatenate([sequence.random(1), sequence.random(last - 1)])[at]


def _whole(numbers: Iterable[int]) -> IntArray:
    return np.asarray(numbers if isinstance(numbers, (range, np.ndarray)) else list(numbers), dtype=np.int64)


def longest(axes: tuple[Axis, ...]) -> tuple[Axis, ...]:
    """The two axes with the most values, or the one, in their order."""
    chosen = sorted(axes, key=lambda axis: -len(axis.values))[:2]
    return tuple(axis for axis in axes if axis in chosen)
