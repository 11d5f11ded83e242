"""Micropart, and simulate: from a surface, a part and a friction law to a trajectory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np

from particle.body import Body, Face
from particle.checks import finite, not_negative, positive, refuse
from particle.events import FIRST_STEP, Part, Request
from particle.film import Film, find_film_path
from particle.fixed import MAX_ROWS, MOREAU, PAPER, default_step, shortest_stroke, step_count
from particle.footprint import Footprint
from particle.friction import LOCAL, Contact, FrictionLaw, ScaledFriction
from particle.interrupt import Stopped, stop_flag
from particle.modes import Mode
from particle.path import find_path, find_path_by_steps
from particle.surface import SurfaceMotion, rim_gap
from particle.trajectory import Trajectory
from particle.types import FloatArray, IntArray

BRIDGED = 100.0  # tolerances, relative: how far off the surface's acceleration may be where breakpoints are bridged

_FIXED_STEPS = {"fixed": MOREAU, "paper": PAPER}


@dataclass(frozen=True)
class Micropart:
    """A part that lies on the surface; (x, y) is the point of the plate's mid-plane under it.

    Raises
    ------
    ValueError
        A field is wrong; names each.
    """

    mass: float  # kg
    position: tuple[float, float]  # m
    velocity: tuple[float, float] = (0.0, 0.0)  # m/s
    squeeze: float = 0.0  # N, a constant force that presses it onto the surface, along the normal
    centre_height: float = 0.0  # m, of its centre of mass over the surface that it lies on
    drag: float = 0.0  # N s/m, of the air under it: a force against its slip (`Air.drag`)
    film: Film | None = None  # of air under it, which bears load and has a drag of its own, in place of `drag`

    def __post_init__(self) -> None:
        pairs = {name: getattr(self, name) for name in ("position", "velocity")}
        refuse(
            "Micropart",
            [
                (positive(self.mass), "mass", "positive, in kg", self.mass),
                (not_negative(self.squeeze), "squeeze", "0 or a positive force in N", self.squeeze),
                (not_negative(self.centre_height), "centre_height", "0 or a positive length in m", self.centre_height),
                (not_negative(self.drag), "drag", "0 or a positive drag in N s/m", self.drag),
                (self.film is None or isinstance(self.film, Film), "film", "a Film or None", self.film),
                *((_is_pair(value), name, "two finite numbers", value) for name, value in pairs.items()),
            ],
        )


def simulate(
    surface: SurfaceMotion,
    part: Micropart | Body,
    friction: Contact,
    duration: float,
    gravity: float | Sequence[float] = 9.80665,
    tolerance: float = 1e-9,
    scheme: str = "events",
    after_detachment: str = "stop",
    time_step: float | None = None,
    after_tipping: str = "stop",
) -> Trajectory:
    """Follow one part over the moving surface, by the equations of motion (3.1) to (3.4) in docs/motion.md.

    Parameters
    ----------
    surface : SurfaceMotion
        The moving surface.
    part : Micropart or Body
        The part and its start.
    friction : friction law
        The contact between them.
    duration : float
        Length of the run, s.
    gravity : float or sequence of 3 floats
        m/s^2 towards the plate, or a vector along x, y, z for a tilted device; (0, 0, -9.80665) is the same as
        9.80665.
    tolerance : float
        Error of one step, relative to the surface's size.
    after_detachment : str
        `"stop"` ends the run where the part comes off; `"fly"` follows it to where it lands (scheme `"events"` only).
    scheme : str
        `"events"` locates every event. For comparison, of first order in `time_step`: `"fixed"`, Moreau's time
        stepping by the same equations, and `"paper"`, the paper's own scheme, which tends to others (docs/motion.md).
    time_step : float, optional
        Step of the schemes `"fixed"` and `"paper"`, which ignore the tolerance, s; by default 1e-4 of the shortest
        stroke.
    after_tipping : str
        `"stop"` ends the run where an edge of a Body lifts; `"ignore"` takes it to stay flat, whatever it says of that.

    Returns
    -------
    trajectory : Trajectory
        The part's path.

    Raises
    ------
    ValueError
        An input makes no sense, such as a start beyond the rim; names each.
    """
    wrong = []
    if scheme != "events" and scheme not in _FIXED_STEPS:
        wrong.append(f"Input scheme of simulate must be 'events', 'fixed' or 'paper'; got {scheme!r}")
    if time_step is not None and scheme == "events":
        wrong.append(f"Input time_step of simulate must be None with the scheme 'events'; got {time_step!r}")
    elif time_step is not None and not (math.isfinite(time_step) and time_step > 0):
        wrong.append(f"Input time_step of simulate must be a positive time in s; got {time_step!r}")
    if scheme in _FIXED_STEPS and after_detachment == "fly":
        wrong.append(f"Input after_detachment of simulate must be 'stop' with the scheme {scheme!r}; got 'fly'")
    if scheme == "paper" and surface.in_plane_count:
        wrong.append(
            "Input scheme of simulate must be 'events' or 'fixed' where the mid-plane moves in its plane; got 'paper'"
        )
    wrong += faults(surface, duration, gravity, tolerance, after_detachment, after_tipping)
    wrong += part_faults(surface, part, type(part).__name__)
    wrong += law_faults(part, friction, after_tipping)
    if not is_law(friction):
        wrong.append(f"Input friction of simulate must be a friction law, such as CoulombAdhesion; got {friction!r}")
    if scheme == "paper" and not wrong and friction.law.kind == LOCAL:
        wrong.append("Input friction of simulate must not be a LocalContact with the scheme 'paper'")
    if isinstance(part, Body):
        wrong += _face_faults(scheme, after_detachment)
    elif scheme != "events" and isinstance(part, Micropart) and (part.drag or part.film):
        wrong.append(
            f"Input {'film' if part.film else 'drag'} of Micropart must be left out with the scheme {scheme!r}"
        )
    if wrong:
        raise ValueError("; ".join(wrong))
    request = new_request(surface, part, friction, duration, gravity, tolerance, after_detachment == "fly")
    if scheme == "events":
        found = path_of(surface, part, friction, request, tolerance, after_tipping, stop_flag())
        if found is None:
            raise Stopped
        return found
    step = float(default_step(surface, duration) if time_step is None else time_step)
    steps = step_count(request.duration, step)
    return find_path_by_steps(surface, request, _FIXED_STEPS[scheme], step, steps, math.ceil(steps / MAX_ROWS))


def path_of(
    surface: SurfaceMotion,
    part: Micropart | Body,
    friction: Contact,
    request: Request,
    tolerance: float,
    after_tipping: str,
    stop: IntArray | None,
) -> Trajectory | None:
    """The path by located events; None when it was interrupted by `stop` (1,), which another thread may set to 1."""
    face = face_of(part, tolerance, after_tipping == "stop")
    film = Film(part.film, part.footprint) if isinstance(part, Body) and part.film else getattr(part, "film", None)
    if film:
        return find_film_path(surface, request, film, friction, stop, face)
    return find_path(surface, request, tolerance, stop, face)


def face_of(part: Micropart | Body, tolerance: float, tips: bool = True) -> Face | None:
    """The face of a part that has one: more points for the surface under it at a tighter tolerance."""
    if not isinstance(part, Body):
        return None
    return part.face(3 if tolerance > 1e-8 else (4 if tolerance > 1e-10 else 5), tips)


def part_faults(surface: SurfaceMotion, part: Micropart | Body, of: str) -> list[str]:
    """What is wrong with where a part starts, and on which surface."""
    wrong = []
    if not rim_gap(surface.record, *map(float, part.position)) >= 0:
        wrong.append(f"Input position of {of} must lie on the plate; got {tuple(part.position)!r} m")
    elif isinstance(part, Body) and not _least_gap(surface, part) >= 0:
        beyond = f"it reaches {-_least_gap(surface, part):.3g} m beyond the rim"
        wrong.append(f"Input position of {of} must put all of the part on the plate; {beyond}")
    if surface.turning_base and not isinstance(part, Body):
        wrong.append(f"Input {of} must be a Body on a base that turns; got a Micropart")
    return wrong


def is_law(friction: object) -> TypeGuard[Contact]:
    """Whether it is a friction law."""
    return isinstance(getattr(friction, "law", None), FrictionLaw)


def law_faults(part: Micropart | Body, friction: Contact, after_tipping: str = "stop") -> list[str]:
    """What is wrong with a friction law for a part."""
    film = getattr(part, "film", None)
    if film and is_law(friction) and friction.pull_off == 0:
        return ["Input friction of simulate must have a pull-off force on a film of air, whose gap follows from it"]
    if isinstance(part, Body) and film and is_law(friction) and friction.law.kind == LOCAL:
        return ["Input friction of simulate must not be a LocalContact with the film of a Body"]
    if isinstance(part, Body) and film and part.pressure == "linear" and after_tipping != "stop":
        return [f"Input after_tipping of simulate must be 'stop' with the film of a Body; got {after_tipping!r}"]
    if not is_law(friction) or friction.law.kind != LOCAL:
        return []
    while isinstance(friction, ScaledFriction):
        friction = friction.contact
    size = getattr(friction, "size", None)
    if isinstance(part, Micropart) and part.film and not isinstance(size, Footprint) and size != part.film.size:
        return [f"Input size of Film must be that of the LocalContact, {size!r} m; got {part.film.size!r}"]
    if not isinstance(part, Body):
        square = "Input size of LocalContact must be the side of a square, in m, with a Micropart"
        return [square] if isinstance(size, Footprint) else []
    wrong = []
    if size != part.footprint:
        wrong.append("Input size of LocalContact must be the footprint of the Body")
    if part.pressure != "linear":
        wrong.append(f"Input pressure of Body must be 'linear' with a LocalContact; got {part.pressure!r}")
    if after_tipping != "stop":
        wrong.append(f"Input after_tipping of simulate must be 'stop' with a LocalContact; got {after_tipping!r}")
    return wrong


def _least_gap(surface: SurfaceMotion, part: Body) -> float:
    """How far [m] the face's nearest point is inside the rim; negative beyond it."""
    if part.footprint.radius and (len(surface.record.conics) or len(surface.record.edges)):
        return float(rim_gap(surface.record, *map(float, part.position)) - part.footprint.radius)
    corners = part.footprint.outline(part.position, part.heading).tolist()
    return min(float(rim_gap(surface.record, x, y)) for x, y in corners)


