"""Fixed steps in time, for comparison: Moreau's projection ("fixed") and the paper's own scheme ("paper").

Nothing is located: slips, stops and ends of contact come at the steps that they fall into, and a breakpoint of a drive
inside a step counts from the next evaluation on. Only a part that leaves the plate is stopped at the rim.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numpy.typing import NDArray

from particle.events import (
    Counts,
    Motion,
    Now,
    Part,
    PathRecord,
    Request,
    Row,
    end_reason,
    fill_row,
    margin,
    note,
    rest_pull,
    with_room,
    write,
)
from particle.fixed.moreau import moreau_step
from particle.fixed.paper_scheme import paper_step
from particle.group import grouped
from particle.jit import device, inlined, jit
from particle.modes import END_EVENTS, NO_EVENT, EventKind, Mode, Verdict
from particle.records import new_records
from particle.surface import (
    UNBUILT,
    LocalSurface,
    Surface,
    SurfaceMotion,
    SurfacePoint,
    enter,
    new_local,
    rim_gap,
    surface_at,
)

MOREAU, PAPER = 0, 1
MAX_STEPS = 100_000_000
MAX_ROWS = 20_000  # besides those at events
FINE = 1e-4  # of the shortest stroke: the step unless one is given
HALVINGS = 50


def shortest_stroke(surface: SurfaceMotion, duration: float) -> float:
    """The time [s] of the surface's shortest stroke, at most the run's duration."""
    return min(float(surface.stroke_times.min(initial=math.inf)), float(duration))


def default_step(surface: SurfaceMotion, duration: float) -> float:
    """The time step [s] of a scheme of fixed steps unless one is given."""
    return FINE * shortest_stroke(surface, duration)


def step_count(duration: float, time_step: float) -> int:
    """How many steps of `time_step` [s], the last one cut, make up a duration [s].

    Raises ValueError when they are more than MAX_STEPS.
    """
    if duration > MAX_STEPS * time_step:
        raise ValueError(
            f"Input time_step of simulate must be at least {duration / MAX_STEPS:g} s, for at most {MAX_STEPS} steps "
            f"in {duration!r} s; got {time_step!r}, for {duration / time_step:.4g} steps"
        )
    return max(1, math.ceil(duration / time_step * (1 - 1e-12)))


@grouped
class FixedMemory(NamedTuple):
    """Scratch memory of a path by fixed steps."""

    local: LocalSurface
    motion: NDArray[Motion]  # (1,), v_z that of the velocity relative to the surface (PAPER)
    after: NDArray[Motion]  # (1,) velocity and energies at the end of a step
    now: NDArray[Now]  # (1,)
    counts: NDArray[Counts]  # (1,)
    row: NDArray[Row]  # (1,)


def new_fixed_memory(surface: Surface) -> FixedMemory:
    """Scratch memory that fits the surface as far as its cells are built."""
    now, counts, row = new_records(Now), new_records(Counts), new_records(Row)
    return FixedMemory(new_local(surface), new_records(Motion), new_records(Motion), now, counts, row)


@jit
def march_fixed(
    surface: Surface,
    request: Request,
    memory: FixedMemory,
    record: PathRecord,
    scheme: int,
    time_step: float,
    steps: int,
    every: int,
) -> PathRecord:
    """The path by `steps` steps of `time_step` [s], the last one cut at the duration; scheme: MOREAU or PAPER.

    Rows at one step in `every`, at events and at the end go to `record`; memory.now says how the path ended,
    memory.counts what it took. Where a cell is lacking it ends, and must begin anew when there is one.
    """
    now: Now = memory.now[0]
    counts: Counts = memory.counts[0]
    motion: Motion = memory.motion[0]
    after: Motion = memory.after[0]
    local, part = memory.local, request.part
    _begin(surface, request, memory)
    if now.verdict != Verdict.GOES_ON:
        return record
    gap = rim_gap(surface, motion.x, motion.y)
    record = _write(memory, part, scheme, record, NO_EVENT)
    for n in range(steps):
        begin, until = n * time_step, (n + 1) * time_step if n + 1 < steps else request.duration
        h = until - begin
        ahead = 0.5 * h if scheme == MOREAU else 0.0
        now.time = begin + ahead
        gap, share = move(surface, gap, motion, ahead * motion.v_x, ahead * motion.v_y)
        if not _enter(surface, memory, now.time, share):
            now.time = begin + share * ahead
            break
        f = surface_at(local, motion.x, motion.y, now.time)
        counts.evaluations += 1
        before = now.mode
        if scheme == MOREAU:
            mode, load, way_x, way_y = moreau_step(f, part, h, before, motion, after)
        else:
            mode, load, way_x, way_y = paper_step(f, part, h, before, motion, after)
        if margin(local, part, load, surface.size) < 0.0:
            now.verdict = end_reason(surface, part, load, motion)
            break
        now.mode = mode
        if before == Mode.RESTING and mode == Mode.SLIDING:
            now.time = begin
            record = _write(memory, part, scheme, record, EventKind.SLIPS)
            now.time = begin + ahead
        event = _find_event(part, memory, f, before)
        motion.v_x, motion.v_y, motion.v_z = after.v_x, after.v_y, after.v_z
        motion.work, motion.dissipated = after.work, after.dissipated
        gap, share = move(surface, gap, motion, way_x, way_y)
        if not _enter(surface, memory, until, share):
            now.time += share * (until - now.time)
            break
        now.time = until
        if event != NO_EVENT or (n + 1) % every == 0 or n + 1 == steps:
            record = _write(memory, part, scheme, record, event)
    if now.verdict != Verdict.GOES_ON and now.verdict != Verdict.LACKS_CELL:
        enter(surface, local, motion.x, motion.y, now.time, math.inf)
        record = _write(memory, part, scheme, record, END_EVENTS + now.verdict)
    return record


@inlined
def _begin(surface: Surface, request: Request, memory: FixedMemory) -> None:
    """The part at its start."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    motion.x, motion.y, motion.v_x, motion.v_y = request.start[0], request.start[1], request.start[2], request.start[3]
    now.mode = Mode.RESTING if motion.v_x == 0.0 and motion.v_y == 0.0 else Mode.SLIDING
    cell = enter(surface, memory.local, motion.x, motion.y, now.time, math.inf)
    if cell == UNBUILT:
        now.verdict = Verdict.LACKS_CELL
    elif cell >= 0:
        f = surface_at(memory.local, motion.x, motion.y, now.time)
        motion.v_z = motion.v_x * f.w_x + motion.v_y * f.w_y


