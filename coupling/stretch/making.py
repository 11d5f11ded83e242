"""From a plate and its drives to a reduced model: read from disk, or made by full solutions and kept there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from coupling.case import MAX_STRETCHING
from coupling.drives import reach, stroke_heights
from coupling.progress import doing
from coupling.stretch.model import TOLERANCE, StretchModel, equilibrium_at
from coupling.stretch.store import keep_model, key_of, read_model
from fem_plate import LargeDeflection
from fem_plate.large_deflection import fine_enough, reduce
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
    key = key_of(large, heights, TOLERANCE)
    if (kept := read_model(key, large)) is not None:
        return StretchModel(large, kept[0], heights, kept[1])
    report = _Report(tell)
    report.begun()
    discrete, mesh_error = fine_enough(large, largest)
    reduction = reduce(
        discrete, heights / discrete.units, TOLERANCE, lambda plate, d: equilibrium_at(plate, d)[0], report.solved
    )
    tell(PARTS, PARTS)
    keep_model(key, reduction, mesh_error)
    return StretchModel(large, reduction, heights, mesh_error)


class _Report:
    """Reports on a scale of the error's logarithm."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._first = tell, 0.0

    def begun(self) -> None:
        self._tell(0, PARTS)
        doing("stretching plate: choosing its cells")

    def solved(self, solutions: int, error: float) -> None:
        """Report full solutions and the error that is left, over the largest w."""
        self._first = max(error, self._first)
        span = math.log(self._first / TOLERANCE)
        share = math.log(self._first / max(error, TOLERANCE)) / span if span > 0 else 1.0
        self._tell(round((PARTS - 1) * share), PARTS)
        text = f"{solutions} full solution{'s' * (solutions != 1)}, error {error:.0e}"
        doing(f"stretching plate: {text.replace('e-0', 'e-')}", share)
