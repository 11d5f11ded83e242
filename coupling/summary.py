"""Summary: what a run says of itself, including where it leaves the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coupling.case import Case, KogutEtsionCase
from fem_plate import InfluenceShapes
from particle import Drive, EventKind, State, SurfaceMotion, Trajectory
from particle.friction import Contact

FloatArray = NDArray[np.float64]

SAMPLES = 201  # moments of the run at which the plate's extremes are sought

# The linear, quasi-static model's path error, measured on separate solvers: 8 % of the path at one thickness.
LINEAR_ERROR = 0.08
THICKNESSES_WARNED = 0.2
SLOPE_WARNED = 0.2
CURVATURE_WARNED = 0.1
ERROR_WARNED = 1e-6  # of a unit stroke


@dataclass(frozen=True)
class Summary:
    """A run in numbers."""

    outcome: str
    sentence: str
    end_time: float  # s
    end_position: tuple[float, float]  # m
    distance: float  # m, from start to end
    path_length: float  # m
    time_stuck: float  # s
    time_slipping: float  # s
    slips: int
    evaluations: int
    plate_unknowns: int
    plate_error: float  # of unit shapes, estimated
    hold_residual: float  # largest |phi_i(x_j) - delta_ij|
    surface_error: float  # of unit shapes' fit, measured
    contact_error: float  # relative, of the tabulated friction limit, measured
    path_error: float | None  # m, end point against a run at a hundredth of the tolerance; None: not the same events
    deflection_over_thickness: float
    linear_path_error: float  # relative, of small-deflection theory
    largest_slope: float
    in_plane_motion: float  # m, of the top face
    part_curvature: float | None  # part size times largest curvature on its path; None: size not given
    part_sag: float  # m, the plate's deflection under the part's largest force
    warnings: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    def lines(self) -> list[tuple[str, str]]:
        """(label, text) rows to print."""
        micro = 1e6
        x, y = (c * micro for c in self.end_position)
        path_error = "the events differ: chaotic" if self.path_error is None else f"{self.path_error:.1e} m"
        rows = [
            ("outcome", f"{self.outcome}. {self.sentence}"),
            ("end", f"({x:.4f}, {y:.4f}) um at {self.end_time * 1e3:.4f} ms"),
            (
                "distance",
                f"{self.distance * micro:.4f} um from the start, over a path of {self.path_length * micro:.2f} um",
            ),
            (
                "contact",
                f"stuck {self.time_stuck * 1e3:.3f} ms, slipping {self.time_slipping * 1e3:.3f} ms, {self.slips} slips",
            ),
            (
                "plate",
                f"{self.plate_unknowns} unknowns; unit shapes to {self.plate_error:.1e} (estimated), "
                f"held to {self.hold_residual:.1e}",
            ),
            (
                "surface",
                f"fitted to {self.surface_error:.1e} of a unit stroke; friction tabulated to {self.contact_error:.1e}",
            ),
            ("integrator", f"end point against a run 100 times tighter: {path_error}; {self.evaluations} evaluations"),
            (
                "model",
                f"deflection {self.deflection_over_thickness:.3g} thicknesses (path error of linear theory about "
                f"{_percent(self.linear_path_error)}), slope {self.largest_slope:.3g}, "
                f"in-plane motion left out {self.in_plane_motion * micro:.3g} um",
            ),
        ]
        if self.part_curvature is not None:
            rows.append(("", f"part size times curvature {self.part_curvature:.2g}"))
        rows.append(("", f"the plate gives {self.part_sag:.1e} m under the part's own force"))
        return rows


def _percent(share: float) -> str:
    return "more than 50 %" if share > 0.5 else f"{100 * share:.2g} %"


def summarise(
    case: Case,
    shapes: InfluenceShapes,
    surface: SurfaceMotion,
    trajectory: Trajectory,
    tighter: Trajectory,
    drives: Sequence[Drive],
    friction: Contact,
) -> Summary:
    """The run's summary; `tighter` is the same run at a hundredth of the tolerance."""
    step = np.diff(trajectory.position, axis=0)
    slope, deflection = _extremes(shapes, drives, float(trajectory.time[-1]))
    over_thickness = deflection / case.plate.thickness
    curvature = _part_curvature(case, surface, trajectory)
    same = [e.kind for e in trajectory.events] == [e.kind for e in tighter.events]
    moved = float(np.hypot(*(trajectory.position[-1] - tighter.position[-1])))
    linear = LINEAR_ERROR * over_thickness**2
    return Summary(
        outcome=trajectory.outcome.value,
        sentence=trajectory.outcome.sentence,
        end_time=float(trajectory.time[-1]),
        end_position=(float(trajectory.position[-1, 0]), float(trajectory.position[-1, 1])),
        distance=trajectory.distance,
        path_length=float(np.hypot(*step.T).sum()),
        time_stuck=trajectory.time_in(State.STICK),
        time_slipping=trajectory.time_in(State.SLIP),
        slips=sum(event.kind is EventKind.SLIPS for event in trajectory.events),
        evaluations=trajectory.evaluations,
        plate_unknowns=shapes.unknowns,
        plate_error=shapes.error_estimate,
        hold_residual=float(np.abs(shapes.evaluate(shapes.points)[0] - np.eye(len(shapes.points))).max()),
        surface_error=surface.error,
        contact_error=friction.table_error,
        path_error=moved if same else None,
        deflection_over_thickness=over_thickness,
        linear_path_error=linear,
        largest_slope=slope,
        in_plane_motion=case.plate.thickness / 2 * slope,
        part_curvature=curvature,
        part_sag=_part_sag(shapes, trajectory),
        warnings=tuple(_warnings(shapes.error_estimate, surface.error, over_thickness, linear, slope, curvature)),
    )


