"""Natural frequencies and modes, also of a plate that actuators hold at points, rigidly or through springs.

At a held point a mode bends as under a point force, which polynomials follow badly. So the trial functions are
w = v + sum_j c_j psi_j, with psi_j the static response to a unit force at held point j. A spring pushes with
c_j = -k_j w(x_j), so that c = -(G + 1/k)^-1 v(x_j), with 1/k = 0 where the hold is rigid. With a(v, psi_j) = v(x_j) and
a(psi_i, psi_j) = G_ij, the energy of plate and springs has the stiffness K - B^T (G + 1/k)^-1 B, where B takes v at the
held points: K with a correction of low rank, and so is its inverse. On a free rim psi_j is one of the finite elements;
there w itself obeys w(x_j) = 0, or has the spring's energy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import eigh
from scipy.sparse import csr_matrix, vstack
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_plate.elements import Derivatives, PlateFunctions, PlateModel
from fem_plate.inputs import check_on_plate
from fem_plate.types import BoolArray, FloatArray

CELLS = 1_000  # evaluated at a time, to bound memory
RIGID_SHIFT = 1e12  # the dimensionless squared frequency that rigid motions are moved to, out of the way
MAX_MODES = 400  # so many responses are enough
ROUNDING = 1e-10  # of a response: less of it that is new counts as nothing
ASYMMETRY = 1e-6  # of a stiffness: what rounding may leave
DEPENDENT = 1e-13  # of the longest of a block, squared
FIRST = 1e-5  # of a mode's residual: its square is left in the frequency


@dataclass(frozen=True, eq=False)
class Modes:
    """Modes of vibration, each with a largest deflection of 1 over the mesh; made by `Plate.modes`.

    Attributes
    ----------
    frequencies : (count,) array
        Natural frequencies [Hz], ascending, repeated ones repeated.
    """

    frequencies: FloatArray
    model: PlateModel
    functions: PlateFunctions
    refine: Callable[[], Modes] | None = field(default=None, repr=False)  # solves again on cells of half the size

    @cached_property
    def error_estimate(self) -> FloatArray:
        """Estimated relative error of each frequency, (count,).

        It is the difference from the frequencies on cells of half the size, which are computed on first use.
        """
        if self.refine is None:
            raise ValueError(
                "Input of error_estimate must be modes of Plate.modes; these were made without finer cells"
            )
        return np.asarray(np.abs(self.frequencies / self.refine().frequencies - 1))

    def evaluate(self, xy: ArrayLike) -> Derivatives:
        """The modes' shapes with first and second derivatives.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].

        Returns
        -------
        value : (n, count) array
        gradient : (n, count, 2) array
            [1/m].
        hessian : (n, count, 2, 2) array
            [1/m^2].

        Raises
        ------
        ValueError
            A point lies beyond the rim.
        """
        xy, size = np.asarray(xy, dtype=float), self.model.mesh.size
        check_on_plate(self.model.mesh.outline, xy, size)
        value, gradient, hessian = self.functions.evaluate(xy / size)
        return value, gradient / size, hessian / size**2


class HeldPlate:
    """A plate held at points (N, 2) [m], by the finite elements v of its trial functions.

    rigidity: N m.  stiffness: (N,) N/m, of the springs there; inf where the hold is rigid.
    responses: (unknowns, N), psi without F, where they are known.
    """

    def __init__(
        self,
        model: PlateModel,
        held: FloatArray,
        rigidity: float,
        stiffness: FloatArray,
        responses: FloatArray | None = None,
    ) -> None:
        self.model, self.held, self.rigidity = model, held / model.mesh.size, rigidity
        compliance = np.diag(rigidity / model.mesh.size**2 / stiffness)  # dimensionless, 1/k
        space, x = model.space, self.held
        self.mass = model.mass
        if responses is None:
            responses = model.under_forces(x) if len(x) else np.zeros((model.unknowns, 0))
        at_held = space.point_values(x).tocsr()  # B
        green = model.infinite.point_value(x, x) + at_held @ responses
        inside = model.infinite.acts(x)
        on_rim, both = ~inside, np.ix_(inside, inside)
        yielding = (green + green.T)[both] / 2 + compliance[both]  # G + 1/k
        # phi: the plate raised by 1 at one held point inside and by 0 at the others; `_raised` is its part without F.
        self._forces = np.zeros((len(x), int(inside.sum())))
        self._forces[inside] = np.linalg.inv(yielding)
        self._raised = responses @ self._forces
        self._to_heights = -at_held[inside]  # v -> how far each phi is raised
        of_singular, inner = singular_masses(model, x, x)
        self._of_singular, inner = of_singular @ self._forces, self._forces.T @ inner @ self._forces
        carried = self._of_singular.T @ self._raised
        self._cross = self.mass @ self._raised + self._of_singular  # int q phi_j
        self._inner = self._raised.T @ (self.mass @ self._raised) + carried + carried.T + inner  # int phi_i phi_j
        rigid = _free_motions(model, at_held)
        inertia = self.with_mass(rigid)
        if rigid.size:
            inertia = inertia @ np.linalg.inv(np.linalg.cholesky(rigid.T @ inertia)).T
        # K's inverse knows the springs spread under the plate and not the held points. Rows of correction turn it into
        # the inverse of the modes' stiffness: the held points, the load that their forces put on the spread springs
        # (what psi_j weighs on each motion), and the rigid motions, moved out of the way.
        on_springs = model.mean + self._to_heights.T @ (self._forces.T @ model.motions(x))
        held_by_rim = csr_matrix(np.where(on_rim[:, None], green @ self._forces, 0.0))
        heights = at_held + held_by_rim @ self._to_heights  # of w, which a spring of 1/k holds on the rim
        rows = vstack([heights, csr_matrix(on_springs.T), csr_matrix(inertia.T)]).tocsr()
        weights = np.zeros((rows.shape[0],) * 2)
        weights[: len(x), : len(x)][both] = yielding
        weights[: len(x), : len(x)][np.ix_(on_rim, on_rim)] = -compliance[np.ix_(on_rim, on_rim)]
        weights[len(x) :, len(x) :] = np.diag(
            np.concatenate([np.ones(on_springs.shape[1]), np.full(inertia.shape[1], -1 / RIGID_SHIFT)])
        )
        self.solve = _corrected(model.solve, rows, weights)

    def unit(self, inertia: float) -> float:
        """The squared angular frequency [1/s^2] that makes eigenvalues dimensionless; inertia: kg/m^2, by area."""
        return self.rigidity / (inertia * self.model.mesh.size**4)

    def with_mass(self, v: FloatArray) -> FloatArray:
        """The inertial load (unknowns, ...) of v, the integrals of its trial functions with all of them."""
        c = self._to_heights @ v
        return np.asarray(self.mass @ v + self._cross @ c + self._to_heights.T @ (self._cross.T @ v + self._inner @ c))

    def inertia_of(self, functions: PlateFunctions) -> FloatArray:
        """The integrals (unknowns, k) of k functions of the same model, without pressure, with all trial functions."""
        model, forces = self.model, functions.forces
        smooth = functions.unknowns + model.space.linear() @ functions.rigid
        with_singular, inner = singular_masses(model, functions.sources, self.held)
        direct = self.mass @ smooth + with_singular @ forces
        of_raised = self._raised.T @ direct + self._of_singular.T @ smooth + self._forces.T @ (inner.T @ forces)
        return np.asarray(direct + self._to_heights.T @ of_raised)

    def functions(self, vectors: FloatArray) -> tuple[PlateFunctions, FloatArray]:
        """The functions of vectors (unknowns, k), each 1 at most at the space's samples, and what they were (k,)."""
        heights, count = self._to_heights @ vectors, vectors.shape[1]
        whole = PlateFunctions(
            self.model.space,
            vectors + self._raised @ heights,
            self.held,
            self._forces @ heights,
            np.zeros((3, count)),
            np.zeros(count),
            self.model.infinite,
        )
        largest = np.abs(whole.values(whole.space.samples)).max(axis=0)
        return whole.weighted(np.diag(1 / largest)), largest


