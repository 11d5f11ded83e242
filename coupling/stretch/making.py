"""From a plate and its drives to a reduced model: read from disk, or made by full solutions and kept there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from coupling.case import MAX_STRETCHING
from coupling.drives import reach, stroke_heights
from coupling.stretch.model import TOLERANCE, StretchModel
from coupling.stretch.store import keep_model, key_of, read_model
from fem_plate import LargeDeflection
from fem_plate.large_deflection import level_of, reduce
from particle import AnyDrive

FloatArray = NDArray[np.float64]
Tell = Callable[[int, int], object]

FEW = 3  # actuators whose model serves all heights between their drives' extremes; with more, it serves the drives' own
PLACES = 32  # heights for each of them among which full solutions are chosen
MOMENTS = 400  # of the drives, where there are more actuators
PARTS = 100  # of the progress that is told


def training(sets: Sequence[Sequence[AnyDrive]], end: float) -> FloatArray:
    """Heights (S, N) [m, or N of forces] that several sets of N drives reach up to a time [s]."""
    count = len(sets[0])
    if count > FEW:
        times = end * np.linspace(0, 1, max(16, MOMENTS // len(sets)))
        return np.concatenate([stroke_heights(drives, times) for drives in sets])
    bounds = np.array([[reach(drive) for drive in drives] for drives in sets])  # (sets, N, 2)
    low, high = bounds[:, :, 0].min(axis=0), bounds[:, :, 1].max(axis=0)
    inside = qmc.Sobol(count, scramble=False).random_base2(math.ceil(math.log2(PLACES * count)))
    corners = np.stack(np.meshgrid(*[(0.0, 1.0)] * count, indexing="ij"), axis=-1).reshape(-1, count)
    return np.asarray(low + np.concatenate([corners, inside]) * (high - low))


def make_model(large: LargeDeflection, sets: Sequence[Sequence[AnyDrive]], end: float, tell: Tell) -> StretchModel:
    """The model of a plate for several sets of drives, from 0 to `end` [s].

    tell: gets how much is done, of PARTS.
    Raises ValueError for more than MAX_STRETCHING actuators, or drives that never move.
    """
    if len(large.points) > MAX_STRETCHING:
        raise ValueError(
            f"Input theory of Plate must be linear for more than {MAX_STRETCHING} actuators, as a von Karman plate is "
            f"solved for all of them at once; got {len(large.points)} of them"
        )
    heights = training(sets, end)
    largest = heights[np.argmax(np.abs(heights).sum(axis=1))]
    if not largest.any():
        raise ValueError("Input drives of a plate that stretches must move it; they never do")
    rigid = np.isinf(large.stiffness)
    state = None if rigid.all() else large.solve(largest)
    reached = np.abs(heights[:, rigid]).max(initial=0.0 if state is None else state.largest)
    level = level_of(float(reached) / large.plate.section.thickness)
    discrete = large.discrete(level, 0)
    key = key_of(large, heights, level, TOLERANCE)
    if (kept := read_model(key, discrete)) is not None:
        return StretchModel(large, kept[0], heights, kept[1])
    first: list[float] = []

    def told(_: int, error: float) -> None:
        first.append(error)
        span = math.log(max(first) / TOLERANCE)
        done = math.log(max(first) / max(error, TOLERANCE)) / span if span > 0 else 1.0
        tell(round((PARTS - 1) * min(max(done, 0.0), 1.0)), PARTS)

    reduction = reduce(discrete, heights / discrete.units, TOLERANCE, told)
    mesh_error = large.solved(largest, 0.0, level, 1).difference(large.solved(largest, 0.0, level, 0))
    tell(PARTS, PARTS)
    keep_model(key, reduction, mesh_error)
    return StretchModel(large, reduction, heights, mesh_error)
