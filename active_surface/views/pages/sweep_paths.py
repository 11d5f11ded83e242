"""Paths of a sweep, found once more for its page, which has them as a few points each."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray, IntArray
from active_surface.studies import AT_ONCE, Engine
from active_surface.views.geometry import thinned
from coupling import ProgressCallback, no_progress
from fem_plate import extent
from particle import Trajectory

MAX_PATHS: Final = 2500  # of a page, if no other number is asked for,
PATIENCE: Final = 60.0  # and about as many as are found in so many seconds
SAMPLES: Final = 400  # of a path
SEEN: Final = 1 / 400  # of the extent of a path: less is not seen
SAME: Final = 1e-6  # of that, by which ends may differ that were found twice,
MIN_SIZE: Final = 1e-9  # m, but not of less


class Paths(NamedTuple):
    """The paths of points of a sweep."""

    lines: dict[int, FloatArray]  # by the path's number: (q, 2) m
    strangers: int  # how many end elsewhere than the sweep says
    headings: dict[int, FloatArray]  # (2,) rad at start and end, of parts with a face


def usual_count(engine: Engine) -> int:
    """How many paths a page has where no number is asked for."""
    return min(MAX_PATHS, max(int(engine.chunk_length * PATIENCE / AT_ONCE), 1))


def spread(shape: tuple[int, ...], count: int) -> BoolArray:
    """Which cells of a shape are chosen so that they are at most `count`: every so many-th along each side."""
    chosen = np.zeros(shape, dtype=bool)
    if count == 0:
        return chosen
    step = 1
    while np.prod([-(-size // step) for size in shape]) > count:
        step += 1
    chosen[tuple(slice((size - 1) % step // 2, None, step) for size in shape)] = True
    return chosen


def find_paths(engine: Engine, numbers: IntArray, ends: FloatArray, tell: ProgressCallback = no_progress) -> Paths:
    """Find the paths of these numbers (p,), whose ends (p, 2) [m] the sweep knows: nan where they were refused."""
    known_ends = np.isfinite(ends).all(axis=1)
    order = np.argsort(numbers[known_ends])
    known = dict(zip(numbers[known_ends].tolist(), ends[known_ends], strict=True))
    lines: dict[int, FloatArray] = {}
    headings: dict[int, FloatArray] = {}
    strangers = 0

    def keep(number: int, path: Trajectory) -> None:
        nonlocal strangers
        samples = path.at(np.linspace(0, path.time[-1], SAMPLES)).position
        size = extent(samples)
        lines[number] = thinned(samples, SEEN * size)
        if path.heading is not None:
            headings[number] = path.heading[[0, -1]]
        strangers += float(np.abs(samples[-1] - known[number]).max()) > SAME * max(size, MIN_SIZE)
        tell(len(lines), len(known))

    engine.follow(numbers[known_ends][order].tolist(), keep)
    return Paths(lines, strangers, headings)
