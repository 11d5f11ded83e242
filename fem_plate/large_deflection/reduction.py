"""Reduction: a stretching plate in a few shapes, found by full solutions where the few are still worst.

The corrections to the linear shapes, the membrane forces and the in-plane motions each get the leading directions (POD)
of the full solutions and of their changes with each stroke. The membrane's energy in these is 1/2 sum_r f_r^2 with
f_r = 1/2 int N_r : grad w grad w, for forces N_r that are in balance and of unit energy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_plate.large_deflection.bordered import BorderedSolver
from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.equilibrium import Coefficients, Loads, NotConverged, Solution
from fem_plate.large_deflection.membrane import Membrane
from fem_plate.large_deflection.reduced import ReducedPlate
from fem_plate.large_deflection.reduced_solver import reduced_equilibrium
from fem_plate.large_deflection.samples import Samples, thirds, times
from fem_plate.large_deflection.snapshots import Columns, bending_products, linear_shapes, slopes, tangents

FloatArray = NDArray[np.float64]

FINE = 0.01  # of the tolerance: directions that matter less are left out
CANDIDATES = 40  # places for a further full solution
CHECKED = 8  # of them, at which the error is estimated after each
HELD_OUT = 4  # full solutions that only measure the error
TANGENT = 0.3  # of each stroke's largest height: how much of a change counts beside a full solution
FEW = 4  # actuators with which each stroke's change is added, too
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
    reducer = _Reducer(discrete, np.abs(strokes).max(axis=0), tolerance)
    size = np.array([reducer.size(row) for row in strokes])
    largest, generator = size.max(), np.random.default_rng(0)
    candidates = _spread_out(strokes[size > 0], CANDIDATES)
    reducer.add(strokes[np.argmax(size)])
    model = reducer.model()
    errors = np.full(len(candidates), np.inf)
    while True:
        # Errors that were small a few solutions ago are small still.
        checked = np.flatnonzero(np.isinf(errors)) if np.isinf(errors).any() else np.argsort(errors)[-CHECKED:]
        errors[checked] = [reducer.estimate(model, candidates[row]) / largest for row in checked]
        worst = float(errors.max())
        tell(reducer.solutions, worst)
        if worst < tolerance:
            held_out = strokes[generator.choice(len(strokes), min(HELD_OUT, len(strokes)), replace=False)]
            measured = max(reducer.error(model, row) for row in held_out) / largest
            if measured < tolerance:
                return reducer.reduction(model, measured)
            errors[:] = np.inf
        else:
            reducer.add(candidates[np.argmax(errors)])
        if reducer.solutions >= MAX_SOLUTIONS:
            raise NotConverged(
                f"The stretching plate needs more than {MAX_SOLUTIONS} full solutions; the last model was off by "
                f"{worst:.0e} of the largest deflection. Lower the strokes, or let fewer actuators move"
            )
        model = reducer.model()


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
class _Model:
    plate: ReducedPlate
    corrections: Columns
    motions: FloatArray


class _Reducer:
    """The full solutions so far."""

    def __init__(self, discrete: DiscretePlate, spread: FloatArray, tolerance: float) -> None:
        self.discrete, self.equilibrium, self.tolerance = discrete, discrete.equilibrium, tolerance
        self.linear, self._spread = linear_shapes(discrete), spread
        self._membranes = _membranes(discrete)
        self._linear_slopes = [self._slopes(i, self.linear) for i in range(2)]
        self._corrections: list[Columns] = []
        self._forces: list[FloatArray] = []  # membrane forces, all samples in a row
        self._motions: list[FloatArray] = []
        self._solvers: list[tuple[FloatArray, BorderedSolver]] = []
        self._model: _Model | None = None

    @property
    def solutions(self) -> int:
        """How many full solutions there are."""
        return len(self._solvers)

    def size(self, strokes: FloatArray) -> float:
        """The largest w of the linear plate."""
        shape = self.linear.weighted(strokes[:, None])
        return self.equilibrium.change(shape.v[:, 0], shape.extra[:, 0])

    def add(self, strokes: FloatArray) -> None:
        """Add a full solution and its changes with each stroke."""
        self._learn(strokes, self.equilibrium.solve(Loads(strokes, 0.0), self._near(strokes)))

    def _learn(self, strokes: FloatArray, solution: Solution) -> None:
        state, linear = solution.state, self.linear.weighted(strokes[:, None])
        few = len(strokes) <= FEW
        changes = tangents(self.discrete, solution) if few else self.linear.weighted(np.zeros((len(strokes), 0)))
        weights = TANGENT * self._spread if few else np.zeros(0)
        further = slice(None if few else 0)
        moved = Columns(
            (changes.v - self.linear.v[:, further]) * weights, (changes.extra - self.linear.extra[:, further]) * weights
        )
        own = Columns(state.v[:, None] - linear.v, state.extra[:, None] - linear.extra)
        self._corrections += [own, moved]
        scaled = changes.weighted(np.diag(weights))
        for i in range(2):
            now = [p[..., 0] for p in self._slopes(i, Columns(state.v[:, None], state.extra[:, None]))]
            steps = self._slopes(i, scaled)
            pairs = [
                (
                    [p + q[..., j] for p, q in zip(now, steps, strict=True)],
                    [p - q[..., j] for p, q in zip(now, steps, strict=True)],
                )
                for j in range(len(weights))
            ]
            answer = self._force if i == 0 else self._motion
            rows = [answer(now), *(0.5 * (answer(ahead) - answer(behind)) for ahead, behind in pairs)]
            (self._forces if i == 0 else self._motions).extend(rows)
        self._solvers.append((strokes, solution.solver))

    def model(self) -> _Model:
        """The reduced plate of what is known."""
        least = FINE * self.tolerance
        everything = Columns.joined(self._corrections)
        corrections = everything.weighted(_leading(bending_products(self.discrete, everything), least))
        membrane, in_plane = (membrane for membrane, _ in self._membranes)
        forces = np.stack(self._forces, axis=1)
        forces = forces @ _leading(_force_products(self.discrete, membrane, forces), least)
        motions = np.stack(self._motions, axis=1)
        motions = motions @ _leading(motions.T @ (in_plane.stiffness @ motions), least)
        shapes = [
            np.concatenate([a, b], axis=2)
            for a, b in zip(self._linear_slopes[0], self._slopes(0, corrections), strict=True)
        ]
        carried = [
            np.concatenate([a, b], axis=2)
            for a, b in zip(self._linear_slopes[1], self._slopes(1, corrections), strict=True)
        ]
        of_motions = _stacked(
            [in_plane.linear_force(samples, in_plane.expand(motions)) for samples in in_plane.samples]
        )
        plate = ReducedPlate(
            stiffness=bending_products(self.discrete, corrections),
            membrane=_forms(membrane.samples, forces, shapes),
            in_plane=-_forms(in_plane.samples, of_motions, carried),
        )
        self._model = _Model(plate, corrections, motions)
        return self._model

    def coefficients(self, model: _Model, strokes: FloatArray) -> Coefficients:
        """The plate of a reduced model."""
        c = reduced_equilibrium(model.plate, strokes).corrections[0]
        a, b = self.linear.weighted(strokes[:, None]), model.corrections.weighted(c[:, None])
        return self.equilibrium.at((a.v + b.v)[:, 0], (a.extra + b.extra)[:, 0], 0.0)

    def estimate(self, model: _Model, strokes: FloatArray) -> float:
        """About the largest error of w in a reduced model: Newton's step, with the nearest solution's matrix."""
        state = self.coefficients(model, strokes)
        held = self.equilibrium.held
        of_v, of_extra = self.equilibrium.imbalance(state, np.where(held, 0.0, strokes))
        missing = (strokes - self.equilibrium.heights(state))[held]
        _, solver = min(
            self._solvers, key=lambda known: min(np.abs(known[0] - strokes).max(), np.abs(known[0] + strokes).max())
        )
        dv, de, _ = solver.solve(of_v, of_extra, missing)
        return self.equilibrium.change(dv, de)

    def error(self, model: _Model, strokes: FloatArray) -> float:
        """The largest error of w in a reduced model, by a full solution, which is then known."""
        state = self.coefficients(model, strokes)
        solution = self.equilibrium.solve(Loads(strokes, 0.0), state)
        self._learn(strokes, solution)
        return self.equilibrium.change(solution.state.v - state.v, solution.state.extra - state.extra)

    def reduction(self, model: _Model, error: float) -> Reduction:
        return Reduction(
            self.discrete, model.plate, self.linear, model.corrections, model.motions, self.solutions, error
        )

    def _near(self, strokes: FloatArray) -> Coefficients | None:
        return None if self._model is None else self.coefficients(self._model, strokes)

    def _slopes(self, i: int, columns: Columns) -> list[FloatArray]:
        membrane, known = self._membranes[i]
        return slopes(self.discrete, membrane.samples, known, columns)

    def _force(self, p: list[FloatArray]) -> FloatArray:
        """The membrane force under slopes, at all samples."""
        membrane = self.discrete.membrane
        everything = membrane.expand(membrane.respond(p)[0])
        return _stacked(
            [membrane.force(samples, everything, q)[..., None] for samples, q in zip(membrane.samples, p, strict=True)]
        )[:, 0]

    def _motion(self, p: list[FloatArray]) -> FloatArray:
        return self.discrete.plane_stress.membrane.respond(p)[0]


def _membranes(discrete: DiscretePlate) -> list[tuple[Membrane, list[FloatArray]]]:
    """The membrane and that of in-plane motion, each with the slopes of the extra functions at its samples."""
    equilibrium, in_plane = discrete.equilibrium, discrete.plane_stress.membrane
    known = equilibrium.known
    if in_plane is discrete.membrane:
        return [(in_plane, known), (in_plane, known)]
    return [(discrete.membrane, known), (in_plane, [equilibrium.trial.slopes(samples) for samples in in_plane.samples])]


def _leading(products: FloatArray, least: float) -> FloatArray:
    """What combines k functions into orthonormal leading ones (k, m), from their products (k, k)."""
    squares, directions = np.linalg.eigh(products)
    kept = squares > max(least**2, 1e-15) * squares[-1]
    return np.asarray((directions[:, kept] / np.sqrt(squares[kept]))[:, ::-1])


def _stacked(parts: Sequence[FloatArray]) -> FloatArray:
    """Stacked quantities (k, j n, c) of all sets of samples in one column each."""
    return np.concatenate([part.reshape(-1, part.shape[-1]) for part in parts])


def _unstacked(samples: Sequence[Samples], columns: FloatArray) -> list[FloatArray]:
    """Tensors (k, 3 n, c) at each set of samples."""
    ends = np.cumsum([3 * s.weights.size for s in samples])
    return [
        part.reshape(len(s.weights), -1, columns.shape[1])
        for s, part in zip(samples, np.split(columns, ends[:-1]), strict=True)
    ]


def _force_products(discrete: DiscretePlate, membrane: Membrane, forces: FloatArray) -> FloatArray:
    """The membrane energies, twice, of forces with each other (c, c)."""
    compliance = np.linalg.inv(discrete.plane_stress.law)
    total = np.zeros((forces.shape[1],) * 2)
    for samples, part in zip(membrane.samples, _unstacked(membrane.samples, forces), strict=True):
        thirds_ = thirds(part)
        for row, one in zip(compliance, thirds_, strict=True):
            strain = sum(a * other for a, other in zip(row, thirds_, strict=True))
            total += np.einsum("kn,kni,knj->ij", samples.weights, one, strain, optimize=True)
    return (total + total.T) / 2


def _forms(sets: Sequence[Samples], forces: FloatArray, shapes: Sequence[FloatArray]) -> FloatArray:
    """int N_r : grad phi_i grad phi_j, (r, b, b)."""
    forms = np.zeros((forces.shape[1], shapes[0].shape[2], shapes[0].shape[2]))
    for samples, tensors, slope in zip(sets, _unstacked(sets, forces), shapes, strict=True):
        flat = slope.reshape(-1, slope.shape[2])
        for r, form in enumerate(forms):
            form += flat.T @ times(samples.weighted(tensors[..., r]), slope).reshape(flat.shape)
    return (forms + forms.transpose(0, 2, 1)) / 2
