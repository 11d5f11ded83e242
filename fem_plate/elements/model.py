"""The discrete plate: a graded mesh, its factorised stiffness, and its responses to unit loads; all dimensionless.

Where the energy is a field, the stiffness and the loads are those of `EnergyForm`; where one law holds everywhere, the
element matrices are exact and nothing inside the cells loads the smooth part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix

from fem_plate.elements.anisotropic import AnisotropicPlate, infinite_plate
from fem_plate.elements.argyris import DEGREE
from fem_plate.elements.condensed import Condensed
from fem_plate.elements.dipoles import SourceBasis, source_basis
from fem_plate.elements.energy import PlateEnergy
from fem_plate.elements.energy_form import EnergyForm
from fem_plate.elements.enriched import EnrichedSpace
from fem_plate.elements.factor import factorised
from fem_plate.elements.forms import rim_traces
from fem_plate.elements.infinite import InfinitePlate, InteriorForces
from fem_plate.elements.rim import rigid_motions
from fem_plate.elements.space import PlateSpace
from fem_plate.elements.wedges import Wedge, corner_functions
from fem_plate.types import BoolArray, FloatArray
from meshes import PlateMesh

CHUNK = 128  # forces solved for at a time, to bound memory
FREE = 1e-10  # of the largest energy of a rigid motion: those with less are free
EPSILON = float(np.finfo(float).eps)
ROUNDING = 3e-20  # of w over the square of the number of unknowns, at degrees above five, as measured


class PlateModel:
    """A plate on one mesh.

    supports: of every boundary.  free_corners: rows of mesh points where second derivatives may jump.
    law: (3, 3), of M(v):H(q) over the plate's rigidity; or the energy, where that is a field or more than bending.
    tension: 1/m^2, over the rigidity too, of a plate of one law; 0 where a boundary is free.
    wedges: corners with functions of their own, of an isotropic plate.
    rim_points: (k, 2) m, on free boundaries, where forces load the elements.
    degree: of the elements; above five only for a plate of one law, held by its supports, without tension,
    free_corners, wedges and rim_points.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        supports: Mapping[str, str],
        law: FloatArray | PlateEnergy,
        free_corners: Iterable[int] = (),
        tension: float = 0.0,
        wedges: Sequence[Wedge] = (),
        rim_points: FloatArray | None = None,
        degree: int = DEGREE,
    ) -> None:
        self.mesh, self.degree = mesh, degree
        self.tension = tension * mesh.size**2  # dimensionless
        self.form: EnergyForm | None = None
        rows = list(free_corners)
        if isinstance(law, PlateEnergy):
            self.space: PlateSpace = PlateSpace(mesh, supports, rows)
            self.form = EnergyForm(self.space, law)
            self.infinite = _with_forces(AnisotropicPlate(law.laws), mesh, rim_points)
            self.rigid = self._orthonormal(self._free(rigid_motions(self.space.rim)))  # (3, r), of 1, x, y
            return
        self.law = law
        self.infinite = _with_forces(infinite_plate(law, self.tension), mesh, rim_points)
        if wedges:
            functions = corner_functions(wedges, mesh.size)
            self.space = EnrichedSpace(mesh, supports, rows, functions, law, self.tension)
        else:
            self.space = PlateSpace(mesh, supports, rows, degree)
        self.rigid = self._orthonormal(rigid_motions(self.space.rim))

    @cached_property
    def condensed(self) -> Condensed | None:
        """The equations where the degree is above five."""
        return Condensed(self.space, self.law) if self.degree > DEGREE else None

    @property
    def unknowns(self) -> int:
        return self.space.unknowns

    def _orthonormal(self, rigid: FloatArray) -> FloatArray:
        """The same rigid motions, orthonormal over the plate."""
        if not rigid.size:
            return rigid
        points, weights = self.space.quadrature
        motions = np.column_stack([np.ones(len(points)), points]) @ rigid
        return np.asarray(rigid @ np.linalg.inv(np.linalg.cholesky(motions.T @ (weights[:, None] * motions))).T)

    def _free(self, rigid: FloatArray) -> FloatArray:
        """The rigid motions (3, r) among those that the supports allow which cost no energy."""
        if not rigid.size or self.form is None:
            return rigid
        even = self._orthonormal(rigid)
        motions = self.space.linear() @ even
        energies, turned = np.linalg.eigh(motions.T @ (self.form.parts[1] @ motions))
        return np.asarray(even @ turned[:, np.abs(energies) <= FREE * np.abs(energies).max()])

    @cached_property
    def mass(self) -> csc_matrix:
        """The matrix of int v q, by the mass per area over that of the section for reference."""
        return self.space.mass() if self.form is None else self.form.mass()

    def masses(self, points: FloatArray, weights: FloatArray) -> FloatArray:
        """The weights (n,) at points (n, 2) of integrals over the plate's mass, as of `mass`; weights: by area."""
        return weights if self.form is None else weights * self.form.energy.relative_thickness(points)

    def basis(self, x: FloatArray, held: BoolArray) -> SourceBasis:
        """What to combine forces at x (N, 2) of, where actuators hold the plate.

        There are no dipoles where the energy is a field: forces at different places have different laws.
        """
        return source_basis(x, held & self.infinite.acts(x) if self.form is None else np.zeros_like(held))

    def rounding(self, x: FloatArray, held: BoolArray) -> float:
        """The error of shapes of actuators at x (N, 2), relative to their largest value, that finer cells have too."""
        if self.form is None:
            return self.basis(x, held).rounding + (ROUNDING * self.unknowns**2 if self.degree > DEGREE else 0.0)
        # Second differences of Green's functions lose digits with the square of the distance between actuators.
        apart = np.linalg.norm(x[held][:, None] - x[held], axis=-1) + np.where(np.eye(int(held.sum())), np.inf, 0.0)
        return float(EPSILON / apart.min(initial=1.0) ** 2)

    @cached_property
    def mean(self) -> FloatArray:
        """(unknowns, r), whose product with a function's unknowns is its integrals with the rigid motions."""
        if not self.rigid.size:
            return np.zeros((self.unknowns, 0))
        return np.asarray(self.space.mass() @ (self.space.linear() @ self.rigid))

    @cached_property
    def pins(self) -> csc_matrix:
        """(r, unknowns), the deflections at r points that would stop every rigid motion if held."""
        xy = self.mesh.points / self.mesh.size
        chosen: list[int] = []
        motions = np.column_stack([np.ones(len(xy)), xy]) @ self.rigid
        for _ in range(self.rigid.shape[1]):
            row = int(np.argmax((motions**2).sum(axis=1)))
            chosen.append(row)
            direction = motions[row] / np.linalg.norm(motions[row])
            motions = motions - np.outer(motions @ direction, direction)
        return self.space.point_values(xy[chosen])

    @cached_property
    def pinned_stiffness(self) -> csc_matrix:
        """The stiffness, with the rigid motions held by springs at a few points."""
        own = self.space.stiffness(self.law, self.tension) if self.form is None else self.form.stiffness
        return (own + self.pins.T @ self.pins).tocsc()

    @cached_property
    def solve(self) -> Callable[[FloatArray], FloatArray]:
        """Solves for the plate's response (unknowns, ...) to a load (unknowns, ...).

        A plate that can move rigidly rests on springs spread evenly under all of it, whose reactions are rigid motions
        too; balanced loads do not feel them.
        """
        if isinstance(self.space, EnrichedSpace):
            return self.space.solve
        if self.condensed is not None:
            return self.condensed.solve
        pinned = factorised(self.pinned_stiffness)
        if not self.rigid.size:
            return pinned
        motions, mean = self.space.linear() @ self.rigid, self.mean

        def on_springs(load: FloatArray) -> FloatArray:
            # The springs take the unbalanced part of the load. The pins do not feel the rest.
            unbalanced = motions.T @ load
            response = pinned(load - mean @ unbalanced)
            return np.asarray(response + motions @ (unbalanced - mean.T @ response))

        return on_springs

    @cached_property
    def _load(self) -> csc_matrix:
        return self.space.load(self.law, self.tension)

    def _traces(self, known: list[list[FloatArray]]) -> FloatArray:
        """The traces (t, k) at the rim of k known functions, from their derivatives there."""
        rows = [rim_traces(derivatives, self.space.rim.normal, self.law).ravel() for derivatives in known]
        return np.stack(rows, axis=1)

    def _smooth_parts(self, traces: FloatArray) -> FloatArray:
        """The parts (unknowns, k) that make k known functions, by their traces (t, k), meet the supports."""
        if isinstance(self.space, EnrichedSpace):
            return self.space.follow(-traces)
        if self.condensed is not None:
            return self.condensed.follow(-traces)
        return self.solve(-(self._load @ traces))

    def under_forces(self, sources: FloatArray, basis: SourceBasis | None = None) -> FloatArray:
        """The smooth parts (unknowns, N) of the responses to unit forces at sources (N, 2), or to those of a basis."""
        responses = self._smooth_under(sources, basis)
        if len(at_rim := np.flatnonzero(~self.infinite.acts(sources))):
            responses[:, at_rim] += self.solve(self.space.point_values(sources[at_rim]).toarray().T)
        if not self.rigid.size:
            return responses
        # The springs respond to the known functions too, by a rigid motion.
        means = self._known_means(sources)
        return responses - self.space.linear() @ (self.rigid @ (means if basis is None else means @ basis.matrix))

    def _smooth_under(self, sources: FloatArray, basis: SourceBasis | None) -> FloatArray:
        """The same without what springs under a plate that can move rigidly add."""
        if self.form is not None:
            return self.solve(self.form.loads(sources, self.infinite))
        responses = np.empty((self.unknowns, len(sources)), order="F")
        rim = self.space.rim.points
        for start in range(0, len(sources), CHUNK):
            part = range(start, min(start + CHUNK, len(sources)))
            known = [self.infinite.point_derivatives(rim, sources[k]) for k in part]
            for k, parent, length in () if basis is None else basis.within(part):
                rest = self.infinite.point_derivatives(rim, sources[parent])
                known[k - start] = [(one - other) / length for one, other in zip(known[k - start], rest, strict=True)]
            responses[:, part.start : part.stop] = self._smooth_parts(self._traces(known))
        return responses

    def under_loads(self, sources: FloatArray, forces: FloatArray) -> FloatArray:
        """The smooth parts (unknowns, k) of the responses to k sets of forces (N, k) at sources (N, 2)."""
        if self.form is not None:
            responses = self.solve(self.form.loads(sources, self.infinite) @ forces)
        else:
            rim = self.space.rim.points
            traces = sum(
                self._traces([self.infinite.point_derivatives(rim, source)]) * at_source
                for source, at_source in zip(sources, forces, strict=True)
            )
            responses = self._smooth_parts(np.asarray(traces))
        if (at_rim := ~self.infinite.acts(sources)).any():
            responses += self.solve(np.asarray(self.space.point_values(sources[at_rim]).T @ forces[at_rim]))
        if not self.rigid.size:
            return responses
        return responses - self.space.linear() @ (self.rigid @ (self._known_means(sources) @ forces))

    def _known_means(self, sources: FloatArray) -> FloatArray:
        """The integrals of F around sources (N, 2) with the rigid motions, (r, N).

        A motion R(x) is R(source) and a part that grows in proportion to the distance. Integrated along rays from the
        source, F times either gives m(x), and the divergence of (x - source) m(x) is what it was: the integrals over
        the plate are those of ((x - source).n) m over the rim. A plate under tension has no rigid motions.
        """
        rim = self.space.rim
        motions = self.motions(rim.points.reshape(-1, 2)).reshape(*rim.weights.shape, -1)
        integrals = []
        for source, at_source in zip(sources, self.motions(sources), strict=True):
            rays = self.infinite.radial(rim.points, source)
            flux = ((rim.points - source) * rim.normal).sum(axis=-1) * rim.weights
            parts = rays.mean(0)[..., None] * at_source + rays.mean(1)[..., None] * (motions - at_source)
            integrals.append(np.einsum("kn,knr->r", flux, parts))
        return np.stack(integrals, axis=1)

    def under_pressure(self) -> FloatArray:
        """The smooth part (unknowns, 1) of the response to a unit pressure."""
        if self.form is not None:
            return self.solve(self.space.mass() @ self.space.linear()[:, :1])
        return self._smooth_parts(
            self._traces([self.infinite.pressure_derivatives(self.space.rim.points - self.space.middle)])
        )

    def motions(self, xy: FloatArray) -> FloatArray:
        """The rigid motions at points (n, 2): (n, r)."""
        return np.asarray(np.column_stack([np.ones(len(xy)), xy]) @ self.rigid)


def _with_forces(infinite: InfinitePlate, mesh: PlateMesh, rim_points: FloatArray | None) -> InfinitePlate:
    """The infinite plate, without the forces at points (k, 2) [m] of the rim."""
    return infinite if rim_points is None or not len(rim_points) else InteriorForces(infinite, rim_points / mesh.size)
