"""The scene of a plate on actuators: its influence shapes, and the surface that they make with the drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, PlateCase
from coupling.drives import build_drives
from coupling.measured import MotionFit
from coupling.progress import Progress
from coupling.surface import surface_motion
from fem_plate import TRUNCATION, Plate, PlateSection, PlateShapes
from particle import AnyDrive, SurfaceMotion

FloatArray = NDArray[np.float64]

# Without a cell size, refine the plate until the estimated error of the unit shapes is below this. It keeps the end
# point of a typical path accurate to 1e-6 of the path.
PLATE_TOLERANCE = 1e-8
# More actuators than this are solved on patches: 625 on the whole plate took longer than 10 000 on patches.
MAX_WHOLE = 250


class Stretch(Protocol):
    """How a plate stretches under its drives. Errors are relative to the largest deflection."""

    @property
    def mesh_error(self) -> float:
        """Estimated, of the full solutions."""

    @property
    def reduction_error(self) -> float:
        """Measured, of the few shapes that stand for these, by full solutions that were held out."""

    @property
    def piece_error(self) -> float:
        """Measured, of the corrections' pieces in time."""

    @property
    def solutions(self) -> int:
        """How many full solutions there are."""

    @property
    def deflection(self) -> float:
        """m, the largest."""

    @property
    def slope(self) -> float:
        """The largest."""

    @property
    def largest_strain(self) -> float:
        """The largest on either face, half a thickness or more from the actuators."""


@dataclass(frozen=True, eq=False)
class PlateScene:
    """A plate on actuators."""

    plate: Plate
    shapes: PlateShapes
    lifts: Sequence[AnyDrive]  # N, one for each actuator
    surface: SurfaceMotion
    base: Sequence[AnyDrive] = field(default=(), init=False)  # it stays in its plane
    origin: str = field(default="the plate", init=False)  # what positions are counted from
    fits: tuple[MotionFit, ...] = field(default=(), init=False)
    stretch: Stretch | None = None  # None: linear theory

    @property
    def moving_shapes(self) -> PlateShapes:
        """The shapes of the moving surface, those of the actuators first."""
        return self.shapes

    @property
    def moving_drives(self) -> Sequence[AnyDrive]:
        """One for each of them."""
        return self.lifts


def plate_scene(case: Case, plate_case: PlateCase, progress: Progress) -> PlateScene:
    """The scene of a case with a plate."""
    with progress("Solving the plate") as tell:
        plate = build_plate(plate_case)
        points = [actuator.position for actuator in case.actuators]
        truncation = TRUNCATION if len(points) > MAX_WHOLE else None
        shapes = plate.influence(points, actuator_stiffness(case), truncation, tell)
    with progress("Fitting the surface"):
        drives = build_drives(case)
        top = plate_case.thickness / 2 if plate_case.top_face else 0.0
        return PlateScene(plate, shapes, drives, surface_motion(shapes, drives, case.run.surface_tolerance, top))


def build_plate(plate: PlateCase) -> Plate:
    """The plate of a case, without loads."""
    section = PlateSection(plate.youngs_modulus, plate.poisson_ratio, plate.thickness, plate.density)
    tolerance = None if plate.cell_size_given else PLATE_TOLERANCE
    return Plate(plate.build_mesh(), section, plate.supports, tolerance)


def actuator_stiffness(case: Case) -> NDArray[np.float64]:
    """The stiffness (N,) [N/m] with which each actuator holds the plate: inf if rigid, 0 if it is a force."""
    return np.array([0.0 if a.force is not None else a.stiffness or np.inf for a in case.actuators])
