"""One step of part and film, by Radau's collocation (`body.collocation`).

The stages Z of the state's change solve Z = h (A x I) F(Z). Newton's method takes the rate's derivatives J from the
step's begin. With A^-1 = T L T^-1 its equations fall apart into one for each of A's eigenvalues,

    (L_k/h - J) W_k = (T^-1 R)_k,   R = F - (A^-1/h) Z,   Z -> Z + T W.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from particle.body import AHEAD, AT_START, DIFFERENCE, NODES, STAGES, A, Face
from particle.events import Request
from particle.film.film import Layer
from particle.film.gap import pumped
from particle.film.memory import CONTENTS, HEADING, PUMPED, RATES, SOLVED, SPIN, STATE, V_X, V_Y, Memory, X, Z
from particle.film.state import fill_rate, within
from particle.jit import device_no_arrays
from particle.modes import Mode
from particle.surface import Surface
from particle.types import FloatArray

PASSES, FOUND = 10, 1e-3  # FOUND: of what a step may be off by, how exactly its stages are found
RELATIVE = 1e-2  # of the speed as a step begins: how far a rate may be off at most
CONTENT = 50.0  # tolerances, of a content over the roughness
NUDGE = 1e-6  # of a speed and a gap, to see how rates change; how they do with the place is left to later passes
LONGER = 2.0  # steps: how far the last step's rates are extrapolated in full
FOLD = 0.3, 2.0  # of z, and roughnesses more: how far the gap may change in a step

BACK = np.linalg.inv(A)
_eigen = np.linalg.eig(BACK)
_half = np.flatnonzero(_eigen[0].imag >= 0)  # of a pair of conjugates one counts twice
ROOTS = _eigen[0][_half]
FROM = np.ascontiguousarray(np.linalg.inv(_eigen[1])[_half])
TO = np.ascontiguousarray(_eigen[1][:, _half] * np.where(_eigen[0][_half].imag > 0, 2.0, 1.0))


@device_no_arrays
def begin_step(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory) -> None:
    """The rate at the state, and by how much it changes with it, into memory.step[0]."""
    step, now, first, last = memory.step[0], memory.now[0], first_of(memory), last_of(face, memory)
    state, nudged, g = step.state, step.end, memory.gap[0]
    for i in range(STATE):
        nudged[i] = state[i]
    memory.gap[1] = g
    for j in range(max(first, V_X), last):
        if j == HEADING:
            continue
        size = NUDGE * g.width
        if j < CONTENTS or j == SPIN:
            size = NUDGE * (g.speed if g.speed > 0.0 else surface.size / request.stroke_time)
            size /= arm_of(face) if j == SPIN else 1.0
        nudged[j] = state[j] + size
        fill_rate(request, layer, face, memory, nudged, now.time, now.mode, memory.gap[1], step.rates[0])
        nudged[j] = state[j]
        for i in range(first, last):
            step.turns[i, j] = (step.rates[0, i] - step.rate[i]) / size


@device_no_arrays
def first_of(memory: Memory) -> int:
    """The first number of a state that moves."""
    return CONTENTS if memory.now[0].mode == Mode.RESTING else X


@device_no_arrays
def last_of(face: Face | tuple[()], memory: Memory) -> int:
    """The first number after those of a state that move."""
    if len(face) == 0:
        return HEADING
    return HEADING if memory.now[0].mode == Mode.RESTING else SOLVED


@device_no_arrays
def arm_of(face: Face | tuple[()]) -> float:
    """m, by which a turn counts as a distance."""
    if len(face) == 0:
        return 1.0
    return face.arm


@device_no_arrays
def attempt(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, h: float) -> bool:
    """Try a step of h [s], after `begin_step`: its stages and its end; False where they are not found."""
    step, now, first, last = memory.step[0], memory.now[0], first_of(memory), last_of(face, memory)
    state, stages, rates, time = step.state, step.stages, step.rates, now.time
    powers, start = (STAGES if h <= LONGER * step.before else 1), memory.gap[0]
    for k in range(STAGES):
        t = NODES[k] * h
        for i in range(STATE):
            stages[k, i] = state[i]
        for i in range(first, last):
            guess = 0.0
            for j in range(powers - 1, -1, -1):
                guess = guess * t + step.lead[j, i] / (j + 1)
            stages[k, i] += t * guess
    before = math.inf
    small = FOUND * request.tolerance
    if now.mode == Mode.SLIDING:
        small = min(small, FOUND * RELATIVE * start.speed * request.stroke_time)
    for turn in range(PASSES):
        for k in range(STAGES):
            if first == X and not within(face, memory, stages[k]):
                return False
            g = memory.gap[k + 1]
            fill_rate(request, layer, face, memory, stages[k], time + NODES[k] * h, now.mode, g, rates[k])
            stages[k, Z] = g.z
            if not abs(g.z - start.z) < FOLD[0] * abs(start.z) + FOLD[1]:
                return False
            if now.mode == Mode.SLIDING and not g.speed > 0.0:
                return False
        largest = _newton(surface, request, layer, face, memory, h)
        if not largest < 1e3 * surface.size:
            return False
        if (min(1.0, largest / before) if turn > 0 else 1.0) * largest <= small:
            break
        if turn == PASSES - 1 or largest > 2.0 * before:
            return False
        before = largest
    _finish(layer, memory, h, first, last)
    return True


@device_no_arrays
def _newton(
    surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, h: float
) -> float:
    """One of Newton's steps of the stages; its largest change as a distance [m]."""
    step, m, ahead, first, last = memory.step[0], memory.system, memory.ahead, first_of(memory), last_of(face, memory)
    state, stages, n = step.state, step.stages, last - first
    for k in range(STAGES):
        for i in range(first, last):
            step.changes[k, i] = 0.0
            step.residuals[k, i] = step.rates[k, i]
            for j in range(STAGES):
                step.residuals[k, i] -= BACK[k, j] / h * (stages[j, i] - state[i])
    for root in range(len(ROOTS)):
        for i in range(n):
            for j in range(n):
                m[i, j] = -step.turns[first + i, first + j]
            m[i, i] += ROOTS[root] / h
            m[i, n] = 0.0
            for k in range(STAGES):
                m[i, n] += FROM[root, k] * step.residuals[k, first + i]
        if not _eliminate(m[:n, : n + 1], ahead[:n]):
            return math.inf
        for k in range(STAGES):
            for i in range(n):
                step.changes[k, first + i] += (TO[k, root] * ahead[i]).real
    largest = 0.0
    for k in range(STAGES):
        for i in range(first, last):
            stages[k, i] += step.changes[k, i]
            largest = max(largest, abs(step.changes[k, i]) * _unit(surface, request, layer, face, i))
    return largest


