"""Borders: the factors of a case's drives from which a part at rest slips and is lost."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

from coupling.case import Case
from coupling.drives import travel
from coupling.part import build_part
from coupling.scene import PlateScene, Scene
from particle import Body, Micropart, Outcome, PartAtRest, SurfaceMotion, Trajectory, part_at_rest
from particle.drives import horizon
from particle.friction import Contact

FAR: Final = 1e-3  # of the surface's size: a part that is carried so far moves
KEPT: Final = Outcome.STUCK, Outcome.MOVING
LOST: Final = Outcome.DETACHED, Outcome.OVERLOADED, Outcome.LEFT_PLATE, Outcome.TIPPED
MAX_STROKES: Final = 85  # of the shortest, in which thresholds are looked for
STEP: Final = math.log(1.25)  # between the logarithms of factors between which a threshold is looked for
RANGE: Final = 64.0  # the largest factor
LEAST: Final = 1 / 4096  # the smallest
BEFORE: Final = 0.98  # of where it comes off
EXACT: Final = 1e-7  # of a threshold


@dataclass(frozen=True)
class Thresholds:
    """From how many times the frequency or stroke a part at its start slips, and comes off, tips or is overloaded.

    None: at none up to 64; 0: at any.
    """

    knob: str  # "frequency" or "stroke"
    slips_from: float | None
    comes_off_from: float | None
    holds: float | None  # the pull over the friction limit just before it comes off, where it does not slip before


class Factors(NamedTuple):
    """The same; inf: none up to the largest."""

    slips: float
    comes_off: float


def thresholds_of(case: Case, scene: Scene, trajectory: Trajectory, friction: Contact) -> Thresholds | None:
    """The thresholds of a part that its drives did not carry far, or did not keep; None where `why_none` says why."""
    if why_none(case, scene, trajectory):
        return None
    rest = at_rest(case, scene.surface, build_part(case), friction)
    own = factors_of(lambda factor: driven(scene, rest, factor))
    if math.isclose(own.slips, own.comes_off, rel_tol=10 * EXACT):  # friction ends with contact
        own = own._replace(slips=own.comes_off)
    unslipped = own.slips >= own.comes_off * BEFORE and 0 < own.comes_off < math.inf
    return Thresholds(
        "stroke" if strokes_alone(scene) else "frequency",
        None if math.isinf(own.slips) else own.slips,
        None if math.isinf(own.comes_off) else own.comes_off,
        driven(scene, rest, own.comes_off * BEFORE).slip().value if unslipped else None,
    )


def why_none(case: Case, scene: Scene, trajectory: Trajectory) -> str:
    """Why a part needs no other drives, or why no factor of its drives tells anything, in a sentence; else empty."""
    if all(travel(drive) == 0 for drive in (*scene.lifts, *scene.base)):
        return "No drive moves."
    if trajectory.outcome in (Outcome.LEFT_PLATE, Outcome.WORK_LIMIT):
        return trajectory.sentence
    if trajectory.outcome in KEPT and trajectory.distance > FAR * scene.surface.size:
        return "The part moves already, and stays on."
    if case.air is not None and case.air.film:
        return "Thresholds are those of a part without a film of air."
    if any(case.part.velocity) or case.part.spin:
        return "The part is on the move from the start, and thresholds are those of a part at rest."
    if strokes_alone(scene) and stretches(scene):
        return "No factor scales the drives of a plate that stretches and has inertia."
    return ""


def strokes_alone(scene: Scene) -> bool:
    """Whether only strokes can be scaled: the plate does not follow its drives at once, or they are measured."""
    return bool(scene.fits) or (isinstance(scene, PlateScene) and scene.has_inertia)


def stretches(scene: Scene) -> bool:
    """Whether the plate stretches, and so is not linear in its strokes."""
    return isinstance(scene, PlateScene) and scene.stretch is not None


def at_rest(case: Case, surface: SurfaceMotion, part: Micropart | Body, friction: Contact) -> PartAtRest:
    """A part that stays at its start, for as long as the drives take to repeat, or some strokes."""
    duration, repeated = case.run.duration, horizon(surface.drives, 0.0)
    shortest = float(surface.stroke_times.min(initial=duration))
    window = min(duration, MAX_STROKES * shortest, math.inf if repeated is None else repeated)
    return part_at_rest(surface, part, friction, window, case.run.gravity, case.run.after_tipping == "stop")


def driven(scene: Scene, rest: PartAtRest, factor: float, stroke: float = 1.0) -> PartAtRest:
    """A part at rest under drives times a factor: of the frequency, or of the stroke where only that is scaled."""
    return rest.scaled(1.0, factor) if strokes_alone(scene) else rest.scaled(factor, stroke)


def factors_of(scaled: Callable[[float], PartAtRest]) -> Factors:
    """The factors of drives from which a part at rest slips, and comes off."""
    ends = math.log(LEAST), math.log(RANGE)

    def factor(excess: Callable[[PartAtRest], float]) -> float:
        return math.exp(begins(lambda x: excess(scaled(math.exp(x))), 0.0, ends, STEP, EXACT))

    return Factors(factor(excess_pull), factor(excess_load))


def excess_pull(rest: PartAtRest) -> float:
    """The logarithm of the largest pull over the friction limit: the part slips from 0 on."""
    return math.log(min(max(rest.slip().value, 1e-9), 1e9))


def excess_load(rest: PartAtRest) -> float:
    """By how much contact is beyond its end, over about the weight: the part is lost from 0 on."""
    return -rest.contact_margin().value


def begins(
    excess: Callable[[float], float], start: float, ends: tuple[float, float], step: float, exact: float
) -> float:
    """Where an excess becomes positive, seen upwards, nearest to a start between two ends.

    inf: nowhere; -inf: it is positive from the start down to the lower end.
    """
    from scipy.optimize import brentq  # here, because runs do without it

    x = start
    positive = excess(x) >= 0
    while x != ends[not positive]:
        before, x = x, max(x - step, ends[0]) if positive else min(x + step, ends[1])
        if (excess(x) >= 0) != positive:
            return float(brentq(excess, *sorted((before, x)), xtol=exact))
    return -math.inf if positive else math.inf
