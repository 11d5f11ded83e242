"""simulate: from a surface, a part and a friction law to a trajectory."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from particle.between import between
from particle.drive_table import jumps
from particle.events import march, new_memory
from particle.fixed import MOREAU, MOST_ROWS, PAPER, default_step, march_fixed, shortest_stroke, step_count
from particle.friction import Contact
from particle.local import missing_place, new_local
from particle.motion import Part
from particle.resume import resume
from particle.rim import rim_gap
from particle.runge_kutta import tableau
from particle.slide import DETACHED, GOES_ON, LACKS_CELL, LEFT_PLATE, OVERLOADED, WORK_LIMIT, Request
from particle.stay import stays
from particle.surface import Surface, SurfaceMotion
from particle.trajectory import Energy, Event, EventKind, Outcome, State, Trajectory, energy_of, samples_of

FloatArray = NDArray[np.float64]
Path = tuple[FloatArray, FloatArray, int, int]  # rows, events, how it ended, evaluations

_FIXED_STEPS = {"fixed": MOREAU, "paper": PAPER}
_OUTCOMES = {
    DETACHED: Outcome.DETACHED,
    LEFT_PLATE: Outcome.LEFT_PLATE,
    OVERLOADED: Outcome.OVERLOADED,
    WORK_LIMIT: Outcome.WORK_LIMIT,
}


@dataclass(frozen=True)
class Micropart:
    """A part, taken as a point on the surface.

    Raises ValueError when the mass is not positive or another number is not finite.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along the normal

    def __post_init__(self) -> None:
        if not (math.isfinite(self.mass) and self.mass > 0):
            raise ValueError(f"Input mass of Micropart must be positive, in kg; got {self.mass!r}")
        if not 0 <= self.squeeze < math.inf:
            raise ValueError(f"Input squeeze of Micropart must be 0 or a positive force in N; got {self.squeeze!r}")
        for name in ("position", "velocity"):
            value = getattr(self, name)
            if len(value) != 2 or not all(math.isfinite(v) for v in value):
                raise ValueError(f"Input {name} of Micropart must be two finite numbers; got {value!r}")


def simulate(
    surface: SurfaceMotion,
    part: Micropart,
    friction: Contact,
    duration: float,
    gravity: float | Sequence[float] = 9.80665,
    tolerance: float = 1e-9,
    scheme: str = "events",
    after_detachment: str = "stop",
    time_step: float | None = None,
) -> Trajectory:
    """The part's path over the moving surface, by the equations of `particle.motion`.

    duration: s.  gravity: m/s^2 towards the plate, or a vector along x, y, z for a tilted device: (0, 0, -9.80665) is
    the same as 9.80665.  tolerance: error of one step, relative to the surface's size.
    scheme: "events" locates every event.  For comparison, of first order in steps of time_step: "fixed", Moreau's time
    stepping by the same equations, and "paper", the paper's own scheme, which tends to others (docs/motion.md).
    after_detachment: "stop" ends the run where the part comes off, "fly" follows it to where it lands ("events" only).
    time_step: s, of the schemes "fixed" and "paper", which heed no tolerance; by default 1e-4 of the shortest stroke.
    Raises ValueError, naming every input that makes no sense, as a start beyond the rim.
    """
    wrong = []
    vector = np.atleast_1d(np.asarray(gravity, dtype=float))
    if not (vector.shape in ((1,), (3,)) and np.isfinite(vector).all()):
        wrong.append(f"Input gravity of simulate must be an acceleration in m/s^2 or three of them; got {gravity!r}")
    if scheme != "events" and scheme not in _FIXED_STEPS:
        wrong.append(f"Input scheme of simulate must be 'events', 'fixed' or 'paper'; got {scheme!r}")
    if time_step is not None and scheme == "events":
        wrong.append(f"Input time_step of simulate must be None with the scheme 'events'; got {time_step!r}")
    elif time_step is not None and not (math.isfinite(time_step) and time_step > 0):
        wrong.append(f"Input time_step of simulate must be a positive time in s; got {time_step!r}")
    if scheme in _FIXED_STEPS and after_detachment == "fly":
        wrong.append(f"Input after_detachment of simulate must be 'stop' with the scheme {scheme!r}; got 'fly'")
    if after_detachment not in ("stop", "fly"):
        wrong.append(f"Input after_detachment of simulate must be 'stop' or 'fly'; got {after_detachment!r}")
    if not (math.isfinite(duration) and duration > 0):
        wrong.append(f"Input duration of simulate must be a positive time in s; got {duration!r}")
    if not 1e-13 <= tolerance <= 1e-2:
        wrong.append(f"Input tolerance of simulate must be in [1e-13, 1e-2]; got {tolerance!r}")
    if not rim_gap(surface.record, *map(float, part.position)) >= 0:
        wrong.append(f"Input position of Micropart must lie on the plate; got {tuple(part.position)!r} m")
    if wrong:
        raise ValueError("; ".join(wrong))
    x, y, z = vector if len(vector) == 3 else (0.0, 0.0, -vector[0])
    stroke_time = shortest_stroke(surface, duration)
    request = Request(
        part=Part(float(part.mass), -float(z), float(x), float(y), float(part.squeeze), friction.law),
        start=np.array([*part.position, *part.velocity], dtype=float),
        duration=float(duration),
        tolerance=tolerance * surface.size,
        stroke_time=stroke_time,
        force=float(part.mass * (np.linalg.norm(vector) + surface.size / stroke_time**2)),
        flies=after_detachment == "fly",
        jumps=jumps(surface.drives),
    )
    if scheme in _FIXED_STEPS:
        kind, step = _FIXED_STEPS[scheme], float(default_step(surface, duration) if time_step is None else time_step)
        steps = step_count(request.duration, step)
        every = math.ceil(steps / MOST_ROWS)

        def path(record: Surface) -> tuple[Path, FloatArray]:
            local = new_local(record)
            return march_fixed(record, request, local, kind, step, steps, every), missing_place(local)

        rows, events, verdict, evaluations = _with_cells(surface, path)
        sampler = partial(between, surface.record, request.part, kind, rows)
    else:
        pair = tableau(tolerance)

        def path(record: Surface) -> tuple[Path, FloatArray]:
            memory = new_memory(record, pair)
            return march(record, request, pair, memory), missing_place(memory.local)

        rows, events, verdict, evaluations = _with_cells(surface, path)
        sampler = partial(resume, surface.record, request, pair, rows)
    found = _trajectory(rows, events, verdict, evaluations, energy_of(rows, request.force * surface.size), sampler)
    if found.outcome is Outcome.STUCK and scheme == "events":
        x, y = found.position[-1].tolist()
        found = replace(found, future=partial(stays, surface, request.part, x, y, request.duration))
    return found


def _with_cells(surface: SurfaceMotion, path: Callable[[Surface], tuple[Path, FloatArray]]) -> Path:
    """A path over the surface, found anew whenever it has come to a place where a cell was lacking."""
    while True:
        found, missing = path(surface.record)
        if found[2] != LACKS_CELL:
            return found
        surface.store.build(missing)


def _trajectory(
    rows: FloatArray,
    events: FloatArray,
    verdict: int,
    evaluations: int,
    energy: Energy,
    sampler: Callable[[FloatArray], FloatArray],
) -> Trajectory:
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
        energy=energy,
        sampler=sampler,
    )
