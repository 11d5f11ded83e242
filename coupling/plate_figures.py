"""What the summary says of a plate: how exact it is, and where it leaves the model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from weakref import WeakKeyDictionary

import numpy as np
from scipy.sparse import csr_matrix, diags

from coupling.case import MAX_VIBRATING, SAME_PLACE, Case, InputError
from coupling.drives import moments, travel
from coupling.extremes import extremes, sharp_points
from coupling.part import bent_under, states_adhesion, tipping_of, top_face_share
from coupling.ringing import RingingModel
from coupling.scene import PlateScene
from coupling.stretch import Stretch
from coupling.vibration import PIECES
from fem_plate import PatchedShapes, Plate, PlateShapes, VaryingSection
from particle import Trajectory, side_by_side
from particle.friction import Contact

MAX_SLOPE, MAX_STRAIN = 0.2, 0.005  # of the plate, to which the model holds; silicon breaks near twice the strain
# The path error of small-deflection theory, measured on separate solvers: 8 % of the path at one thickness.
LINEAR_ERROR = 0.08
# The quasi-static model's error of w_tt, measured likewise, over one over a stroke's time by the plate's first
# frequency: 3.3 f/f1 of strokes up and down at f. The jump of jerk at both ends of a stroke makes it ring so.
QUASI_STATIC_ERROR = 1.65
# Farther from the rim, in half widths of the plate or in its cells, these give a sag to three digits.
NEAR_RIM, NEAR_CELLS = 0.1, 0.75
_FIRST: WeakKeyDictionary[PlateShapes, dict[float, float]] = WeakKeyDictionary()  # Hz, by density


@dataclass(frozen=True)
class StretchError:
    """The errors of a plate that stretches, relative to its largest deflection."""

    mesh: float  # estimated, of the full solutions
    reduction: float  # measured, of the few shapes that stand for these
    pieces: float | None  # measured, of these shapes' drives, piece by piece in time; None with inertia

    @property
    def largest(self) -> float:
        """Of these errors."""
        return max(self.mesh, self.reduction, self.pieces or 0.0)


@dataclass(frozen=True)
class VibrationFigures:
    """The modes of a plate with inertia; errors are of the surface's acceleration, over its largest."""

    modes: int
    coupled: int  # the lowest of them, which the membrane couples; 0 in linear theory
    uncoupled: float  # the share of the acceleration that the others have where the plate stretches, by linear theory
    highest: float  # Hz
    mode_error: float  # estimated, of having no more of them
    piece_error: float  # bounded, of their drives, piece by piece in time


@dataclass(frozen=True)
class PlateFigures:
    """What a plate adds to the summary."""

    theory: str  # "linear" or "von-karman"
    plate_unknowns: int
    plate_error: float  # of unit shapes, estimated
    hold_residual: float  # largest |phi_i(x_j) - delta_ij|, what springs give added; 0 where only forces act
    surface_error: float  # of unit shapes' fit, measured
    stretch_error: StretchError | None  # None: linear theory
    stretch_solutions: int | None  # full solutions that the few shapes are taken from; None likewise
    vibration: VibrationFigures | None  # None: without inertia
    deflection_over_thickness: float
    linear_path_error: float | None  # relative, of small-deflection theory; None: von Karman's
    can_stretch: bool  # whether the same case goes with von Karman's theory; false where it has it
    can_vibrate: bool  # likewise with inertia
    largest_slope: float
    largest_strain: float | None  # of either face, in linear theory by bending and tension; None: too many actuators
    top_face_share: float | None  # what top face and centre of mass add to a point's pull over the rest; None: no rest
    tipping: float | None  # largest shift of the pressure centre over half the part's size; None: size not given
    tips: bool  # whether it is more than 1, and the friction law states the adhesion
    first_frequency: float | None  # Hz, of the plate with its actuators held; None: no density given
    drive_over_first: float | None  # fastest drive over that frequency
    drives_over_first: tuple[float, float] | None  # the slowest and the fastest drive over it
    strokes_over_first: tuple[float, float] | None  # likewise one over the time of a stroke
    plate_rings: bool  # whether a drive's velocity or acceleration jumps
    quasi_static_error: float | None  # relative, of the surface's acceleration; None: no density given, or it rings
    part_curvature: float | None  # part size times largest curvature on its path; None: size not given
    part_sag_over_roughness: float | None  # of the plate under the part's size there; None: no rough contact
    local_contact: bool  # whether the contact follows the sag
    bent_friction: float | None  # limit at zero load of contact only where the surfaces meet, over that of a flat face
    bent_pull_off: float | None  # likewise; both None where the sag is small, or so large that few asperities touch
    part_sag: float  # m, the plate's deflection under the part's largest force


