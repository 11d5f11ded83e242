"""Sliding: how a part with a face begins to slide, its steps, and its stop."""

from __future__ import annotations

import math

from particle.body.averages import within_cells
from particle.body.balance import energy_of, find_rates, powers, set_load, solve
from particle.body.collocation import AHEAD, AT_START, DIFFERENCE, NODES, ORDER, STAGES, A
from particle.body.face import Face
from particle.body.limit import gauge, needed, slip_rate
from particle.body.memory import HEADING, LOSS, SPIN, STATE, UNKNOWNS, V_X, V_Y, WORK, Memory, Step, X, Y
from particle.body.state import base_at, contact_margin, end_reason, rim_margin, settle, slip_speed
from particle.events import Request
from particle.events.mechanics import Now
from particle.jit import device_no_arrays, inlined
from particle.modes import NO_EVENT, EventKind, Mode, Verdict
from particle.surface import Surface

FIRST = 1e-3  # of a stroke: the first moment of a slip, over which its acceleration is linear in time
SHORT = 1e-4  # of a stroke: what is left of a span is then all in that moment
CLOSE = 1e-6  # of the limit: how close a slip that was located begins to it
BEFORE_STOP = 0.9  # of the time to a stop: the longest step
STOPPED = 1e-7, 1e-3  # of a stroke, of the tolerance: how close a stop's time and place must be
STIFF = 0.01  # of a step times friction's own rate, from where on Newton's method finds its stages
PASSES, FOUND = 12, 1e-5  # FOUND: of what a step may be off by, how exactly its stages are found
RELATIVE = 1e-2  # of the speed as a step begins: how far a rate may be off at most
SLOW = 0.05  # of a pass: what it leaves of the last one's change, from where on friction's turns are found anew
LONGER = 2.0  # steps: how far the last step's accelerations are extrapolated in full
MAX_GROWTH, SAFETY, MIN_STEP = 8.0, 0.9, 1e-13


@inlined
def begin_slip(request: Request, face: Face, memory: Memory) -> bool:
    """Move a resting part that friction no longer holds over the first moment of its slip; False: it stays after all.

    Over that moment d the slip's rate goes from r_0 to r_1 along nearly the same e: it comes to (r_0 + r_1) d/2.
    """
    now: Now = memory.now[0]
    part, state, b, s = request.part, memory.step[0].state, memory.balance[0], memory.search[0]
    remaining = now.span_end - now.time
    whole = remaining < SHORT * request.stroke_time
    moment = remaining if whole else min(FIRST * request.stroke_time, 0.1 * remaining)
    settle(part, face, memory, state, now.time)
    before = sum(energy_of(part, face, base_at(memory.local, now.time), 0.0, 0.0, 0.0, b))
    needed(b, s.needed)
    first = 0.0
    if gauge(part, face, b, s) > 1.0 + CLOSE:
        first = max(slip_rate(part, face, b, s), 0.0)
    settle(part, face, memory, state, now.time + moment)
    if first == 0.0:
        needed(b, s.needed)
        gauge(part, face, b, s)
    rate = slip_rate(part, face, b, s)
    now.time = now.span_end if whole else now.time + moment
    speed = 0.5 * (first + rate) * moment
    if not (rate > 0.0 and speed > 0.0):
        after = sum(energy_of(part, face, base_at(memory.local, now.time), 0.0, 0.0, 0.0, b))
        state[WORK] += after - before
        return False
    way = (2 * first + rate) * moment * moment / 6
    for i in range(3):
        for j in range(3):
            b.matrix[i, j] = b.planar[i, j]
        b.matrix[i, 3] = s.e[i] / (face.arm if i == 2 else 1.0)
    solve(b.matrix, b.rates)
    for i in range(3):
        state[X + i] += way * b.rates[i]
        state[V_X + i] = speed * b.rates[i]
        for k in range(2, STAGES):
            memory.step[0].lead[k, i] = 0.0
        memory.step[0].lead[0, i] = rate * b.rates[i]
        memory.step[0].lead[1, i] = (rate - first) / moment * b.rates[i]
    settle(part, face, memory, state, now.time)
    find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b)
    _, loss = powers(part, b)
    lost = loss / speed * way
    after = sum(energy_of(part, face, base_at(memory.local, now.time), state[V_X], state[V_Y], state[SPIN], b))
    state[LOSS] += lost
    state[WORK] += after - before + lost
    now.mode, now.h, memory.step[0].error = Mode.SLIDING, moment, math.inf
    return True


