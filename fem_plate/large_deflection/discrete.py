"""The stretching plate on one mesh: its cells, which are small around actuators and where it bends in a layer."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from fem_plate.elements import PlateModel, corner_rows
from fem_plate.graded import GradedPlate
from fem_plate.large_deflection.equilibrium import Coefficients, Equilibrium, Loads
from fem_plate.large_deflection.membrane import AIRY, Membrane, airy, airy_corners
from fem_plate.large_deflection.plane_stress import PlaneStress
from fem_plate.large_deflection.trial import Trial
from fem_plate.types import FloatArray
from meshes import PlateMesh

FIRMER = 5.0  # of edges' lengths; their cube divides the error
# Around an actuator the plate also bends as r^4 ln r, which halved cells take up: how often, and how near (in cells).
AROUND, NEAR = 2, 2.0
# From so many thicknesses on: the bands at the rim whose cells are halved, over the half width, and the halvings added
# around actuators.
ROUNDING = 1e-6  # of that many
LEVELS = ((0.0, (), 0), (5.0, (0.16,), 1), (15.0, (0.2, 0.08), 2))


class DiscretePlate:
    """A plate with actuators at points (N, 2) [m] on one mesh.

    stiffness: (N,) N/m of the actuators.  movable: by boundary.  membrane: AIRY or PLANE_STRESS.
    level: of fineness (see `cells`).  halvings: of all cells.
    """

    def __init__(
        self,
        plate: GradedPlate,
        points: FloatArray,
        stiffness: FloatArray,
        movable: Mapping[str, bool],
        membrane: str,
        level: int,
        halvings: int,
    ) -> None:
        self.level, self.halvings = level, halvings
        section, by_airy = plate.section, membrane == AIRY
        every_rim_moves = all(movable.values())
        corners = airy_corners(plate.mesh, every_rim_moves, section.poisson_ratio) if by_airy else []
        mesh = plate.cells(points, halvings, corners)
        self.mesh = refined_for(mesh, points, plate.grading.half_width, level)
        rows = corner_rows(self.mesh, [*plate.corners, *corners])
        self.size, self.thickness, self.rigidity = self.mesh.size, section.thickness, section.rigidity
        self.model = PlateModel(self.mesh, plate.supports, section.law, rows, plate.relative_tension)
        hold_firmly(self.model)
        self.in_plane_supports, self.poisson_ratio = dict(movable), section.poisson_ratio
        self._by_airy, self._corner_rows, self.x = by_airy, rows, points / self.size
        with np.errstate(divide="ignore"):
            self.compliance = self.membrane_unit / stiffness
        # Of the actuators' strokes, m, or of forces, N.
        self.units = np.where(stiffness > 0, self.thickness, self.force_unit)

    @cached_property
    def membrane(self) -> Membrane:
        """How it stretches."""
        if not self._by_airy:
            return self.plane_stress.membrane
        return airy(self.mesh, all(self.in_plane_supports.values()), self.poisson_ratio, self._corner_rows)

    @cached_property
    def trial(self) -> Trial:
        """What its deflection is made of."""
        return Trial(self.model, self.x)

    @cached_property
    def equilibrium(self) -> Equilibrium:
        """What deflects it."""
        return Equilibrium(self.trial, self.membrane, self.compliance)

    @cached_property
    def plane_stress(self) -> PlaneStress:
        """The plate's in-plane motion."""
        return PlaneStress(self.mesh, self.model.space, self.in_plane_supports, self.poisson_ratio)

    def loads(self, strokes: FloatArray, pressure: float) -> Loads:
        """Strokes [m], or forces [N], and a pressure [Pa] without dimensions."""
        return Loads(strokes / self.units, pressure / self.pressure_unit)

    def in_plane_motion(self, state: Coefficients) -> FloatArray:
        """The unknowns of `plane_stress` in a state."""
        plane_stress = self.plane_stress
        if self.membrane is plane_stress.membrane:
            return state.membrane
        slopes = self.equilibrium.slopes_at(plane_stress.membrane.samples, state)
        return plane_stress.membrane.respond(slopes)[0]

    @property
    def force_unit(self) -> float:
        """N, of dimensionless forces."""
        return self.rigidity * self.thickness / self.size**2

    @property
    def pressure_unit(self) -> float:
        """Pa."""
        return self.force_unit / self.size**2

    @property
    def membrane_unit(self) -> float:
        """N/m, of membrane forces."""
        return self.rigidity / self.size**2

    @property
    def motion_unit(self) -> float:
        """m, of in-plane motion."""
        return self.thickness**2 / self.size

    @property
    def energy_unit(self) -> float:
        """J."""
        return self.force_unit * self.thickness


def hold_firmly(model: PlateModel) -> None:
    """Let simply supported edges count as shorter, so that penalties on them are larger.

    The rim's deflection is small, not zero, and the membrane force across the rim times its slope works on it. That
    work is not in the energy: it would be an error of third order.
    """
    rim = model.space.rim
    simply = (rim.c[:, 0] > 0) & (np.trace(rim.T[:, 0], axis1=1, axis2=2) < 1.5)
    model.space.rim = rim._replace(h=np.where(simply, rim.h / FIRMER, rim.h))


def level_of(thicknesses: float) -> int:
    """The level of fineness for a largest deflection over the thickness."""
    return sum(thicknesses > least * (1 + ROUNDING) for least, _, _ in LEVELS[1:])


def refined_for(mesh: PlateMesh, points: FloatArray, half_width: float, level: int) -> PlateMesh:
    """The mesh with halved cells around actuators at points (N, 2) [m] and at the rim."""
    _, bands, more = LEVELS[level]
    for band in bands:
        mesh = mesh.refined(mesh.outline.gap(_centres(mesh)) < band * half_width)
    if len(points):
        tree = cKDTree(points)
        for _ in range(AROUND + more):
            mesh = mesh.refined(tree.query(_centres(mesh))[0] < NEAR * mesh.cell_sizes)
    return mesh


def _centres(mesh: PlateMesh) -> FloatArray:
    return np.asarray(mesh.points[mesh.triangles].mean(axis=1))
