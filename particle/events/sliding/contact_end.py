"""Where the contact of a sliding part ends: beyond the rim, below pull-off or above the largest load."""

from __future__ import annotations

from particle.events.mechanics import Counts, Motion, Now, Part, margin
from particle.events.memory import Memory
from particle.events.request import Request
from particle.events.sliding.manifold import MAX_TOUCH
from particle.events.sliding.runge_kutta import attempt, first_excursion
from particle.events.tableau import Tableau
from particle.jit import device_no_arrays, inlined
from particle.modes import Verdict
from particle.surface import Surface, first_beyond, rim_gap


@inlined
def stays_in_contact(surface: Surface, request: Request, pair: Tableau, memory: Memory) -> bool:
    """Whether contact lasts over the step that was tried; if not, it is to be tried shorter, or the path has ended."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    step, h, last = memory.step, now.h, len(pair.c) - 1
    end, start_rate, end_rate = step.end[0], step.rates[0], step.rates[last]
    on_plate = first_beyond(
        surface,
        now.gap,
        (motion.x, motion.y),
        (end.x, end.y),
        (start_rate.x, start_rate.y),
        (end_rate.x, end_rate.y),
        h,
    )
    # A path that leaves and comes back ends where it first leaves; where it ends beyond, the end is located below.
    if on_plate < (0.9 if step.margins[last] < 0.0 else 1.0):
        now.h = h * on_plate
        return False
    if step.margins[last] < 0.0:
        h = _locate_end(surface, request.part, pair, memory)
        memory.motion[0] = step.end[0]
        now.time, now.h, now.verdict = now.time + h, h, end_reason(surface, request.part, step.loads[last], motion)
        return False
    for k in range(1, last):
        if step.margins[k] < 0.0:
            now.h = 0.5 * h
            return False
    share = first_excursion(request.part, pair, step)
    if share < 1.0 and h > MAX_TOUCH * request.stroke_time:
        now.h = h * share
        return False
    return True


@inlined
def _locate_end(surface: Surface, part: Part, pair: Tableau, memory: Memory) -> float:
    """The step that ends where contact does, just beyond it: a bracket that secants (Illinois) and halving close."""
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    step, time, h, last = memory.step, now.time, now.h, len(pair.c) - 1
    low, high = 0.0, h
    below, above = step.margins[last], margin(memory.local, part, step.loads[0], now.gap)
    secant = True
    while True:
        located = not (high - low > 1e-15 * (time + high) and high - low > 1e-14 * h)
        middle = high if located else 0.5 * (low + high)
        if secant and above > 0.0 and not located:
            share = above / (above - below)
            # Never quite at an end, lest the other one stay for ever.
            middle = low + min(max(share, 1e-6), 1.0 - 1e-6) * (high - low)
        counts.evaluations += len(pair.c)
        good = attempt(surface, part, pair, memory, middle)
        if located:
            return high
        width = high - low
        if good and step.margins[last] < 0.0:
            high, below, above = middle, step.margins[last], 0.5 * above
        else:
            low, above, below = middle, (step.margins[last] if good else 0.0), 0.5 * below
        secant = high - low < 0.5 * width


@device_no_arrays
def end_reason(surface: Surface, part: Part, load: float, motion: Motion) -> int:
    """Why contact ends where the margin is negative."""
    if rim_gap(surface, motion.x, motion.y) < 0.0:
        return Verdict.LEFT_PLATE
    if load < -part.law.pull_off:
        return Verdict.DETACHED
    return Verdict.OVERLOADED
