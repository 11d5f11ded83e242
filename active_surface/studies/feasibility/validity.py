"""Validity: up to which strokes the plate's model is valid."""

from __future__ import annotations

import math

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.ground import Ground
from active_surface.studies.feasibility.squares import squares_within
from coupling.case import PlateCase

DEFLECTION, SLOPE = 0.2, 0.2  # of the thickness, in linear theory; everywhere
ACROSS, MOMENTS = 40, 61  # places along the plate's longer side, and moments of the window
STROKES, FREQUENCIES = 5, 7  # at which a plate that stretches, and one with mass, is looked at


def valid_strokes(ground: Ground, frequencies: FloatArray, strokes: tuple[float, float], window: float) -> FloatArray:
    """The strokes' factors (n,) up to which slopes and, in linear theory, deflections are small, at ascending factors.

    window: s, of the drives' own times.
    """
    some = np.geomspace(frequencies[0], frequencies[-1], FREQUENCIES) if not ground.follows else np.ones(1)
    limits = [_limit(ground, float(k), strokes, window) for k in some]
    return np.exp(np.interp(np.log(frequencies), np.log(some), np.log(limits)))


def _limit(ground: Ground, frequency: float, strokes: tuple[float, float], window: float) -> float:
    tried = np.ones(1) if ground.linear else np.geomspace(strokes[1] / 2**STROKES, strokes[1], STROKES + 1)
    uses = np.array([_share(ground, frequency, float(stroke), window) for stroke in tried])
    if ground.linear:
        return float(1 / max(uses[0], 1e-9))
    uses = np.maximum.accumulate(np.maximum(uses, 1e-9))
    return float(math.exp(np.interp(0.0, np.log(uses), np.log(tried), right=np.log(tried[-1]))))


def _share(ground: Ground, frequency: float, stroke: float, window: float) -> float:
    """The largest slope, and in linear theory the largest deflection, over what is valid."""
    plate = ground.case.plate
    assert isinstance(plate, PlateCase)
    end = window if ground.follows else window / frequency
    surface = ground.driven(1.0 if ground.follows else frequency, stroke, end)
    points = np.concatenate([squares_within(ground.outline, ACROSS).centres, ground.actuators])
    share = 0.0
    for time in np.linspace(0.0, end, MOMENTS).tolist():
        state = surface.evaluate(points, time)
        share = max(share, float(np.hypot(*state.gradient.T).max()) / SLOPE)
        if ground.linear:
            share = max(share, float(np.abs(state.w).max()) / (DEFLECTION * plate.thickness))
    return share
