"""When a sliding part is on the slow manifold, and when it leaves it for plain steps."""

from __future__ import annotations

import math

from particle.events.mechanics import (
    Motion,
    Now,
    Part,
    RestPull,
    energy_at_rest,
    heading,
    length,
    rest_pull,
    slip_speed,
    stretched,
    velocity,
)
from particle.events.memory import Memory
from particle.events.request import Request
from particle.events.sliding.runge_kutta import motion_rate
from particle.friction import friction_limit
from particle.jit import device_no_arrays, inlined
from particle.modes import Mode
from particle.surface import LocalSurface, SurfacePoint, surface_at

MIN_PULL = 0.75  # of the friction limit: the slow manifold draws parts to it down to a pull of half of it
MAX_TOUCH = 1e-6  # of a stroke: a break-away that has not come off by then was only a touch
GOOD, AGAIN, AT_REST = range(3)


@device_no_arrays
def first_mode(part: Part, load: float) -> int:
    """How a part begins to slide: without friction there is no slow manifold, and no stiffness either."""
    return Mode.MANIFOLD if friction_limit(part.law, load) > 0.0 else Mode.SLIDING


@device_no_arrays
def manifold_error(local: LocalSurface, part: Part, time: float, motion: Motion) -> float:
    """What the slow manifold's next term would move the part by [m]."""
    f = surface_at(local, motion.x, motion.y, time)
    a = rest_pull(f, part)
    kappa = heading(local, part, time, motion.x, motion.y, motion.v_x, f, a).kappa
    return 3 * abs(kappa) * motion.v_x**3 / a.limit if a.limit > 0.0 else math.inf


@inlined
def joins_manifold(
    local: LocalSurface, request: Request, time: float, motion: Motion, f: SurfacePoint, a: RestPull
) -> bool:
    """Whether a slow part's velocity (v_x, v_y) has become that of the slow manifold, on which steps may be longer."""
    u, tolerance = slip_speed(f, request.part, motion.v_x, motion.v_y), request.tolerance
    if a.limit <= 0.0 or a.demand < 1.1 * MIN_PULL * a.limit or u > 0.01 * a.limit * request.stroke_time:
        return False
    h = heading(local, request.part, time, motion.x, motion.y, u, f, a)
    v_x, v_y = velocity(f, request.part, u, h)
    # What is off the manifold turns into it within u / Q.
    off = length(f, *stretched(f, motion.v_x - v_x, motion.v_y - v_y)) * u / a.limit
    return bool(off <= 0.01 * tolerance and 3 * abs(h.kappa) * u**3 / a.limit <= 0.01 * tolerance)


@device_no_arrays
def to_plane(local: LocalSurface, part: Part, time: float, motion: Motion, f: SurfacePoint, a: RestPull) -> None:
    """Turn the sliding speed u of a motion on the manifold into v_x and v_y."""
    h = heading(local, part, time, motion.x, motion.y, motion.v_x, f, a)
    motion.v_x, motion.v_y = velocity(f, part, motion.v_x, h)


@inlined
def check_manifold(request: Request, memory: Memory, f: SurfacePoint, a: RestPull) -> int:
    """What becomes of a step tried on the manifold: it is good (GOOD), to be tried again, shorter or off the manifold
    (AGAIN), or brings the part to rest (AT_REST).
    """
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    local, part, step, time, h = memory.local, request.part, memory.step, now.time, now.h
    touch = h <= MAX_TOUCH * request.stroke_time
    if step.end[0].v_x <= 0.0:
        if not touch:
            now.h = 0.5 * h
            return AGAIN
        motion.v_x = motion.v_y = 0.0
        motion.work += energy_at_rest(local, part, time + h, motion)
        motion.work -= energy_at_rest(local, part, time, motion)
        now.mode, now.time = Mode.RESTING, time + h
        return AT_REST
    error = manifold_error(local, part, time + h, step.end[0]) / request.tolerance
    if error > 1.0 and not touch:
        # It grows with the speed's third power, and that with the time.
        now.h = h * max(0.05, 0.9 * error ** (-1 / 3))
        return AGAIN
    if error > 1.0:
        # Friction is about to vanish, and the manifold with it.
        to_plane(local, part, time, motion, f, a)
        now.mode = Mode.SLIDING
        step.loads[0] = motion_rate(f, now.mode, local, part, time, motion, step.rates[0])
        return AGAIN
    return GOOD


@inlined
def leave_manifold(request: Request, memory: Memory) -> None:
    """Go over to plain steps once the part is fast enough for them, or slows down again."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    local, part = memory.local, request.part
    f = surface_at(local, motion.x, motion.y, now.time)
    a = rest_pull(f, part)
    fast = motion.v_x > 0.03 * a.limit * request.stroke_time
    accurate = manifold_error(local, part, now.time, motion) <= 0.1 * request.tolerance
    if not (accurate and not fast and a.demand >= MIN_PULL * a.limit):
        to_plane(local, part, now.time, motion, f, a)
        now.mode = Mode.SLIDING
