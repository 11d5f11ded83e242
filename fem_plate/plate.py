"""Plate: a mesh, a section and its supports, ready to be loaded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu
from scipy.spatial import cKDTree

from fem_plate.influence import Fields, Shapes, check_points
from fem_plate.section import PlateSection
from fem_plate.singular import point_load
from fem_plate.space import PlateSpace
from meshes import PlateMesh

FloatArray = NDArray[np.float64]

MOST_UNKNOWNS = 100_000  # refinement to a tolerance stops here
FAR = 0.7  # of the plate's size: an actuator that far from the rim needs no smaller cells there
REFINEMENT_GAIN = 2.0**5  # halving the cells divides the error of w by this at least (observed: 2^5.5 and more)


class Plate:
    """A Kirchhoff-Love plate, clamped at its rim.

    mesh: its outline.  section: its material and thickness.  supports: "clamped".
    tolerance: with one, `influence` refines until its own error estimate (of unit shapes) meets it, or until 100 000
    unknowns; `error_estimate` says what was reached.
    Raises ValueError for any other support.
    """

    def __init__(
        self, mesh: PlateMesh, section: PlateSection, supports: str = "clamped", tolerance: float | None = None
    ) -> None:
        if supports != "clamped":
            raise ValueError(f"Input supports of Plate must be 'clamped'; got {supports!r}")
        self.mesh = mesh
        self.section = section
        self.tolerance = tolerance
        self._finer: Plate | None = None

    @property
    def finer(self) -> Plate:
        """The same plate on cells of half the size."""
        if self._finer is None:
            self._finer = Plate(self.mesh.refined(), self.section)
        return self._finer

    def graded(self, points: FloatArray) -> Plate:
        """This plate, or one with smaller cells where actuators at points (N, 2) [m] are near the rim.

        The smooth part varies over the distance to the actuators' mirror images beyond the rim; cells stay as small
        in comparison as they are for an actuator at FAR from the rim.
        """
        mesh, images = self.mesh, cKDTree(self.mesh.mirrored(points))
        slope = float(np.median(mesh.cell_sizes)) / (FAR * mesh.size)
        while True:
            distance, _ = images.query(mesh.points[mesh.triangles].mean(axis=1))
            large = mesh.cell_sizes > slope * distance
            if not large.any():
                break
            mesh = mesh.refined(large)
        return self if mesh is self.mesh else Plate(mesh, self.section)

    def influence(self, points: ArrayLike) -> InfluenceShapes:
        """The influence shapes of actuators at points (N, 2) [m].

        Raises ValueError, naming every point that is not inside the rim or stands on another.
        """
        points = np.asarray(points, dtype=float).reshape(-1, 2)
        check_points(points, self.mesh.rim_gap(points), self.mesh.size)
        shapes = InfluenceShapes(self.graded(points), points)
        if self.tolerance is None:
            return shapes
        estimate = np.inf
        while estimate > self.tolerance and 4 * shapes.unknowns < MOST_UNKNOWNS:
            coarse, shapes = shapes, InfluenceShapes(shapes.plate.finer, points)
            estimate = _difference(coarse, shapes) / REFINEMENT_GAIN
            shapes.error_estimate = estimate
        return shapes

    def deflection(self, points: ArrayLike, forces: ArrayLike) -> Deflection:
        """The plate under forces (N,) [N] at points (N, 2) [m], with no actuator holding it.

        Raises ValueError as `influence` does, and when there is not one force a point.
        """
        points, forces = np.atleast_2d(np.asarray(points, dtype=float)), np.atleast_1d(np.asarray(forces, dtype=float))
        if forces.shape != points.shape[:1]:
            raise ValueError(f"Input forces of deflection must be one a point, {len(points)}; got shape {forces.shape}")
        check_points(points, self.mesh.rim_gap(points), self.mesh.size)
        return Deflection(InfluenceShapes(self.graded(points), points), forces)

    def frequencies(self, count: int, held: ArrayLike | None = None) -> FloatArray:
        """The lowest natural frequencies (count,) [Hz], ascending, repeated ones repeated.

        held: points (N, 2) [m] that actuators hold still; the plate bends there as under point loads, which polynomials
        follow only to about three digits.
        Raises ValueError when the section has no density, the count is not positive, or a point is not inside the rim.
        """
        density = self.section.density
        if density is None:
            raise ValueError("Input density of PlateSection must be given for frequencies; got None")
        if not 1 <= count < self.space.unknowns // 2:
            raise ValueError(f"Input count of frequencies must be at least 1; got {count!r}")
        solve = self._factor.solve
        if held is not None:
            points = np.asarray(held, dtype=float).reshape(-1, 2)
            check_points(points, self.mesh.rim_gap(points), self.mesh.size)
            solve = self._held(points / self.mesh.size)
        mass = self.space.mass()
        inverse = LinearOperator(mass.shape, matvec=solve, dtype=float)
        start = np.ones(self.space.unknowns)  # a start of its own would make results differ from run to run
        inertia, stiffness = density * self.section.thickness * self.mesh.size**4, self.section.rigidity
        squares = eigsh(mass, count, M=mass, sigma=0, OPinv=inverse, v0=start, return_eigenvectors=False)
        return np.asarray(np.sqrt(np.sort(squares) * stiffness / inertia) / (2 * np.pi))

    def _held(self, points: FloatArray) -> Callable[[FloatArray], FloatArray]:
        """The plate's answer (unknowns,) to a load while it is held at points (N, 2), dimensionless."""
        values = self.space.point_values(points)
        answers = self._factor.solve(values.T.toarray())
        reactions = np.linalg.inv(values @ answers)

        def solve(load: FloatArray) -> FloatArray:
            free = self._factor.solve(load)
            return np.asarray(free - answers @ (reactions @ (values @ free)))

        return solve

    @cached_property
    def space(self) -> PlateSpace:
        return PlateSpace(self.mesh)

    @cached_property
    def _factor(self) -> SuperLU:
        # Symmetric ordering without pivoting: the matrix is positive definite, and rounding stays at 1e-11.
        matrix = self.space.stiffness(self.section.poisson_ratio)
        return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def solve_point_loads(self, sources: FloatArray) -> FloatArray:
        """The unknowns (unknowns, N) of the smooth parts under unit forces at sources (N, 2), all dimensionless."""
        f, f_x, _ = point_load(self.space.rim_points, sources)
        data = np.concatenate([f, f_x[..., 0], f_x[..., 1]])
        return np.asarray(self._factor.solve(-(self.space.rim_operator(self.section.poisson_ratio) @ data)))


