"""A part with a face on a film of air: the equations of `body` under what the film leaves to asperities.

The gap is that in the body's axes, between the face and the surface's plane of least squares, with the surface's second
derivatives under it. The film's pressure has no moment and its gap no tilt: asperities bear the moments M alone, and
friction has the tractions (Q(N_c) + dQ/dN_c rho.S^-1 (-M_2, M_1))/A under their load N_c. As contents are given, a
change of the load N is shared by film and asperities as they are stiff, so Q is linear in N around the last gap.
Drag is mu A/(<h> + 2 mfp) times the slip of each point.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from particle.body import (
    STAGES,
    Face,
    base_at,
    energy_of,
    enter_all,
    find_rates,
    friction_wrench,
    gauge,
    least_pressure,
    needed,
    powers,
    quick_gauge,
    rim_margin,
    settle_body,
    slip_rate,
    slip_speed,
    solve,
)
from particle.events import Request, Row
from particle.film.film import Layer
from particle.film.gap import Gap, fill_asperities, fill_gap, fill_limit, fill_separation
from particle.film.memory import CONTENTS, HEADING, SPIN, V_X, V_Y, Memory, X, Y, Z
from particle.friction import FrictionLaw, friction_slope
from particle.jit import device_no_arrays, jit
from particle.modes import Mode, Verdict
from particle.surface import Surface
from particle.types import FloatArray

CLOSE = 1e-6  # of the limit: how close a slip that was located begins to it
LIFTS = 1e-6  # of the pull-off force: what moments lift an edge by counts from there on


@device_no_arrays
def drag_of(layer: Layer, gap: float) -> float:
    """mu A/(h + 2 mfp) [N s/m], the force of the air against a slip over its velocity, at a mean gap [m]."""
    return layer.viscosity * layer.area / (gap + 2.0 * layer.free_path)


@device_no_arrays
def stand_face(request: Request, face: Face, memory: Memory, state: FloatArray, time: float, g: Gap) -> bool:
    """The equations at a state and time [s], with the surface under the face and the load, into `g`; False: none."""
    body = memory.body
    b, pose = body.balance[0], body.step[0].state
    pose[0], pose[1], pose[2] = state[X], state[Y], state[HEADING]
    pose[3], pose[4], pose[5] = state[V_X], state[V_Y], state[SPIN]
    known = settle_body(request.part, face, body, pose, time)
    g.xx, g.xy, g.yy, g.normal = b.bend[0], b.bend[1], b.bend[2], b.load[0]
    return known


@device_no_arrays
def place_face(
    request: Request, layer: Layer, face: Face, memory: Memory, state: FloatArray, time: float, g: Gap
) -> None:
    """The equations at a state and time [s], and the gap there, into `g`."""
    known = stand_face(request, face, memory, state, time, g)
    g.z, g.speed = state[Z], slip_speed(face, memory.body)
    memory.body.balance[0].on_film = 1
    _share(request, layer, face, memory, state, g)
    if not known:
        g.verdict = Verdict.TIPPED


@device_no_arrays
def _share(request: Request, layer: Layer, face: Face, memory: Memory, state: FloatArray, g: Gap) -> None:
    """The gap under b.load, and friction around it; g.verdict: an edge lifts."""
    part, b = request.part, memory.body.balance[0]
    fill_gap(layer, part.law, state[CONTENTS:HEADING], b.load[0], g)
    g.normal = b.at = b.load[0]
    b.limit, b.by_borne, b.drag = g.limit, _by_borne(layer, part.law, g), drag_of(layer, g.width)
    b.by_load = g.borne_slope / g.slope if layer.grips else b.by_borne * g.rise / g.slope
    lifted = b.load[0] - least_pressure(face, b)  # by moments; without them it comes off as a whole
    if g.verdict == Verdict.GOES_ON and lifted > LIFTS * part.law.pull_off and g.load - lifted < -part.law.pull_off:
        g.verdict = Verdict.TIPPED


@device_no_arrays
def _by_borne(layer: Layer, law: FrictionLaw, g: Gap) -> float:
    """dQ/dN_c."""
    if layer.grips:
        return float(g.borne_slope / g.rise)
    return friction_slope(law, g.load) if g.limit > 0.0 else 0.0


@jit
def shares(
    surface: Surface, request: Request, layer: Layer, face: Face, memory: Memory, rows: NDArray[Row]
) -> FloatArray:
    """Friction's limit Q [N], dQ/dN_c and the drag [N s/m] at rows of a path; (k, 3)."""
    out, g, body, law = np.zeros((len(rows), 3)), memory.gap[0], memory.body, request.part.law
    for k in range(len(rows)):
        row, state = rows[k], memory.step[0].state
        state[X], state[Y], state[HEADING] = row.x, row.y, row.heading
        state[V_X], state[V_Y], state[SPIN] = row.v_x, row.v_y, row.spin
        cell, _ = enter_all(
            surface, body.local, body.under, face, row.x, row.y, row.heading, row.time, math.inf, (0.0, 0.0)
        )
        if cell < 0:
            continue
        stand_face(request, face, memory, state, row.time, g)
        g.width, g.load = row.gap, row.load - row.air
        fill_separation(layer, g)
        fill_asperities(layer, g.z, g)
        g.rise = g.net_slope
        fill_limit(layer, law, 0.0, g)
        out[k, 0], out[k, 1], out[k, 2] = g.limit, _by_borne(layer, law, g), drag_of(layer, row.gap)
    return out