def _face_faults(scheme: str, after_detachment: str) -> list[str]:
    """What a part with a face does not go with."""
    wrong = []
    if scheme != "events":
        wrong.append(f"Input scheme of simulate must be 'events' with a Body; got {scheme!r}")
    if after_detachment == "fly":
        wrong.append("Input after_detachment of simulate must be 'stop' with a Body; got 'fly'")
    return wrong


def faults(
    surface: SurfaceMotion,
    duration: float,
    gravity: float | Sequence[float],
    tolerance: float,
    after_detachment: str,
    after_tipping: str,
) -> list[str]:
    """What is wrong with what all paths of a run have in common."""
    wrong = []
    height = surface.half_thickness
    if not 0 <= height < math.inf:
        wrong.append(f"Input half_thickness of SurfaceMotion must be 0 or a positive length in m; got {height!r}")
    vector = np.atleast_1d(np.asarray(gravity, dtype=float))
    if not (vector.shape in ((1,), (3,)) and np.isfinite(vector).all()):
        wrong.append(f"Input gravity of simulate must be an acceleration in m/s^2 or three of them; got {gravity!r}")
    if after_detachment not in ("stop", "fly"):
        wrong.append(f"Input after_detachment of simulate must be 'stop' or 'fly'; got {after_detachment!r}")
    if after_tipping not in ("stop", "ignore"):
        wrong.append(f"Input after_tipping of simulate must be 'stop' or 'ignore'; got {after_tipping!r}")
    if not (math.isfinite(duration) and duration > 0):
        wrong.append(f"Input duration of simulate must be a positive time in s; got {duration!r}")
    if not 1e-13 <= tolerance <= 1e-2:
        wrong.append(f"Input tolerance of simulate must be in [1e-13, 1e-2]; got {tolerance!r}")
    return wrong


