"""Fixed steps in time, for comparison: Moreau's projection ("fixed") and the paper's own scheme ("paper").

Nothing is located: slips, stops and ends of contact come at the steps that they fall into, and a kink of a drive inside
a step counts from the next evaluation on. Only a part that leaves the plate is stopped at the rim.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from particle.events import (
    ENDS,
    FRICTION,
    GOES_ON,
    LACKS_CELL,
    LEFT_PLATE,
    LOAD,
    MODE,
    RESTING,
    REVERSES,
    SLIDING,
    SLIPS,
    STOPS,
    V_X,
    V_Y,
    Part,
    Record,
    Request,
    margin,
    new_record,
    note,
    reason,
    row_of,
    slope,
    write,
)
from particle.fixed.moreau import moreau_step
from particle.fixed.paper_scheme import paper_step
from particle.jit import jit
from particle.surface import UNBUILT, Local, SurfaceMotion, enter, fields, rim_gap

FloatArray = NDArray[np.float64]

MOREAU, PAPER = 0, 1
MOST_STEPS = 100_000_000
MOST_ROWS = 20_000  # besides those at events
FINE = 1e-4  # of the shortest stroke: the step unless one is given
HALVINGS = 50


def shortest_stroke(surface: SurfaceMotion, duration: float) -> float:
    """The time [s] of the shortest stroke of any drive, at most the run's duration."""
    return min(float(surface.drives.stroke_time.min(initial=math.inf)), float(duration))


def default_step(surface: SurfaceMotion, duration: float) -> float:
    """The time step [s] of a scheme of fixed steps unless one is given."""
    return FINE * shortest_stroke(surface, duration)


def step_count(duration: float, time_step: float) -> int:
    """How many steps of `time_step` [s], the last one cut, make up a duration [s].

    Raises ValueError when they are more than MOST_STEPS.
    """
    if duration > MOST_STEPS * time_step:
        raise ValueError(
            f"Input time_step of simulate must be at least {duration / MOST_STEPS:g} s, for at most {MOST_STEPS} steps "
            f"in {duration!r} s; got {time_step!r}, for {duration / time_step:.4g} steps"
        )
    return max(1, math.ceil(duration / time_step * (1 - 1e-12)))


@jit
def march_fixed(
    surface: Any, request: Request, local: Any, scheme: int, time_step: float, steps: int, every: int
) -> tuple[FloatArray, FloatArray, int, int]:
    """The path by `steps` steps of `time_step` [s], the last one cut at the duration; scheme: MOREAU or PAPER.

    Returns rows (n, COLUMNS), at one step in `every`, at events and at the end, events (m, EVENT_COLUMNS), how the path
    ended, and evaluations of the surface. Where a cell is lacking it ends, and must begin anew when there is one.
    """
    part, end = request.part, request.duration
    record = new_record()
    # x, y, v_x, v_y, work, dissipation, -, the velocity's z component relative to the surface (PAPER)
    state, after = np.zeros(8), np.zeros(8)
    state[:4] = request.start
    mode = RESTING if state[2] == 0.0 and state[3] == 0.0 else SLIDING
    time, gap, verdict, count = 0.0, rim_gap(surface, state[0], state[1]), GOES_ON, 0
    cell = enter(surface, local, state[0], state[1], time, math.inf)
    if cell == UNBUILT:
        return record.rows[:0], record.events[:0], LACKS_CELL, count
    if cell >= 0:
        f = fields(local, state[0], state[1], time)
        state[7] = state[2] * f.x + state[3] * f.y
    record = write(record, fixed_row(local, part, scheme, mode, time, state))
    for n in range(steps):
        begin, until = n * time_step, (n + 1) * time_step if n + 1 < steps else end
        h = until - begin
        ahead = 0.5 * h if scheme == MOREAU else 0.0
        time = begin + ahead
        gap, share = move(surface, gap, state, ahead * state[2], ahead * state[3])
        cell = enter(surface, local, state[0], state[1], time, math.inf)
        if cell == UNBUILT:
            verdict = LACKS_CELL
            break
        if share < 1.0 or cell < 0:
            time, verdict = begin + share * ahead, LEFT_PLATE
            break
        f = fields(local, state[0], state[1], time)
        count += 1
        before = mode
        if scheme == MOREAU:
            mode, load, way_x, way_y = moreau_step(f, part, h, before, state, after)
        else:
            mode, load, way_x, way_y = paper_step(f, part, h, before, state, after)
        if margin(local, part, load, surface.size) < 0.0:
            mode, verdict = before, reason(surface, part, load, state)
            break
        if before == RESTING and mode == SLIDING:
            record = _note(record, SLIPS, fixed_row(local, part, scheme, mode, begin, state))
        event = -1
        if before == SLIDING and mode == RESTING:
            a = slope(f, part)
            event = STOPS
            if a.demand > part.law.static_ratio * a.limit:
                mode, event = SLIDING, REVERSES
        # A path that turns by more than a right angle within one step is not told from one that turns back.
        elif before == SLIDING and after[2] * state[2] + after[3] * state[3] < 0.0:
            event = REVERSES
        state[2:] = after[2:]
        gap, share = move(surface, gap, state, way_x, way_y)
        cell = enter(surface, local, state[0], state[1], until, math.inf)
        if cell == UNBUILT:
            verdict = LACKS_CELL
            break
        if share < 1.0 or cell < 0:
            time, verdict = time + share * (until - time), LEFT_PLATE
            break
        time = until
        if event >= 0 or (n + 1) % every == 0 or n + 1 == steps:
            row = fixed_row(local, part, scheme, mode, time, state)
            record = _note(record, event, row) if event >= 0 else write(record, row)
    if verdict not in (GOES_ON, LACKS_CELL):
        enter(surface, local, state[0], state[1], time, math.inf)
        record = _note(record, ENDS + verdict, fixed_row(local, part, scheme, mode, time, state))
    return record.rows[: record.counts[0]], record.events[: record.counts[1]], verdict, count


@jit
def fixed_row(local: Local, part: Part, scheme: int, mode: int, time: float, state: FloatArray) -> FloatArray:
    """The row (COLUMNS,) of a state; loads of the paper's scheme are its own, those of a part at rest."""
    row = row_of(local, part, mode, time, state)
    if scheme == PAPER:
        a = slope(fields(local, state[0], state[1], time), part)
        row[LOAD], row[FRICTION] = a.load, part.mass * (a.demand if row[MODE] == RESTING else a.limit)
    return row


@jit
def move(surface: Any, gap: float, state: FloatArray, way_x: float, way_y: float) -> tuple[float, float]:
    """Moves `state` by a straight way [m], at most to the rim; `gap` [m], at most the distance from it, saves looking.

    Returns the new gap and the share of the way that was gone, less than 1 where the rim is in it.
    """
    x, y = state[0], state[1]
    gap -= math.hypot(way_x, way_y)
    state[0], state[1] = x + way_x, y + way_y
    if gap > 0.0:
        return gap, 1.0
    gap = rim_gap(surface, state[0], state[1])
    if gap >= 0.0:
        return gap, 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if rim_gap(surface, x + middle * way_x, y + middle * way_y) < 0.0:
            high = middle
        else:
            low = middle
    # Just on the plate, so that a way which ends within a rounding of the rim counts as crossing it, too.
    state[0], state[1] = x + low * way_x, y + low * way_y
    return 0.0, low


@jit
def _note(record: Record, kind: int, row: FloatArray) -> Record:
    return note(write(record, row), kind, row, math.hypot(row[V_X], row[V_Y]))
