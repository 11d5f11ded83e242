"""Where a part with a face is in space, and what acts on it there."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.body.averages import AT, enter_all
from particle.body.balance import find_rates, friction_wrench, limits, set_load
from particle.body.face import Face
from particle.body.limit import gauge, needed
from particle.body.memory import HEADING, SPIN, V_X, V_Y, Memory, X, Y
from particle.body.press import pull_to_end
from particle.body.state import base_at, settle, slip_speed
from particle.events import CONTACT_STATE, ContactState, Request, Row
from particle.friction import LOCAL
from particle.jit import jit
from particle.modes import Mode
from particle.surface import Surface
from particle.types import FloatArray


@jit
def face_states(
    surface: Surface, request: Request, face: Face, memory: Memory, rows: NDArray[Row], on_film: FloatArray
) -> NDArray[ContactState]:
    """The states (k,) at rows of a path; nan where the face is not on the plate any more.

    The contact is the face's origin, the normal that of the face. What the contact must bear is a force and a torque;
    `pull` is that of a point as near to slipping: the gauge of `limit` times friction's limit at rest, over the mass.
    `point_pull` is the force alone, over the mass, and `added_pull` their difference.
    on_film: (k, 3) of a film of air, `limit`, `by_borne` and `drag` of `Balance`; without one (0, 3).
    """
    out = np.zeros(len(rows), CONTACT_STATE)
    part, b, s, state = request.part, memory.balance[0], memory.search[0], memory.step[0].state
    for k in range(len(rows)):
        row, found = rows[k], out[k]
        state[X], state[Y], state[HEADING] = row.x, row.y, row.heading
        state[V_X], state[V_Y], state[SPIN] = row.v_x, row.v_y, row.spin
        cell, _ = enter_all(
            surface, memory.local, memory.under, face, row.x, row.y, row.heading, row.time, math.inf, (0.0, 0.0)
        )
        if cell < 0 or not settle(part, face, memory, state, row.time):
            found.x = found.y = found.z = found.centre_x = found.centre_y = found.centre_z = math.nan
            found.normal_x = found.normal_y = found.normal_z = math.nan
            found.friction_x = found.friction_y = found.friction_z = math.nan
            found.pull = found.point_pull = found.added_pull = math.nan
            continue
        base, e, y = base_at(memory.local, row.time), b.axes, b.averages[AT]
        cosine, sine = math.cos(base.turn), math.sin(base.turn)
        found.normal_x = cosine * e[2, 0] - sine * e[2, 1]
        found.normal_y = sine * e[2, 0] + cosine * e[2, 1]
        found.normal_z = e[2, 2]
        x, y_ = base.x + cosine * y[0] - sine * y[1], base.y + sine * y[0] + cosine * y[1]
        found.x, found.y = x + part.contact * found.normal_x, y_ + part.contact * found.normal_y
        found.z = y[2] + part.contact * found.normal_z
        found.centre_x, found.centre_y = x + part.centre * found.normal_x, y_ + part.centre * found.normal_y
        found.centre_z = y[2] + part.centre * found.normal_z
        b.stands = 0  # rows are in any order
        if len(on_film) > 0:
            b.on_film, b.at, b.by_load = 1, row.load, 0.0
            b.limit, b.by_borne, b.drag = on_film[k, 0], on_film[k, 1], on_film[k, 2]
        for i in range(3):
            b.rates[i] = 0.0
        if row.mode == Mode.SLIDING and slip_speed(face, memory) > 0.0:
            find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b)
        f_1, f_2, _ = friction_wrench(part, b)
        f_x, f_y = f_1 * e[0, 0] + f_2 * e[1, 0], f_1 * e[0, 1] + f_2 * e[1, 1]
        found.friction_x, found.friction_y = cosine * f_x - sine * f_y, sine * f_x + cosine * f_y
        found.friction_z = f_1 * e[0, 2] + f_2 * e[1, 2]
        if part.law.kind == LOCAL:
            found.bend_loss = b.load[0] + part.law.pull_off - pull_to_end(part.law, face, b.load, b)
        set_load(part, 0.0, 0.0, 0.0, b)
        needed(b, s.needed)
        limit = part.law.static_ratio * limits(part, b)[0]
        found.point_pull = math.hypot(s.needed[0], s.needed[1]) / part.mass
        found.pull = gauge(part, face, b, s) * limit / part.mass
        found.added_pull = abs(found.pull - found.point_pull)
    return out
