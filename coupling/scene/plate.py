"""The scene of a plate on actuators: its shapes, and the surface that they make with the drives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, PlateCase
from coupling.drives import build_drives
from coupling.measured import MotionFit
from coupling.plate_figures import plate_figures
from coupling.progress import Progress
from coupling.rim import onto_plate
from coupling.scene.drawn_mesh import drawn_plate
from coupling.scene.scene import Ground
from coupling.summary import PlateFigures
from coupling.surface import FLOOR, surface_motion
from fem_plate import TRUNCATION, PatchedShapes, Plate, PlateSection, PlateShapes
from particle import AnyDrive, SurfaceMotion, Trajectory

FloatArray = NDArray[np.float64]

# Without a cell size the plate is refined until the unit shapes' estimated error is below this, which keeps the end
# point of a usual path to 1e-6 of it.
PLATE_TOLERANCE = 1e-8
# Actuators whose shapes are found on the whole plate: with 625 a run took longer than with 10 000 on patches.
MOST_WHOLE = 250
DRAWN = 1e-7  # of a stroke: less is not drawn
WRITTEN = 1e-5  # of the curvature at an actuator: less is not written


@dataclass(frozen=True, eq=False)
class PlateScene:
    """A plate on actuators."""

    plate: Plate
    shapes: PlateShapes
    lifts: Sequence[AnyDrive]
    surface: SurfaceMotion
    base: Sequence[AnyDrive] = field(default=(), init=False)
    origin: str = field(default="the plate", init=False)
    fits: tuple[MotionFit, ...] = field(default=(), init=False)

    def ground(self, trajectory: Trajectory) -> Ground:
        points, triangles = drawn_plate(self.plate.mesh, self.shapes.points)
        return Ground(points, triangles, lifting(self.shapes, points), bending(self.shapes, points))

    def onto(self, xy: FloatArray) -> FloatArray:
        return onto_plate(self.shapes.outline, xy)

    def figures(self, case: Case, trajectory: Trajectory) -> PlateFigures:
        return plate_figures(case, self.plate, self.shapes, self.surface, self.lifts, trajectory)


def lifting(shapes: PlateShapes, points: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """The deflections (k, n) [m] at points (n, 2) [m] as a function of the actuators' heights (k, N) [m]."""
    values = shapes.matrix(points, DRAWN) if isinstance(shapes, PatchedShapes) else shapes.values(points)
    return lambda heights: np.asarray((values @ heights.T).T)


def bending(shapes: PlateShapes, points: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Likewise the Laplacians (k, n) [1/m], bounded at actuators as the part's surface is.

    They are found when first asked for.
    """

    @cache
    def bends() -> Any:
        floor = FLOOR * shapes.size
        if isinstance(shapes, PatchedShapes):
            return shapes.laplacians(points, floor, WRITTEN)
        return shapes.laplacians(points, floor)

    return lambda heights: np.asarray((bends() @ heights.T).T)


def plate_scene(case: Case, plate_case: PlateCase, progress: Progress) -> PlateScene:
    """The scene of a case with a plate."""
    with progress("Solving the plate") as tell:
        plate = build_plate(plate_case)
        points = [actuator.position for actuator in case.actuators]
        shapes = plate.influence(points, springs(case), TRUNCATION if len(points) > MOST_WHOLE else None, tell)
    with progress("Fitting the surface"):
        drives = build_drives(case)
        return PlateScene(plate, shapes, drives, surface_motion(shapes, drives, case.run.surface_tolerance))


def build_plate(plate: PlateCase) -> Plate:
    """The plate, not yet loaded."""
    section = PlateSection(plate.youngs_modulus, plate.poisson_ratio, plate.thickness, plate.density)
    tolerance = None if plate.cell_size_given else PLATE_TOLERANCE
    return Plate(plate.build_mesh(), section, plate.supports, tolerance)


def springs(case: Case) -> NDArray[np.float64]:
    """The stiffness (N,) [N/m] with which each actuator holds its place, 0 where a force drives it."""
    return np.array([0.0 if a.force is not None else a.stiffness or np.inf for a in case.actuators])