class InfluenceShapes(Shapes):
    """Influence shapes found by finite elements on one mesh; made by `Plate.influence`."""

    def __init__(self, plate: Plate, points: FloatArray) -> None:
        self.plate = plate
        scaled = points / plate.mesh.size
        self._unknowns = plate.solve_point_loads(scaled)
        compliance = point_load(scaled, scaled)[0] + plate.space.evaluate(scaled, self._unknowns)[0]
        super().__init__(points, plate.mesh.size, plate.mesh.curves["rim"], compliance)

    @property
    def unknowns(self) -> int:
        """How many unknowns the mesh has."""
        return self.plate.space.unknowns

    @property
    def compliance(self) -> FloatArray:
        """Deflection at i under a unit force at j, (N, N) [m/N]."""
        return np.asarray(np.linalg.inv(self.strengths) * self.size**2 / self.plate.section.rigidity)

    @property
    def stiffness(self) -> FloatArray:
        """Force at i that raises j by one metre while the others hold 0, (N, N) [N/m]."""
        return self.strengths * self.plate.section.rigidity / self.size**2

    @cached_property
    def error_estimate(self) -> float:
        """Largest error of the unit shapes, estimated: their difference from those on cells of half the size."""
        return _difference(self, InfluenceShapes(self.plate.finer, self.points))

    def loaded(self, x: FloatArray, strengths: FloatArray) -> Fields:
        return self.plate.space.evaluate(x, self._unknowns @ strengths)


@dataclass(frozen=True)
class Deflection:
    """The plate under given forces [N] at the shapes' points."""

    shapes: InfluenceShapes
    forces: FloatArray

    def evaluate(self, xy: ArrayLike) -> Fields:
        """w (n,) m, gradient (n, 2), Hessian (n, 2, 2) 1/m at points (n, 2) [m]; raises as the shapes do."""
        unit = self.shapes.size**2 / self.shapes.plate.section.rigidity
        value, gradient, hessian = self.shapes.under_forces(xy, unit * self.forces[:, None])
        return value[:, 0], gradient[:, 0], hessian[:, 0]


def _difference(one: InfluenceShapes, other: InfluenceShapes) -> float:
    """The largest difference of two sets of unit shapes, over the finer mesh's points."""
    xy = max(one, other, key=lambda shapes: shapes.unknowns).plate.mesh.points
    return float(np.max(np.abs(one.evaluate(xy)[0] - other.evaluate(xy)[0])))
