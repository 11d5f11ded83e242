"""A deflected plate: its shape, membrane, reactions and small vibrations, in SI units."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator, eigsh

from fem_plate.deflection import Estimated
from fem_plate.elements import Derivatives, PlateFunctions
from fem_plate.inputs import SAME_PLACE, check_on_plate
from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.equilibrium import Coefficients
from fem_plate.large_deflection.trial import BorderedSolver, Trial
from fem_plate.modes import Modes
from fem_plate.types import FloatArray


class DeflectedPlate(Estimated):
    """A plate that is bent and stretched; made by `LargeDeflection.solve`.

    Attributes
    ----------
    reactions : (N,) array
        Force of each actuator on the plate, positive up [N].
    energy : float
        Elastic energy of the plate, of bending and stretching [J].
    stretching_energy : float
        Its part of stretching [J].
    membrane : str
        "airy" or "plane-stress": how its stretching was computed.
    """

    def __init__(self, discrete: DiscretePlate, coefficients: Coefficients, forces: FloatArray) -> None:
        self.discrete, self.coefficients = discrete, coefficients
        self.size = discrete.size
        self.reactions = forces * discrete.force_unit
        trial = discrete.equilibrium.trial
        unscaled = trial.functions(*coefficients.columns, np.array([coefficients.pressure]))
        self.functions = unscaled.weighted(np.array([discrete.thickness]))
        self.stretching_energy = coefficients.stretching * discrete.energy_unit
        self.membrane = discrete.membrane.name

    @cached_property
    def largest(self) -> float:
        """The largest deflection [m], up or down, at the mesh's points and the actuators."""
        points = np.concatenate([self.functions.space.points, self.functions.sources])
        return float(np.abs(self.functions.values(points)).max())

    @cached_property
    def energy(self) -> float:
        bending = self.discrete.equilibrium.bending_energy(self.coefficients)
        return bending * self.discrete.energy_unit + self.stretching_energy

    def evaluate(self, xy: ArrayLike) -> Derivatives:
        """The deflection with first and second derivatives.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].

        Returns
        -------
        w : (n,) array
            [m].
        gradient : (n, 2) array
            [1].
        hessian : (n, 2, 2) array
            [1/m]; infinite at an actuator.

        Raises
        ------
        ValueError
            A point lies beyond the rim.
        """
        value, gradient, hessian = self.functions.evaluate(self._dimensionless(xy))
        return value[:, 0], gradient[:, 0] / self.size, hessian[:, 0] / self.size**2

    def in_plane(self, xy: ArrayLike) -> FloatArray:
        """The in-plane motion u (n, 2) [m] of the mid-plane at points (n, 2) [m]; raises as `evaluate` does."""
        x = self._dimensionless(xy)
        return self.discrete.plane_stress.values(x, self._motion[:, None])[..., 0] * self.discrete.motion_unit

    def membrane_force(self, xy: ArrayLike) -> FloatArray:
        """The membrane force (n, 2, 2) [N/m], positive: pulls, at points (n, 2) [m]; raises as `evaluate` does."""
        x = self._dimensionless(xy)
        discrete, membrane = self.discrete, self.coefficients.membrane
        if discrete.membrane.law is None:
            hessian = discrete.model.space.evaluate(x, membrane[:, None], orders=3)[2][:, 0]
            force = np.trace(hessian, axis1=1, axis2=2)[:, None, None] * np.eye(2) - hessian
        else:
            strain = discrete.plane_stress.gradients(x, membrane[:, None])[..., 0]
            slope = self.functions.evaluate(x)[1][:, 0] / discrete.thickness
            strain = (strain + strain.transpose(0, 2, 1) + slope[:, :, None] * slope[:, None]) / 2
            xx, xy_, yy = discrete.membrane.law @ np.stack([strain[:, 0, 0], 2 * strain[:, 0, 1], strain[:, 1, 1]])
            force = np.stack([np.stack([xx, xy_], -1), np.stack([xy_, yy], -1)], -1)
        force += discrete.model.tension * np.eye(2)
        return np.asarray(force * discrete.membrane_unit)

    @cached_property
    def _motion(self) -> FloatArray:
        """The unknowns of the in-plane motion."""
        return self.discrete.in_plane_motion(self.coefficients)

    def modes(self, count: int, held: FloatArray, stiffness: FloatArray, inertia: float) -> Modes:
        """The lowest modes about this state, as `Plate.modes`.

        held: (k, 2) m.  stiffness: (k,) N/m.  inertia: kg/m^2, mass per area.
        """
        discrete, x, rigidity = self.discrete, self.functions.sources, self.discrete.rigidity
        compliance = rigidity / self.size**2 / stiffness
        holds = np.full(len(x), np.inf)
        for point, c in zip(held / self.size, compliance, strict=True):
            near = np.flatnonzero(np.hypot(*(x - point).T) < SAME_PLACE)
            if not near.size:
                raise ValueError(
                    f"Input held of modes must be actuators of the deflected state; it has none at "
                    f"{(point * self.size).tolist()} m"
                )
            holds[near] = c
        squares, functions = modes_about(discrete, self.coefficients, holds, count)
        frequencies = np.sqrt(squares * rigidity / (inertia * self.size**4)) / (2 * np.pi)
        finer = cast(Callable[[], DeflectedPlate], self.refine)
        return Modes(frequencies, discrete.model, functions, lambda: finer().modes(count, held, stiffness, inertia))

    def _dimensionless(self, xy: ArrayLike) -> FloatArray:
        xy = np.asarray(xy, dtype=float)
        check_on_plate(self.discrete.mesh.outline, xy, self.size)
        return xy / self.size


