"""simulate: from a surface, a part and a friction law to a trajectory."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from particle.events import march
from particle.friction import Contact
from particle.motion import Part
from particle.rim import rim_gap
from particle.runge_kutta import tableau
from particle.slide import DETACHED, GOES_ON, LEFT_PLATE, OVERLOADED, WORK_LIMIT, Request
from particle.surface import SurfaceMotion
from particle.trajectory import Event, EventKind, Outcome, State, Trajectory

_OUTCOMES = {
    DETACHED: Outcome.DETACHED,
    LEFT_PLATE: Outcome.LEFT_PLATE,
    OVERLOADED: Outcome.OVERLOADED,
    WORK_LIMIT: Outcome.WORK_LIMIT,
}


@dataclass(frozen=True)
class Micropart:
    """A part, taken as a point on the surface.

    Raises ValueError when the mass is not positive or a coordinate is not finite.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s

    def __post_init__(self) -> None:
        if not (math.isfinite(self.mass) and self.mass > 0):
            raise ValueError(f"Input mass of Micropart must be positive, in kg; got {self.mass!r}")
        for name in ("position", "velocity"):
            value = getattr(self, name)
            if len(value) != 2 or not all(math.isfinite(v) for v in value):
                raise ValueError(f"Input {name} of Micropart must be two finite numbers; got {value!r}")


def simulate(
    surface: SurfaceMotion,
    part: Micropart,
    friction: Contact,
    duration: float,
    gravity: float = 9.80665,
    tolerance: float = 1e-9,
    scheme: str = "events",
) -> Trajectory:
    """The part's path over the moving surface, by the equations of `particle.motion`.

    duration: s.  gravity: m/s^2.  tolerance: error of one step, relative to the surface's size.  scheme: "events".
    Raises ValueError for a scheme, duration or tolerance that makes no sense and for a start beyond the rim.
    """
    if scheme != "events":
        raise ValueError(f"Input scheme of simulate must be 'events'; got {scheme!r}")
    if not (math.isfinite(duration) and duration > 0):
        raise ValueError(f"Input duration of simulate must be a positive time in s; got {duration!r}")
    if not math.isfinite(gravity):
        raise ValueError(f"Input gravity of simulate must be a finite acceleration in m/s^2; got {gravity!r}")
    if not 1e-13 <= tolerance <= 1e-2:
        raise ValueError(f"Input tolerance of simulate must be in [1e-13, 1e-2]; got {tolerance!r}")
    if not rim_gap(surface, *map(float, part.position)) >= 0:
        raise ValueError(f"Input position of Micropart must lie on the plate; got {tuple(part.position)!r} m")
    scales = surface.drives.scale[np.repeat(np.isfinite(surface.drives.span), np.diff(surface.drives.first))]
    request = Request(
        part=Part(part.mass, gravity, friction.law),
        start=np.array([*part.position, *part.velocity], dtype=float),
        duration=float(duration),
        tolerance=tolerance * surface.size,
        stroke_time=float(min(scales.min(initial=math.inf), duration)),
    )
    rows, events, verdict, evaluations = march(surface, request, tableau(tolerance))
    if verdict == GOES_ON:
        outcome = Outcome.MOVING if rows[-1, 7] == State.SLIP else Outcome.STUCK
    else:
        outcome = _OUTCOMES[verdict]
    return Trajectory(
        time=rows[:, 0],
        position=rows[:, 1:3],
        velocity=rows[:, 3:5],
        normal_force=rows[:, 5],
        friction_force=rows[:, 6],
        state=rows[:, 7].astype(np.int64),
        events=[Event(EventKind(int(k)), t, (x, y), load) for k, t, x, y, load in events.tolist()],
        outcome=outcome,
        evaluations=evaluations,
    )