def _warnings(
    plate_error: float,
    surface_error: float,
    over_thickness: float,
    linear: float,
    slope: float,
    curvature: float | None,
) -> list[str]:
    said = []
    if max(plate_error, surface_error) > ERROR_WARNED:
        said.append(
            f"The plate's shapes are only good to {max(plate_error, surface_error):.1e} of a stroke; a smaller "
            "plate.cell_size, or actuators further from the rim, make them better."
        )
    if over_thickness > THICKNESSES_WARNED:
        said.append(
            f"The plate deflects by {over_thickness:.3g} thicknesses; small-deflection theory holds to about "
            f"{THICKNESSES_WARNED}. Expect the path to be off by {_percent(linear)}."
        )
    if slope > SLOPE_WARNED:
        said.append(f"The surface is as steep as {slope:.2g}; small-slope theory holds to about {SLOPE_WARNED}.")
    if curvature is not None and curvature > CURVATURE_WARNED:
        said.append(
            f"Part size times curvature reaches {curvature:.2g}; a part stands for a point up to about "
            f"{CURVATURE_WARNED}."
        )
    return said


def _extremes(shapes: InfluenceShapes, drives: Sequence[Drive], end: float) -> tuple[float, float]:
    """The largest slope and deflection [m] of the surface during the run, over the mesh's points."""
    value, gradient, _ = shapes.evaluate(shapes.plate.mesh.points)
    heights = stroke_heights(drives, np.linspace(0, end, SAMPLES))
    slope = max(float(np.hypot(*np.einsum("i,nid->dn", h, gradient)).max()) for h in heights)
    return slope, float(np.abs(heights @ value.T).max())


def stroke_heights(drives: Sequence[Drive], times: FloatArray) -> FloatArray:
    """The strokes h_i(t) [m] at times (k,) [s]: (k, N)."""
    return np.stack([drive.evaluate(times)[0] for drive in drives], axis=1)


def _part_curvature(case: Case, surface: SurfaceMotion, trajectory: Trajectory) -> float | None:
    """The part's size times the largest curvature under it at the rows of its path."""
    size = case.part.size
    if size is None and isinstance(case.friction, KogutEtsionCase):
        size = float(np.sqrt(case.friction.contact_area))
    if size is None:
        return None
    on_plate = rim_rows(surface, trajectory)
    places = zip(trajectory.position[on_plate], trajectory.time[on_plate], strict=True)
    return size * max(float(np.abs(np.linalg.eigvalsh(surface.evaluate(xy, t).hessian)).max()) for xy, t in places)


def rim_rows(surface: SurfaceMotion, trajectory: Trajectory) -> NDArray[np.bool_]:
    """Rows (n,) whose position is on the plate: all but the last of a part that slid over the rim."""
    return np.hypot(*trajectory.position.T) <= surface.rim[0]


def _part_sag(shapes: InfluenceShapes, trajectory: Trajectory) -> float:
    """How far [m] the plate, its actuators held, gives under the part's largest force where it began."""
    start = trajectory.position[0]
    try:
        with_part = InfluenceShapes(shapes.plate, np.concatenate([shapes.points, start[None]]))
    except np.linalg.LinAlgError:  # the part stands on an actuator, which does not give
        return 0.0
    give = 1 / float(with_part.stiffness[-1, -1])
    return give * float(np.abs(trajectory.normal_force).max()) if give > 0 else 0.0
