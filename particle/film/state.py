"""A part on a film of air at one moment: its rates, its row in the record, and what holds it."""

from __future__ import annotations

from particle.events import Request, Row
from particle.events.mechanics import Pull, at_contact, braked, energy, inner, length, pull, rising, slip
from particle.film.film import FUNCTIONS, Layer
from particle.film.gap import Gap, fill_flow, fill_gap, stored
from particle.film.memory import CONTENTS, HEAT, LOSS, SOLVED, STORED, V_X, V_Y, WORK, Memory, X, Y, Z
from particle.jit import device_no_arrays
from particle.modes import Mode, Verdict
from particle.surface import SurfacePoint, surface_at
from particle.types import FloatArray

FAR = 10.0  # roughnesses, of the gap at its nearest point: from there on the part is off the surface


@device_no_arrays
def settle(request: Request, layer: Layer, memory: Memory, state: FloatArray, time: float, g: Gap) -> SurfacePoint:
    """The gap at a state and time [s], looked for near state[Z], and the forces there, into `g`; the surface there."""
    part = request.part
    f = surface_at(memory.local, state[X], state[Y], time)
    p = pull(f, state[V_X], state[V_Y], part)
    memory.counts[0].evaluations += 1
    g.xx, g.xy, g.yy, g.z = f.w_xx, f.w_xy, f.w_yy, state[Z]
    g.pull_x, g.pull_y, g.normal, g.speed = p.x, p.y, p.normal, p.speed
    g.demand = part.mass * length(f, *at_contact(f, part, p.x, p.y))
    fill_gap(layer, part.law, state[CONTENTS:SOLVED], p.normal, g)
    return f


@device_no_arrays
def fill_rate(
    request: Request, layer: Layer, memory: Memory, state: FloatArray, time: float, mode: int, g: Gap, rate: FloatArray
) -> None:
    """The rate of a state at a time [s] into `rate` (RATES,), with its gap in `g`.

    Friction Q and the drag mu A/(<h> + 2 mfp) of the air brake the slip; of a part that is off the surface drag alone.
    """
    part = request.part
    f = settle(request, layer, memory, state, time, g)
    fill_flow(layer, g, rate[CONTENTS:SOLVED])
    heat = 0.0
    for i in range(FUNCTIONS):
        heat -= g.excess[i] * rate[CONTENTS + i]
    rate[HEAT] = heat * layer.pressure * layer.area
    for i in (X, Y, V_X, V_Y, WORK, LOSS):
        rate[i] = 0.0
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
def drag_of(layer: Layer, gap: float) -> float:
    """mu A/(h + 2 mfp) [N s/m], the force of the air against a slip over its velocity, at a mean gap [m]."""
    return layer.viscosity * layer.area / (gap + 2.0 * layer.free_path)


@device_no_arrays
def is_off(g: Gap) -> bool:
    """Whether a gap is wider than what counts as contact."""
    return g.near > FAR or g.verdict == Verdict.DETACHED


@device_no_arrays
def leaves(request: Request, g: Gap) -> float:
    """Above 0 where a part at rest does not stay: what it needs less the largest friction, over their sum."""
    if g.verdict != Verdict.GOES_ON or is_off(g):
        return 2.0
    limit = request.part.law.static_ratio * g.limit
    return (g.demand - limit) / (g.demand + limit) if g.demand + limit > 0.0 else 0.0


@device_no_arrays
def fill_row(request: Request, layer: Layer, memory: Memory, mode: int, row: Row) -> None:
    """The row of memory.step[0].state into `row`."""
    state, now, part, g = memory.step[0].state, memory.now[0], request.part, memory.gap[0]
    x, y, v_x, v_y = state[X], state[Y], state[V_X], state[V_Y]
    row.time, row.x, row.y, row.v_x, row.v_y, row.mode = now.time, x, y, v_x, v_y, mode
    row.work, row.dissipated = state[WORK], state[LOSS]
    f = settle(request, layer, memory, state, now.time, g)
    state[Z], state[STORED] = g.z, stored(layer, g)
    row.z, row.v_z, row.load = f.w, rising(f, v_x, v_y), g.normal
    row.friction = g.demand if mode == Mode.RESTING else (g.limit if mode == Mode.SLIDING else 0.0)
    row.kinetic, row.potential = energy(f, x, y, v_x, v_y, row.z, row.v_z, part)
    row.gap, row.air = g.width, g.air


@device_no_arrays
def energy_now(request: Request, memory: Memory) -> float:
    """Kinetic and potential energy [J] of the part at memory.step[0].state."""
    state, time = memory.step[0].state, memory.now[0].time
    f = surface_at(memory.local, state[X], state[Y], time)
    v_x, v_y = state[V_X], state[V_Y]
    kinetic, potential = energy(f, state[X], state[Y], v_x, v_y, f.w, rising(f, v_x, v_y), request.part)
    return kinetic + potential