@inlined
def slide(surface: Surface, request: Request, face: Face, memory: Memory) -> int:
    """Move the part on by one step of about now.h [s], or to its stop: STOPS, REVERSES or NO_EVENT.

    The equations are set up already, for the last row; anew only where accelerations may jump between spans.
    """
    now: Now = memory.now[0]
    part, step, b = request.part, memory.step[0], memory.balance[0]
    state = step.state
    if request.bridged[0] == 0.0:
        settle(part, face, memory, state, now.time)
    speed = slip_speed(face, memory)
    if not find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b):
        now.verdict = Verdict.TIPPED
        return NO_EVENT
    step.friction, step.speed = powers(part, b)[1] / (part.mass * speed * speed), speed
    slowing = 0.0
    for i in range(3):
        step.gap[i] = b.gap[i]
        unit = face.arm if i == 2 else 1.0
        rate = b.planar[i, 0] * b.rates[0] + b.planar[i, 1] * b.rates[1] + b.planar[i, 2] * b.rates[2]
        slowing -= unit * unit * rate * b.slip[i] / speed
        step.lead[0, i] = b.rates[i]
    remaining = now.span_end - now.time
    now.h = remaining if now.h >= 0.9 * remaining else now.h
    if slowing > 0.0:
        until = speed / slowing
        close = until < STOPPED[0] * request.stroke_time and speed * until < STOPPED[1] * request.tolerance
        if close and until <= remaining:
            return _stop(request, face, memory, until)
        now.h = min(now.h, BEFORE_STOP * until)
    while True:
        if now.h < MIN_STEP * request.stroke_time and now.h < remaining:
            now.verdict = Verdict.WORK_LIMIT
            return NO_EVENT
        if not _attempt(surface, request, face, memory, now.h):
            now.h *= 0.4
            continue
        error = _error(request, face, memory, now.h) / request.tolerance
        if not error <= 1.0:
            now.h *= max(0.2, SAFETY * error ** (-1 / ORDER)) if error > 1.0 else 0.2
            continue
        least = math.inf
        for k in range(STAGES - 1):
            least = min(least, step.margins[k])
        if step.margins[STAGES - 1] < 0.0:
            _end_contact(surface, request, face, memory)
            return NO_EVENT
        if least < 0.0:
            now.h *= 0.5
            continue
        break
    h = now.h
    for i in range(STATE):
        state[i] = step.end[i]
    for i in range(3):
        power = 1.0
        for k in range(STAGES):
            step.lead[k, i] = 0.0
            for j in range(STAGES):
                step.lead[k, i] += AHEAD[k, j] * step.rates[j, i] / power
            power *= h
    growth = min(MAX_GROWTH, SAFETY * max(error, 1e-12) ** (-1 / ORDER))
    if math.isfinite(step.error):  # as a slip comes to its stop, each step is shorter than the last by about as much
        trend = h / step.before * (max(step.error, 1e-12) / max(error, 1e-12)) ** (1 / ORDER)
        growth = min(growth, growth * trend)
    step.before, step.error = h, error
    now.time = now.span_end if h == remaining else now.time + h
    now.h = h * growth
    return NO_EVENT


@inlined
def _stop(request: Request, face: Face, memory: Memory, until: float) -> int:
    """Move a part that stops after `until` [s], with forces as they are, to its stop."""
    now: Now = memory.now[0]
    part, state, b = request.part, memory.step[0].state, memory.balance[0]
    work, loss = powers(part, b)
    e_1, e_2, e_3 = b.slip[0], b.slip[1], b.slip[2]
    state[LOSS] += 0.5 * loss * until
    for i in range(3):
        state[X + i] += 0.5 * until * state[V_X + i]
        state[V_X + i] = 0.0
    now.time += until
    settle(part, face, memory, state, now.time)
    needed(b, memory.search[0].needed)
    find_rates(part, face, e_1, e_2, e_3, b)
    state[WORK] += 0.5 * (work + powers(part, b)[0]) * until
    set_load(part, 0.0, 0.0, 0.0, b)
    now.mode = Mode.RESTING
    return EventKind.REVERSES.value if gauge(part, face, b, memory.search[0]) > 1.0 + CLOSE else EventKind.STOPS.value