def plate_figures(
    case: Case, scene: PlateScene, trajectory: Trajectory, friction: Contact, with_sag: bool = True
) -> PlateFigures:
    """The figures of a plate under its drives and a part's path over it; with_sag: else without `part_sag`."""
    plate, shapes, drives, surface, stretch = scene.plate, scene.shapes, scene.lifts, scene.surface, scene.stretch
    deflection, slope, strain = largest(scene, case.run.duration)
    over_thickness = deflection / plate.section.thickness
    contact = trajectory.contact_at(moments(drives, float(trajectory.time[-1])))
    tipping = tipping_of(case, contact, friction)
    load = float(np.nanmax(np.abs(contact.normal_force)))
    sag = part_sag(plate, shapes, trajectory, load) if with_sag else np.nan
    # The shapes keep their error estimate.
    first, _ = side_by_side(partial(_first_frequency, plate, shapes), lambda: shapes.error_estimate)
    driven = [drive for drive in dict.fromkeys(drives) if travel(drive) > 0] or drives
    rates = None if first is None else _range([drive.frequency / first for drive in driven])
    rings = not scene.has_inertia and bool((surface.drives.jump[: len(drives), :2] > 0).any())
    strokes = None if first is None else _range([1 / drive.stroke_time / first for drive in driven])
    bent = bent_under(case, shapes.outline, surface, trajectory)
    return PlateFigures(
        theory="linear" if stretch is None else "von-karman",
        plate_unknowns=shapes.unknowns,
        plate_error=shapes.error_estimate,
        hold_residual=_hold_residual(shapes),
        surface_error=surface.error,
        stretch_error=None if stretch is None else _stretch_error(stretch),
        stretch_solutions=None if stretch is None else stretch.solutions,
        vibration=_vibration(scene),
        deflection_over_thickness=over_thickness,
        linear_path_error=LINEAR_ERROR * over_thickness**2 if stretch is None else None,
        can_stretch=stretch is None and _goes_with(case, "plate.theory", "von-karman"),
        can_vibrate=not scene.has_inertia and _goes_with(case, "plate.inertia", True),
        largest_slope=slope,
        largest_strain=strain,
        top_face_share=None if case.part.face else top_face_share(contact),
        tipping=tipping,
        tips=tipping is not None and tipping > 1 and states_adhesion(friction),
        first_frequency=first,
        drive_over_first=None if rates is None else rates[1],
        drives_over_first=rates,
        strokes_over_first=strokes,
        plate_rings=rings,
        quasi_static_error=None if scene.has_inertia or rings or strokes is None else QUASI_STATIC_ERROR * strokes[1],
        part_curvature=bent and bent.curvature,
        part_sag_over_roughness=bent and bent.sag,
        local_contact=case.part.local_contact,
        bent_friction=bent and bent.friction,
        bent_pull_off=bent and bent.pull_off,
        part_sag=sag,
    )


def largest(scene: PlateScene, duration: float) -> tuple[float, float, float | None]:
    """The largest deflection [m], slope and strain of a plate over a duration [s]; no strain of very many actuators."""
    if scene.stretch is not None:
        return scene.stretch.extremes
    plate, half = scene.plate, scene.plate.section.thickness / 2
    sharp = sharp_points(plate.singular_corners, scene.shapes.points)
    slope, deflection, curvature = extremes(scene.moving_shapes, scene.moving_drives, duration, sharp, half)
    return deflection, slope, None if curvature is None else half * curvature + _residual_strain(plate)


