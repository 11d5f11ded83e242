"""The reduced model of a plate that stretches, for all heights that its drives reach."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from coupling.drives import reach, stroke_heights
from coupling.stretch.corrections import Corrections, correction_drives
from fem_plate import LargeDeflection, StretchedShapes
from fem_plate.large_deflection import ReducedPlate, Reduction, reduced_equilibrium
from particle import AnyDrive

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-5  # of the largest w, of the reduction and of time pieces
FEW = 3  # actuators for which a model serves all heights between its drives' extremes; with more, those of the drives
PLACES = 32  # to the power of 2/3 of their number: heights among which full solutions are chosen
MOMENTS = 400  # of the drives, where there are more
CELLS = 10.0  # times the surface's tolerance: how well cells follow corrections
IN_PLANE = 1000.0  # times it: in-plane motions, which carry a part less than slopes do


def training(sets: Sequence[Sequence[AnyDrive]], end: float) -> FloatArray:
    """Heights (S, N) that the drives reach, of several sets of drives; m, or N of forces."""
    count = len(sets[0])
    if count > FEW:
        per_set = max(16, MOMENTS // len(sets))
        heights = [stroke_heights(drives, end * np.linspace(0, 1, per_set)) for drives in sets]
        return np.concatenate(heights)
    low, high = np.array([[reach(drive) for drive in drives] for drives in sets]).transpose(2, 0, 1)
    low, high = low.min(axis=0), high.max(axis=0)
    inside = qmc.Sobol(count, scramble=False).random_base2(math.ceil(math.log2(PLACES * count)))
    corners = np.stack(np.meshgrid(*[(0.0, 1.0)] * count, indexing="ij"), axis=-1).reshape(-1, count)
    return np.asarray(low + np.concatenate([corners, inside]) * (high - low))


class StretchModel:
    """A plate that stretches, in a few shapes.

    heights: (S, N) m or N, that it is good for.  mesh_error: of a full solution, over its largest w.
    """

    def __init__(self, large: LargeDeflection, reduction: Reduction, heights: FloatArray, mesh_error: float) -> None:
        self.large, self.reduction, self.heights, self.mesh_error = large, reduction, heights, mesh_error
        discrete = reduction.discrete
        rigid = large.stiffness > 0
        self._units = np.where(rigid, discrete.thickness, discrete.force_unit)

    @cached_property
    def plate(self) -> ReducedPlate:
        """The reduced plate in SI units: drives in m or N, corrections and in-plane motions in m."""
        discrete, plate = self.reduction.discrete, self.reduction.plate
        unit = np.concatenate([self._units, np.full(len(plate.stiffness), discrete.thickness)])
        scale = 1 / np.outer(unit, unit)
        return ReducedPlate(
            plate.stiffness / discrete.thickness**2,
            plate.membrane * scale,
            in_plane=plate.in_plane * scale * discrete.motion_unit,
        )

    @cached_property
    def _largest(self) -> tuple[FloatArray, FloatArray]:
        """The largest corrections (n,) and in-plane motions (M,) at the heights [m]."""
        states = [reduced_equilibrium(self.plate, row) for row in self.heights]
        return (
            np.max([np.abs(state.corrections[0]) for state in states], axis=0),
            np.max([np.abs(state.in_plane[0]) for state in states], axis=0),
        )

    @cached_property
    def shapes(self) -> StretchedShapes:
        """Shapes of actuators, corrections and in-plane motions, with scales for the cells of the moving surface."""
        corrections, motions = self._largest
        springs = self.large.stiffness
        strokes = np.abs(self.heights).max(axis=0)
        stroke = float(strokes[springs > 0].max(initial=0.0)) or float(strokes.max())
        own = np.where(springs > 0, 1.0, stroke / np.where(strokes > 0, strokes, 1.0))
        scales = np.concatenate([own, CELLS * stroke / corrections])
        return StretchedShapes(self.reduction, self.large.points, springs, scales, IN_PLANE * motions.max() / motions)

    def corrections(self, drives: Sequence[AnyDrive], end: float) -> Corrections:
        """What corrects the linear shapes under drives, from 0 to `end` [s]."""
        shapes, count = self.shapes, len(self._units)
        points = shapes.functions.space.points * shapes.size
        heights = np.abs(shapes.values(points))[:, count:].max(axis=0)
        in_plane = np.abs(shapes.in_plane_values(points)).max(axis=(0, 1))
        corrections, motions = self._largest
        return correction_drives(
            self.plate,
            drives,
            end,
            TOLERANCE,
            weights=heights,
            in_plane_weights=in_plane,
            floor=float((heights * corrections).max()),
            in_plane_floor=float((in_plane * motions).max()),
        )
