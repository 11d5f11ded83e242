"""What tests against `motion_oracle` share: friction by its own formulas, breakpoints of strokes, lengths of paths."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from motion_problem import Path

from particle import ConstantFriction, CoulombAdhesion
from particle.friction import Contact

NAMES = {
    "SLIPS": "slips",
    "STOPS": "stops",
    "REVERSES": "reverses",
    "DETACHES": "detaches",
    "LEAVES_PLATE": "leaves",
    "LANDS": "lands",
}
Strokes = Sequence[tuple[float, float, float]]  # stroke, frequency, delay


def limit_of(law: Contact) -> Callable[[float], float]:
    if isinstance(law, ConstantFriction):
        return lambda load: law.limit
    if isinstance(law, CoulombAdhesion):
        return lambda load: max(0.0, law.coefficient * (load + law.adhesion))
    return lambda load: float(law.friction_limit(load))


def ratio_of(law: Contact) -> float:
    if isinstance(law, CoulombAdhesion) and law.static_coefficient is not None:
        return law.static_coefficient / law.coefficient
    return getattr(law, "static_ratio", 1.0)


def breakpoints(strokes: Strokes, duration: float) -> list[float]:
    return [delay + k / (2 * f) for _, f, delay in strokes for k in range(math.ceil(2 * f * duration) + 1)]


def path_length(path: Path, start: Sequence[float]) -> float:
    """From event to event."""
    corners = [start, *(place for _, _, *place in path.events), path.position]
    return sum(math.dist(a, b) for a, b in pairwise(corners))
