"""One step of an embedded Runge-Kutta pair, for sliding and for the slow manifold after break-away."""

from __future__ import annotations

import math

from particle.events.mechanics import INTEGRATED, Motion, Part, manifold_rate, margin, slide_rate
from particle.events.memory import Memory, Step
from particle.events.tableau import Tableau
from particle.friction import friction_limit
from particle.jit import device_no_arrays, inlined, spliced
from particle.lanes import LANES, lanes_of, load, load_some, nought, total
from particle.modes import Mode
from particle.surface import LocalSurface, Surface, SurfacePoint, gap_at, surface_here, within_cell


@spliced
def motion_rate(
    f: SurfacePoint, mode: int, local: LocalSurface, part: Part, time: float, motion: Motion, rate: Motion
) -> float:
    """The right side, while sliding or on the slow manifold, into `rate`; returns the load [N] as on a flat surface.

    f: the surface at `motion` and `time`.
    """
    if mode == Mode.SLIDING:
        return slide_rate(f, part, motion, rate)
    return manifold_rate(f, local, part, time, motion, rate)


@device_no_arrays
def attempt(surface: Surface, part: Part, pair: Tableau, memory: Memory, h: float) -> bool:
    """Tries a step of h [s] from the part's motion, whose rate is step.rates[0]; its end goes to step.end.

    False when a stage leaves the cell's polynomials, or turns the velocity back under friction, which would then point
    the wrong way.
    """
    mode, time, motion, step, local = (
        memory.now[0].mode,
        memory.now[0].time,
        memory.motion[0],
        memory.step,
        memory.local,
    )
    # A part that starts from rest where friction vanishes has no direction to keep.
    dry = mode == Mode.SLIDING and friction_limit(part.law, step.loads[0]) > 0.0
    dry = dry and math.hypot(motion.v_x, motion.v_y) > 0.0
    stages = len(pair.c)
    stage: Motion = step.stage[0]
    for k in range(1, stages):
        x = y = v_x = v_y = work = dissipated = 0.0
        for j in range(k):
            a, rate = pair.a[k, j], step.rates[j]
            x, y, v_x, v_y = x + a * rate.x, y + a * rate.y, v_x + a * rate.v_x, v_y + a * rate.v_y
            work, dissipated = work + a * rate.work, dissipated + a * rate.dissipated
        stage.x, stage.y = motion.x + h * x, motion.y + h * y
        stage.v_x, stage.v_y = motion.v_x + h * v_x, motion.v_y + h * v_y
        stage.work, stage.dissipated = motion.work + h * work, motion.dissipated + h * dissipated
        if not within_cell(local, stage.x, stage.y):
            return False
        if dry and stage.v_x * motion.v_x + stage.v_y * motion.v_y <= 0.0:
            return False
        moment = time + pair.c[k] * h
        f = surface_here(local, stage.x, stage.y, moment)
        normal = motion_rate(f, mode, local, part, moment, stage, step.rates[k])
        # As far from the rim as the start is, less the way from there: where that does not settle it, look.
        gap = memory.now[0].gap - math.hypot(stage.x - motion.x, stage.y - motion.y)
        gap = gap if gap > 0.0 else gap_at(surface, local, stage.x, stage.y)
        step.loads[k], step.margins[k] = normal, margin(local, part, normal, gap)
    step.end[0] = stage
    return True


@inlined
def step_error(pair: Tableau, step: Step, h: float, lasting: float, force: float) -> float:
    """The step's error as a distance [m].

    An error of velocity counts as what it moves the part by in `lasting` [s], one of the ledger as the way on which
    `force` [N] does that work.
    """
    rates, error = step.rate_numbers, pair.error
    zero = nought(load(rates[0], 0))
    e = e_2 = d = d_2 = zero
    for k in range(len(pair.c)):
        first, second = load(rates[k], 0), load_some(rates[k], LANES, INTEGRATED - LANES)
        e, e_2 = e + first * error[0, k], e_2 + second * error[0, k]
        d, d_2 = d + first * error[1, k], d_2 + second * error[1, k]
    weight, weight_2 = lanes_of(h, h, h * lasting, h * lasting), h / force
    e, e_2, d, d_2 = e * weight, e_2 * weight_2, d * weight, d_2 * weight_2
    fifth, third = total(e * e + e_2 * e_2), total(d * d + d_2 * d_2)
    if fifth == 0.0:
        return 0.0
    # Hairer's combination: the fifth-order estimate, damped by the third-order one.
    return fifth / math.sqrt(fifth + 0.01 * third)


@inlined
def first_excursion(part: Part, pair: Tableau, step: Step) -> float:
    """The share of a step at which the load leaves the contact's range between two stages; 1: nowhere.

    The loads between them are those of a polynomial fitted to the stages'.
    """
    for k in range(len(pair.between)):
        normal = 0.0
        for j in range(len(pair.c)):
            normal += pair.blend[k, j] * step.loads[j]
        if not -part.law.pull_off <= normal <= part.law.largest_load:
            return float(pair.between[k])
    return 1.0
