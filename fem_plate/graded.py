"""GradedPlate: a mesh, a section and supports, on cells that are small where a question needs it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fem_plate.elements import (
    COARSE_GAIN,
    DEGREE,
    FREE,
    GAIN,
    MAX_EXPONENT,
    MeshGrading,
    PlateModel,
    SingularCorner,
    by_boundary,
    corner_rows,
    grade_mesh,
    plate_energy,
    rigid_motions,
    rim_quadrature,
    singular_corners,
    wedges,
)
from fem_plate.sections import Field, PlateSection, Section, VaryingSection
from fem_plate.types import FloatArray
from meshes import PlateMesh

if TYPE_CHECKING:
    from skfem import BilinearForm

# Degrees of refinement: the highest, the step to the next, and the highest to begin with. Of a step's gain one part in
# SPARE is counted on.
HIGHEST, STEP, LAST_FIRST, SPARE = 10, 2, 8, 4.0
MILD = 2.0  # corners of at least this exponent leave second derivatives continuous, as the elements have them


class GradedPlate:
    """A plate and its models; parameters as of `Plate`.

    corners: where cells are small.  enriched_corners: those with functions of their own.  left_out: how many corners
    have such functions that this plate leaves out.  energy: None of a uniform plate.
    """

    def __init__(
        self,
        mesh: PlateMesh,
        section: Section,
        supports: str | Mapping[str, str] = "clamped",
        tolerance: float | None = None,
        tension: float = 0.0,
        foundation: float | Field = 0.0,
        forms: Sequence[BilinearForm] = (),
    ) -> None:
        self.supports = by_boundary(supports, mesh.boundaries)
        self.mesh = mesh
        self.section = section
        self.tolerance = tolerance
        check_tension(tension, self.supports)
        self.tension = float(tension)
        self.foundation = foundation
        self.forms = tuple(forms) if isinstance(forms, Sequence) else (forms,)
        self.grading = MeshGrading.of(mesh, self.relative_tension)
        self.corners = singular_corners(mesh, self.supports, section.poisson_ratio)
        self.energy = plate_energy(mesh, section, foundation, self.tension, self.forms)
        obtuse = wedges(mesh, self.supports, self.tension)
        isotropic = isinstance(section, PlateSection) and self.energy is None  # as corner functions are
        self.enriched_corners, self.left_out = (obtuse, 0) if isotropic else ([], len(obtuse))
        self._last: tuple[bytes, PlateModel] | None = None

    def cells(
        self, points: FloatArray | None = None, halvings: int = 0, corners: Sequence[SingularCorner] = ()
    ) -> PlateMesh:
        """Halved cells, graded towards the plate's corners, further ones, and for actuators at points (N, 2) [m]."""
        return self._graded([*self.corners, *corners], points, halvings)

    def _graded(
        self, corners: list[SingularCorner], points: FloatArray | None, halvings: int, degree: int = DEGREE
    ) -> PlateMesh:
        mesh = self.mesh
        for _ in range(halvings):
            mesh = mesh.refined()
        return grade_mesh(mesh, replace(self.grading.halved(halvings), degree=degree), corners, points)

    def refinement(self, points: FloatArray) -> tuple[Callable[[int], PlateModel], float]:
        """Models for actuators at points (N, 2) [m], each finer than the last, and the least gain from one to the next.

        Two degrees more gain as much as cells of half the size, for less; beyond the last of them cells are halved.
        """
        degrees = self._degrees(points)

        def level(k: int) -> PlateModel:
            return self.model(points, max(k - len(degrees) + 1, 0), degrees[min(k, len(degrees) - 1)])

        if len(degrees) == 1:
            return level, self.gain
        gain = self.grading.error(degrees[0]) / self.grading.error(degrees[1])
        return level, gain / SPARE

    def _degrees(self, points: FloatArray) -> Sequence[int]:
        """The degrees that elements go through: five alone of what is not smooth.

        The second of them is about what meets the tolerance; without one, it is for the estimate alone.
        """
        if not self._smooth or self.mesh.on_rim(points).any():
            return [DEGREE]
        if self.tolerance is None:
            return [DEGREE, DEGREE + 1]
        first = DEGREE
        while first < LAST_FIRST and self.grading.error(first) > GAIN * self.tolerance:
            first += 1
        return range(first, HIGHEST + 1, STEP)

    @cached_property
    def _smooth(self) -> bool:
        """Whether the plate's supports hold it, one law holds everywhere, and no corner or tension bends it sharply."""
        singular = self.enriched_corners or any(corner.exponent < MILD for corner in self.corners)
        if self.energy is not None or self.tension or singular:
            return False
        return not rigid_motions(rim_quadrature(self.mesh, self.supports)[0]).size

    def model(self, points: FloatArray | None = None, halvings: int = 0, degree: int = DEGREE) -> PlateModel:
        """The plate on cells for actuators at points (N, 2) [m], with the corner functions of its wedges."""
        corners = self.graded_corners
        rim_points = np.empty((0, 2))
        if points is not None:
            on_rim = self.mesh.on_rim(points)
            points, rim_points = points[~on_rim], points[on_rim]
            corners += [SingularCorner(point, 1.0) for point in rim_points]
        if self.energy is not None and points is not None and self.energy.exponent < MAX_EXPONENT:
            corners += [SingularCorner(point, self.energy.exponent) for point in points]
        mesh = self._graded(corners, points, halvings, degree)
        key = mesh.points.tobytes() + rim_points.tobytes() + bytes([degree])
        last = self._last  # another thread may exchange it meanwhile
        if last is None or last[0] != key:
            last = self._last = key, self.model_on(mesh, self.tension, rim_points, degree)
        return last[1]

    def model_on(
        self, mesh: PlateMesh, tension: float, rim_points: FloatArray | None = None, degree: int = DEGREE
    ) -> PlateModel:
        """The plate on cells as they are, under another tension [N/m]; rim_points, degree: as of `PlateModel`."""
        rows = corner_rows(mesh, self._other_corners) if degree == DEGREE else []
        if self.energy is not None:
            energy = replace(self.energy, tension=tension, size=mesh.size)
            return PlateModel(mesh, self.supports, energy, rows, rim_points=rim_points)
        law, relative = self.section.law, tension / self.section.rigidity
        return PlateModel(mesh, self.supports, law, rows, relative, self.enriched_corners, rim_points, degree)

    @property
    def free_boundaries(self) -> tuple[str, ...]:
        """The boundaries that no support holds."""
        return tuple(name for name, support in self.supports.items() if support == FREE)

    @property
    def gain(self) -> float:
        """What halving the cells divides the error of w by, at least: little where corners make most of the error.

        Rounding of corner functions grows as cells shrink.
        """
        if self.enriched_corners:
            return 1.0
        fine = all(self.grading.at_corner(corner)[1] for corner in self.corners)
        return self.grading.gain if fine else COARSE_GAIN

    @property
    def graded_corners(self) -> list[SingularCorner]:
        """The corners that a model's cells are small at."""
        return [*self._other_corners, *(wedge.corner for wedge in self.enriched_corners)]

    @property
    def singular_corners(self) -> list[SingularCorner]:
        """All corners where the deflection is not smooth, those of small turns too."""
        known = {corner.point.tobytes() for corner in self.corners}
        small = (SingularCorner(w.point, w.exponent) for w in self.enriched_corners if w.point.tobytes() not in known)
        return [*self.corners, *small]

    @property
    def _other_corners(self) -> list[SingularCorner]:
        """The singular corners that are no wedges."""
        known = {wedge.point.tobytes() for wedge in self.enriched_corners}
        return [corner for corner in self.corners if corner.point.tobytes() not in known]

    @property
    def relative_tension(self) -> float:
        """The tension over the plate's rigidity [1/m^2]."""
        return self.tension / self.section.rigidity

    def __repr__(self) -> str:
        width, height = np.ptp(self.mesh.outline.box, axis=0)
        rims = ", ".join(f"{name} {support}" for name, support in self.supports.items())
        tension = f"; tension {self.tension:.4g} N/m" if self.tension else ""
        about = "about " if isinstance(self.section, VaryingSection) else ""
        more = "; on a foundation" if callable(self.foundation) or self.foundation else ""
        more += f"; with {len(self.forms)} forms" if self.forms else ""
        thick = f"{about}{self.section.thickness:.4g} m thick"
        return f"Plate of {width:.4g} m x {height:.4g} m, {thick}; {rims}{tension}{more}"


def check_tension(tension: float, supports: Mapping[str, str]) -> None:
    """ValueError unless a uniform tension [N/m] is in balance at every boundary; a free rim pulls on nothing."""
    if not math.isfinite(tension):
        raise ValueError(f"Input tension of Plate must be finite; got {tension!r}")
    free = [name for name, support in supports.items() if support == FREE]
    if tension and free:
        names = ", ".join(map(repr, free))
        raise ValueError(
            "Input tension of Plate must be 0 where a boundary is free, as a free rim carries none; "
            f"got {tension!r} N/m, and free {names}"
        )
