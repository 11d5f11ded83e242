"""The reduced model of a plate that stretches and has mass, in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from coupling.drives import fastest_acceleration
from coupling.ringing.forces import Ringing
from coupling.ringing.motion import ringing_corrections
from coupling.stretch import Corrections, Response, StretchModel
from coupling.vibration import PIECES, ChosenModes, Damping, ModalMotion, motion_of
from fem_plate import LargeDeflection, StretchedShapes
from fem_plate.large_deflection import Columns, ReducedPlate, Reduction, reduced_equilibrium
from particle import AnyDrive

FloatArray = NDArray[np.float64]

IN_PLANE = 100.0  # times the pieces' error: in-plane motions, which carry a part less than slopes do


class RingingModel(StretchModel):
    """A plate that stretches and has mass.

    Its lowest modes ring as the membrane couples them; those above ring as on a plate that does not stretch.

    reduction: the ringing modes are its first corrections.  above: the modes above these.
    heights: (S, N) m or N, that it is good for.  mesh_error: of a full solution, over its largest w.
    chosen: all modes.  damping: their ratios.  steady: whether runs begin in the steady state.
    amplitudes: (n,) m, the largest of each mode as on a plate that does not stretch.
    """

    def __init__(
        self,
        large: LargeDeflection,
        reduction: Reduction,
        above: Columns,
        heights: FloatArray,
        mesh_error: float,
        chosen: ChosenModes,
        damping: Damping,
        steady: bool,
        amplitudes: FloatArray,
    ) -> None:
        super().__init__(large, reduction, heights, mesh_error)
        self.chosen, self.damping, self.steady = chosen, damping, steady
        self._above, self._amplitudes = above, amplitudes
        self.count = len(chosen.modes.omega) - above.v.shape[1]

    @cached_property
    def ringing(self) -> Ringing:
        """What kernels follow."""
        plate, count, modes = self.plate, self.count, self.chosen.modes
        follows = ReducedPlate(plate.stiffness[count:, count:], plate.membrane, in_plane=plate.in_plane)
        omega = modes.omega[:count]
        ratio = self.damping(modes.frequencies[:count])
        return Ringing(
            follows.forms,
            omega**2,
            2 * ratio * omega,
            np.diag(plate.stiffness)[:count] / omega**2,
            np.ascontiguousarray(modes.participation[:count]),
        )

    @cached_property
    def largest(self) -> tuple[FloatArray, FloatArray]:
        """The largest modes, corrections and modes above (n,), and in-plane motions (M,), about [m]."""
        corrections, motions = StretchModel.largest.func(self)  # type: ignore[attr-defined]
        ringing = np.maximum(corrections[: self.count], self._amplitudes[: self.count])
        return np.concatenate([ringing, corrections[self.count :], self._amplitudes[self.count :]]), motions

    @cached_property
    def shapes(self) -> StretchedShapes:
        """Shapes of actuators, modes, corrections, modes above, and in-plane motions."""
        corrections = Columns.joined([self.reduction.corrections, self._above])
        return self._shapes_of(replace(self.reduction, corrections=corrections))

    def corrections(self, drives: Sequence[AnyDrive], end: float, response: Response | None = None) -> Corrections:
        """How modes, corrections and in-plane motions go on under drives, from 0 to `end` [s]."""
        linear = motion_of(self.chosen.modes, self.damping, drives, end, self.steady)
        lifted = [unit * fastest_acceleration(drive) for unit, drive in zip(self._lifts, drives, strict=True)]
        allowed = PIECES * max(*lifted, linear.largest_acceleration())
        at_rest = reduced_equilibrium(self.plate, np.array([float(drive.evaluate(0.0)[0]) for drive in drives]))
        start = at_rest.corrections[0][: self.count], np.zeros(self.count)
        found = ringing_corrections(self.ringing, drives, end, start, self.limits(allowed), self.steady)
        own = [*found.drives, *self._linear(linear).modal_drives(allowed)]
        return replace(found, drives=own, error=PIECES * found.error, acceleration_error=PIECES * found.error)

    def limits(self, allowed: float) -> FloatArray:
        """What the accelerations of coordinates (n + M,) may be off by, where that of w may [m/s^2]."""
        heights, in_plane = self._weights
        return np.concatenate([allowed / heights[: len(self.plate.stiffness)], IN_PLANE * allowed / in_plane])

    def _linear(self, motion: ModalMotion) -> ModalMotion:
        """That of the modes above."""
        return motion.chosen(np.arange(len(self.chosen.modes.omega)) >= self.count)

    @property
    def _lifts(self) -> FloatArray:
        """How high a unit of each drive lifts the plate at most, (N,)."""
        functions = self.shapes.functions
        values = functions.values(functions.space.points)[:, : len(self.large.points)]
        return np.abs(values).max(axis=0)

    @property
    def response(self) -> None:
        """None: what the plate does does not follow from heights alone."""
        return None
