"""The scene of a plate on actuators: its influence shapes, and the surface that they make with the drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, PlateCase
from coupling.drives import build_drives
from coupling.measured import MotionFit
from coupling.progress import Progress, ProgressCallback
from coupling.ringing import RingingModel, make_ringing_model
from coupling.stretch import Stretch, StretchModel, make_model
from coupling.surface import Pressed, surface_motion
from coupling.vibration import Damping, Vibration, VibrationModel, always_running, make_vibration_model
from fem_plate import TRUNCATION, AnisotropicSection, InfluenceShapes, Plate, PlateSection, PlateShapes, Shapes
from particle import AnyDrive, SurfaceMotion, interruptible

FloatArray = NDArray[np.float64]
Place = tuple[float, float]

# Without a cell size, refine the plate until the estimated error of the unit shapes is below this. It keeps the end
# point of a typical path accurate to 1e-6 of the path.
PLATE_TOLERANCE = 1e-8
# The same of a plate that stretches: half of what its reduced model adds.
STRETCHED_TOLERANCE = 5e-6
# More actuators than this are solved on patches: 625 on the whole plate took longer than 10 000 on patches.
MAX_WHOLE = 250


@dataclass(frozen=True, eq=False)
class PlateScene:
    """A plate on actuators.

    stretch: what bends and stretches it, None in linear theory.  vibration: None without inertia.
    pressed: None with any of these, or without a pressure.
    """

    plate: Plate
    shapes: PlateShapes
    lifts: Sequence[AnyDrive]  # N, one for each actuator
    surface: SurfaceMotion
    stretch: Stretch | None = None
    vibration: Vibration | None = None
    pressed: Pressed | None = None
    base: Sequence[AnyDrive] = field(default=(), init=False)  # it stays in its plane
    origin: str = field(default="the plate", init=False)  # what positions are counted from
    fits: tuple[MotionFit, ...] = field(default=(), init=False)

    @property
    def has_inertia(self) -> bool:
        """Whether the plate rings."""
        return self.vibration is not None or (self.stretch is not None and isinstance(self.stretch.model, RingingModel))

    @property
    def moving_shapes(self) -> Shapes:
        """The shapes of the moving surface."""
        motion = self.stretch or self.vibration or self.pressed
        return self.shapes if motion is None else motion.shapes

    @property
    def moving_drives(self) -> Sequence[AnyDrive]:
        """The drive of each of them."""
        motion = self.stretch or self.vibration or self.pressed
        return self.lifts if motion is None else motion.moving_drives


def plate_scene(case: Case, plate_case: PlateCase, progress: Progress, known: PlateShapes | None = None) -> PlateScene:
    """The scene of a case with a plate; known: its shapes, if they are; ValueError for those of another."""
    tolerance, top = case.run.surface_tolerance, plate_case.thickness / 2 if plate_case.top_face else 0.0
    drives = lifts_of(case)
    with progress("Solving the plate") as tell:
        plate = build_plate(plate_case)
        points = [actuator.position for actuator in case.actuators]
        truncation = TRUNCATION if len(points) > MAX_WHOLE else None
        stiffness = actuator_stiffness(case)
        if known is not None and (wrong := shapes_faults(known, plate, points, stiffness)):
            raise ValueError(f"Input shapes of run_case must be of the case's plate; theirs has {' and '.join(wrong)}")
        shapes = plate.influence(points, stiffness, truncation, tell) if known is None else known
    if plate_case.inertia and plate_case.theory == "linear":
        with progress("Finding the modes") as tell:
            modes = vibration_model(case, plate_case, plate, shapes, [drives], tell)
            vibration = Vibration.under(modes, drives)
        with progress("Fitting the surface"):
            return PlateScene(plate, shapes, drives, vibration.surface(tolerance, top), vibration=vibration)
    if plate_case.theory == "linear" and plate_case.pressure:
        with progress("Fitting the surface"):
            assert isinstance(shapes, InfluenceShapes)
            pressed = Pressed.under(shapes, drives, plate_case.pressure)
            return PlateScene(plate, shapes, drives, pressed.surface(tolerance, top), pressed=pressed)
    if plate_case.theory == "linear":
        with progress("Fitting the surface"):
            return PlateScene(plate, shapes, drives, surface_motion(shapes, drives, tolerance, top))
    with progress("Solving the stretching plate") as tell:
        model = stretch_model(case, plate_case, plate, [drives], tell)
    with progress("Finding the plate's motion"):
        stretch = interruptible(Stretch.under, model, drives, case.run.duration)
    with progress("Fitting the surface"):
        return PlateScene(plate, shapes, drives, stretch.surface(tolerance, top), stretch)


def shapes_faults(shapes: PlateShapes, plate: Plate, points: Sequence[Place], stiffness: FloatArray) -> list[str]:
    """What shapes are of in place of a plate with actuators of a stiffness (N,) [N/m] at points; nothing: of that."""
    other = shapes.plate
    wrong = [] if np.array_equal(shapes.points, np.array(points)) else ["actuators at other places"]
    if not wrong and not np.array_equal(shapes.springs, stiffness):
        wrong.append("actuators of another stiffness")
    if not other.mesh.same_as(plate.mesh):
        wrong.append("another outline or other cells")
    ours, theirs = (one.section for one in (plate, other))
    if isinstance(ours, PlateSection) and isinstance(theirs, PlateSection):
        names = ["youngs_modulus", "poisson_ratio", "thickness"]
    else:
        names = ["thickness"]
        if getattr(ours, "stiffness", None) != getattr(theirs, "stiffness", None) or type(ours) is not type(theirs):
            wrong.append("another material")
    for name in names:
        if getattr(ours, name) != getattr(theirs, name):
            wrong.append(f"{name} {getattr(theirs, name):g}, not {getattr(ours, name):g}")
    for name in ("supports", "tension", "tolerance"):
        if getattr(plate, name) != getattr(other, name):
            wrong.append(f"{name} {getattr(other, name)}, not {getattr(plate, name)}")
    if plate.foundation != other.foundation or other.forms:
        wrong.append("another foundation, or forms")
    return wrong


def stretch_model(
    case: Case, plate_case: PlateCase, plate: Plate, sets: Sequence[Sequence[AnyDrive]], tell: ProgressCallback
) -> StretchModel:
    """The model of a case's plate as it stretches, for several sets of drives."""
    points = [actuator.position for actuator in case.actuators]
    large = plate.large_deflection(points, plate_case.in_plane_supports, actuator_stiffness(case))
    model = interruptible(make_model, large, sets, case.run.duration, tell)
    if not plate_case.inertia:
        return model
    steady = case.run.start == "steady"
    return interruptible(make_ringing_model, model, damping_of(plate_case), sets, case.run.duration, steady)


