"""One run, from case to result: this file reads as the pipeline.

case -> mesh -> plate influence shapes -> surface motion -> trajectory -> summary -> result files and picture
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import particle
from coupling.case import ActuatorCase, Case, ConstantCase, CoulombCase, TableCase, amplitude
from coupling.drive_case import ENDLESS
from coupling.progress import Progress, interruptible, silent
from coupling.results import write_results
from coupling.summary import Summary, summarise
from coupling.surface import surface_motion
from fem_plate import InfluenceShapes, Plate, PlateSection
from fem_plate.influence import MOST_DENSE
from particle import AnyDrive, Drive, Segment, SegmentDrive, SurfaceMotion, TableDrive, Trajectory
from particle.friction import Contact

# Without a cell size the plate is refined until the unit shapes' estimated error is below this, which keeps the end
# point of a usual path to 1e-6 of it.
PLATE_TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class Result:
    """What a run found; `files` are those it wrote."""

    case: Case
    shapes: InfluenceShapes = field(repr=False)
    surface: SurfaceMotion = field(repr=False)
    trajectory: Trajectory = field(repr=False)
    summary: Summary
    files: tuple[Path, ...] = ()


def run_case(case: Case, output: str | Path | None = None, progress: Progress = silent) -> Result:
    """Run a case; with `output`, a folder, also write NAME.plate.vtkhdf, NAME.part.vtkhdf and NAME.png there."""
    with progress("Solving the plate"):
        plate = build_plate(case)
        shapes = find_shapes(case, plate)
    with progress("Fitting the surface"):
        drives = build_drives(case)
        surface = surface_motion(shapes, drives)
    with progress("Following the part (the first run compiles: half a minute)"):
        friction = build_friction(case)
        trajectory = interruptible(follow_part, case, surface, friction, case.run.tolerance)
        tighter = interruptible(follow_part, case, surface, friction, max(case.run.tolerance / 100, 1e-13))
    with progress("Checking the model's validity"):
        summary = summarise(case, plate, shapes, surface, trajectory, tighter, drives, friction)
    result = Result(case, shapes, surface, trajectory, summary)
    if output is None:
        return result
    with progress("Writing the results"):
        files = write_results(case, plate.mesh, shapes, drives, trajectory, summary, Path(output))
    return Result(case, shapes, surface, trajectory, summary, files)


def build_surface(case: Case) -> SurfaceMotion:
    """The moving surface of a case."""
    return surface_motion(find_shapes(case, build_plate(case)), build_drives(case))


def build_plate(case: Case) -> Plate:
    """The plate, not yet loaded."""
    plate = case.plate
    section = PlateSection(plate.youngs_modulus, plate.poisson_ratio, plate.thickness, plate.density)
    tolerance = None if plate.cell_size_given else PLATE_TOLERANCE
    return Plate(plate.build_mesh(), section, plate.supports, tolerance)


def find_shapes(case: Case, plate: Plate) -> InfluenceShapes:
    """The influence shapes of the case's actuators; ValueError when they are too many for a run."""
    shapes = plate.influence([actuator.position for actuator in case.actuators], springs(case))
    if not isinstance(shapes, InfluenceShapes):
        raise ValueError(f"Input actuators of a run must be at most {MOST_DENSE}; got {len(case.actuators)}")
    return shapes


def springs(case: Case) -> NDArray[np.float64]:
    """The stiffness (N,) [N/m] with which each actuator holds its place, 0 where a force drives it."""
    return np.array([0.0 if a.force is not None else a.stiffness or np.inf for a in case.actuators])


def build_drives(case: Case) -> list[AnyDrive]:
    """The actuators' drives; those of forces are in N."""
    return [build_drive(actuator) for actuator in case.actuators]


def build_drive(actuator: ActuatorCase) -> AnyDrive:
    """The drive of one actuator: a table, a schedule of segments, or one cycle over and over."""
    repeats = None if actuator.repeats == ENDLESS else actuator.repeats
    if actuator.table is not None:
        times, heights = np.array(actuator.table).T
        return TableDrive(times, heights, repeats, actuator.delay)
    if actuator.segments is not None:
        return SegmentDrive([Segment(**segment.model_dump()) for segment in actuator.segments], repeats, actuator.delay)
    a = actuator
    return Drive(amplitude(a), a.frequency or 0.0, a.cycle, a.cycles, a.delay, a.dwell)


def build_friction(case: Case) -> Contact:
    """The friction law between part and surface."""
    law = case.friction
    if isinstance(law, ConstantCase):
        return particle.ConstantFriction(law.limit)
    if isinstance(law, CoulombCase):
        return particle.CoulombAdhesion(law.coefficient, law.adhesion, law.static_coefficient)
    if isinstance(law, TableCase):
        return particle.FrictionTable(law.loads or (), law.limits or (), law.static_ratio)
    return particle.KogutEtsion(**law.model_dump(exclude={"model", "preset"}))


def follow_part(case: Case, surface: SurfaceMotion, friction: Contact, tolerance: float) -> Trajectory:
    """The part's path over the surface."""
    part = particle.Micropart(case.part.mass, case.part.position, case.part.velocity)
    return particle.simulate(surface, part, friction, case.run.duration, case.run.gravity, tolerance)
