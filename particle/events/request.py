"""What a path is computed from, besides the surface."""

from __future__ import annotations

from typing import NamedTuple

from particle.events.mechanics import Part
from particle.types import FloatArray


class Request(NamedTuple):
    """One path to compute."""

    part: Part
    start: FloatArray  # (4,) m, m, m/s, m/s
    duration: float  # s
    tolerance: float  # m, error of one step
    stroke_time: float  # s, the shortest stroke
    force: float  # N, that of gravity and of crossing the surface in a stroke
    flies: bool  # whether a part that comes off is followed to where it lands
    jumps: bool  # whether the surface's velocity jumps at breakpoints
    bends: bool  # whether its acceleration does
    centre_height: float  # m, of the part's centre of mass over its contact
    bridged: tuple[float, float]  # m/s, m/s^2, how far the surface may be off over bridged breakpoints