def vibration_model(
    case: Case,
    plate_case: PlateCase,
    plate: Plate,
    shapes: PlateShapes,
    sets: Sequence[Sequence[AnyDrive]],
    tell: ProgressCallback,
) -> VibrationModel:
    """The modes of a case's plate, for several sets of drives."""
    assert isinstance(shapes, InfluenceShapes)
    steady, damping, pressure = case.run.start == "steady", damping_of(plate_case), plate_case.pressure
    return interruptible(
        make_vibration_model, shapes, plate.section, damping, sets, case.run.duration, steady, tell, pressure
    )


def damping_of(plate: PlateCase) -> Damping:
    """The damping ratios (n,) of modes by their frequencies (n,) [Hz]: those of a table go on beyond its ends."""
    if isinstance(plate.damping, float):
        ratio = plate.damping
        return lambda frequencies: np.full(len(frequencies), ratio)
    known = np.array(plate.damping)
    return lambda frequencies: np.interp(frequencies, *known.T)


def lifts_of(case: Case) -> list[AnyDrive]:
    """The actuators' drives; in a steady state they have always been running."""
    drives = build_drives(case)
    return [always_running(drive) for drive in drives] if case.run.start == "steady" else drives


def build_plate(plate: PlateCase) -> Plate:
    """The plate of a case, without loads."""
    tolerance = PLATE_TOLERANCE if plate.theory == "linear" else STRETCHED_TOLERANCE
    given = plate.cell_size_given
    mesh, section = plate.build_mesh(), section_of(plate)
    return Plate(mesh, section, plate.supports, None if given else tolerance, plate.tension, plate.foundation)


def section_of(plate: PlateCase) -> PlateSection | AnisotropicSection:
    """Material and thickness of a case's plate."""
    if plate.wafer is not None:
        constants = plate.c11, plate.c12, plate.c44
        return AnisotropicSection.cubic(constants, plate.thickness, plate.density, plate.wafer, plate.wafer_angle)
    assert plate.youngs_modulus is not None and plate.poisson_ratio is not None
    return PlateSection(plate.youngs_modulus, plate.poisson_ratio, plate.thickness, plate.density)


def actuator_stiffness(case: Case) -> NDArray[np.float64]:
    """The stiffness (N,) [N/m] with which each actuator holds the plate: inf if rigid, 0 if it is a force."""
    return np.array([0.0 if a.force is not None else a.stiffness or np.inf for a in case.actuators])