@inlined
def _end_contact(surface: Surface, request: Request, face: Face, memory: Memory) -> None:
    """Move the part to where its contact ends within the step tried, just beyond it, by halving the step."""
    now: Now = memory.now[0]
    low, high = 0.0, now.h
    while high - low > 1e-15 * (now.time + high) and high - low > 1e-13 * now.h:
        middle = 0.5 * (low + high)
        if _attempt(surface, request, face, memory, middle) and memory.step[0].margins[STAGES - 1] < 0.0:
            high = middle
        else:
            low = middle
    _attempt(surface, request, face, memory, high)
    for i in range(STATE):
        memory.step[0].state[i] = memory.step[0].end[i]
    now.time += high
    now.verdict = end_reason(surface, request.part, face, memory, memory.step[0].stages[STAGES - 1])


@device_no_arrays
def _attempt(surface: Surface, request: Request, face: Face, memory: Memory, h: float) -> bool:
    """Try a step of h [s]: its stages, and its end; False where they are not found or leave their cells."""
    part, state, stages, b = request.part, memory.step[0].state, memory.step[0].stages, memory.balance[0]
    time, step = memory.now[0].time, memory.step[0]
    powers_ahead = STAGES if h <= LONGER * step.before else 2
    for k in range(STAGES):
        t = NODES[k] * h
        for i in range(3):
            guess = 0.0
            for j in range(powers_ahead - 1, -1, -1):
                guess = guess * t + step.lead[j, i] / (j + 1)
            stages[k, V_X + i] = state[V_X + i] + t * guess
    stiff, anew, before = h * step.friction > STIFF, True, math.inf
    small = FOUND * min(request.tolerance / request.stroke_time, RELATIVE * step.speed)
    for turn in range(PASSES):
        for i in range(3):
            b.gap[i] = step.gap[i]
        for k in range(STAGES):
            for i in range(3):
                total = 0.0
                for j in range(STAGES):
                    total += A[k, j] * stages[j, V_X + i]
                stages[k, X + i] = state[X + i] + h * total
            if not within_cells(memory.local, memory.under, face, stages[k, X], stages[k, Y], stages[k, HEADING]):
                return False
            if not settle(part, face, memory, stages[k], time + NODES[k] * h):
                return False
            speed = slip_speed(face, memory)
            if not speed > 0.0:
                return False
            if not find_rates(part, face, b.slip[0], b.slip[1], b.slip[2], b):
                return False
            for i in range(3):
                step.rates[k, i] = b.rates[i]
            stages[k, WORK], stages[k, LOSS] = powers(part, b)
            rim = rim_margin(surface, face, stages[k]) / surface.size
            step.margins[k] = min(contact_margin(part, face, memory, False), rim)
            if stiff and anew and not _fill_turns(request, face, memory, k):
                return False
        for k in range(STAGES):
            for i in range(3):
                total = 0.0
                for j in range(STAGES):
                    total += A[k, j] * step.rates[j, i]
                step.steps[3 * k + i] = h * total - (stages[k, V_X + i] - state[V_X + i])
        if stiff:
            if anew and not _factorise(step, h):
                return False
            _newton(step)
        largest = fastest = 0.0
        for k in range(STAGES):
            for i in range(3):
                unit = face.arm if i == 2 else 1.0
                stages[k, V_X + i] += step.steps[3 * k + i]
                largest = max(largest, unit * abs(step.steps[3 * k + i]))
                fastest = max(fastest, unit * abs(stages[k, V_X + i]))
        if not largest < 1e3 * surface.size / request.stroke_time:
            return False
        if (min(1.0, largest / before) if turn > 0 else 1.0) * largest <= max(small, 1e-14 * fastest):
            break
        if turn == PASSES - 1:
            return False
        anew, before = largest > SLOW * before, largest
    for i in range(STATE):
        step.end[i] = stages[STAGES - 1, i]
    for i in (WORK, LOSS):
        total = 0.0
        for j in range(STAGES):
            total += A[STAGES - 1, j] * stages[j, i]
        step.end[i] = state[i] + h * total
    for i in range(3):
        total = 0.0
        for j in range(STAGES):
            total += A[STAGES - 1, j] * stages[j, V_X + i]
        step.end[X + i] = state[X + i] + h * total
    return True


