"""Summary: a run in numbers, including those that tell where it leaves the model; `report` says them in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, KogutEtsionCase
from coupling.places import SAME_PLACE
from fem_plate import InfluenceShapes, Plate
from meshes import Outline
from particle import AnyDrive, EventKind, State, SurfaceMotion, Trajectory
from particle.friction import Contact

FloatArray = NDArray[np.float64]

SAMPLES = 201  # moments of the run at which the plate's extremes are sought

# The path error of small-deflection theory, measured on separate solvers: 8 % of the path at one thickness.
LINEAR_ERROR = 0.08
# The quasi-static model's error of w_tt, measured likewise, over the drive's frequency by the plate's first.
QUASI_STATIC_ERROR = 3.3


@dataclass(frozen=True)
class Summary:
    """A run in numbers."""

    outcome: str
    sentence: str
    end_time: float  # s
    duration: float  # s, asked for
    at_rest_since: float | None  # s; None: it does not rest at the end
    end_position: tuple[float, float]  # m
    distance: float  # m, from start to end
    path_length: float  # m
    time_stuck: float  # s
    time_slipping: float  # s
    slips: int
    evaluations: int
    plate_unknowns: int
    plate_error: float  # of unit shapes, estimated
    hold_residual: float  # largest |phi_i(x_j) - delta_ij|, what springs give added; 0 where only forces act
    surface_error: float  # of unit shapes' fit, measured
    contact_error: float  # relative, of the tabulated friction limit, measured
    path_error: float | None  # m, end point against a run at a hundredth of the tolerance; None: other events
    deflection_over_thickness: float
    linear_path_error: float  # relative, of small-deflection theory
    largest_slope: float
    in_plane_motion: float  # m, of the top face
    first_frequency: float | None  # Hz, of the plate with its actuators held as if rigid; None: no density given
    drive_over_first: float | None  # fastest drive over that frequency
    drives_over_first: tuple[float, ...] | None  # each drive over it
    strokes_over_first: tuple[float, ...] | None  # each inverse time of one stroke over it
    quasi_static_error: float | None  # relative, of the surface's acceleration
    part_curvature: float | None  # part size times largest curvature on its path; None: size not given
    part_sag: float  # m, the plate's deflection under the part's largest force

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def summarise(
    case: Case,
    plate: Plate,
    shapes: InfluenceShapes,
    surface: SurfaceMotion,
    trajectory: Trajectory,
    tighter: Trajectory,
    drives: Sequence[AnyDrive],
    friction: Contact,
) -> Summary:
    """The run's summary; `tighter` is the same run at a hundredth of the tolerance."""
    step = np.diff(trajectory.position, axis=0)
    slope, deflection = _extremes(shapes, drives, case.run.duration)
    over_thickness = deflection / case.plate.thickness
    times = np.linspace(0, trajectory.time[-1], SAMPLES)
    normal = trajectory.at(times).normal_force
    same = [e.kind for e in trajectory.events] == [e.kind for e in tighter.events]
    moved = float(np.hypot(*(trajectory.position[-1] - tighter.position[-1])))
    held = shapes.points[shapes.springs > 0]
    first = None if plate.section.density is None else float(plate.frequencies(1, held if len(held) else None)[0])
    ratio = None if first is None else max(drive.frequency for drive in drives) / first
    return Summary(
        outcome=trajectory.outcome.value,
        sentence=trajectory.outcome.sentence,
        end_time=float(trajectory.time[-1]),
        duration=case.run.duration,
        at_rest_since=_at_rest_since(trajectory),
        end_position=(float(trajectory.position[-1, 0]), float(trajectory.position[-1, 1])),
        distance=trajectory.distance,
        path_length=float(np.hypot(*step.T).sum()),
        time_stuck=trajectory.time_in(State.STICK),
        time_slipping=trajectory.time_in(State.SLIP),
        slips=sum(event.kind is EventKind.SLIPS for event in trajectory.events),
        evaluations=trajectory.evaluations,
        plate_unknowns=shapes.unknowns,
        plate_error=shapes.error_estimate,
        hold_residual=_hold_residual(shapes),
        surface_error=surface.error,
        contact_error=friction.table_error,
        path_error=moved if same else None,
        deflection_over_thickness=over_thickness,
        linear_path_error=LINEAR_ERROR * over_thickness**2,
        largest_slope=slope,
        in_plane_motion=case.plate.thickness / 2 * slope,
        first_frequency=first,
        drive_over_first=ratio,
        drives_over_first=None if first is None else tuple(drive.frequency / first for drive in drives),
        strokes_over_first=None if first is None else tuple(1 / drive.stroke_time / first for drive in drives),
        quasi_static_error=None if ratio is None else QUASI_STATIC_ERROR * ratio,
        part_curvature=_part_curvature(case, shapes.outline, surface, trajectory),
        part_sag=_part_sag(plate, shapes, trajectory, float(np.nanmax(np.abs(normal)))),
    )