@device_no_arrays
def _eliminate(m: Any, out: Any) -> bool:
    """Solve the real or complex system (n, n + 1) by elimination with pivots, in place; False where it is singular."""
    n = len(m)
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(m[i, k]) > abs(m[pivot, k]):
                pivot = i
        if not 0.0 < abs(m[pivot, k]) < math.inf:
            return False
        if pivot != k:
            for j in range(k, n + 1):
                m[k, j], m[pivot, j] = m[pivot, j], m[k, j]
        for i in range(k + 1, n):
            factor = m[i, k] / m[k, k]
            if factor != 0.0:
                for j in range(k + 1, n + 1):
                    m[i, j] -= factor * m[k, j]
    for k in range(n - 1, -1, -1):
        total = m[k, n]
        for j in range(k + 1, n):
            total -= m[k, j] * out[j]
        out[k] = total / m[k, k]
    return True


@device_no_arrays
def _unit(surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], i: int) -> float:
    """What an error of a number of the state counts as a distance [m] over it.

    A velocity counts as what it moves the part by in the shortest stroke, a roughness of gap as a 50th of the surface's
    size, a turn at the mean distance from the face's origin.
    """
    if i >= CONTENTS and i < HEADING:
        return surface.size / (CONTENT * layer.law.roughness)
    unit = arm_of(face) if i >= HEADING else 1.0
    return request.stroke_time * unit if i in (V_X, V_Y, SPIN) else unit


