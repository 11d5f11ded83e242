"""The problem that every method solves: a clamped disc of radius 1 and rigidity 1 under nine off-centre actuators."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_plate import DiscShapes

FloatArray = NDArray[np.float64]
Fields = tuple[FloatArray, FloatArray, FloatArray]

COUNT, OUTERMOST, APART = 9, 0.75, 0.2
AWAY = 0.02  # samples are at least that far from every actuator
OUT_TO = 0.999  # of the radius, where every mesh still has a cell close by
W_SHARE = 1 / 3  # of the bound on the Hessian's error, the bound on those of w and gradient


def actuators(rng: np.random.Generator) -> FloatArray:
    """(9, 2), the first of them farthest out."""
    points = [OUTERMOST * np.array([np.cos(1.0), np.sin(1.0)])]
    while len(points) < COUNT:
        at = rng.uniform(-OUTERMOST, OUTERMOST, 2)
        if 0.1 < np.hypot(*at) < OUTERMOST and min(np.hypot(*(at - p)) for p in points) > APART:
            points.append(at)
    return np.array(points)


def samples(rng: np.random.Generator) -> FloatArray:
    """Points (n, 2) all over the disc up to its rim, off the actuators."""
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    inside = rng.uniform(-1, 1, (8000, 2))
    inside = inside[np.hypot(*inside.T) < OUT_TO]
    points = np.concatenate([inside, OUT_TO * np.column_stack([np.cos(angle), np.sin(angle)])])
    distance = np.linalg.norm(points[:, None] - ACTUATORS, axis=2).min(axis=1)
    return np.asarray(points[distance > AWAY])


_RNG = np.random.default_rng(3)
ACTUATORS = actuators(_RNG)
STROKES = _RNG.uniform(-1, 1, COUNT)
SAMPLES = samples(_RNG)
EXACT: Fields = DiscShapes(ACTUATORS, 1.0).evaluate(SAMPLES, STROKES)


@dataclass(frozen=True)
class Solution:
    """The plate as one method finds it. evaluate: gives w, gradient and Hessian of the plate at points (n, 2)."""

    unknowns: int
    evaluate: Callable[[FloatArray], Fields]

    def errors(self) -> list[float]:
        """The largest errors of w, gradient and Hessian, each relative to its largest value."""
        found = self.evaluate(SAMPLES)
        return [float(np.abs(a - b).max() / np.abs(b).max()) for a, b in zip(found, EXACT, strict=True)]


@dataclass(frozen=True)
class Run:
    """One method on one mesh.

    mesh: makes it; not timed.  solve: from the mesh to the solved shapes; timed.
    bound: what the error of the Hessian must not exceed.
    """

    method: str
    mesh: Callable[[], Any]
    solve: Callable[[Any], Solution]
    bound: float


def forces(compliance: FloatArray) -> FloatArray:
    """The actuators' forces (N,) for the strokes."""
    return np.asarray(np.linalg.solve((compliance + compliance.T) / 2, STROKES))
