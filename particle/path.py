"""From a request to the path that answers it, and from that to a trajectory."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from particle.body import Face, face_states, march_body, new_body_memory
from particle.drives import horizon
from particle.events import (
    Memory,
    Motion,
    Pairs,
    PathRecord,
    Request,
    clear_memory,
    contact_states,
    march,
    new_memory,
    new_record,
    pairs_for,
)
from particle.fixed import between, march_fixed, new_fixed_memory
from particle.modes import EventKind, Mode, Outcome, State, Verdict
from particle.samples import Event, samples_of
from particle.surface import Surface, SurfaceMotion, missing_place
from particle.trajectory import Energy, Trajectory
from particle.types import BoolArray, FloatArray, IntArray

Rows = NDArray[Any]  # of `Row`


class Computed(NamedTuple):
    """What a kernel has made of a request."""

    rows: Rows
    events: NDArray[Any]  # of `EventRow`
    verdict: int
    evaluations: int
    missing: FloatArray  # (1, 2) m, where a cell is lacking


_OUTCOMES = {
    Verdict.DETACHED: Outcome.DETACHED,
    Verdict.LEFT_PLATE: Outcome.LEFT_PLATE,
    Verdict.OVERLOADED: Outcome.OVERLOADED,
    Verdict.TIPPED: Outcome.TIPPED,
    Verdict.WORK_LIMIT: Outcome.WORK_LIMIT,
}


_under_way: dict[int, tuple[NDArray[Any], float]] = {}  # on each thread: where a path is, and until when it goes


def under_way() -> tuple[float, float] | None:
    """How far [s] the path that lags most has come, and its end [s]; None: none is followed."""
    return min(((float(now["time"][0]), until) for now, until in list(_under_way.values())), default=None)


@contextmanager
def seen(now: NDArray[Any], until: float) -> Iterator[None]:
    """Shows a path to `under_way` in its block."""
    _under_way[threading.get_ident()] = now, until
    try:
        yield
    finally:
        del _under_way[threading.get_ident()]


class _Scratch(threading.local):
    """The scratch memory of the last path on each thread, which serves the next one that needs as much."""

    measures: tuple[int, ...] = ()
    memory: Memory


_scratch = _Scratch()


def _memory(surface: Surface, pairs: Pairs, stop: IntArray) -> Memory:
    """Scratch memory for a path over the surface."""
    sizes = surface.cells.grid[0].item()[4:]
    measures = *sizes, surface.in_plane_count, len(pairs.long.c)
    if _scratch.measures != measures:
        _scratch.measures, _scratch.memory = measures, new_memory(surface, pairs, stop)
        return _scratch.memory
    clear_memory(surface, _scratch.memory)
    return _scratch.memory._replace(stop=stop)


def find_path(
    surface: SurfaceMotion,
    request: Request,
    tolerance: float,
    stop: IntArray | None = None,
    face: Face | None = None,
) -> Trajectory | None:
    """The path by located events; None when it was interrupted by `stop` (1,), which another thread may set to 1.

    tolerance: relative to the surface's size.  face: of a part that has one.
    """
    pairs, stop = pairs_for(tolerance), np.zeros(1, dtype=np.int64) if stop is None else stop
    if face is not None:
        return _face_path(surface, request, face, stop)

    def path(record: Surface) -> Computed:
        memory = _memory(record, pairs, stop)
        with seen(memory.now, request.until):
            return computed_of(march(record, request, pairs, memory, new_record()), memory)

    computed = with_cells(surface, path)
    if computed.verdict == Verdict.INTERRUPTED:
        return None
    sampler = partial(_by_events, surface, request, pairs, computed.rows)
    trajectory = trajectory_of(surface, request, computed, sampler, partial(_contact_states, surface, request))
    if trajectory.outcome is Outcome.STUCK:
        x, y = trajectory.position[-1].tolist()
        future = partial(_stays, surface, request, pairs, x, y)
        trajectory = replace(trajectory, future=future)
    return trajectory


def _face_path(surface: SurfaceMotion, request: Request, face: Face, stop: IntArray) -> Trajectory | None:
    """As `find_path`, of a part with a face."""

    def path(record: Surface, asked: Request = request) -> Computed:
        memory = new_body_memory(record, face, stop)
        with seen(memory.now, asked.until):
            return computed_of(march_body(record, asked, face, memory, new_record()), memory)

    computed = with_cells(surface, path)
    if computed.verdict == Verdict.INTERRUPTED:
        return None
    rows = computed.rows
    if computed.verdict == Verdict.JUMPS:
        at = float(rows["time"][-1])
        raise ValueError(
            f"Input surface of simulate must move without jumps of velocity under a Body; got one at {at:g} s"
        )

    def sampler(times: FloatArray) -> Rows:
        """The rows at ascending times [s]: pieces of the path, each from the row before."""
        places = np.searchsorted(rows["time"], times, side="right") - 1
        found, record, over = rows[places], new_record(), surface.record
        memory = new_body_memory(over, face, np.zeros(1, dtype=np.int64))
        for k in np.flatnonzero((times > found["time"]) & (places + 1 < len(rows))):
            row = found[k]
            start = [row[name] for name in ("x", "y", "heading", "v_x", "v_y", "spin", "work", "dissipated")]
            begin, until, mode = float(row["time"]), float(times[k]), int(row["mode"])
            step = until - begin
            piece = request._replace(start=np.array(start), mode=mode, begin=begin, until=until, first_step=step)
            memory.counts[0] = record.lengths[0] = 0
            done = march_body(over, piece, face, memory, record)
            found[k] = done.rows[done.lengths[0]["rows"] - 1]
        return found

    def contact(rows: Rows) -> Rows:
        """Where contact and centre of mass are at rows of the path, and what acts there."""
        memory = new_body_memory(surface.record, face, np.zeros(1, dtype=np.int64))
        return face_states(surface.record, request, face, memory, rows, np.zeros((0, 3)))

    trajectory = trajectory_of(surface, request, computed, sampler, contact, face)
    if trajectory.outcome is Outcome.STUCK:
        trajectory = replace(trajectory, future=partial(_face_stays, surface, request, face, trajectory))
    return trajectory


def find_path_by_steps(
    surface: SurfaceMotion, request: Request, kind: int, step: float, steps: int, every: int
) -> Trajectory:
    """The path by a scheme of fixed steps [s], of which one in `every` is kept."""

    def path(record: Surface) -> Computed:
        memory = new_fixed_memory(record)
        with seen(memory.now, request.until):
            return computed_of(march_fixed(record, request, memory, new_record(), kind, step, steps, every), memory)

    computed = with_cells(surface, path)
    sampler = partial(_by_steps, surface, request, kind, computed.rows)
    return trajectory_of(surface, request, computed, sampler, partial(_contact_states, surface, request))


def computed_of(record: PathRecord, memory: Any) -> Computed:
    lengths, now = record.lengths[0], memory.now[0]
    return Computed(
        rows=record.rows[: lengths["rows"]],
        events=record.events[: lengths["events"]],
        verdict=int(now.verdict),
        evaluations=int(memory.counts[0].evaluations),
        missing=missing_place(memory.local),
    )


def _face_stays(surface: SurfaceMotion, request: Request, face: Face, trajectory: Trajectory) -> bool | None:
    """As `_stays`, of a part with a face."""
    assert trajectory.heading is not None
    end = _end_of_change(surface, request)
    if end is None:
        return None
    start = np.array([*trajectory.position[-1], trajectory.heading[-1], *np.zeros(5)])
    rest = request._replace(start=start, mode=int(Mode.RESTING), begin=request.duration, until=end, duration=end)
    memory = new_body_memory(surface.record, face, np.zeros(1, dtype=np.int64))
    record = march_body(surface.record, rest, face, memory, new_record())
    return bool(memory.now[0].verdict == Verdict.GOES_ON and record.lengths[0]["events"] == 0)


def _end_of_change(surface: SurfaceMotion, request: Request) -> float | None:
    """Until when [s] a resting part is looked at to see that it stays; None: that is not known."""
    after = None if (surface.drives.jump[:, 0] > 0).any() else horizon(surface.drives, request.duration)
    if after is None:
        return None
    return after + (0.0 if np.isinf(surface.drives.repeats).any() else 1.0)  # 1 s, to look at the surface at rest


def _stays(surface: SurfaceMotion, request: Request, pairs: Pairs, x: float, y: float) -> bool | None:
    """Whether a part that rests at (x, y) [m] at the end of the path does so for ever.

    None where that is not known: as for `horizon`, or where a drive's velocity jumps.
    """
    if (end := _end_of_change(surface, request)) is None:
        return None
    start = np.array([x, y, *np.zeros(6)])
    rest = request._replace(start=start, mode=int(Mode.RESTING), begin=request.duration, until=end, duration=end)
    memory = _memory(surface.record, pairs, np.zeros(1, dtype=np.int64))
    march(surface.record, rest._replace(only_rests=True), pairs, memory, new_record())
    return bool(memory.now[0].mode == Mode.RESTING and memory.now[0].verdict == Verdict.GOES_ON)


def _by_events(surface: SurfaceMotion, request: Request, pairs: Pairs, rows: Rows, times: FloatArray) -> Rows:
    """The rows at ascending times [s]: pieces of the path, each from the row before."""
    places = np.searchsorted(rows["time"], times, side="right") - 1
    found, record, out = rows[places], surface.record, new_record()
    memory = _memory(record, pairs, np.zeros(1, dtype=np.int64))
    between = (times > found["time"]) & (places + 1 < len(rows))
    for k in np.flatnonzero(between):
        row, time = found[k], float(times[k])
        piece = request._replace(
            start=np.array([row[name] for name in Motion.__annotations__]),
            mode=int(row["mode"]),
            begin=float(row["time"]),
            until=time,
            first_step=time - float(row["time"]),
        )
        clear_memory(record, memory)
        out.lengths[0] = 0
        done = march(record, piece, pairs, memory, out)
        found[k] = done.rows[done.lengths[0]["rows"] - 1]
    return found


def _by_steps(surface: SurfaceMotion, request: Request, kind: int, rows: Rows, times: FloatArray) -> Rows:
    """The rows at ascending times [s]."""

    def sample() -> tuple[Rows, BoolArray]:
        record = surface.record
        return between(record, request.part, new_fixed_memory(record), kind, rows, times)

    samples, missing = sample()
    if missing.any():
        surface.store.build(np.column_stack([samples["x"], samples["y"]])[missing])
        samples, _ = sample()
    return samples


def _contact_states(surface: SurfaceMotion, request: Request, rows: Rows) -> Rows:
    """Where contact and centre of mass are at rows of the path, and what acts there."""
    contact = surface.half_thickness
    points = surface.samples(np.column_stack([rows["x"], rows["y"]]), np.ascontiguousarray(rows["time"]))
    drags = np.full(len(rows), request.part.drag)
    return contact_states(points, request.part, contact, contact + request.centre_height, rows, drags)


def with_cells(surface: SurfaceMotion, path: Callable[[Surface], Computed]) -> Computed:
    """A path over the surface, computed anew whenever it has come to a place where a cell was lacking."""
    while True:
        computed = path(surface.record)
        if computed.verdict != Verdict.LACKS_CELL:
            return computed
        surface.store.build(computed.missing)


def trajectory_of(
    surface: SurfaceMotion,
    request: Request,
    computed: Computed,
    sampler: Callable[[FloatArray], Rows],
    contact: Callable[[Rows], Rows],
    face: Face | None = None,
    film: bool = False,
) -> Trajectory:
    """What a kernel has made of a request, for people; film: whether a film of air bears load."""
    rows = computed.rows
    samples = samples_of(rows, face is not None, film)
    if computed.verdict == Verdict.GOES_ON:
        outcome = Outcome.STUCK if samples.state[-1] == State.STICK else Outcome.MOVING
    else:
        outcome = _OUTCOMES[Verdict(computed.verdict)]
    return Trajectory(
        **samples._asdict(),
        events=[
            Event(EventKind(kind), time, (x, y), speed, load, heading if face else None)
            for kind, time, x, y, speed, load, heading in computed.events.tolist()
        ],
        outcome=outcome,
        evaluations=computed.evaluations,
        energy=Energy(
            rows["kinetic"], rows["potential"], rows["work"], rows["dissipated"], request.force * surface.size
        ),
        sampler=sampler,
        contact=contact,
    )