@device_no_arrays
def _finish(layer: Layer, memory: Memory, h: float, first: int, last: int) -> None:
    """The end of a step whose stages are found, both ledgers included, and its rate as a polynomial."""
    step, start = memory.step[0], memory.gap[0]
    state, stages, end, final = step.state, step.stages, step.end, STAGES - 1
    for i in range(STATE):
        end[i] = stages[final, i]
    for i in range(SOLVED, RATES):
        end[i] = state[i]
        for j in range(STAGES):
            end[i] += h * A[final, j] * step.rates[j, i]
    for k in range(STAGES):
        for i in range(first, last):
            step.rates[k, i] = 0.0
            for j in range(STAGES):
                step.rates[k, i] += BACK[k, j] / h * (stages[j, i] - state[i])
    end[PUMPED] = state[PUMPED]
    for k in range(STAGES):
        z = xx = xy = yy = 0.0
        for j in range(STAGES):
            g = memory.gap[j + 1]
            z += BACK[k, j] / h * (g.z - start.z)
            xx += BACK[k, j] / h * (g.xx - start.xx)
            xy += BACK[k, j] / h * (g.xy - start.xy)
            yy += BACK[k, j] / h * (g.yy - start.yy)
        end[PUMPED] += h * A[final, k] * pumped(layer, z, xx, xy, yy, memory.gap[k + 1])
    for k in range(STAGES):
        for i in range(first, last):
            step.past[k, i] = 0.0
            for j in range(STAGES):
                step.past[k, i] += AHEAD[k, j] * step.rates[j, i]


@device_no_arrays
def error_of(
    surface: Surface, request: Request, layer: Layer, face: Face | tuple[()], memory: Memory, h: float
) -> float:
    """The error of the step tried as a distance [m]."""
    step, first = memory.step[0], first_of(memory)
    m, n = step.system, last_of(face, memory) - first
    for i in range(n):
        m[i, n] = AT_START * step.rate[first + i]
        for k in range(STAGES):
            m[i, n] += DIFFERENCE[k] * step.rates[k, first + i]
        m[i, n] *= h
        for j in range(n):
            m[i, j] = (1.0 if i == j else 0.0) - h * AT_START * step.turns[first + i, first + j]
    if not _eliminate(m[:n, : n + 1], step.off[:n]):
        return math.inf
    total = 0.0
    for i in range(n):
        total += (step.off[i] * _unit(surface, request, layer, face, first + i)) ** 2
    return math.sqrt(total)


@device_no_arrays
def fill_within(face: Face | tuple[()], memory: Memory, share: float, h: float, out: FloatArray) -> None:
    """The state a share of the last step of h [s] after its begin into `out`, ledgers excluded."""
    step, first = memory.step[0], first_of(memory)
    for i in range(STATE):
        out[i] = step.end[i]
    for i in range(first, last_of(face, memory)):
        total = 0.0
        for k in range(STAGES - 1, -1, -1):
            total = total * (share - 1.0) + step.past[k, i] / (k + 1)
        out[i] += h * (share - 1.0) * total


@device_no_arrays
def take_step(face: Face | tuple[()], memory: Memory, h: float) -> None:
    """Make the end of a step of h [s] the state, and its rate the guess for the next."""
    step, first = memory.step[0], first_of(memory)
    for i in range(STATE):
        step.state[i] = step.end[i]
    for i in range(first, last_of(face, memory)):
        power = 1.0
        for k in range(STAGES):
            step.lead[k, i] = step.past[k, i] / power
            power *= h
    step.before = h
