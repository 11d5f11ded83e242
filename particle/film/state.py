"""A part on a film of air at one moment: its rates, its row in the record, and what holds it."""

from __future__ import annotations

from particle.body import Face, within_cells
from particle.events import Request, Row
from particle.events.mechanics import Pull, at_contact, braked, energy, inner, length, pull, rising, slip
from particle.film.face import (
    drag_of,
    face_energy,
    fill_face_row,
    place_face,
    rim_of_face,
    slide_face,
    stand_face,
    weigh,
)
from particle.film.film import FUNCTIONS, Layer
from particle.film.gap import Gap, fill_flow, fill_gap, stored
from particle.film.memory import CONTENTS, HEADING, HEAT, LOSS, SPIN, STORED, V_X, V_Y, WORK, Memory, X, Y, Z
from particle.jit import device_no_arrays
from particle.modes import Mode, Verdict
from particle.surface import Surface, SurfacePoint, gap_at, surface_at, within_cell
from particle.types import FloatArray

FAR = 10.0  # roughnesses, of the gap at its nearest point: from there on the part is off the surface


@device_no_arrays
def settle(
    request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, state: FloatArray, time: float, g: Gap
) -> None:
    """The gap at a state and time [s], looked for near state[Z], and the forces there, into `g`."""
    if len(face) == 0:
        _place_point(request, layer, memory, state, time, g)
    else:
        place_face(request, layer, face, memory, state, time, g)
        if memory.now[0].mode == Mode.RESTING:
            weigh(request, face, memory, g)


@device_no_arrays
def fill_load(request: Request, face: Face | tuple[()], memory: Memory, state: FloatArray, time: float, g: Gap) -> None:
    """The surface under the part, and its load, into `g`."""
    if len(face) == 0:
        f = surface_at(memory.local, state[X], state[Y], time)
        g.xx, g.xy, g.yy, g.normal = f.w_xx, f.w_xy, f.w_yy, pull(f, state[V_X], state[V_Y], request.part).normal
    else:
        stand_face(request, face, memory, state, time, g)


@device_no_arrays
def _place_point(
    request: Request, layer: Layer, memory: Memory, state: FloatArray, time: float, g: Gap
) -> SurfacePoint:
    """The same of a point, and the surface there."""
    part = request.part
    f = surface_at(memory.local, state[X], state[Y], time)
    p = pull(f, state[V_X], state[V_Y], part)
    memory.counts[0].evaluations += 1
    g.xx, g.xy, g.yy, g.z = f.w_xx, f.w_xy, f.w_yy, state[Z]
    g.pull_x, g.pull_y, g.normal, g.speed = p.x, p.y, p.normal, p.speed
    g.demand = part.mass * length(f, *at_contact(f, part, p.x, p.y))
    fill_gap(layer, part.law, state[CONTENTS:HEADING], p.normal, g)
    return f


@device_no_arrays
def fill_rate(
    request: Request,
    layer: Layer,
    face: Face | tuple[()],
    memory: Memory,
    state: FloatArray,
    time: float,
    mode: int,
    g: Gap,
    rate: FloatArray,
) -> None:
    """The rate of a state at a time [s] into `rate` (RATES,), with its gap in `g`.

    Friction Q and the drag mu A/(<h> + 2 mfp) of the air brake the slip; of a part that is off the surface drag alone.
    """
    for i in (X, Y, V_X, V_Y, HEADING, SPIN, WORK, LOSS):
        rate[i] = 0.0
    if len(face) == 0:
        _fill_point_rate(request, layer, memory, state, time, mode, g, rate)
    else:
        place_face(request, layer, face, memory, state, time, g)
        if mode != Mode.RESTING:
            rate[WORK], rate[LOSS] = slide_face(request, layer, face, memory, state, mode, g)
            rate[X], rate[Y], rate[HEADING] = state[V_X], state[V_Y], state[SPIN]
            found = memory.body.balance[0].rates
            rate[V_X], rate[V_Y], rate[SPIN] = found[0], found[1], found[2]
    fill_flow(layer, g, rate[CONTENTS:HEADING])
    heat = 0.0
    for i in range(FUNCTIONS):
        heat -= g.excess[i] * rate[CONTENTS + i]
    rate[HEAT] = heat * layer.pressure * layer.area


