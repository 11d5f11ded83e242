"""The reduced model of a plate that stretches, in SI units: read from disk, or made of full solutions and kept."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from coupling.case import MAX_STRETCHING
from coupling.drives import reach, stroke_heights
from coupling.progress import doing
from coupling.stretch.corrections import Corrections, correction_drives
from coupling.stretch.interval import new_moment
from coupling.stretch.newton import FINE, NOT_STABLE, fill_motions, find_equilibrium, new_state
from coupling.stretch.response import Response, find_response
from coupling.stretch.store import keep_model, key_of, read_model
from fem_plate import LargeDeflection, StretchedShapes
from fem_plate.large_deflection import ReducedPlate, Reduction, fine_enough, reduce
from particle import AnyDrive

FloatArray = NDArray[np.float64]
Tell = Callable[[int, int], object]

TOLERANCE = 1e-5  # of the largest w of the reduction, and of the largest correction of time pieces
MANY = 3e-5  # the same of time pieces in sweeps and aims, where each piece costs as much as ten evaluations
RESPONSE = 0.1  # times it: of the response to heights
CELLS = 10.0  # times the surface's tolerance: how well cells follow corrections
IN_PLANE = 1000.0  # times it: in-plane motions, which carry a part less than slopes do
FEW = 3  # actuators whose model serves all heights between their drives' extremes; with more, it serves the drives' own
PLACES = 32  # heights for each of them among which full solutions are chosen
MOMENTS = 400  # of the drives, where there are more actuators
PARTS = 100  # of the progress


class StretchModel:
    """A plate that stretches, in a few shapes.

    heights: (S, N) m or N, that it is good for.  mesh_error: of a full solution, over its largest w.
    """

    steady = False  # whether runs begin in the steady state of drives that have always been running

    def __init__(self, large: LargeDeflection, reduction: Reduction, heights: FloatArray, mesh_error: float) -> None:
        self.large, self.reduction, self.heights, self.mesh_error = large, reduction, heights, mesh_error

    @cached_property
    def plate(self) -> ReducedPlate:
        """The reduced plate: drives in m or N, corrections and in-plane motions in m."""
        discrete, plate = self.reduction.discrete, self.reduction.plate
        unit = np.concatenate([discrete.units, np.full(len(plate.stiffness), discrete.thickness)])
        scale = 1 / np.outer(unit, unit)
        return ReducedPlate(
            plate.stiffness / discrete.thickness**2,
            plate.membrane * scale,
            in_plane=plate.in_plane * scale * discrete.motion_unit,
        )

    @cached_property
    def largest(self) -> tuple[FloatArray, FloatArray]:
        """The largest corrections (n,) and in-plane motions (M,) at the heights [m]."""
        return self._at_heights()

    def _at_heights(self) -> tuple[FloatArray, FloatArray]:
        corrections, motions = zip(*(equilibrium_at(self.plate, row) for row in self.heights), strict=True)
        return np.max(np.abs(corrections), axis=0), np.max(np.abs(motions), axis=0)

    @cached_property
    def shapes(self) -> StretchedShapes:
        """Shapes of actuators, corrections and in-plane motions, with scales for the cells of the moving surface."""
        return self._shapes_of(self.reduction)

    def _shapes_of(self, reduction: Reduction) -> StretchedShapes:
        (corrections, motions), springs = self.largest, self.large.stiffness
        strokes = np.abs(self.heights).max(axis=0)
        stroke = float(strokes[springs > 0].max(initial=0.0)) or self.reduction.discrete.thickness
        own = np.where(springs > 0, 1.0, stroke / np.where(strokes > 0, strokes, 1.0))
        scales = np.concatenate([own, CELLS * stroke / corrections])
        return StretchedShapes(reduction, self.large.points, springs, scales, IN_PLANE * motions.max() / motions)

    @cached_property
    def _weights(self) -> tuple[FloatArray, FloatArray]:
        """How high each correction is for a metre of its coefficient, and how far each in-plane motion goes."""
        shapes = self.shapes
        points = shapes.functions.space.samples * shapes.size
        heights = np.abs(shapes.values(points))[:, len(self.large.points) :].max(axis=0)
        return heights, np.abs(shapes.in_plane_values(points)).max(axis=(0, 2))

    def corrections(self, drives: Sequence[AnyDrive], end: float, response: Response | None = None) -> Corrections:
        """What corrects the linear shapes under drives, from 0 to `end` [s]; response: to make many of them."""
        weights, floors, tolerance = self._weights, self._floors, TOLERANCE if response is None else MANY
        return correction_drives(self.plate, drives, end, tolerance, *weights, *floors, response)

    @cached_property
    def response(self) -> Response | None:
        """Corrections and in-plane motions over all heights, much better than the pieces; None: there is none."""
        limits = [RESPONSE * MANY * floor / weights for floor, weights in zip(self._floors, self._weights, strict=True)]
        return find_response(self.plate, self.heights, np.concatenate(limits))

    @cached_property
    def _floors(self) -> tuple[float, float]:
        """The largest weighted correction and in-plane motion at the heights."""
        (heights, in_plane), (corrections, motions) = self._weights, self.largest
        return float((heights * corrections).max()), float((in_plane * motions).max())


def equilibrium_at(plate: ReducedPlate, drives: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The corrections (n,) and in-plane motions (M,) of a reduced plate under drives (N,) that stand still.

    Raises ValueError where Newton's method does not converge, or the energy is not least.
    """
    forms = plate.forms
    moment, state = new_moment(forms), new_state(forms)
    moment.own[0] = 0.5 * np.einsum("i,rij,j->r", drives, forms.drives, drives)
    moment.mixed[0] = np.einsum("i,rij->rj", drives, forms.mixed)
    corrections, motions = np.zeros(len(forms.load)), np.zeros(len(plate.in_plane))
    outcome = find_equilibrium(forms, moment, state, corrections, 0.0)
    if outcome == NOT_STABLE:
        raise ValueError("The plate is not stable there: its energy is not least")
    if outcome != FINE:
        raise ValueError("The corrections of the plate do not converge; reduce the strokes")
    fill_motions(forms, moment, state, corrections, motions)
    return corrections, motions