def _residual_strain(plate: Plate) -> float:
    """The largest strain of the plate's tension N, N (1 - nu) / (E t) where it is isotropic."""
    assert not isinstance(plate.section, VaryingSection)  # no case has one
    return float(np.linalg.solve(plate.section.membrane_stiffness, [plate.tension, plate.tension, 0.0])[:2].max())


def _goes_with(case: Case, field: str, value: object) -> bool:
    """Whether a case may have another value in a field, such as theory or inertia, which large arrays may not."""
    if len(case.actuators) > MAX_VIBRATING:
        return False
    try:
        case.vary({field: value})
    except InputError:
        return False
    return True


def _stretch_error(stretch: Stretch) -> StretchError:
    ringing = isinstance(stretch.model, RingingModel)  # its pieces' error is one of the acceleration
    return StretchError(stretch.mesh_error, stretch.reduction_error, None if ringing else stretch.piece_error)


def _vibration(scene: PlateScene) -> VibrationFigures | None:
    stretch = scene.stretch
    if stretch is not None and isinstance(stretch.model, RingingModel):
        chosen, pieces = stretch.model.chosen, stretch.piece_error
        coupled = stretch.model.count, stretch.model.uncoupled
    elif scene.vibration is not None:
        chosen, pieces, coupled = scene.vibration.model.chosen, PIECES, (0, 0.0)
    else:
        return None
    frequencies = chosen.modes.frequencies
    return VibrationFigures(len(frequencies), *coupled, float(frequencies.max()), chosen.error, pieces)


def _first_frequency(plate: Plate, shapes: PlateShapes) -> float | None:
    """The plate's first frequency [Hz] with its actuators held; of very many, that where they are sparsest."""
    density, held = plate.section.density, shapes.springs > 0
    if density is None:
        return None
    known = _FIRST.setdefault(shapes, {})
    if density not in known:
        # Shapes that meet a tolerance have finer cells than a frequency needs.
        if held.any() if isinstance(shapes, PatchedShapes) else plate.tolerance is None:
            known[density] = shapes.first_frequency(density * plate.section.thickness)
        else:
            known[density] = float(plate.frequencies(1, shapes.points[held], shapes.springs[held])[0])
    return known[density]


def _range(values: list[float]) -> tuple[float, float]:
    return min(values), max(values)


def _hold_residual(shapes: PlateShapes) -> float:
    held = np.flatnonzero(shapes.springs > 0)
    if not len(held):
        return 0.0
    places, give = shapes.points[held], 1 / shapes.springs[held]
    if isinstance(shapes, PatchedShapes):
        heights = shapes.matrix(places) + diags(give) @ shapes.stiffness[held]
        heights -= csr_matrix((np.ones(len(held)), (np.arange(len(held)), held)), shape=heights.shape)
        return float(abs(heights).max())
    heights = shapes.values(places) + give[:, None] * shapes.stiffness[held]
    return float(np.abs(heights - np.eye(len(shapes.points))[held]).max())


def part_sag(plate: Plate, shapes: PlateShapes, trajectory: Trajectory, force: float) -> float:
    """How far [m] the plate, its actuators held, gives under the part's largest force [N] where it began."""
    start = trajectory.position[:1]
    distance = np.hypot(*(shapes.points - start).T)
    below = int(np.argmin(distance))
    if distance[below] < SAME_PLACE * shapes.size:
        # The part stands on an actuator. A force k there raises the plate like a unit stroke on the spring k.
        spring = float(shapes.springs[below])
        return 0.0 if np.isinf(spring) else float(shapes.own_heights()[below]) / (spring or 1.0) * force
    cells = NEAR_CELLS * plate.grading.cell if plate.tolerance is None else 0.0
    near = max(NEAR_RIM * plate.grading.half_width, cells)
    if isinstance(shapes, PatchedShapes) or shapes.outline.gap(start)[0] >= near:
        return shapes.compliance_at(start[0]) * force
    # This close to the rim the shapes' cells are too large for the part.
    springs = np.append(shapes.springs, 0.0)
    meshed = plate if plate.tolerance is None else plate.as_meshed()
    with_part = meshed.influence(np.concatenate([shapes.points, start]), springs)
    return float(with_part.evaluate(start)[0][0, -1]) * force