@inlined
def _fill_turns(request: Request, face: Face, memory: Memory, k: int) -> bool:
    """By how much a stage's acceleration changes with its rates as friction turns, into memory.step[0].turns[k]."""
    b = memory.balance[0]
    size = 1e-6 * slip_speed(face, memory)
    for j in range(3):
        step = size / face.arm if j == 2 else size
        s_1, s_2 = b.slip[0] + step * b.planar[0, j], b.slip[1] + step * b.planar[1, j]
        if not find_rates(request.part, face, s_1, s_2, b.slip[2] + step * b.planar[2, j], b):
            return False
        for i in range(3):
            memory.step[0].turns[k, i, j] = (b.rates[i] - memory.step[0].rates[k, i]) / step
    return True


@inlined
def _factorise(step: Step, h: float) -> bool:
    """The matrix of Newton's steps into step.system as the product L U, with pivots; False where it is singular."""
    m = step.system
    for k in range(STAGES):
        for i in range(3):
            row = 3 * k + i
            for j in range(STAGES):
                for n in range(3):
                    m[row, 3 * j + n] = -h * A[k, j] * step.turns[j, i, n]
            m[row, row] += 1.0
    for k in range(UNKNOWNS):
        pivot = k
        for i in range(k + 1, UNKNOWNS):
            if abs(m[i, k]) > abs(m[pivot, k]):
                pivot = i
        step.pivots[k] = pivot
        if m[pivot, k] == 0.0 or not math.isfinite(m[pivot, k]):
            return False
        if pivot != k:
            for j in range(UNKNOWNS):
                m[k, j], m[pivot, j] = m[pivot, j], m[k, j]
        top = m[k, k + 1 :]
        for i in range(k + 1, UNKNOWNS):
            m[i, k] /= m[k, k]
            factor, rest = m[i, k], m[i, k + 1 :]
            for j in range(len(rest)):
                rest[j] -= factor * top[j]
    return True


@inlined
def _newton(step: Step) -> None:
    """Turn the stages' residuals step.steps into Newton's steps, by step.system."""
    m, out = step.system, step.steps
    for k in range(UNKNOWNS):
        pivot = int(step.pivots[k])
        out[k], out[pivot] = out[pivot], out[k]
    for k in range(1, UNKNOWNS):
        for j in range(k):
            out[k] -= m[k, j] * out[j]
    for k in range(UNKNOWNS - 1, -1, -1):
        for j in range(k + 1, UNKNOWNS):
            out[k] -= m[k, j] * out[j]
        out[k] /= m[k, k]


@inlined
def _error(request: Request, face: Face, memory: Memory, h: float) -> float:
    """The step's error as a distance [m]; a turn counts at the mean distance from the face's origin.

    An error of a rate counts as what it moves the part by in the shortest stroke.
    """
    state, stages, m = memory.step[0].state, memory.step[0].stages, memory.balance[0].matrix
    stiff = h * memory.step[0].friction > STIFF
    for i in range(3):
        error = AT_START * memory.step[0].lead[0, i]
        for k in range(STAGES):
            error += DIFFERENCE[k] * memory.step[0].rates[k, i]
        m[i, 3] = h * error
        for j in range(3):
            m[i, j] = (1.0 if i == j else 0.0) - (h * AT_START * memory.step[0].turns[0, i, j] if stiff else 0.0)
    off = memory.step[0].steps  # (3,) of it
    if not solve(m, off[:3]):
        return math.inf
    total = 0.0
    for i in range(3):
        unit = face.arm if i == 2 else 1.0
        place = AT_START * state[V_X + i]
        for k in range(STAGES):
            place += DIFFERENCE[k] * stages[k, V_X + i]
        place = h * (place + AT_START * off[i])
        total += (unit * place) ** 2 + (unit * request.stroke_time * off[i]) ** 2
    return math.sqrt(total)
