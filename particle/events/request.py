"""What a path is computed from, besides the surface."""

from __future__ import annotations

from typing import NamedTuple

from particle.events.mechanics import Part
from particle.group import grouped
from particle.types import FloatArray


@grouped
class Request(NamedTuple):
    """One path to compute, or a piece of it."""

    part: Part
    start: FloatArray  # (8,) the numbers of a `Motion`; those of the slow manifold as the plane's velocity
    mode: int  # Mode at the start
    begin: float  # s, when it starts
    until: float  # s, when it ends
    first_step: float  # s, what its first step is tried with
    duration: float  # s, the end of the whole path
    tolerance: float  # m, error of one step
    stroke_time: float  # s, the shortest stroke
    force: float  # N, that of gravity and of crossing the surface in a stroke
    flies: bool  # whether a part that comes off is followed to where it lands
    jumps: bool  # whether the surface's velocity jumps at breakpoints
    centre_height: float  # m, of the part's centre of mass over its contact
    bridged: tuple[float, float]  # m/s, m/s^2, how far the surface may be off over bridged breakpoints
    only_rests: bool = False  # whether the path ends where the part leaves rest