@device_no_arrays
def _fill_point_rate(
    request: Request, layer: Layer, memory: Memory, state: FloatArray, time: float, mode: int, g: Gap, rate: FloatArray
) -> None:
    """Of a point, except for its film."""
    part = request.part
    f = _place_point(request, layer, memory, state, time, g)
    if mode == Mode.RESTING:
        return
    v_x, v_y = state[V_X], state[V_Y]
    slow = drag_of(layer, g.width)
    if mode == Mode.SLIDING and g.speed > 0.0:
        slow += g.limit / g.speed
    p = Pull(g.pull_x, g.pull_y, g.normal, g.speed)
    rate[X], rate[Y] = v_x, v_y
    rate[V_X], rate[V_Y], rate[WORK] = braked(f, part, p, slow / part.mass, v_x, v_y)
    rate[LOSS] = slow * g.speed * g.speed
    k_x, k_y = slip(f, part, v_x, v_y)
    a_x, a_y = slip(f, part, rate[V_X], rate[V_Y])
    g.slowing = -inner(f, k_x, k_y, a_x, a_y) / g.speed if g.speed > 0.0 else 0.0


@device_no_arrays
def is_off(g: Gap) -> bool:
    """Whether a gap is wider than what counts as contact."""
    return g.near > FAR or g.verdict == Verdict.DETACHED


@device_no_arrays
def fill_need(request: Request, face: Face | tuple[()], memory: Memory, g: Gap) -> None:
    """What a part at rest needs into g.demand, after `fill_rate`, which leaves that of a face out."""
    if len(face) == 0:
        return
    weigh(request, face, memory, g)


@device_no_arrays
def leaves(request: Request, g: Gap) -> float:
    """Above 0 where a part at rest does not stay: what it needs less the largest friction, over their sum."""
    if g.verdict != Verdict.GOES_ON or is_off(g):
        return 2.0
    limit = request.part.law.static_ratio * g.limit
    return (g.demand - limit) / (g.demand + limit) if g.demand + limit > 0.0 else 0.0


@device_no_arrays
def fill_row(request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, mode: int, row: Row) -> None:
    """The row of memory.step[0].state into `row`."""
    state, now, g = memory.step[0].state, memory.now[0], memory.gap[0]
    row.time, row.x, row.y, row.v_x, row.v_y, row.mode = now.time, state[X], state[Y], state[V_X], state[V_Y], mode
    row.work, row.dissipated = state[WORK], state[LOSS]
    if len(face) == 0:
        _fill_point_row(request, layer, memory, mode, row)
    else:
        settle(request, layer, face, memory, state, now.time, g)
        if mode != Mode.RESTING and g.speed > 0.0:
            slide_face(request, layer, face, memory, state, mode, g)
        fill_face_row(request, face, memory, g, row)
    state[Z], state[STORED] = g.z, stored(layer, g)
    row.gap, row.air = g.width, g.air


@device_no_arrays
def _fill_point_row(request: Request, layer: Layer, memory: Memory, mode: int, row: Row) -> None:
    """Of a point, except for its film."""
    state, now, part, g = memory.step[0].state, memory.now[0], request.part, memory.gap[0]
    x, y, v_x, v_y = state[X], state[Y], state[V_X], state[V_Y]
    f = _place_point(request, layer, memory, state, now.time, g)
    row.z, row.v_z, row.load = f.w, rising(f, v_x, v_y), g.normal
    row.friction = g.demand if mode == Mode.RESTING else (g.limit if mode == Mode.SLIDING else 0.0)
    row.kinetic, row.potential = energy(f, x, y, v_x, v_y, row.z, row.v_z, part)


@device_no_arrays
def energy_now(request: Request, face: Face | tuple[()], memory: Memory) -> float:
    """Kinetic and potential energy [J] of the part at memory.step[0].state."""
    state, time = memory.step[0].state, memory.now[0].time
    if len(face) == 0:
        return _point_energy(request, memory, state, time)
    return face_energy(request, face, memory, state, time)


@device_no_arrays
def _point_energy(request: Request, memory: Memory, state: FloatArray, time: float) -> float:
    """The same of a point."""
    f = surface_at(memory.local, state[X], state[Y], time)
    v_x, v_y = state[V_X], state[V_Y]
    kinetic, potential = energy(f, state[X], state[Y], v_x, v_y, f.w, rising(f, v_x, v_y), request.part)
    return kinetic + potential


@device_no_arrays
def within(face: Face | tuple[()], memory: Memory, state: FloatArray) -> bool:
    """Whether the part is where the cells' polynomials hold."""
    if len(face) == 0:
        return within_cell(memory.local, state[X], state[Y])
    return within_cells(memory.local, memory.body.under, face, state[X], state[Y], state[HEADING])


@device_no_arrays
def rim_of(surface: Surface, face: Face | tuple[()], memory: Memory, state: FloatArray) -> float:
    """How far [m] the part is from the rim at least, negative beyond it."""
    if len(face) == 0:
        return gap_at(surface, memory.local, state[X], state[Y])
    return rim_of_face(surface, face, memory, state)