def modes(held_plate: HeldPlate, count: int, inertia: float, refine: Callable[[], Modes] | None = None) -> Modes:
    """The lowest modes of a plate held at points.

    inertia: kg/m^2, mass per area.  refine: solves on halved cells.
    """
    squares, vectors = _lowest(held_plate, count, 0.0)  # to rounding: less may miss one of two equal frequencies
    functions, _ = held_plate.functions(vectors)
    return Modes(np.sqrt(squares * held_plate.unit(inertia)) / (2 * np.pi), held_plate.model, functions, refine)


def first_frequency(held_plate: HeldPlate, inertia: float) -> float:
    """The lowest natural frequency [Hz] of a plate held at points, without its mode; inertia: kg/m^2, by area."""
    return float(np.sqrt(_lowest(held_plate, 1, FIRST)[0][0] * held_plate.unit(inertia)) / (2 * np.pi))


def _lowest(held_plate: HeldPlate, count: int, residual: float) -> tuple[FloatArray, FloatArray]:
    """The lowest squared frequencies (count,), dimensionless and ascending, and their vectors (unknowns, count)."""
    unknowns = held_plate.model.unknowns
    mass_operator = LinearOperator((unknowns, unknowns), matvec=held_plate.with_mass, dtype=float)
    squares, vectors = eigsh(
        mass_operator,  # only its shape is used: with sigma = 0 all that is solved with is OPinv
        count,
        M=mass_operator,
        sigma=0,
        OPinv=LinearOperator((unknowns, unknowns), matvec=held_plate.solve, dtype=float),
        # Fixed, so that runs agree; random, so that every mode has a share.
        v0=np.random.default_rng(0).standard_normal(unknowns),
        tol=residual,
    )
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def singular_masses(model: PlateModel, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """int q F_i (unknowns, N) of F around points x (N, 2), and int F_i F_j (N, M), F_j around y (M, 2)."""
    with_singular, of_singular = np.zeros((model.unknowns, len(x))), np.zeros((len(x), len(y)))
    for triangle, points, weights in model.space.cells(CELLS):
        places = points.reshape(-1, 2)
        singular = model.infinite.point_value(places, x)
        weighted = model.masses(places, weights.ravel())[:, None] * singular
        with_singular += model.space.load_at(triangle, points, weighted.reshape(*weights.shape, -1))
        of_singular += weighted.T @ (singular if x is y else model.infinite.point_value(places, y))
    return with_singular, of_singular


def _free_motions(model: PlateModel, at_held: csr_matrix) -> FloatArray:
    """The rigid motions (unknowns, f) that neither the supports nor the held points stop."""
    rigid = model.space.linear() @ model.rigid
    if not rigid.size or not at_held.shape[0]:
        return np.asarray(rigid)
    moved = at_held @ rigid
    directions = np.linalg.svd(moved)[2]
    return np.asarray(rigid @ directions[np.linalg.matrix_rank(moved, tol=1e-9) :].T)


def _corrected(
    solve: Callable[[FloatArray], FloatArray], rows: csr_matrix, weights: FloatArray
) -> Callable[[FloatArray], FloatArray]:
    """The inverse of A - rows^T weights^-1 rows from that of A (Sherman-Morrison-Woodbury)."""
    solved = solve(rows.toarray().T)
    correction = np.linalg.inv(weights - rows @ solved)

    def corrected(load: FloatArray) -> FloatArray:
        plain = solve(load)
        return np.asarray(plain + solved @ (correction @ (rows @ plain)))

    return corrected


class WithModel(Protocol):
    """The influence shapes of N actuators, and the plate's model on whose cells they are."""

    model: PlateModel
    functions: PlateFunctions
    points: FloatArray  # (N, 2) m
    springs: FloatArray  # (N,) N/m
    size: float  # m


@dataclass(frozen=True, eq=False)
class ExcitedModes:
    """Modes that N actuators excite, each 1 at most at the space's samples."""

    omega: FloatArray  # (n,) rad/s, ascending
    functions: PlateFunctions  # n
    participation: FloatArray  # (n, N), m_ni

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies (n,) [Hz]."""
        return self.omega / (2 * np.pi)

    def chosen(self, rows: BoolArray) -> ExcitedModes:
        """Some of the modes (n,)."""
        functions = self.functions.weighted(np.eye(len(rows))[:, rows])
        return ExcitedModes(self.omega[rows], functions, self.participation[rows])


class Excitation:
    """The modes that actuators excite, among the plate's responses to the inertia of its influence shapes.

    Under strokes h the plate is w = sum_i h_i phi_i + sum_n eta_n psi_n, where phi_i are the influence shapes and psi_n
    the modes with the actuators held. Each mode obeys

        eta_n'' + 2 zeta omega_n eta_n' + omega_n^2 eta_n = -sum_i m_ni h_i'',  m_ni = (phi_i, psi_n) / (psi_n, psi_n).

    Modes that have no share in the influence shapes never move. So the modes are sought among the plate's own
    responses: the static response to the inertia of the shapes, then to the inertia of that response, and so on
    (Wilson, Yuan and Dickens, 1982). The lowest modes converge first; those left at the end stand for all the others.

    The responses come in blocks of N at most.

    shapes: of the actuators.  inertia: kg/m^2, mass per area.  rigidity: N m.
    """

    def __init__(self, shapes: WithModel, inertia: float, rigidity: float) -> None:
        held = shapes.springs > 0
        self._plate = HeldPlate(shapes.model, shapes.points[held], rigidity, shapes.springs[held])
        self._unit = self._plate.unit(inertia)
        self._load = self._plate.inertia_of(shapes.functions)  # (phi_i, q)
        none = np.zeros((len(self._load), 0))
        self._basis, self._stiff, self._heavy = none, none, none  # V, K V and M V, V orthonormal in M
        self.blocks = [0]  # how many responses there are after each block
        self.grow()

    @property
    def exhausted(self) -> bool:
        """Whether the last block brought nothing new, or there are as many responses as are ever taken."""
        return self.blocks[-1] >= MAX_MODES or (len(self.blocks) > 1 and self.blocks[-1] == self.blocks[-2])

    def grow(self) -> None:
        """Add a block: the responses to the inertia of the last one."""
        load = self._load if len(self.blocks) == 1 else self._heavy[:, self.blocks[-2] :]
        response, stiff = self._plate.solve(load), load
        scale = np.sqrt(np.einsum("uk,uk->k", response, self._plate.with_mass(response)))
        response, stiff = response / scale, stiff / scale
        for _ in range(2):  # once leaves rounding behind
            shares = self._heavy.T @ response
            response, stiff = response - self._basis @ shares, stiff - self._stiff @ shares
        heavy = self._plate.with_mass(response)
        combine = _orthonormalising(response.T @ heavy)
        basis = np.concatenate([self._basis, response @ combine], axis=1)
        stiffness = np.concatenate([self._stiff, stiff @ combine], axis=1)
        if _is_symmetric(basis.T @ stiffness):
            self._basis, self._stiff = basis, stiffness
            self._heavy = np.concatenate([self._heavy, heavy @ combine], axis=1)
        self.blocks.append(self._basis.shape[1])

    def modes(self, blocks: int | None = None) -> ExcitedModes:
        """The modes among the responses of all blocks, or of the first few."""
        count = self.blocks[-1 if blocks is None else blocks]
        basis, heavy, stiff = (part[:, :count] for part in (self._basis, self._heavy, self._stiff))
        stiffness, mass = basis.T @ stiff, basis.T @ heavy
        squares, turned = eigh((stiffness + stiffness.T) / 2, (mass + mass.T) / 2)
        vectors = basis @ turned
        functions, largest = self._plate.functions(vectors)
        participation = largest[:, None] * (vectors.T @ self._load)
        return ExcitedModes(np.sqrt(squares * self._unit), functions, participation)


def _is_symmetric(stiffness: FloatArray) -> bool:
    """Whether rounding, which grows from block to block, leaves a matrix (k, k) symmetric and positive."""
    own = np.diag(stiffness)
    if not (own > 0).all():
        return False
    return bool((np.abs(stiffness - stiffness.T) <= ASYMMETRY * np.sqrt(own * own[:, None])).all())


def _orthonormalising(gram: FloatArray) -> FloatArray:
    """The combinations (k, l) of k vectors that are orthonormal, without what is rounding of vectors of length 1."""
    squares, turned = np.linalg.eigh((gram + gram.T) / 2)
    kept = squares > max(ROUNDING**2, DEPENDENT * squares[-1])
    return np.asarray(turned[:, kept] / np.sqrt(squares[kept]))
