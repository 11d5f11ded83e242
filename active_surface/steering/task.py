"""Task: a part that is to get from where it starts to a target, and which drives may bring it there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.disturbances import deviations
from active_surface.steering.knobs import shortest
from active_surface.steering.reach import off_the_line
from active_surface.steering.tables import Settings
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

Mistake = tuple[str, str]
"""A key of [aim], and what is wrong with it."""


@dataclass(frozen=True)
class Task:
    """A case whose part is to be brought to a target (x, y) in m within its duration.

    Raises
    ------
    ValueError
        An input makes no sense, such as a target that is off the plate or cannot be reached; has all.
    """

    case: Case
    target: tuple[float, float]  # m
    settings: Settings = field(default_factory=Settings)
    name: str = ""  # of the files that are written; "": that of the case

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", self.name or self.case.name)
        wrong = [f"{key} {message}" for key, message in mistakes(self.case, self.settings, self.target)]
        if wrong:
            raise ValueError("\n".join(wrong))

    @property
    def movers(self) -> tuple[int, ...]:
        """The numbers of the actuators that take part, ascending."""
        return movers(self.case, self.settings, self.target)

    def within(self, duration: float, start: tuple[float, float] | None = None) -> Task:
        """The same within another duration [s], and from a place [m] where the part rests.

        Raises ValueError where the target cannot be reached from there.
        """
        case = self.case
        run = case.run.model_copy(update={"duration": duration})
        moved = {} if start is None else {"position": start, "velocity": (0.0, 0.0)}
        part = case.part.model_copy(update=moved)
        return replace(self, case=case.model_copy(update={"run": run, "part": part, "source": None}))


def movers(case: Case, settings: Settings, target: tuple[float, float]) -> tuple[int, ...]:
    """The numbers of the actuators that take part on the way to a target [m]: those that are told, or the nearest."""
    if settings.actuators is not None:
        return tuple(sorted(settings.actuators))
    fit = able(case, settings)
    away = _from_way(np.array([case.actuators[k].position for k in fit]), case.part.position, target)
    order = np.argsort(away, kind="stable")[: settings.nearest].tolist()
    return tuple(sorted(fit[k] for k in order))


def able(case: Case, settings: Settings) -> list[int]:
    """The numbers of the actuators that can take part, ascending: those that are told, or all that fit."""
    if settings.actuators is not None:
        return sorted(settings.actuators)
    return [k for k, actuator in enumerate(case.actuators) if not _unfit(actuator, settings)]


def mistakes(case: Case, settings: Settings, target: tuple[float, float] | None) -> Iterator[Mistake]:
    """Yield what is wrong with settings and a target [m] for a case, None where that is not known."""
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
    away = math.dist(target, case.part.position)
    if away <= settings.tolerance and not any(case.part.velocity):
        yield (
            "target",
            f"must be farther from the part than the tolerance, {length_text(settings.tolerance)}; "
            f"got a point {length_text(away)} from where it starts: it is there already",
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


def is_schedulable(actuator: ActuatorCase) -> bool:
    """Whether segments can state its drive: a stroke that goes up and down, from the start of its cycle."""
    return actuator.stroke is not None and actuator.cycle == "up-down" and not actuator.phase


def _unfit(actuator: ActuatorCase, settings: Settings) -> str:
    """Why an actuator cannot take part; "": it can."""
    if actuator.stroke is None:
        return "has no stroke but a force, a table or segments"
    if actuator.cycle != "up-down":
        return f'has cycle = "{actuator.cycle}"'
    if actuator.phase:
        return "has a phase, so that it begins in the middle"
    return "is 0, which leaves no bounds" if actuator.stroke == 0 and settings.stroke is None else ""


def misplaced(case: Case, target: tuple[float, float]) -> Iterator[str]:
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


def _from_way(places: FloatArray, start: tuple[float, float], target: tuple[float, float]) -> FloatArray:
    """How far places (n, 2) are from the straight way from a start to a target, all in m."""
    way = np.subtract(target, start)
    length = float(way @ way)
    part = np.clip((places - start) @ way / length, 0, 1) if length > 0 else np.zeros(len(places))
    return np.asarray(np.linalg.norm(places - start - part[:, None] * way, axis=1))