def _at_rest_since(trajectory: Trajectory) -> float | None:
    moving = np.flatnonzero(trajectory.state != State.STICK)
    if len(moving) == 0:
        return float(trajectory.time[0])
    return float(trajectory.time[moving[-1] + 1]) if moving[-1] + 1 < len(trajectory.time) else None


def _hold_residual(shapes: InfluenceShapes) -> float:
    held = shapes.springs > 0
    heights = shapes.evaluate(shapes.points)[0] + shapes.stiffness / np.where(held, shapes.springs, 1.0)[:, None]
    return float(np.abs(heights - np.eye(len(held)))[held].max(initial=0.0))


def _extremes(shapes: InfluenceShapes, drives: Sequence[AnyDrive], end: float) -> tuple[float, float]:
    """The largest slope and deflection [m] over the mesh's points and the time asked for, wherever the run ended."""
    value, gradient, _ = shapes.evaluate(shapes.model.mesh.points)
    heights = stroke_heights(drives, np.linspace(0, end, SAMPLES))
    slope = max(float(np.hypot(*np.einsum("i,nid->dn", h, gradient)).max()) for h in heights)
    return slope, float(np.abs(heights @ value.T).max())


def stroke_heights(drives: Sequence[AnyDrive], times: FloatArray) -> FloatArray:
    """The heights h_i(t) [m] of the drives at times (k,) [s]: (k, N)."""
    return np.stack([drive.evaluate(times)[0] for drive in drives], axis=1)


def _part_curvature(case: Case, outline: Outline, surface: SurfaceMotion, trajectory: Trajectory) -> float | None:
    """The part's size times the largest curvature under it at the rows of its path."""
    size = case.part.size
    if size is None and isinstance(case.friction, KogutEtsionCase):
        size = float(np.sqrt(case.friction.contact_area))
    if size is None:
        return None
    on_plate = outline.gap(trajectory.position) >= 0  # all but the last of a part that slid over the rim
    places = zip(trajectory.position[on_plate], trajectory.time[on_plate], strict=True)
    return size * max(float(np.abs(np.linalg.eigvalsh(surface.evaluate(xy, t).hessian)).max()) for xy, t in places)


def _part_sag(plate: Plate, shapes: InfluenceShapes, trajectory: Trajectory, force: float) -> float:
    """How far [m] the plate, its actuators held, gives under the part's largest force [N] where it began."""
    start = trajectory.position[:1]
    if np.hypot(*(shapes.points - start).T).min() < SAME_PLACE * shapes.size:
        return 0.0  # the part stands on an actuator, which does not give
    springs = np.append(shapes.springs, 0.0)
    coarse = Plate(plate.mesh, plate.section, plate.supports)  # three digits are enough
    with_part = coarse.influence(np.concatenate([shapes.points, start]), springs)
    return float(with_part.evaluate(start)[0][0, -1]) * force