CHUNK = 20_000  # quadrature points evaluated at a time, to bound memory


def modes_about(
    discrete: DiscretePlate, state: Coefficients, compliance: FloatArray, count: int
) -> tuple[FloatArray, PlateFunctions]:
    """The lowest dimensionless squared frequencies (count,), ascending, and the modes.

    compliance: (J,) of the actuators: 0 rigid, inf one that pushes with the same force all the time.
    Raises ValueError when the state is not stable.
    """
    equilibrium = discrete.equilibrium
    trial, n = equilibrium.trial, discrete.model.unknowns
    held = np.isfinite(compliance)
    solver = BorderedSolver(trial, *equilibrium.tangent(state), held, compliance)
    mass, cross, own = discrete.model.space.mass(), *_masses(trial)
    still = np.zeros(int(held.sum()))

    def with_mass(x: FloatArray) -> FloatArray:
        v, extra = x[:n], x[n:]
        return np.concatenate([mass @ v + cross @ extra, cross.T @ v + own @ extra])

    def solve(load: FloatArray) -> FloatArray:
        return np.concatenate(solver.solve(load[:n], load[n:], still)[:2])

    shape = (n + trial.count,) * 2
    operator = LinearOperator(shape, matvec=with_mass, dtype=float)
    squares, vectors = eigsh(
        operator,  # only its shape is used: with sigma = 0 all that is solved with is OPinv
        count,
        M=operator,
        sigma=0,
        OPinv=LinearOperator(shape, matvec=solve, dtype=float),
        v0=solve(with_mass(np.random.default_rng(0).standard_normal(shape[0]))),  # meets the constraints
    )
    order = np.argsort(squares)
    squares, vectors = squares[order], vectors[:, order]
    if squares[0] <= 0:
        raise ValueError("Input deflected of modes must be a stable state; it is not: it has a growing motion")
    functions = trial.functions(vectors[:n], vectors[n:])
    scale = 1 / np.abs(functions.values(functions.space.points)).max(axis=0)
    return squares, functions.weighted(np.diag(scale))


def _masses(trial: Trial) -> tuple[FloatArray, FloatArray]:
    """The integrals of the extra functions with finite elements (unknowns, e) and with each other (e, e)."""
    space, count = trial.model.space, trial.count
    (points, weights), triangles = space.quadrature, space.quadrature_triangles
    cross, own = np.zeros((space.unknowns, count)), np.zeros((count, count))
    for start in range(0, len(points), CHUNK):
        part = slice(start, start + CHUNK)
        value = trial.extra.values(points[part])[:, :-1]
        weighted = weights[part, None] * value
        cross += space.point_values(points[part], triangles[part]).T @ weighted
        own += value.T @ weighted
    return cross, own