@device
def _enter(surface: Surface, memory: FixedMemory, time: float, share: float) -> bool:
    """Prepares the surface around the part; False where the path ends, as it has gone a `share` of its way only."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    cell = enter(surface, memory.local, motion.x, motion.y, time, math.inf)
    if cell == UNBUILT:
        now.verdict = Verdict.LACKS_CELL
    elif share < 1.0 or cell < 0:
        now.verdict = Verdict.LEFT_PLATE
    return now.verdict == Verdict.GOES_ON


@inlined
def _find_event(part: Part, memory: FixedMemory, f: SurfacePoint, before: int) -> int:
    """What has happened to a part that slid before the step: STOPS, REVERSES or NO_EVENT."""
    now: Now = memory.now[0]
    motion: Motion = memory.motion[0]
    after: Motion = memory.after[0]
    if before == Mode.SLIDING and now.mode == Mode.RESTING:
        a = rest_pull(f, part)
        if a.demand <= part.law.static_ratio * a.limit:
            return EventKind.STOPS.value
        now.mode = Mode.SLIDING
        return EventKind.REVERSES.value
    # A path that turns by more than a right angle within one step looks like one that turns back.
    if before == Mode.SLIDING and after.v_x * motion.v_x + after.v_y * motion.v_y < 0.0:
        return EventKind.REVERSES.value
    return NO_EVENT


@device
def _write(memory: FixedMemory, part: Part, scheme: int, record: PathRecord, event: int) -> PathRecord:
    """The record with the part's row, and with an event there."""
    now: Now = memory.now[0]
    row: Row = memory.row[0]
    fill_fixed_row(memory.local, part, scheme, now.mode, now.time, memory.motion[0], row)
    record = with_room(record)
    write(record, row)
    if event != NO_EVENT:
        note(record, event, row)
    return record


@device
def fill_fixed_row(
    local: LocalSurface, part: Part, scheme: int, mode: int, time: float, motion: Motion, row: Row
) -> None:
    """The row of a motion into `row`; loads of the paper's scheme are its own, those of a part at rest."""
    fill_row(local, part, mode, time, motion, row)
    if scheme == PAPER:
        a = rest_pull(surface_at(local, motion.x, motion.y, time), part)
        row.load, row.friction = a.load, part.mass * (a.demand if row.mode == Mode.RESTING else a.limit)


@device
def move(surface: Surface, gap: float, motion: Motion, way_x: float, way_y: float) -> tuple[float, float]:
    """Moves `motion` by a straight way [m], at most to the rim; `gap` [m], at most the distance from it, saves looking.

    Returns the new gap and the share of the way that was gone, less than 1 where the rim is in it.
    """
    x, y = motion.x, motion.y
    gap -= math.hypot(way_x, way_y)
    motion.x, motion.y = x + way_x, y + way_y
    if gap > 0.0:
        return gap, 1.0
    gap = rim_gap(surface, motion.x, motion.y)
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
    motion.x, motion.y = x + low * way_x, y + low * way_y
    return 0.0, low
