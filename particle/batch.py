"""simulate_many: many paths over one surface, side by side."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent import futures
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from queue import Empty, SimpleQueue

import numpy as np

from particle.body import Body
from particle.drives import AnyDrive
from particle.friction import Contact
from particle.interrupt import wait
from particle.simulation import Micropart, faults, is_law, law_faults, new_request, part_faults, path_of
from particle.surface import SurfaceMotion
from particle.trajectory import Trajectory

PATIENCE = 0.5  # s that threads have to stop


class Interrupted(KeyboardInterrupt):
    """Ctrl-C while paths were found. `found` has those that were done, None in place of the others."""

    def __init__(self, found: list[Trajectory | None]) -> None:
        super().__init__(f"stopped after {sum(path is not None for path in found)} of {len(found)} paths")
        self.found = found


def simulate_many(
    surface: SurfaceMotion,
    parts: Sequence[Micropart | Body],
    friction: Contact | Iterable[Contact],
    duration: float,
    gravity: float | Sequence[float] = 9.80665,
    tolerance: float = 1e-9,
    after_detachment: str = "stop",
    drives: Sequence[Sequence[AnyDrive]] | None = None,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    after_tipping: str = "stop",
) -> list[Trajectory]:
    """Follow many parts by located events, with the same bits as from `simulate` for any number of threads.

    Other parameters are those of `simulate`. Ctrl-C takes effect within a second, whatever the threads still compile
    or build.

    Parameters
    ----------
    surface : SurfaceMotion
        The moving surface.
    parts : sequence of Micropart or Body
        The parts.
    friction : friction law or sequence of them
        One for all, or one for each part.
    duration : float
        Length of each run, s.
    drives : sequence, optional
        For each part one drive for each actuator; by default the surface's own.
    threads : int, optional
        Number of paths at a time, by default one on each processor.
    progress : callable, optional
        Called with the number of finished paths, and of all.

    Returns
    -------
    trajectories : list of Trajectory
        One for each part.

    Raises
    ------
    ValueError
        An input makes no sense; names each, with the part's number.
    Interrupted
        Ctrl-C, a KeyboardInterrupt whose `found` has the finished paths.
    """
    frictions, wrong = _laws(friction, len(parts))
    if drives is not None:
        if len(drives) != len(parts):
            wrong.append(f"Input drives of simulate_many must be one row a part, {len(parts)}; got {len(drives)}")
        wrong += surface.drive_faults({f"drives of part {k}": own for k, own in enumerate(drives)})
    if threads is not None and threads < 1:
        wrong.append(f"Input threads of simulate_many must be at least 1; got {threads!r}")
    wrong += faults(surface, duration, gravity, tolerance, after_detachment, after_tipping)
    wrong += [fault for k, part in enumerate(parts) for fault in part_faults(surface, part, f"part {k}")]
    wrong += [
        fault for part, law in zip(parts, frictions, strict=False) for fault in law_faults(part, law, after_tipping)
    ]
    if after_detachment == "fly" and any(isinstance(part, Body) for part in parts):
        wrong.append("Input after_detachment of simulate_many must be 'stop' with a Body; got 'fly'")
    if wrong:
        raise ValueError("; ".join(wrong))
    found: list[Trajectory | None] = [None] * len(parts)
    stop = np.zeros(1, dtype=np.int64)

    def path(k: int) -> None:
        driven = surface if drives is None else surface.driven_by(drives[k])
        request = new_request(driven, parts[k], frictions[k], duration, gravity, tolerance, after_detachment == "fly")
        found[k] = path_of(driven, parts[k], frictions[k], request, tolerance, after_tipping, stop)

    pool, handed_out = ThreadPoolExecutor(threads or processors()), []
    try:
        try:
            ended: SimpleQueue[Future[None]] = SimpleQueue()
            for k in range(len(parts)):
                handed_out.append(pool.submit(path, k))
                handed_out[-1].add_done_callback(ended.put)
            for done in range(1, len(parts) + 1):
                _next(ended).result()
                if progress:
                    progress(done, len(parts))
        finally:
            stop[0] = 1
            pool.shutdown(wait=False, cancel_futures=True)
            futures.wait(handed_out, PATIENCE)
    except KeyboardInterrupt:
        raise Interrupted(list(found)) from None
    return [trajectory for trajectory in found if trajectory is not None]


def _next(ended: SimpleQueue[Future[None]]) -> Future[None]:
    """The next future that ended; Ctrl-C is heard while it is waited for."""
    found: list[Future[None]] = []

    def look(seconds: float) -> bool:
        with suppress(Empty):
            found.append(ended.get(timeout=seconds))
        return bool(found)

    wait(look)
    return found[0]


def _laws(friction: Contact | Iterable[Contact], count: int) -> tuple[list[Contact], list[str]]:
    """One law for each of so many parts, and what is wrong with what was given."""
    if is_law(friction):
        return [friction] * count, []
    laws = list(friction) if isinstance(friction, Iterable) else None
    wrong = []
    if laws is None or len(laws) != count:
        got = repr(friction) if laws is None else len(laws)
        wrong.append(f"Input friction of simulate_many must be one law or one a part, {count}; got {got}")
    for k, law in enumerate(laws or []):
        if not is_law(law):
            wrong.append(f"Input friction of part {k} must be a friction law; got {law!r}")
    return laws or [], wrong


def processors() -> int:
    """How many processors this process may use; all where the system does not tell, as macOS."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