@device_no_arrays
def weigh(request: Request, face: Face, memory: Memory, g: Gap) -> None:
    """The friction that a part at rest needs, as a share of the limit times it, into g.demand; after `place_face`."""
    part, body = request.part, memory.body
    b, s = body.balance[0], body.search[0]
    needed(b, s.needed)
    limit = part.law.static_ratio * b.limit
    if limit > 0.0:
        g.demand = quick_gauge(part, face, b, s) * limit
    else:
        g.demand = math.sqrt(s.needed[0] * s.needed[0] + s.needed[1] * s.needed[1]) + abs(s.needed[2]) / face.arm


@device_no_arrays
def slide_face(
    request: Request, layer: Layer, face: Face, memory: Memory, state: FloatArray, mode: int, g: Gap
) -> tuple[float, float]:
    """The accelerations into the balance's rates, and the slip's into g.slowing; work and loss [W]; after `place_face`.

    The gap is found anew under the load that the accelerations make.
    """
    part, body = request.part, memory.body
    b = body.balance[0]
    for turn in range(2):
        if turn == 1:
            _share(request, layer, face, memory, state, g)
        if mode != Mode.SLIDING:
            b.limit = b.by_load = b.by_borne = 0.0
        if not find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b):
            g.verdict = Verdict.TIPPED
    g.slowing = 0.0
    for i in range(3):
        unit = face.arm if i == 2 else 1.0
        rate = b.planar[i, 0] * b.rates[0] + b.planar[i, 1] * b.rates[1] + b.planar[i, 2] * b.rates[2]
        g.slowing -= unit * unit * rate * b.slip[i] / g.speed if g.speed > 0.0 else 0.0
    return powers(part, b)


@device_no_arrays
def fill_face_row(request: Request, face: Face, memory: Memory, g: Gap, row: Row) -> None:
    """What a face has in a row, after `place_face`, and `slide_face` where it slides."""
    part, body, time = request.part, memory.body, memory.now[0].time
    b, pose = body.balance[0], body.step[0].state
    if g.speed == 0.0:
        for i in range(3):
            b.rates[i] = 0.0
    f_1, f_2, _ = friction_wrench(part, b)
    row.z, row.v_z, row.heading, row.spin = b.averages[0, 2], b.rate[2], pose[2], pose[5]
    row.load = b.load[0]
    row.friction = math.hypot(f_1, f_2)
    borne = b.load[0] - g.air
    row.pressure = (least_pressure(face, b) - g.air) / borne if borne != 0.0 else math.nan
    row.kinetic, row.potential = energy_of(part, face, base_at(body.local, time), pose[3], pose[4], pose[5], b)


@device_no_arrays
def face_energy(request: Request, face: Face, memory: Memory, state: FloatArray, time: float) -> float:
    """Kinetic and potential energy [J] at a state and time [s]."""
    body, base = memory.body, base_at(memory.local, time)
    stand_face(request, face, memory, state, time, memory.gap[STAGES + 1])
    pose = body.step[0].state
    kinetic, potential = energy_of(request.part, face, base, pose[3], pose[4], pose[5], body.balance[0])
    return kinetic + potential


@device_no_arrays
def face_slip_rate(request: Request, face: Face, memory: Memory, first: bool) -> float:
    """r [m/s^2] by which a part at rest begins to slip, as in `body.limit`, after `place_face`; 0 at the limit.

    The rates of (x, y, heading) over it into step.off. first: whether this is where it leaves its rest.
    """
    part, body, off = request.part, memory.body, memory.step[0].off
    b, s = body.balance[0], body.search[0]
    needed(b, s.needed)
    if gauge(part, face, b, s) <= 1.0 + CLOSE and first:
        return 0.0
    rate = slip_rate(part, face, b, s)
    for i in range(3):
        for j in range(3):
            b.matrix[i, j] = b.planar[i, j]
        b.matrix[i, 3] = s.e[i] / (face.arm if i == 2 else 1.0)
    solve(b.matrix, off[:3])
    return rate


@device_no_arrays
def face_lost(request: Request, layer: Layer, face: Face, memory: Memory, g: Gap) -> float:
    """What friction dissipates [N] along the way of the slip at memory.step[0].state."""
    state = memory.step[0].state
    place_face(request, layer, face, memory, state, memory.now[0].time, g)
    _, loss = slide_face(request, layer, face, memory, state, Mode.SLIDING, g)
    return loss / g.speed


@device_no_arrays
def rim_of_face(surface: Surface, face: Face, memory: Memory, state: FloatArray) -> float:
    """How far [m] a face is from the rim; at least 0 where it is on the plate, to rounding."""
    pose = memory.body.step[0].state
    pose[0], pose[1], pose[2] = state[X], state[Y], state[HEADING]
    return rim_margin(surface, face, pose) + 1e-12 * surface.size
