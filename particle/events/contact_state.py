"""Where contact and centre of mass of a part are in space, and what acts on it there, over samples of the surface."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.events.mechanics import Part, at_contact, grip_at, length, pull, slip
from particle.events.record import Row
from particle.friction import friction_limit
from particle.jit import jit
from particle.modes import Mode
from particle.records import Record, record_type
from particle.surface import point_of
from particle.types import FloatArray


class ContactState(Record):
    """A part at one moment, in space."""

    x: float  # m, of the contact; over the base at its start
    y: float
    z: float
    centre_x: float  # m, of the centre of mass
    centre_y: float
    centre_z: float
    normal_x: float  # of the surface, along which the part stands
    normal_y: float
    normal_z: float
    friction_x: float  # N, on the part
    friction_y: float
    friction_z: float
    pull: float  # m/s^2, friction per kg that a part at rest needs, as on a flat surface
    point_pull: float  # m/s^2, the same on a point of the mid-plane
    added_pull: float  # m/s^2, the length of their difference
    bend_loss: float  # N, by how much the surface's curvature lessens the pull-off force


CONTACT_STATE = record_type(ContactState)


@jit
def contact_states(
    points: FloatArray, part: Part, contact: float, centre: float, rows: NDArray[Row], drags: FloatArray
) -> NDArray[ContactState]:
    """The states (k,) at the rows (k,) of a path, over points of the surface (k, 49); nan where these are.

    contact, centre: m, the heights over the mid-plane, also of a part on a surface that stays level.  drags: (k,)
    N s/m, of the air.
    """
    out = np.zeros(len(rows), CONTACT_STATE)
    point = Part(part.mass, part.gravity, part.tilt_x, part.tilt_y, part.squeeze, part.law, 0.0, 0.0)
    for k in range(len(rows)):
        row, state, f = rows[k], out[k], point_of(points[k])
        x, y, v_x, v_y = row.x, row.y, row.v_x, row.v_y
        s = math.sqrt(1 + f.w_x * f.w_x + f.w_y * f.w_y)
        n_x, n_y, n_z = -f.w_x / s, -f.w_y / s, 1 / s
        x, y = x + f.base_px, y + f.base_py
        state.x, state.y, state.z = x + contact * n_x, y + contact * n_y, row.z + contact * n_z
        state.centre_x, state.centre_y = x + centre * n_x, y + centre * n_y
        state.centre_z = row.z + centre * n_z
        state.normal_x, state.normal_y, state.normal_z = n_x, n_y, n_z
        if row.mode == Mode.FLYING:
            continue
        p, q = pull(f, v_x, v_y, part), pull(f, v_x, v_y, point)
        p_x, p_y = at_contact(f, part, p.x, p.y)
        state.pull, state.point_pull = length(f, p_x, p_y), length(f, q.x, q.y)
        state.added_pull = length(f, p_x - q.x, p_y - q.y)
        if row.mode == Mode.RESTING:
            d_x, d_y = -part.mass * p_x, -part.mass * p_y
        elif p.speed > 0.0:
            k_x, k_y = slip(f, part, v_x, v_y)
            against = row.friction / p.speed + drags[k]
            d_x, d_y = -against * k_x, -against * k_y
        else:  # it begins to slide, along the pull
            against = row.friction / state.pull if state.pull > 0.0 else 0.0
            d_x, d_y = -against * p_x, -against * p_y
        state.friction_x, state.friction_y, state.friction_z = d_x, d_y, d_x * f.w_x + d_y * f.w_y
        limit, load = grip_at(f, part, row.load)
        state.bend_loss = row.load - load
        if state.bend_loss != 0.0 and limit > 0.0:
            state.pull *= friction_limit(part.law, row.load) / limit
    return out


@jit
def rest_loads(points: FloatArray, part: Part) -> tuple[FloatArray, FloatArray]:
    """Net loads N [N], and |K^-1 p|_M [m/s^2], of a part at rest at points of the surface (n, 49); (n,) each.

    As on a flat surface: as far above pull-off, and as near to slipping.
    """
    loads, demands = np.zeros(len(points)), np.zeros(len(points))
    for n in range(len(points)):
        f = point_of(points[n])
        p = pull(f, 0.0, 0.0, part)
        limit, loads[n] = grip_at(f, part, p.normal)
        demands[n] = length(f, *at_contact(f, part, p.x, p.y))
        if loads[n] != p.normal and limit > 0.0:
            demands[n] *= friction_limit(part.law, loads[n]) / limit
    return loads, demands
