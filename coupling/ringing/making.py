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
from fem_plate import Excitation, HeldShapes
from fem_plate.large_deflection import mode_columns, with_modes
from particle import AnyDrive

FloatArray = NDArray[np.float64]

MIN_COUPLING = 1e-6  # of the largest membrane force: what two shapes stretch less is left out
MAX_UNCOUPLED = 0.01  # of the largest acceleration: what the modes that the membrane does not couple may add together
MIN_RINGING, MAX_RINGING = 4, 8  # modes that it couples
MIN_SWING, MAX_SWING = 0.01, 3.0  # of a mode, over the plate's largest deflection; or over its thickness
MOMENTS, MAX_POINTS = 2001, 400


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
        keep_model(key, together, model.mesh_error)
    figures = model.heights, model.mesh_error
    return RingingModel(large, together, above, *figures, chosen, damping, steady, amplitudes, float(shares[count]))


def _shares(shapes: HeldShapes, chosen: ChosenModes, lifted: FloatArray, rung: FloatArray) -> FloatArray:
    """The largest acceleration of the modes from each one on, and of none (n + 1,), over that of the surface.

    lifted, rung: accelerations (k, N) and (k, n) of drives and modes, m/s^2, or N/s^2 of forces.
    """
    points = shapes.model.space.points
    points = points[:: max(len(points) // MAX_POINTS, 1)]
    values, fixed = chosen.modes.functions.values(points), lifted @ shapes.functions.values(points).T
    largest = np.abs(fixed + rung @ values.T).max() or 1.0
    count = rung.shape[1]
    return np.array([np.abs(rung[:, k:] @ values[:, k:].T).max(initial=0.0) / largest for k in range(count + 1)])


def _heights(model: StretchModel) -> float:
    """The plate's largest deflection at rest [m], about: that of the linear shapes."""
    functions = model.shapes.functions
    values = functions.values(functions.space.points)[:, : model.heights.shape[1]]
    return float(np.abs(model.heights @ values.T).max())
