"""Tasks and routes: a part that is to get to a target, or over way-points, and which drives may bring it there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import shortest
from active_surface.steering.robustness import deviations
from active_surface.steering.settings import Settings
from active_surface.steering.symmetry import off_the_line
from coupling.case import (
    SAME_PLACE,
    ActuatorCase,
    Case,
    PlateCase,
    gaps,
    half_size,
    length_text,
    must_be_inside,
)
from particle import Trajectory

TOGETHER, APART = 9, 4  # actuators that take part with one frequency for all, and with a frequency each

Place = tuple[float, float]
"""(x, y) in m."""
Mistake = tuple[str, str]
"""A key of [aim], and what is wrong with it."""


class Turn(NamedTuple):
    """The heading that a part is to have at its target."""

    heading: float  # rad
    gyration: float  # m, of the part's face: an angle times this is a length

    def left(self, heading: float) -> float:
        """The angle [rad] from this heading to another [rad], within half a turn either way."""
        return math.remainder(heading - self.heading, 2 * math.pi)


def offset(target: Place, turn: Turn | None, position: ArrayLike, heading: float = 0.0) -> FloatArray:
    """How far a position [m] is off a target [m], (2,) m; with a turn (3,), how far a heading [rad] is off as well."""
    away = np.subtract(position, target)
    return away if turn is None else np.append(away, turn.gyration * turn.left(heading))


def offset_of(path: Trajectory, target: Place, turn: Turn | None) -> FloatArray:
    """The same of the end of a path."""
    return offset(target, turn, path.position[-1], 0.0 if path.heading is None else float(path.heading[-1]))


@dataclass(frozen=True)
class Task:
    """A case whose part is to be brought to a target (x, y) in m, and to a heading in rad, within its duration.

    A miss counts position and heading: the angle that is left, times the radius of gyration of the part's face about
    its centroid, is a length beside those along x and y.

    Raises
    ------
    ValueError
        An input makes no sense, such as a target that is off the plate or cannot be reached; has all.
    """

    case: Case
    target: Place  # m
    settings: Settings = field(default_factory=Settings)
    name: str = ""  # of the files that are written; "": that of the case
    heading: float | None = None  # rad, of a part with a footprint; None: any

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.case.name)
        found = mistakes(self.case, self.settings, self.target, self.heading)
        wrong = [f"{key} {message}" for key, message in found]
        if wrong:
            raise ValueError("\n".join(wrong))

    @property
    def movers(self) -> tuple[int, ...]:
        """The numbers of the actuators that take part with a frequency each, ascending."""
        return movers(self.case, self.settings, self.target, APART)

    @property
    def together(self) -> tuple[int, ...]:
        """The same of those that take part with one frequency for all."""
        return movers(self.case, self.settings, self.target)

    @property
    def turn(self) -> Turn | None:
        """The heading to reach; None: any will do."""
        return _turn(self.case, self.heading)

    @property
    def away(self) -> float:
        """How far off the part starts [m]."""
        part = self.case.part
        return float(np.hypot.reduce(offset(self.target, self.turn, part.position, part.heading)))

    def within(self, duration: float, path: Trajectory | None = None) -> Task:
        """The same within another duration [s], and from where the part rests at the end of a path.

        Raises ValueError where the target cannot be reached from there.
        """
        run = self.case.run.model_copy(update={"duration": duration})
        place = None if path is None else end_of(path)
        heading = None if path is None or path.heading is None else float(path.heading[-1])
        return replace(self, case=_from(self.case, place, heading).model_copy(update={"run": run}))


@dataclass(frozen=True)
class Route:
    """A case whose part is to be carried over way-points (x, y) in m, to each within the case's duration.

    Raises
    ------
    ValueError
        An input makes no sense, such as a way-point off the plate or a first one that cannot be reached; has all.
    """

    case: Case
    through: tuple[Place, ...]  # m
    settings: Settings = field(default_factory=Settings)
    name: str = ""  # of the files that are written; "": that of the case

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.case.name)
        wrong = (
            [] if self.through else ["through must be one way-point or more, as --through 20,0 or --by 20,0; got none"]
        )
        if len(self.through) > 1 and self.case.part.face is not None:
            wrong.append("through must be one way-point for a part with a footprint, whose heading no leg carries on")
        for number, place in enumerate(self.through):
            if number == 0:
                for key, message in mistakes(self.case, self.settings, place):
                    wrong.append(f"{'way-point 0' if key == 'target' else key} {message}")
            else:  # where legs after the first begin is not known yet: `leg` looks at what depends on it
                wrong += [f"way-point {number} {message}" for message in misplaced(self.case, place)]
        if wrong:
            raise ValueError("\n".join(wrong))

    def distances(self, places: Iterable[Sequence[float]]) -> list[float]:
        """How far off the way-points [m] are places [m], one for each way-point so far."""
        return [math.dist(place, target) for place, target in zip(places, self.through, strict=False)]

    def leg(self, way_point: int, start: Place, number: int | None = None) -> Task:
        """The task to get to a way-point from a place [m] where the part rests, or in the first leg where it starts.

        Raises ValueError where it cannot be reached from there.

        number: of the leg, where several may lead to a way-point.
        """
        leg = way_point if number is None else number
        if leg and self.case.part.face is not None:
            raise ValueError("Input case of a later leg must have no footprint, whose heading no leg carries on")
        case = _from(self.case, start if leg else None)
        return Task(case, self.through[way_point], self.settings, f"{self.name}_leg_{leg}")


def end_of(path: Trajectory) -> Place:
    """Where a path ends [m]."""
    x, y = path.position[-1].tolist()
    return x, y


def _turn(case: Case, heading: float | None) -> Turn | None:
    return None if heading is None else Turn(heading, case.part.gyration)


def _from(case: Case, start: Place | None, heading: float | None = None) -> Case:
    """The case whose part rests at a place [m] and a heading [rad] in the beginning; None: it begins as it does."""
    rest: dict[str, object] = {} if start is None else {"position": start, "velocity": (0.0, 0.0)}
    rest |= {} if heading is None else {"heading": heading, "spin": 0.0}
    return case.model_copy(update={"part": case.part.model_copy(update=rest), "source": None})


def movers(case: Case, settings: Settings, target: Place, nearest: int = TOGETHER) -> tuple[int, ...]:
    """The numbers of the actuators that take part on the way to a target [m]: those stated, or the nearest."""
    fit = able(case, settings)
    if settings.actuators is not None:
        return tuple(fit)
    away = _from_way(np.array([case.actuators[k].position for k in fit]), case.part.position, target)
    order = np.argsort(away, kind="stable")[: settings.nearest or nearest].tolist()
    return tuple(sorted(fit[k] for k in order))


def able(case: Case, settings: Settings) -> list[int]:
    """The numbers of the actuators that can take part, ascending: those stated, or all that fit."""
    if settings.actuators is not None:
        return sorted(settings.actuators)
    return [k for k, actuator in enumerate(case.actuators) if not _unfit(actuator, settings)]


def mistakes(case: Case, settings: Settings, target: Place | None, heading: float | None = None) -> Iterator[Mistake]:
    """Yield what is wrong with settings, a target [m] and a heading [rad] for a case; None where one is not known."""
    if not isinstance(case.plate, PlateCase):
        yield "case", "must have a plate on actuators; got a platform"
        return
    if case.run.scheme != "events":
        yield "case", f'must have scheme = "events", by which drives are found; got "{case.run.scheme}"'
    if settings.quantile is not None and settings.cvar is not None:
        yield "cvar", "must not be given with quantile; a search makes one of them small"
    try:
        deviations(case, settings.disturbances)
    except ValueError as error:
        yield from (("disturbances", message) for message in str(error).split("\n"))
    unfit = list(_actuator_mistakes(case, settings))
    yield from unfit
    if heading is not None and case.part.face is None:
        yield "heading", "must not be given for a part without a footprint, a point that does not turn"
        return
    if heading is not None and not math.isfinite(heading):
        yield "heading", f"must be a finite angle in rad; got {heading}"
        return
    if target is None:
        return
    placed = list(misplaced(case, target))
    yield from (("target", message) for message in placed)
    if unfit:
        return
    chosen = movers(case, settings, target)
    soonest, duration = shortest(case, settings, chosen), case.run.duration
    if soonest > duration:
        key = "delay" if settings.delay else "frequency" if settings.frequency else "case"
        yield (
            key,
            "must leave time for a cycle of each actuator that takes part; the soonest that all can end is "
            f"{soonest * 1e3:g} ms, and the run ends at {duration * 1e3:g} ms",
        )
    away = float(np.hypot.reduce(offset(target, _turn(case, heading), case.part.position, case.part.heading)))
    if away <= settings.tolerance and not any((*case.part.velocity, case.part.spin)):
        as_length = "" if heading is None else ", its heading included"
        yield (
            "target",
            f"must be farther from the part than the tolerance, {length_text(settings.tolerance)}; "
            f"got a point {length_text(away)} from where it starts{as_length}: it is there already",
        )
    elif not placed:
        wrong = off_the_line(case, case.plate, target, settings.tolerance, chosen)
        yield from (("target", message) for message in wrong)


def _actuator_mistakes(case: Case, settings: Settings) -> Iterator[Mistake]:
    count = len(case.actuators)
    for k in settings.actuators or ():
        if k >= count:
            yield "actuators", f"must be numbers of actuators from 0 to {count - 1}; got {k}"
        elif reason := _unfit(case.actuators[k], settings):
            yield "actuators", f"must be driven by a stroke that goes up and down; that of actuator {k} {reason}"
    if settings.actuators is None and all(_unfit(actuator, settings) for actuator in case.actuators):
        yield "case", "must have an actuator whose stroke goes up and down, or whose bounds are given; it has none"


def _unfit(actuator: ActuatorCase, settings: Settings) -> str:
    """Why an actuator cannot take part; "": it can."""
    if actuator.stroke is None:
        return "has no stroke but a force, a table or segments"
    if actuator.cycle != "up-down":
        return f'has cycle = "{actuator.cycle}"'
    if actuator.phase:
        return "has a phase, so that it begins in the middle"
    return "is 0, which leaves no bounds" if actuator.stroke == 0 and settings.stroke is None else ""


def misplaced(case: Case, target: Place) -> Iterator[str]:
    """Yield that a target [m] is not on the plate of a case, or so near its rim that the part does not fit."""
    if not isinstance(case.plate, PlateCase):
        return
    if not all(math.isfinite(place) for place in target):
        yield f"must be two finite lengths; got {target}"
        return
    mesh = case.plate.coarse_mesh
    least = SAME_PLACE * half_size(mesh)
    (gap,) = gaps(mesh, [target])
    room = (case.footprint or 0.0) / math.sqrt(2)
    if gap <= least:
        yield must_be_inside(gap, mesh)
    elif gap < room:
        yield (
            f"must be at least {length_text(room)} inside the rim, half of the part's diagonal, for the part to fit; "
            f"got a point {length_text(gap)} inside it"
        )


def _from_way(places: FloatArray, start: tuple[float, float], target: Place) -> FloatArray:
    """How far places (n, 2) are from the straight way from a start to a target, all in m."""
    way = np.subtract(target, start)
    length = float(way @ way)
    part = np.clip((places - start) @ way / length, 0, 1) if length > 0 else np.zeros(len(places))
    return np.asarray(np.linalg.norm(places - start - part[:, None] * way, axis=1))
