"""From a plate that stretches, its mass and its drives to a reduced model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coupling.drives import stroke_heights
from coupling.progress import doing
from coupling.ringing.model import RingingModel
from coupling.stretch import StretchModel, keep_model, key_of, read_model
from coupling.vibration import ChosenModes, Damping, choose_modes, motion_of
from fem_plate import Excitation
from fem_plate.large_deflection import HeldShapes, mode_columns, with_modes
from particle import AnyDrive

FloatArray = NDArray[np.float64]

LEAST = 1e-6  # of the largest membrane force: what two shapes stretch less is left out
ABOVE = 0.01  # of the largest acceleration: what the modes that the membrane does not couple may add together
MAX_RINGING = 8
LEAST_AMPLITUDE = 0.01  # of a mode, over the plate's largest correction
MOMENTS = 2001


def make_ringing_model(
    model: StretchModel, damping: Damping, sets: Sequence[Sequence[AnyDrive]], end: float, steady: bool
) -> RingingModel:
    """The model of a plate with mass, from that of the plate without, for several sets of drives up to an end [s].

    Raises ValueError when a mode without damping resonates.
    """
    doing("stretching plate: finding its modes", 0.0)
    large, section, reduction = model.large, model.large.plate.section, model.reduction
    assert section.density is not None
    shapes = HeldShapes(reduction, large.points, large.stiffness)
    excitation = Excitation(shapes, section.density * section.thickness, section.rigidity)
    chosen = choose_modes(shapes, excitation, damping, sets, end, steady)
    times = np.linspace(0.0, end, MOMENTS)
    rung = [motion_of(chosen.modes, damping, drives, end, steady).evaluate(times) for drives in sets]
    lifted = [stroke_heights(drives, times, 2) for drives in sets]
    needed = (_ringing(shapes, chosen, one, rings[2]) for one, rings in zip(lifted, rung, strict=True))
    count = min(max(needed), MAX_RINGING)
    amplitudes = np.max([np.abs(one[0]).max(axis=0) for one in rung], axis=0)
    corrections = model.largest[0] / section.thickness
    swings = np.clip(amplitudes / section.thickness, LEAST_AMPLITUDE * corrections.max(), None)[:count]
    strokes = np.abs(model.heights).max(axis=0) / reduction.discrete.units
    modes = mode_columns(reduction.discrete, shapes, chosen.modes)
    lowest = modes.weighted(np.eye(len(amplitudes))[:, :count])
    above = modes.weighted(np.eye(len(amplitudes))[:, count:])
    key = key_of(large, model.heights, LEAST, lowest.v, swings)
    if (kept := read_model(key, large)) is not None:
        together = kept[0]
    else:
        together = with_modes(reduction, lowest, (strokes, swings, corrections), LEAST)
        keep_model(key, together, model.mesh_error)
    return RingingModel(large, together, above, model.heights, model.mesh_error, chosen, damping, steady, amplitudes)


def _ringing(shapes: HeldShapes, chosen: ChosenModes, lifted: FloatArray, rung: FloatArray) -> int:
    """How many of the modes matter; lifted, rung: (k, N) and (k, n) m/s^2, of drives and modes."""
    points = shapes.model.space.points
    values, fixed = chosen.modes.functions.values(points), lifted @ shapes.functions.values(points).T
    largest = np.abs(fixed + rung @ values.T).max()
    for count in range(1, len(chosen.modes.omega)):
        if np.abs(rung[:, count:] @ values[:, count:].T).max() <= ABOVE * largest:
            return count
    return len(chosen.modes.omega)
