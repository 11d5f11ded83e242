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
from coupling.stretch import Corrections, Response, StretchModel, equilibrium_at
from coupling.vibration import PIECES, ChosenModes, Damping, motion_of
from fem_plate import LargeDeflection, StretchedShapes
from fem_plate.large_deflection import Columns, ReducedPlate, Reduction
from particle import AnyDrive

FloatArray = NDArray[np.float64]

IN_PLANE = 100.0  # times the pieces' error: in-plane motions, which carry a part less than slopes do


class RingingModel(StretchModel):
    """A plate that stretches and has mass.

    Its lowest modes ring as the membrane couples them; those above ring as on a plate that does not stretch.

    reduction: the ringing modes are its first corrections.  above: the modes above these.
    heights: (S, N) m or N, that it is good for.  mesh_error: of a full solution, over its largest w.
    chosen: all modes.  damping: their ratios.  steady: whether runs begin in the steady state.
    amplitudes: (n,) m, about the largest of each mode.
    uncoupled: the share of the acceleration that modes have which the membrane does not couple.
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
        uncoupled: float,
    ) -> None:
        super().__init__(large, reduction, heights, mesh_error)
        self.chosen, self.damping, self.steady, self.uncoupled = chosen, damping, steady, uncoupled
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
        corrections, motions = self._at_heights()
        ringing = np.maximum(corrections[: self.count], self._amplitudes[: self.count])
        together = np.concatenate([np.abs(self.heights).max(axis=0), ringing, corrections[self.count :]])
        most = 0.5 * np.einsum("mij,i,j->m", np.abs(self.plate.in_plane), together, together)
        above = self._amplitudes[self.count :]
        return np.concatenate([ringing, corrections[self.count :], above]), np.maximum(motions, most)

    @cached_property
    def shapes(self) -> StretchedShapes:
        """Shapes of actuators, modes, corrections, modes above, and in-plane motions."""
        corrections = Columns.joined([self.reduction.corrections, self._above])
        return self._shapes_of(replace(self.reduction, corrections=corrections))

    def corrections(self, drives: Sequence[AnyDrive], end: float, response: Response | None = None) -> Corrections:
        """How modes, corrections and in-plane motions go on under drives, from 0 to `end` [s]."""
        linear = motion_of(self.chosen.modes, self.damping, drives, end, self.steady)
        lifted = max(unit * fastest_acceleration(drive) for unit, drive in zip(self._lifts, drives, strict=True))
        # At resonance a plate that does not stretch swings far higher than one that does.
        swings = float(self.chosen.modes.omega[0] ** 2 * self._amplitudes[0])
        allowed = PIECES / 2 * max(lifted, min(linear.largest_acceleration(), swings))
        at_rest, _ = equilibrium_at(self.plate, np.array([float(drive.evaluate(0.0)[0]) for drive in drives]))
        start = at_rest[: self.count], np.zeros(self.count)
        found, largest = ringing_corrections(self.ringing, drives, end, start, self.limits(allowed), self.steady)
        above = linear.chosen(np.arange(len(self.chosen.modes.omega)) >= self.count)
        own = [*found.drives, *(above.modal_drives(allowed) if len(above.oscillators.omega) else [])]
        error = 2 * allowed / max(lifted, largest) if allowed > 0 else 0.0
        return replace(found, drives=own, error=error, acceleration_error=error)

    def limits(self, allowed: float) -> FloatArray:
        """What the accelerations of coordinates (n + M,) may be off by, where that of w may [m/s^2]."""
        heights, in_plane = self._weights
        return np.concatenate([allowed / heights[: len(self.plate.stiffness)], IN_PLANE * allowed / in_plane])

    @cached_property
    def _lifts(self) -> FloatArray:
        """How high a unit of each drive lifts the plate at most, (N,)."""
        functions = self.shapes.functions
        values = functions.values(functions.space.points)[:, : len(self.large.points)]
        return np.abs(values).max(axis=0)

    @property
    def response(self) -> None:
        """None: what the plate does does not follow from heights alone."""
        return None
