"""A part with a face at one state: its equations set up, its contact's margin, its row in the record."""

from __future__ import annotations

import math

from particle.body.averages import AT, fill_averages
from particle.body.balance import (
    Base,
    energy_of,
    fill_forces,
    fill_pose,
    find_rates,
    friction_wrench,
    least_pressure,
    set_load,
)
from particle.body.face import Face
from particle.body.memory import HEADING, LOSS, SPIN, V_X, V_Y, WORK, Memory, X, Y
from particle.body.press import comes_off, press
from particle.drives import evaluate_piece
from particle.events import Row
from particle.events.mechanics import Part
from particle.friction import LOCAL
from particle.jit import device_no_arrays
from particle.modes import Verdict
from particle.surface import LocalSurface, Surface, has_rim, rim_gap
from particle.types import FloatArray

TOGETHER = 1e-12  # of the weight: an edge that lifts so little before all of a face comes off with it


@device_no_arrays
def base_at(local: LocalSurface, time: float) -> Base:
    """The base at a time [s] of the prepared span."""
    frame = local.frame[0]
    if frame.base_drives == 0:
        return Base(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    s = (time - frame.time) / frame.unit
    x, v_x, a_x = evaluate_piece(local.base[0, :, 0], s, frame.unit)
    y, v_y, a_y = evaluate_piece(local.base[0, :, 1], s, frame.unit)
    turn, spin, spin_rate = evaluate_piece(local.base[0, :, 2], s, frame.unit)  # 0 of a base that does not turn
    return Base(x, y, turn, v_x, v_y, spin, a_x, a_y, spin_rate)


@device_no_arrays
def settle(part: Part, face: Face, memory: Memory, state: FloatArray, time: float) -> bool:
    """Set up the equations at a state and time; False where there are none."""
    b = memory.balance[0]
    if fill_averages(memory.local, memory.under, state[X], state[Y], state[HEADING], time, b.averages):
        memory.counts[0].evaluations += 1
    base = base_at(memory.local, time)
    if not fill_pose(part, base, b):
        return False
    fill_forces(part, face, base, state[V_X], state[V_Y], state[SPIN], b)
    set_load(part, 0.0, 0.0, 0.0, b)
    return True


@device_no_arrays
def slip_speed(face: Face, memory: Memory) -> float:
    """The speed [m/s] of the face over the surface, the turn's at the mean distance from its origin."""
    s = memory.balance[0].slip
    turn = face.arm * s[2]
    return math.sqrt(s[0] * s[0] + s[1] * s[1] + turn * turn)


@device_no_arrays
def contact_margin(part: Part, face: Face, memory: Memory, rests: bool) -> float:
    """How far the contact is from its end under b.load, dimensionless: pull-off, the largest load, a lifted edge."""
    load, weight = memory.balance[0].load[0], part.mass * max(1.0, abs(part.gravity))
    least = math.inf
    if part.law.kind == LOCAL:
        b = memory.balance[0]
        return min(
            b.stability if press(part.law, face, b.load, b, rests) else -1.0, (part.law.largest_load - load) / weight
        )
    if math.isfinite(part.law.pull_off):
        least = (load + part.law.pull_off) / weight
        if face.tips:
            least = min(least, (least_pressure(face, memory.balance[0]) + part.law.pull_off) / weight)
    if math.isfinite(part.law.largest_load):
        least = min(least, (part.law.largest_load - load) / weight)
    return least


@device_no_arrays
def rim_margin(surface: Surface, face: Face, state: FloatArray) -> float:
    """How far [m] the face is from the rim; at least 0 where it is on the plate."""
    gap = rim_gap(surface, state[X], state[Y])
    if not has_rim(surface):
        return gap
    if face.radius > 0.0 or gap > face.reach:
        return gap - face.reach
    cosine, sine = math.cos(state[HEADING]), math.sin(state[HEADING])
    least = math.inf
    for k in range(len(face.corners)):
        p, q = face.corners[k, 0], face.corners[k, 1]
        least = min(least, rim_gap(surface, state[X] + cosine * p - sine * q, state[Y] + sine * p + cosine * q))
    return least


@device_no_arrays
def end_reason(surface: Surface, part: Part, face: Face, memory: Memory, state: FloatArray) -> int:
    """Why contact ends under b.load."""
    load = memory.balance[0].load[0]
    if rim_margin(surface, face, state) < 0.0:
        return Verdict.LEFT_PLATE
    if load + part.law.pull_off < TOGETHER * part.mass * max(1.0, abs(part.gravity)):
        return Verdict.DETACHED
    if part.law.kind == LOCAL and load <= part.law.largest_load:
        b = memory.balance[0]
        press(part.law, face, b.load, b, False)
        return Verdict.DETACHED if comes_off(b) else Verdict.TIPPED
    return Verdict.OVERLOADED if load > part.law.largest_load else Verdict.TIPPED


@device_no_arrays
def fill_row(part: Part, face: Face, memory: Memory, mode: int, row: Row) -> None:
    """The row of memory.step[0].state into `row`."""
    state, b, time = memory.step[0].state, memory.balance[0], memory.now[0].time
    row.time, row.x, row.y, row.heading = time, state[X], state[Y], state[HEADING]
    row.v_x, row.v_y, row.spin = state[V_X], state[V_Y], state[SPIN]
    row.mode, row.work, row.dissipated = mode, state[WORK], state[LOSS]
    settle(part, face, memory, state, time)
    row.z, row.v_z = b.averages[AT, 2], b.rate[2]
    for k in range(3):
        b.rates[k] = 0.0
    if slip_speed(face, memory) > 0.0:
        find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b)
    f_1, f_2, _ = friction_wrench(part, b)
    row.load, row.friction = b.load[0], math.hypot(f_1, f_2)
    linear = part.law.kind != LOCAL and b.load[0] != 0.0
    row.pressure = least_pressure(face, b) / b.load[0] if linear else math.nan
    base = base_at(memory.local, time)
    row.kinetic, row.potential = energy_of(part, face, base, state[V_X], state[V_Y], state[SPIN], b)
