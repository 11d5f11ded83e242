"""Influence shapes on one mesh: the plate with one actuator raised by one metre while the others hold 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import diags

from fem_plate.deflection import Estimated
from fem_plate.elements import Derivatives, PlateFunctions, PlateModel, SourceBasis
from fem_plate.inputs import check_held
from fem_plate.modes import HeldPlate, first_frequency
from fem_plate.shapes import Shapes
from fem_plate.types import FloatArray, IntArray

SUMS = 16  # of all shapes, that are compared with those on finer cells where there are many
CHUNK = 4096  # unknowns combined at a time
RANK = 1e-9  # of rigid motions: smaller deflections are none
MAX_DENSE = 2000  # actuators whose compliance and stiffness are worth a dense matrix


def held_shapes(
    model: PlateModel,
    x: FloatArray,
    stiffness: FloatArray,
    stiffness_unit: float,
    chosen: IntArray | None = None,
    may_move: bool = False,
) -> tuple[PlateFunctions, FloatArray]:
    """The shapes of actuators at x (N, 2), of all or of the chosen rows, and the plate's compliance G (N, N).

    The held actuators' forces P and the rigid motions c obey, dimensionless and with strokes h,

        (G + diag(1 / stiffness)) P + R c = h,   R^T P = 0 over all actuators,

    where the force of a floating actuator is given: one newton.

    stiffness: (N,) N/m, of the actuators, inf rigid, 0 floating.  stiffness_unit: N/m, of dimensionless stiffness.
    may_move: whether supports and actuators may leave the plate rigid motions; the shapes then have any share of them.
    Raises ValueError when they do and may not.
    """
    held = stiffness > 0
    basis, responses, compliance, motions, matrix = _held_system(model, x, stiffness, stiffness_unit, may_move)
    to_forces, to_basis = basis.matrix, basis.matrix.T.tocsr()
    columns = np.arange(len(x)) if chosen is None else chosen
    drives = np.eye(len(x))[:, columns] * np.where(held[columns], 1.0, 1 / stiffness_unit)
    strokes = (to_basis[:, held] @ drives[held])[held] - compliance[np.ix_(held, ~held)] @ drives[~held]
    given = np.concatenate([strokes, -motions[~held].T @ drives[~held]])
    solution = np.linalg.lstsq(matrix, given)[0] if may_move else np.linalg.solve(matrix, given)
    coefficients = drives.copy()
    coefficients[held] = solution[: held.sum()]
    forces = np.asarray(to_forces @ coefficients)
    rigid = model.rigid @ solution[held.sum() :]
    if chosen is None:
        for start in range(0, len(responses), CHUNK):  # in place: there is not always room for two
            responses[start : start + CHUNK] = responses[start : start + CHUNK] @ coefficients
    else:
        responses = responses @ coefficients
    no_pressure = np.zeros(forces.shape[1])
    functions = PlateFunctions(model.space, responses, x, forces, rigid, no_pressure, model.infinite)
    return functions, basis.green(compliance)


def held_under_pressure(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float
) -> PlateFunctions:
    """The plate under a unit pressure with its actuators at x (N, 2) held at 0: one function, dimensionless.

    With the deflection d and the resultant s under the pressure alone, forces P and rigid motions c obey

        (G + diag(1 / stiffness)) P + R c + d = 0,   R^T P + s = 0.

    stiffness, stiffness_unit: as of `held_shapes`.
    """
    held = stiffness > 0
    basis, responses, _, motions, matrix = _held_system(model, x, stiffness, stiffness_unit)
    nothing, alone = np.zeros((len(x), 1)), np.ones(1)
    unmoved = PlateFunctions(model.space, model.under_pressure(), x, nothing, np.zeros((3, 1)), alone, model.infinite)
    points, weights = model.space.quadrature
    deflected = (basis.matrix.T.tocsr() @ unmoved.values(x))[held]
    solution = np.linalg.solve(matrix, -np.concatenate([deflected, (weights @ model.motions(points))[:, None]]))
    coefficients = nothing.copy()
    coefficients[held] = solution[: held.sum()]
    rigid = model.rigid @ solution[held.sum() :]
    forces = np.asarray(basis.matrix @ coefficients)
    return replace(unmoved, unknowns=unmoved.unknowns + responses @ coefficients, forces=forces, rigid=rigid)


def _held_system(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float, may_move: bool = False
) -> tuple[SourceBasis, FloatArray, FloatArray, FloatArray, FloatArray]:
    """What the forces of held actuators follow from: their basis, the responses to it, G and R in it, the matrix."""
    held = stiffness > 0
    basis = model.basis(x, held)
    to_forces, to_basis = basis.matrix, basis.matrix.T.tocsr()  # P from coefficients; and what they feel from heights
    responses = model.under_forces(x, basis)
    compliance = basis.point_values(model.infinite) + np.asarray((to_basis @ model.space.point_values(x)) @ responses)
    compliance = (compliance + compliance.T) / 2
    motions = np.asarray(to_basis @ model.motions(x))
    r = motions.shape[1]
    if not may_move:
        check_held("influence", model.motions(x), held)
    springs = (to_basis[:, held] @ diags(stiffness_unit / stiffness[held]) @ to_forces[held])[held][:, held]
    yielding = compliance[np.ix_(held, held)] + springs.toarray()
    matrix = np.block([[yielding, motions[held]], [motions[held].T, np.zeros((r, r))]])
    return basis, responses, compliance, motions, matrix


def sums_on(model: PlateModel, coarse: InfluenceShapes, values: FloatArray, weights: FloatArray) -> FloatArray:
    """What sums of shapes with weights (N, k) change by on a finer mesh, (n, k) at its space's samples.

    The coarse forces, taken over, leave the actuators slightly off their heights. The coarse shapes bring them back, to
    the product of two errors. So each sum takes one solution, where each shape would take one.

    values: (n, N), of the coarse shapes at these points.
    """
    size, ratio, held = model.mesh.size, model.mesh.size / coarse.size, coarse.springs > 0
    before = coarse.functions.weighted(weights)
    x, forces = coarse.points / size, before.forces * ratio**2
    after = replace(
        before,
        space=model.space,
        unknowns=model.under_loads(x, forces),
        sources=x,
        forces=forces,
        rigid=before.rigid * [[1.0], [ratio], [ratio]],
        infinite=model.infinite,
    )
    give = coarse.stiffness_unit / ratio**2 / coarse.springs[held, None]
    off = after.values(x)[held] + forces[held] * give - weights[held]
    return np.asarray(after.values(model.space.samples) - values[:, held] @ off - values @ weights)


def unheld_shapes(
    model: PlateModel, x: FloatArray, stiffness: FloatArray, stiffness_unit: float
) -> tuple[PlateFunctions, FloatArray]:
    """The same on a plate that supports and actuators may leave rigid motions u: shapes phi with (phi, u) = 0.

    A plate with mass does not pick up what nothing pushes: where no force acts along u, (w, u)'' = 0. Modes have no
    share of u either. So w = sum h_i phi_i + sum eta_n psi_n holds from rest, and in a steady state.
    Raises ValueError when u are left and an actuator pushes with a force, which would accelerate the plate for ever.
    """
    held = stiffness > 0
    motions = model.motions(x[held])
    r = motions.shape[1]
    if not r or np.linalg.matrix_rank(motions, tol=RANK) == r:
        return held_shapes(model, x, stiffness, stiffness_unit)
    if not held.all():
        check_held("influence", model.motions(x), held)
    functions, green = held_shapes(model, x, stiffness, stiffness_unit, may_move=True)
    free = np.linalg.svd(motions)[2][np.linalg.matrix_rank(motions, tol=RANK) :].T  # (r, f), 0 at all actuators
    size = model.mesh.size
    plate = HeldPlate(model, x * size, stiffness_unit * size**2, stiffness)
    rigid = model.rigid @ free
    moved = model.space.linear() @ rigid
    shares = np.linalg.solve(moved.T @ plate.with_mass(moved), moved.T @ plate.inertia_of(functions))
    return replace(functions, rigid=functions.rigid - rigid @ shares), green


class InfluenceShapes(Shapes, Estimated):
    """Influence shapes computed by finite elements on one mesh; made by `Plate.influence`.

    A rigid actuator's shape is 1 there and 0 at the other rigid ones. An actuator of finite stiffness k yields: under
    its force P the plate stands at h - P/k. A floating one (k = 0) holds nothing: its shape is the deflection under a
    unit force there [m/N].

    free_motions: whether the plate may be left rigid motions; then its shapes carry none of their momentum.
    finer: the model of the next level of fineness.
    """

    def __init__(
        self,
        model: PlateModel,
        points: FloatArray,
        rigidity: float,
        actuator_stiffness: FloatArray,
        free_motions: bool,
        finer: Callable[[], PlateModel],
    ) -> None:
        self.model, self.finer = model, finer
        self.points = np.ascontiguousarray(points)  # kernels would be compiled anew for another layout
        self.size = model.mesh.size
        self.outline = model.mesh.outline
        self.springs = actuator_stiffness
        self.stiffness_unit = rigidity / self.size**2  # N/m
        solve = unheld_shapes if free_motions else held_shapes
        self.functions, self._green = solve(model, points / self.size, actuator_stiffness, self.stiffness_unit)
        self.strengths = model.infinite.logarithms(points / self.size)[:, None] * self.functions.forces
        self.rounding = model.rounding(points / self.size, actuator_stiffness > 0)

    @cached_property
    def error_estimate(self) -> float:
        """Estimated largest error of w, relative to each shape's largest deflection.

        It is the difference from finer shapes, which are computed on first use, and rounding.
        Of many actuators it is the root of the sum of squares of all shapes' differences at the worst place, found from
        random sums of them: as large as that of the worst shape, or somewhat larger.
        """
        if len(self.points) <= 2 * SUMS or self.rounding:  # actuators nearly coincide: sums of forces would cancel
            return super().error_estimate
        model = self.finer()
        shapes = self.values(model.space.samples * model.mesh.size)
        signs = np.random.default_rng(0).choice([-1.0, 1.0], (len(self.points), SUMS))
        off = sums_on(model, self, shapes, signs / np.abs(shapes).max(axis=0)[:, None])
        return float(np.sqrt(np.square(off).mean(axis=1).max()))

    @property
    def compliance(self) -> FloatArray:
        """Deflection at i under a unit force at j, (N, N) m/N, with no actuator holding the plate.

        Raises
        ------
        ValueError
            The plate's supports leave it a rigid motion.
        """
        if self.model.rigid.size:
            raise ValueError("Input supports of Plate must hold it without actuators for a compliance; they do not")
        return self._green / self.stiffness_unit

    @property
    def stiffness(self) -> FloatArray:
        """Force at i for a unit stroke of actuator j, (N, N) [N/m]; for a floating one, for a unit force."""
        return self.functions.forces * self.stiffness_unit

    def under_pressure(self, pressure: float) -> PlateFunctions:
        """The plate's deflection under a uniform pressure [Pa], up, while its actuators' strokes and forces are 0.

        Its value is in m, over places in `size`. Rigid actuators stay where they are and springs yield.
        """
        scale = pressure * self.size**2 / self.stiffness_unit
        unit = held_under_pressure(self.model, self.points / self.size, self.springs, self.stiffness_unit)
        return unit.weighted(np.array([scale]))

    def pressure_forces(self, pressure: float) -> FloatArray:
        """The forces (N,) [N] on the plate with which actuators bear a uniform pressure [Pa]; 0 of floating ones."""
        return np.asarray(self.under_pressure(pressure).forces[:, 0] * self.stiffness_unit)

    def compliance_at(self, place: ArrayLike) -> float:
        """The deflection [m/N] at a place (2,) [m] clear of actuators under a unit force there, with these held.

        By reciprocity an actuator's force there is, downwards, what a unit stroke of it lifts the place by.
        """
        s, held, model = np.asarray(place, dtype=float)[None] / self.size, self.springs > 0, self.model
        one, none = np.ones((1, 1)), np.zeros((3, 1))
        alone = PlateFunctions(model.space, model.under_forces(s), s, one, none, np.zeros(1), model.infinite)
        x, lifts = self.points[held] / self.size, self.functions.values(s)[0, held]
        at_held, motions = alone.values(x)[:, 0], model.motions(x)
        moved = self._green[np.ix_(held, held)] @ lifts + lifts * self.stiffness_unit / self.springs[held] - at_held
        rigid = model.motions(s)[0] @ np.linalg.lstsq(motions, moved)[0] if motions.size else 0.0
        return float((alone.values(s)[0, 0] - lifts @ at_held + rigid) / self.stiffness_unit)

    def first_frequency(self, inertia: float) -> float:
        """The plate's first frequency [Hz] on these cells, with the actuators held; inertia: kg/m^2, mass per area."""
        held, model, responses = self.springs > 0, self.model, None
        if held.all() and not model.rigid.size:  # the shapes are these responses to the forces that raise actuators
            responses = self.functions.unknowns @ (self._green + np.diag(self.stiffness_unit / self.springs))
        rigidity = self.stiffness_unit * self.size**2
        return first_frequency(HeldPlate(model, self.points[held], rigidity, self.springs[held], responses), inertia)

    def derivatives(self, x: FloatArray, weights: FloatArray | None) -> Derivatives:
        return self._weighted(weights).evaluate(x)

    def values(self, xy: ArrayLike, weights: FloatArray | None = None) -> FloatArray:
        return self._weighted(weights).values(np.asarray(xy, dtype=float) / self.size)

    def laplacians(self, xy: ArrayLike, floor: float) -> FloatArray:
        """The shapes' Laplacians.

        Parameters
        ----------
        xy : (n, 2) array_like
            Points on the plate [m].
        floor : float
            Radius around an actuator within which its Laplacian grows no more [m]; under a point load it has no bound.

        Returns
        -------
        (n, N) array
            [1/m^2].
        """
        return self.functions.laplacians(np.asarray(xy, dtype=float) / self.size, floor / self.size) / self.size**2

    def nonzero_values(self, xy: FloatArray) -> tuple[IntArray, FloatArray]:
        return np.arange(len(self.points)), self.functions.values(xy / self.size)

    def own_heights(self) -> FloatArray:
        return np.abs(np.diag(self.functions.values(self.points / self.size)))

    def _weighted(self, weights: FloatArray | None) -> PlateFunctions:
        return self.functions if weights is None else self.functions.weighted(weights)
