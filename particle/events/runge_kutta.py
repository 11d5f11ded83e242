"""One step of an embedded Runge-Kutta pair, for sliding and for the slow manifold after break-away."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853, RK45

from particle.events.breakaway import manifold_rate
from particle.events.equations import Part, margin, slide_rate
from particle.events.record import SLIDING
from particle.friction import friction_limit
from particle.jit import bare, jit
from particle.surface import CELL, Fields, fields, gap_at, within_cell

FloatArray = NDArray[np.float64]

LOOSE = 1e-6  # tolerances from here on are met most cheaply by the pair of order 5


class Tableau(NamedTuple):
    """An embedded pair: coefficients of Dormand and Prince (1980; order 8 by Hairer, Norsett and Wanner, 1993)."""

    a: FloatArray  # (stages + 1, stages): the last row is the step itself, evaluated for its error
    c: FloatArray  # (stages + 1,)
    error: FloatArray  # (2, stages + 1): error weights; the second row is zero when there is only one
    order: int
    between: FloatArray  # (m,), places in the step between its stages
    blend: FloatArray  # (m, stages + 1): a smooth quantity there, from its values at the stages


class Pairs(NamedTuple):
    """The pairs that a path uses: one for steps as long as the tolerance admits, one where a kink ends them before."""

    long: Tableau
    short: Tableau


@cache
def tableau(order: int) -> Tableau:
    """The pair of order 5 or 8."""
    if order == 5:
        return _tableau(RK45, np.stack([RK45.E, 0 * RK45.E]), 5)
    return _tableau(DOP853, np.stack([DOP853.E5, DOP853.E3]), 8)


def pairs_for(tolerance: float) -> Pairs:
    """Order 8 for long steps at tight tolerances, order 5 elsewhere."""
    return Pairs(long=tableau(5 if tolerance >= LOOSE else 8), short=tableau(5))


def _tableau(pair: Any, error: FloatArray, order: int) -> Tableau:
    stages = len(pair.B)
    a = np.zeros((stages + 1, stages))
    a[:stages, : pair.A.shape[1]] = pair.A[:stages, :stages]
    a[stages] = pair.B
    c = np.append(pair.C[:stages], 1.0)
    places = np.unique(c)
    between = 0.5 * (places[1:] + places[:-1])
    powers = np.arange(min(len(places), 6))
    blend = between[:, None] ** powers @ np.linalg.pinv(c[:, None] ** powers)
    return Tableau(a, c, error, order, between, blend)


class Step(NamedTuple):
    """Scratch memory and result of a step."""

    rates: FloatArray  # (stages + 1, 6)
    loads: FloatArray  # (stages + 1,) N, normal force at each stage
    margins: FloatArray  # (stages + 1,) how far each stage is from the end of contact
    stage: FloatArray  # (6,)
    end: FloatArray  # (6,)
    start_gap: FloatArray  # (1,) m, the step's start from the rim
    moving: FloatArray  # (8,) the state in the plane's coordinates
    still: FloatArray  # (2,) zeros
    seen: FloatArray  # (4 + Fields,) the last stage's time, x, y and cell, and the surface there


@jit
def new_step(pairs: Pairs) -> Step:
    stages = len(pairs.long.c)
    rates, loads = np.zeros((stages, 6)), np.zeros(stages)
    return Step(
        rates,
        loads,
        loads.copy(),
        np.zeros(6),
        np.zeros(6),
        np.zeros(1),
        np.zeros(8),
        np.zeros(2),
        np.full(20, math.nan),
    )


@bare
def fields_at_start(local: Any, step: Step, count: NDArray[np.int64], time: float, state: FloatArray) -> Fields:
    """The surface where a step starts; the step before may have seen it at its end. count[0] counts evaluations."""
    s = step.seen
    if s[0] == time and s[1] == state[0] and s[2] == state[1] and s[3] == local.counts[CELL]:
        return Fields(
            s[4], s[5], s[6], s[7], s[8], s[9], s[10], s[11], s[12], s[13], s[14], s[15], s[16], s[17], s[18], s[19]
        )
    count[0] += 1
    return fields(local, state[0], state[1], time)


@bare
def keep_fields(local: Any, step: Step, time: float, f: Fields) -> None:
    """Keep the surface at the end of a step that ends at a time [s]."""
    s = step.seen
    s[0], s[1], s[2], s[3] = time, step.stage[0], step.stage[1], local.counts[CELL]
    s[4], s[5], s[6], s[7], s[8], s[9], s[10], s[11] = f.w, f.w_t, f.w_tt, f.x, f.y, f.xt, f.yt, f.xx
    s[12], s[13], s[14], s[15] = f.xy, f.yy, f.base_px, f.base_py
    s[16], s[17], s[18], s[19] = f.base_vx, f.base_vy, f.base_ax, f.base_ay


@bare
def rate(f: Fields, mode: int, local: Any, part: Part, time: float, state: FloatArray, out: FloatArray) -> float:
    """The right side: of (x, y, v_x, v_y, work, dissipation) while sliding, of (x, y, u, -, ...) on the slow manifold.

    f: the surface at `state` and `time`.  Returns the load [N].
    """
    if mode == SLIDING:
        return slide_rate(f, part, state, out)
    return manifold_rate(f, local, part, time, state, out)


@bare
def attempt(
    mode: int, surface: Any, local: Any, part: Part, pair: Tableau, step: Step, time: float, state: FloatArray, h: float
) -> bool:
    """Tries a step of h [s] from `state`, whose rate is step.rates[0] and gap step.start_gap; the end goes to step.end.

    False when a stage leaves the cell's polynomials, or turns the velocity back under friction, which would then point
    the wrong way.
    """
    # A part that starts from rest where friction vanishes has no direction to keep.
    dry = mode == SLIDING and friction_limit(part.law, step.loads[0]) > 0.0 and math.hypot(state[2], state[3]) > 0.0
    stages = len(pair.c)
    for k in range(1, stages):
        for i in range(6):
            total = 0.0
            for j in range(k):
                total += pair.a[k, j] * step.rates[j, i]
            step.stage[i] = state[i] + h * total
        if not within_cell(local, step.stage[0], step.stage[1]):
            return False
        if dry and step.stage[2] * state[2] + step.stage[3] * state[3] <= 0.0:
            return False
        moment = time + pair.c[k] * h
        f = fields(local, step.stage[0], step.stage[1], moment)
        if k == stages - 1:
            keep_fields(local, step, moment, f)
        load = rate(f, mode, local, part, moment, step.stage, step.rates[k])
        # As far from the rim as the start is, less the way from there: where that does not settle it, look.
        gap = step.start_gap[0] - math.hypot(step.stage[0] - state[0], step.stage[1] - state[1])
        gap = gap if gap > 0.0 else gap_at(surface, local, step.stage[0], step.stage[1])
        step.loads[k], step.margins[k] = load, margin(local, part, load, gap)
    for i in range(6):
        step.end[i] = step.stage[i]
    return True


@bare
def error(pair: Tableau, step: Step, h: float, lasting: float, force: float) -> float:
    """The step's error as a distance [m].

    An error of velocity counts as what it moves the part by in `lasting` [s], one of the ledger as the way on which
    `force` [N] does that work.
    """
    fifth = third = 0.0
    for i in range(6):
        e = d = 0.0
        for k in range(len(pair.c)):
            e += pair.error[0, k] * step.rates[k, i]
            d += pair.error[1, k] * step.rates[k, i]
        weight = h / force if i >= 4 else (h * lasting if i >= 2 else h)
        fifth += (weight * e) ** 2
        third += (weight * d) ** 2
    if fifth == 0.0:
        return 0.0
    # Hairer's combination: the fifth-order estimate, damped by the third-order one.
    return fifth / math.sqrt(fifth + 0.01 * third)


@bare
def first_excursion(part: Part, pair: Tableau, step: Step) -> float:
    """The share of a step at which the load leaves the contact's range between two stages; 1: nowhere.

    The loads between them are those of a polynomial fitted to the stages'.
    """
    for k in range(len(pair.between)):
        load = 0.0
        for j in range(len(pair.c)):
            load += pair.blend[k, j] * step.loads[j]
        if not -part.law.pull_off <= load <= part.law.largest_load:
            return float(pair.between[k])
    return 1.0
