"""Reduction: a stretching plate in a few shapes, found by full solutions where the few are still worst.

The corrections to the linear shapes, the membrane forces and the in-plane motions are each projected on their leading
directions (POD). The membrane's energy in these is 1/2 sum_r f_r^2 with f_r = 1/2 int N_r : grad w grad w, for forces
N_r that are in balance and of unit energy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.equilibrium import Coefficients, NotConverged
from fem_plate.large_deflection.full_solutions import (
    Columns,
    FullSolutions,
    ReducedSolver,
    bending_products,
    stacked,
    unstacked,
)
from fem_plate.large_deflection.membrane import Membrane, Samples, halves, thirds
from fem_plate.large_deflection.reduced import ReducedPlate
from fem_plate.types import FloatArray

FINE = 0.01  # of the tolerance: directions that matter less are left out
CANDIDATES = 40  # places for a further full solution
CHECKED = 8  # of them, at which the error is estimated after each
HELD_OUT = 4  # full solutions that only measure the error
MAX_SOLUTIONS = 60
ROUNDING = 1e-15  # of the largest square: directions below it are rounding
CHUNK = 400_000  # numbers in the products of two slopes that are held at a time


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


def reduce(
    discrete: DiscretePlate,
    strokes: FloatArray,
    tolerance: float,
    solve: ReducedSolver,
    tell: Callable[[int, float], None] = lambda solutions, error: None,
) -> Reduction:
    """Reduce a plate for strokes (S, N) that it is to be good for.

    solve: finds the equilibrium of a reduced plate.
    tell: called after each full solution with their number and the error estimated so far.
    Raises NotConverged when the tolerance takes more than MAX_SOLUTIONS full solutions.
    """
    known, generator = FullSolutions(discrete, np.abs(strokes).max(axis=0), solve), np.random.default_rng(0)
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


@dataclass(frozen=True, eq=False)
class Projection:
    """The plate in a few shapes."""

    plate: ReducedPlate
    corrections: Columns


def project(known: FullSolutions, least: float) -> Projection:
    """The plate in the leading directions of full solutions, without in-plane motion.

    least: of the largest direction; those that matter less are left out.
    """
    discrete, membrane = known.discrete, known.membrane(0)
    everything = Columns.joined(known.corrections)
    corrections = everything.weighted(_leading(bending_products(discrete, everything), least))
    forces = np.stack(known.forces, axis=1)
    forces = forces @ _leading(force_products(discrete, membrane, forces), least)
    shapes = known.slopes(0, Columns.joined([known.linear, corrections]))
    plate = ReducedPlate(bending_products(discrete, corrections), forms_of(membrane.samples, forces, shapes))
    return Projection(plate, corrections)


def with_in_plane(known: FullSolutions, model: Projection, least: float) -> tuple[ReducedPlate, FloatArray]:
    """The plate of a model with the leading in-plane motions (unknowns, M), each of unit energy, and these."""
    membrane, motions = known.membrane(1), np.stack(known.motions, axis=1)
    motions = motions @ _leading(motions.T @ (membrane.stiffness @ motions), least)
    everything = membrane.expand(motions)
    forces = stacked([membrane.linear_force(samples, everything) for samples in membrane.samples])
    shapes = known.slopes(1, Columns.joined([known.linear, model.corrections]))
    stiffness, forms = model.plate.stiffness, model.plate.membrane
    return ReducedPlate(stiffness, forms, in_plane=-forms_of(membrane.samples, forces, shapes)), motions


def _leading(products: FloatArray, least: float) -> FloatArray:
    """What combines k functions into orthonormal leading ones (k, m), from their products (k, k)."""
    squares, directions = np.linalg.eigh(products)
    kept = squares > max(least**2, ROUNDING) * squares[-1]
    return np.asarray((directions[:, kept] / np.sqrt(squares[kept]))[:, ::-1])


def force_products(discrete: DiscretePlate, membrane: Membrane, forces: FloatArray) -> FloatArray:
    """The membrane energies, twice, of forces with each other (c, c)."""
    compliance = np.linalg.inv(discrete.plane_stress.law)
    total = np.zeros((forces.shape[1],) * 2)
    for samples, part in zip(membrane.samples, unstacked(membrane.samples, forces), strict=True):
        thirds_ = thirds(part)
        for row, one in zip(compliance, thirds_, strict=True):
            strain = sum(a * other for a, other in zip(row, thirds_, strict=True))
            total += np.einsum("kn,kni,knj->ij", samples.weights, one, strain, optimize=True)
    return (total + total.T) / 2


def forms_of(sets: Sequence[Samples], forces: FloatArray, shapes: Sequence[FloatArray]) -> FloatArray:
    """int N_r : grad phi_i grad phi_j, (r, b, b)."""
    count = shapes[0].shape[2]
    rows, columns = np.triu_indices(count)
    upper = np.zeros((forces.shape[1], len(rows)))
    for samples, tensors, slope in zip(sets, unstacked(sets, forces), shapes, strict=True):
        step = max(1, CHUNK // (samples.weights.shape[1] * len(rows)))
        for start in range(0, len(slope), step):
            part = slice(start, start + step)
            weights = samples.weights[part, :, None]
            x, y = halves(slope[part])
            (x_i, x_j), (y_i, y_j) = ((side[..., rows], side[..., columns]) for side in (x, y))
            products = (x_i * x_j, x_i * y_j + y_i * x_j, y_i * y_j)
            for tensor, product in zip(thirds(tensors[part]), products, strict=True):
                upper += (tensor * weights).reshape(-1, len(upper)).T @ product.reshape(-1, len(rows))
    forms = np.zeros((len(upper), count, count))
    forms[:, rows, columns] = forms[:, columns, rows] = upper
    return forms


def deflected(known: FullSolutions, model: Projection, strokes: FloatArray) -> Coefficients:
    """The plate of a reduced model under strokes (N,)."""
    c = known.solve(model.plate, strokes)
    a, b = known.linear.weighted(strokes[:, None]), model.corrections.weighted(c[:, None])
    return known.discrete.equilibrium.at((a.v + b.v)[:, 0], (a.extra + b.extra)[:, 0], 0.0)


def estimated_error(known: FullSolutions, model: Projection, strokes: FloatArray) -> float:
    """About the largest error of w in a reduced model: Newton's step, with the nearest solution's matrix."""
    state, equilibrium = deflected(known, model, strokes), known.discrete.equilibrium
    of_v, of_extra = equilibrium.imbalance(state, np.where(equilibrium.held, 0.0, strokes))
    missing = (strokes - equilibrium.heights(state))[equilibrium.held]
    dv, de, _ = known.nearest(strokes).solve(of_v, of_extra, missing)
    return equilibrium.change(dv, de)


def measured_error(known: FullSolutions, model: Projection, strokes: FloatArray) -> float:
    """The largest error of w in a reduced model, by a full solution, which is then known."""
    state = deflected(known, model, strokes)
    full = known.add(strokes, state)
    return known.discrete.equilibrium.change(full.v - state.v, full.extra - state.extra)