def reached(sets: Sequence[Sequence[AnyDrive]], end: float) -> FloatArray:
    """The heights that several sets of N drives reach until `end` [s]; m, or N.

    Of few drives the lowest and highest (2, N), of more those over time (S, N).
    """
    if len(sets[0]) > FEW:
        times = end * np.linspace(0, 1, max(16, MOMENTS // len(sets)))
        return np.concatenate([stroke_heights(drives, times) for drives in sets])
    bounds = np.array([[reach(drive) for drive in drives] for drives in sets])  # (sets, N, 2)
    return np.stack([bounds[:, :, 0].min(axis=0), bounds[:, :, 1].max(axis=0)])


def training(found: FloatArray) -> FloatArray:
    """Heights (S, N) all over what drives reach, as `reached` finds it."""
    count = found.shape[1]
    if count > FEW:
        return found
    from scipy.stats.qmc import Sobol  # here, because it takes a while

    low, high = found
    inside = Sobol(count, scramble=False).random_base2(math.ceil(math.log2(PLACES * count)))
    corners = np.stack(np.meshgrid(*[(0.0, 1.0)] * count, indexing="ij"), axis=-1).reshape(-1, count)
    return np.asarray(low + np.concatenate([corners, inside]) * (high - low))


def make_model(large: LargeDeflection, sets: Sequence[Sequence[AnyDrive]], end: float, tell: Tell) -> StretchModel:
    """The model of a plate for several sets of drives, from 0 to `end` [s].

    tell: gets how much is done, of PARTS.
    Raises ValueError for more than MAX_STRETCHING actuators, or drives that never move.
    """
    if len(large.points) > MAX_STRETCHING:
        raise ValueError(
            f"Input theory of Plate must be linear for more than {MAX_STRETCHING} actuators, as a von Karman plate is "
            f"solved for all of them at once; got {len(large.points)} of them"
        )
    found = reached(sets, end)
    if not found.any():
        raise ValueError("Input drives of a plate that stretches must move it; they never do")
    key = key_of(large, found, TOLERANCE)
    if (kept := read_model(key, large)) is not None:
        return StretchModel(large, *kept)
    heights = training(found)
    largest = heights[np.argmax(np.abs(heights).sum(axis=1))]
    report = _Report(tell)
    report.begun()
    discrete, mesh_error = fine_enough(large, largest)
    reduction = reduce(
        discrete, heights / discrete.units, TOLERANCE, lambda plate, d: equilibrium_at(plate, d)[0], report.solved
    )
    tell(PARTS, PARTS)
    keep_model(key, reduction, heights, mesh_error)
    return StretchModel(large, reduction, heights, mesh_error)


class _Report:
    """Reports on a scale of the error's logarithm."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._first = tell, 0.0

    def begun(self) -> None:
        self._tell(0, PARTS)
        doing("stretching plate: choosing its cells")

    def solved(self, solutions: int, error: float) -> None:
        """Report full solutions and the error that is left, over the largest w."""
        self._first = max(error, self._first)
        span = math.log(self._first / TOLERANCE)
        share = math.log(self._first / max(error, TOLERANCE)) / span if span > 0 else 1.0
        self._tell(round((PARTS - 1) * share), PARTS)
        text = f"{solutions} full solution{'s' * (solutions != 1)}, error {error:.0e}"
        doing(f"stretching plate: {text.replace('e-0', 'e-')}", share)
