"""The reduced model of a plate that stretches and has mass, in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from coupling.drives import fastest_acceleration, stroke_heights
from coupling.progress import doing
from coupling.ringing.forces import Ringing, ringing_of
from coupling.ringing.motion import ringing_corrections
from coupling.stretch import Corrections, Response, StretchModel, equilibrium_at, keep_model, key_of, read_model
from coupling.vibration import PIECES, ChosenModes, Damping, choose_modes, motion_of
from fem_plate import Excitation, HeldShapes, LargeDeflection, StretchedShapes
from fem_plate.large_deflection import Columns, ReducedPlate, Reduction, mode_columns, with_modes
from particle import AnyDrive

FloatArray = NDArray[np.float64]

IN_PLANE = 100.0  # times the pieces' error: in-plane motions, which carry a part less than slopes do
MIN_COUPLING = 1e-6  # of the largest membrane force: what two shapes stretch less is left out
MAX_UNCOUPLED = 0.01  # of the largest acceleration: what the modes that the membrane does not couple may add together
MIN_RINGING, MAX_RINGING = 4, 8  # modes that it couples
MIN_SWING, MAX_SWING = 0.01, 3.0  # of a mode, over the plate's largest deflection; or over its thickness
MOMENTS, MAX_POINTS = 2001, 400


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
        return ringing_of(
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
        own = [*found.drives]
        if len(above.oscillators.omega):
            own += above.modal_drives(allowed, found.drives[0])
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
        values = functions.values(functions.space.samples)[:, : len(self.large.points)]
        return np.abs(values).max(axis=0)

    @property
    def response(self) -> None:
        """None: what the plate does does not follow from heights alone."""
        return None


def make_ringing_model(
    model: StretchModel, damping: Damping, sets: Sequence[Sequence[AnyDrive]], end: float, steady: bool
) -> RingingModel:
    """The model of a plate with mass, from that of the plate without, for several sets of drives up to an end [s].

    Raises ValueError when a mode without damping resonates.
    """
    doing("stretching plate: finding its modes")
    large, section, reduction = model.large, model.large.plate.section, model.reduction
    assert section.density is not None
    shapes = HeldShapes(reduction, large.points, large.stiffness)
    excitation = Excitation(shapes, section.density * section.thickness, section.rigidity)
    chosen = choose_modes(shapes, excitation, damping, sets, end, steady)
    times = np.linspace(0.0, end, MOMENTS)
    rung = [motion_of(chosen.modes, damping, drives, end, steady).evaluate(times) for drives in sets]
    shares = np.max(
        [
            _shares(shapes, chosen, stroke_heights(drives, times, 2), one[2])
            for drives, one in zip(sets, rung, strict=True)
        ],
        axis=0,
    )
    enough = np.flatnonzero(shares <= MAX_UNCOUPLED)[0]
    count = min(max(int(enough), MIN_RINGING), MAX_RINGING, len(shares) - 1)
    largest, corrections = _heights(model), model.largest[0] / section.thickness
    amplitudes = np.max([np.abs(one[0]).max(axis=0) for one in rung], axis=0)
    # At resonance a plate that does not stretch swings far higher than one that does.
    amplitudes[:count] = np.minimum(amplitudes[:count], MAX_SWING * max(largest, section.thickness))
    swings = np.maximum(amplitudes[:count], MIN_SWING * largest) / section.thickness
    swings = np.array([float(f"{swing:.1e}") for swing in swings])  # cases that are much alike share a model
    strokes = np.abs(model.heights).max(axis=0) / reduction.discrete.units
    modes = mode_columns(reduction.discrete, shapes.springs, chosen.modes)
    lowest = modes.weighted(np.eye(len(shares) - 1)[:, :count])
    above = modes.weighted(np.eye(len(shares) - 1)[:, count:])
    key = key_of(large, model.heights, MIN_COUPLING, lowest.v, lowest.extra, swings)
    if (kept := read_model(key, large)) is not None:
        together = kept[0]
    else:
        together = with_modes(reduction, lowest, (strokes, swings, corrections), MIN_COUPLING)
        keep_model(key, together, model.heights, model.mesh_error)
    figures = model.heights, model.mesh_error
    return RingingModel(large, together, above, *figures, chosen, damping, steady, amplitudes, float(shares[count]))


def _shares(shapes: HeldShapes, chosen: ChosenModes, lifted: FloatArray, rung: FloatArray) -> FloatArray:
    """The largest acceleration of the modes from each one on, and of none (n + 1,), over that of the surface.

    lifted, rung: accelerations (k, N) and (k, n) of drives and modes, m/s^2, or N/s^2 of forces.
    """
    points = shapes.model.space.samples
    points = points[:: max(len(points) // MAX_POINTS, 1)]
    values, fixed = chosen.modes.functions.values(points), lifted @ shapes.functions.values(points).T
    largest = np.abs(fixed + rung @ values.T).max() or 1.0
    count = rung.shape[1]
    return np.array([np.abs(rung[:, k:] @ values[:, k:].T).max(initial=0.0) / largest for k in range(count + 1)])


def _heights(model: StretchModel) -> float:
    """The plate's largest deflection at rest [m], about: that of the linear shapes."""
    functions = model.shapes.functions
    values = functions.values(functions.space.samples)[:, : model.heights.shape[1]]
    return float(np.abs(model.heights @ values.T).max())
