"""From a request to the path that answers it, and from that to a trajectory."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from particle.events import (
    DETACHED,
    GOES_ON,
    INTERRUPTED,
    LACKS_CELL,
    LEFT_PLATE,
    OVERLOADED,
    WORK_LIMIT,
    Memory,
    Pairs,
    Part,
    Request,
    X,
    Y,
    forget,
    march,
    new_memory,
    pairs_for,
    resume,
    stays,
)
from particle.fixed import between, march_fixed
from particle.surface import Surface, SurfaceMotion, missing_place, new_local
from particle.trajectory import Event, EventKind, Outcome, State, Trajectory, energy_of, samples_of

FloatArray = NDArray[np.float64]
Found = tuple[FloatArray, FloatArray, int, int]  # rows, events, how it ended, evaluations

_OUTCOMES = {
    DETACHED: Outcome.DETACHED,
    LEFT_PLATE: Outcome.LEFT_PLATE,
    OVERLOADED: Outcome.OVERLOADED,
    WORK_LIMIT: Outcome.WORK_LIMIT,
}


class _Scratch(threading.local):
    """The scratch memory of the last path on each thread, which serves the next one that needs as much."""

    measures: tuple[int, ...] = ()
    memory: Memory


_scratch = _Scratch()


def _memory(record: Surface, pairs: Pairs, stop: NDArray[np.int64]) -> Memory:
    """Scratch memory for a path over the surface."""
    cells = record.cells
    measures = cells.highest, cells.most_near, cells.most_drives, len(pairs.long.c)
    if _scratch.measures == measures:
        memory = _scratch.memory._replace(stop=stop)
        forget(record, memory)
        return memory
    _scratch.measures, _scratch.memory = measures, new_memory(record, pairs, stop)
    return _scratch.memory


def find_path(
    surface: SurfaceMotion, request: Request, tolerance: float, stop: NDArray[np.int64] | None = None
) -> Trajectory | None:
    """The path by located events; None when it was interrupted by `stop` (1,), which another thread may set to 1.

    tolerance: relative to the surface's size.
    """
    pairs, stop = pairs_for(tolerance), np.zeros(1, dtype=np.int64) if stop is None else stop

    def path(record: Surface) -> tuple[Found, FloatArray]:
        memory = _memory(record, pairs, stop)
        return march(record, request, pairs, memory), missing_place(memory.local)

    found = _with_cells(surface, path)
    rows, _, verdict, _ = found
    if verdict == INTERRUPTED:
        return None
    trajectory = _trajectory(surface, request, found, partial(_by_events, surface, request, pairs, rows))
    if trajectory.outcome is Outcome.STUCK:
        x, y = trajectory.position[-1].tolist()
        future = partial(stays, surface, request.part, x, y, request.duration)
        trajectory = replace(trajectory, future=future)
    return trajectory


def find_path_by_steps(
    surface: SurfaceMotion, request: Request, kind: int, step: float, steps: int, every: int
) -> Trajectory:
    """The path by a scheme of fixed steps [s], of which one in `every` is kept."""

    def path(record: Surface) -> tuple[Found, FloatArray]:
        local = new_local(record)
        return march_fixed(record, request, local, kind, step, steps, every), missing_place(local)

    found = _with_cells(surface, path)
    return _trajectory(surface, request, found, partial(_by_steps, surface, request.part, kind, found[0]))


def _by_events(
    surface: SurfaceMotion, request: Request, pairs: Pairs, rows: FloatArray, times: FloatArray
) -> FloatArray:
    """The rows at ascending times [s]."""
    return resume(surface.record, request, pairs, rows, times)


def _by_steps(surface: SurfaceMotion, part: Part, kind: int, rows: FloatArray, times: FloatArray) -> FloatArray:
    """The rows at ascending times [s]."""
    samples, missing = between(surface.record, part, kind, rows, times)
    if missing.any():
        surface.store.build(samples[missing][:, [X, Y]])
        samples, _ = between(surface.record, part, kind, rows, times)
    return samples


def _with_cells(surface: SurfaceMotion, path: Callable[[Surface], tuple[Found, FloatArray]]) -> Found:
    """A path over the surface, found anew whenever it has come to a place where a cell was lacking."""
    while True:
        found, missing = path(surface.record)
        if found[2] != LACKS_CELL:
            return found
        surface.store.build(missing)


def _trajectory(
    surface: SurfaceMotion, request: Request, found: Found, sampler: Callable[[FloatArray], FloatArray]
) -> Trajectory:
    rows, events, verdict, evaluations = found
    samples = samples_of(rows)
    if verdict == GOES_ON:
        outcome = Outcome.STUCK if samples.state[-1] == State.STICK else Outcome.MOVING
    else:
        outcome = _OUTCOMES[verdict]
    return Trajectory(
        *samples,
        events=[Event(EventKind(int(k)), t, (x, y), speed, load) for k, t, x, y, speed, load in events.tolist()],
        outcome=outcome,
        evaluations=evaluations,
        energy=energy_of(rows, request.force * surface.size),
        sampler=sampler,
    )