def new_request(
    surface: SurfaceMotion,
    part: Micropart | Body,
    friction: Contact,
    duration: float,
    gravity: float | Sequence[float],
    tolerance: float,
    flies: bool,
) -> Request:
    """What kernels are asked for."""
    vector = np.atleast_1d(np.asarray(gravity, dtype=float))
    stroke_time = shortest_stroke(surface, duration)
    force = float(part.mass * (np.linalg.norm(vector) + surface.size / stroke_time**2))
    jumps, bends = (bool((surface.drives.jump[:, k] > 0).any()) for k in (0, 1))
    return Request(
        part=part_record(surface, part, friction, gravity),
        start=_start(part),
        mode=int(Mode.SLIDING if np.any(part.velocity) or _start(part)[5] else Mode.RESTING),
        begin=0.0,
        until=float(duration),
        first_step=FIRST_STEP * stroke_time,
        duration=float(duration),
        tolerance=tolerance * surface.size,
        stroke_time=stroke_time,
        force=force,
        flies=flies,
        jumps=jumps,
        centre_height=float(part.centre_height or 0.0),
        bridged=(0.0, 0.0)
        if bends or jumps
        else (tolerance * surface.size / stroke_time, BRIDGED * tolerance * force / part.mass),
    )


def _start(part: Micropart | Body) -> FloatArray:
    """The numbers (8,) of a `Motion`, or of the state of a part with a face."""
    if isinstance(part, Body):
        return np.array([*part.position, part.heading, *part.velocity, part.spin, 0.0, 0.0], dtype=float)
    return np.array([*part.position, *part.velocity, *np.zeros(4)], dtype=float)


def part_record(
    surface: SurfaceMotion, part: Micropart | Body, friction: Contact, gravity: float | Sequence[float]
) -> Part:
    """The part's record for the kernels: forces, friction law, and heights of contact and centre over the mid-plane."""
    vector = np.atleast_1d(np.asarray(gravity, dtype=float))
    x, y, z = vector if len(vector) == 3 else (0.0, 0.0, -vector[0])
    contact = centre = 0.0
    if surface.tilts or isinstance(part, Body):  # on a surface that stays level all heights move alike
        contact, centre = surface.half_thickness, surface.half_thickness + (part.centre_height or 0.0)
    forces = float(part.mass), -float(z), float(x), float(y), float(part.squeeze)
    return Part(*forces, friction.law, float(contact), float(centre), float(part.drag))


def _is_pair(value: Any) -> bool:
    return np.shape(value) == (2,) and all(finite(part) for part in value)
