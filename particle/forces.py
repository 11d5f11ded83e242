"""The contact's forces at any moments of a trajectory, for files and summaries."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from particle.breakaway import slope
from particle.drive import next_kink
from particle.fields import fields, new_local, pin_cell, pin_time
from particle.friction import Contact, friction_limit
from particle.jit import jit
from particle.motion import Part, pull
from particle.surface import SurfaceMotion
from particle.trajectory import State, Trajectory

FloatArray = NDArray[np.float64]

STICK = int(State.STICK)  # kernels take plain numbers


def contact_forces(
    surface: SurfaceMotion, trajectory: Trajectory, friction: Contact, mass: float, gravity: float, times: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Net normal force and friction force [N], each (k,), at times (k,) within the run [s].

    A stuck part's friction is what holds it, a sliding part's is the limit Q. nan where the part is past the rim.
    """
    times = np.asarray(times, dtype=float)
    position, velocity, row = trajectory.at(times)
    part = Part(mass, gravity, friction.law)
    forces = _forces(surface, part, times, position, velocity, trajectory.state[row])
    return forces[:, 0], forces[:, 1]


@jit
def _forces(
    surface: Any, part: Part, times: FloatArray, position: FloatArray, velocity: FloatArray, state: NDArray[np.int64]
) -> FloatArray:
    out = np.full((len(times), 2), math.nan)
    local = new_local(surface)
    for k in range(len(times)):
        time, x, y = times[k], position[k, 0], position[k, 1]
        pin_time(surface, local, time, min(next_kink(surface.drives, time), time + 1.0))
        if not pin_cell(surface, local, x, y):
            continue
        f = fields(surface, local, x, y, time)
        if state[k] == STICK:
            a = slope(f, part)
            out[k, 0], out[k, 1] = a.load, part.mass * a.demand
        else:
            load = pull(f, velocity[k, 0], velocity[k, 1], part).normal
            out[k, 0], out[k, 1] = load, friction_limit(part.law, load)
    return out
