"""Reduction: a stretching plate in a few shapes, found by full solutions where the few are still worst."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fem_plate.large_deflection.reduction.full_solutions import FullSolutions
from fem_plate.large_deflection.reduction.model_error import deflected, estimated_error, measured_error
from fem_plate.large_deflection.reduction.projection import Projection, project, with_in_plane
from fem_plate.large_deflection.reduction.reduced import ReducedPlate
from fem_plate.large_deflection.reduction.reduced_solver import reduced_equilibrium
from fem_plate.large_deflection.reduction.snapshots import Columns
from fem_plate.large_deflection.solution import DiscretePlate, NotConverged
from fem_plate.types import FloatArray

FINE = 0.01  # of the tolerance: directions that matter less are left out
CANDIDATES = 40  # places for a further full solution
CHECKED = 8  # of them, at which the error is estimated after each
HELD_OUT = 4  # full solutions that only measure the error
MAX_SOLUTIONS = 60


@dataclass(frozen=True, eq=False)
class Reduction:
    """A stretching plate in a few shapes; dimensionless, strokes and corrections over the thickness.

    linear, corrections: shapes of w.  motions: (in-plane unknowns, M), of the in-plane motion.
    error: the largest difference of w from full solutions that were held out, over the largest w.
    """

    discrete: DiscretePlate
    plate: ReducedPlate
    linear: Columns
    corrections: Columns
    motions: FloatArray
    solutions: int
    error: float

    def coefficients(self, strokes: FloatArray) -> Columns:
        """The plate (one column) with strokes (N,)."""
        c = reduced_equilibrium(self.plate, strokes).corrections[0]
        linear, corrections = self.linear.weighted(strokes[:, None]), self.corrections.weighted(c[:, None])
        return Columns(linear.v + corrections.v, linear.extra + corrections.extra)


def reduce(
    discrete: DiscretePlate,
    strokes: FloatArray,
    tolerance: float,
    tell: Callable[[int, float], None] = lambda solutions, error: None,
) -> Reduction:
    """Reduce a plate for strokes (S, N) that it is to be good for.

    tell: called after each full solution with their number and the error estimated so far.
    Raises NotConverged when the tolerance takes more than MAX_SOLUTIONS full solutions.
    """
    known, generator = FullSolutions(discrete, np.abs(strokes).max(axis=0)), np.random.default_rng(0)
    size = np.array([_size(known, row) for row in strokes])
    largest, least = size.max(), FINE * tolerance
    candidates = _Candidates(_spread_out(strokes[size > 0], CANDIDATES), largest)
    known.add(strokes[np.argmax(size)], None)
    while True:
        model = project(known, least)
        worst = candidates.worst(known, model)
        tell(len(known), worst)
        if worst < tolerance:
            plate, motions = with_in_plane(known, model, least)
            held_out = strokes[generator.choice(len(strokes), min(HELD_OUT, len(strokes)), replace=False)]
            measured = max(measured_error(known, model, row) for row in held_out) / largest
            if measured < tolerance:
                return Reduction(discrete, plate, known.linear, model.corrections, motions, len(known), measured)
            tell(len(known), measured)
            candidates.forget()
        else:
            row = candidates.next
            known.add(row, deflected(known, model, row))
        if len(known) >= MAX_SOLUTIONS:
            raise NotConverged(
                f"The stretching plate needs more than {MAX_SOLUTIONS} full solutions; the last model was off by "
                f"{worst:.0e} of the largest deflection. Lower the strokes, or let fewer actuators move"
            )


class _Candidates:
    """Strokes (C, N) for a further full solution, with the errors of the last model there, over the largest w."""

    def __init__(self, strokes: FloatArray, largest: float) -> None:
        self._strokes, self._largest = strokes, largest
        self.forget()

    def forget(self) -> None:
        """Estimate all errors anew."""
        self._errors = np.full(len(self._strokes), np.inf)

    def worst(self, known: FullSolutions, model: Projection) -> float:
        """The largest error, estimated anew where it was largest: those that were small are small still."""
        unknown = np.isinf(self._errors)
        for row in np.flatnonzero(unknown) if unknown.any() else np.argsort(self._errors)[-CHECKED:]:
            self._errors[row] = estimated_error(known, model, self._strokes[row]) / self._largest
        return float(self._errors.max())

    @property
    def next(self) -> FloatArray:
        """Where the error is largest."""
        return np.asarray(self._strokes[np.argmax(self._errors)])


def _size(known: FullSolutions, strokes: FloatArray) -> float:
    """The largest w of the linear plate."""
    shape = known.linear.weighted(strokes[:, None])
    return known.discrete.equilibrium.change(shape.v[:, 0], shape.extra[:, 0])


def _spread_out(rows: FloatArray, count: int) -> FloatArray:
    """At most `count` of the rows, far from each other."""
    distance, chosen = np.full(len(rows), np.inf), [int(np.argmax(np.abs(rows).sum(axis=1)))]
    while len(chosen) < min(count, len(rows)):
        distance = np.minimum(distance, np.abs(rows - rows[chosen[-1]]).max(axis=1))
        if distance.max() == 0:
            break
        chosen.append(int(np.argmax(distance)))
    return rows[chosen]
