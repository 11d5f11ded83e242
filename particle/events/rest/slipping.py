"""Slipping: what pulls and presses a part at rest."""

from __future__ import annotations

import numpy as np

from particle.events.mechanics import Part, length, pull
from particle.jit import jit
from particle.surface import point_of
from particle.types import FloatArray


@jit
def rest_loads(points: FloatArray, part: Part) -> tuple[FloatArray, FloatArray]:
    """Net loads N [N] and pulls |p|_M [m/s^2] (n,) on a part at rest at points of the surface (n, 49)."""
    loads, demands = np.zeros(len(points)), np.zeros(len(points))
    for n in range(len(points)):
        f = point_of(points[n])
        p = pull(f, 0.0, 0.0, part)
        loads[n], demands[n] = p.normal, length(f, p.x, p.y)
    return loads, demands
