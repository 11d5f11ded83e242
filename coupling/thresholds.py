"""Thresholds: the factors of a case's drives from which a part at rest slips, and comes off."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

from scipy.optimize import brentq

from coupling.case import Case
from coupling.drives import travel
from coupling.part import build_part
from coupling.scene import PlateScene, Scene
from particle import Micropart, Outcome, PartAtRest, SurfaceMotion, Trajectory, part_at_rest
from particle.drives import horizon
from particle.friction import Contact

FAR: Final = 1e-3  # of the surface's size: a part that is carried so far moves
ENDS: Final = Outcome.STUCK, Outcome.MOVING, Outcome.DETACHED, Outcome.OVERLOADED
MAX_STROKES: Final = 85  # of the shortest, in which thresholds are looked for
STEP: Final = 1.25  # ratio of factors between which a threshold is looked for
RANGE: Final = 64.0  # the largest factor
LEAST: Final = 1 / 4096  # the smallest
BEFORE: Final = 0.98  # of where it comes off
EXACT: Final = 1e-7  # of a threshold


@dataclass(frozen=True)
class Thresholds:
    """From how many times the frequency or stroke a part at its start slips, and comes off or is overloaded.

    None: at none up to 64; 0: at any.
    """

    knob: str  # "frequency" or "stroke"
    slips_from: float | None
    comes_off_from: float | None
    holds: float | None  # the pull over what friction holds just before it comes off, where it does not slip before


class Factors(NamedTuple):
    """The same; inf: none up to the largest."""

    slips: float
    comes_off: float


def thresholds_of(case: Case, scene: Scene, trajectory: Trajectory, friction: Contact) -> Thresholds | None:
    """The thresholds of a part that its drives did not carry far, or did not keep; None where no factor scales them."""
    if not lacks_motion(case, scene, trajectory):
        return None
    rest = at_rest(case, scene.surface, build_part(case), friction)
    own = factors_of(lambda factor: driven(scene, rest, factor))
    unslipped = own.slips >= own.comes_off * BEFORE and 0 < own.comes_off < math.inf
    return Thresholds(
        "stroke" if strokes_alone(scene) else "frequency",
        None if math.isinf(own.slips) else own.slips,
        None if math.isinf(own.comes_off) else own.comes_off,
        driven(scene, rest, own.comes_off * BEFORE).slip().value if unslipped else None,
    )


def lacks_motion(case: Case, scene: Scene, trajectory: Trajectory) -> bool:
    """Whether drives that some factor scales did not carry a part far, or did not keep it.

    No factor scales a plate that stretches and has inertia.
    """
    still = trajectory.outcome in ENDS and not moves(scene, trajectory) and not any(case.part.velocity)
    moving = any(travel(drive) > 0 for drive in (*scene.lifts, *scene.base))
    return still and moving and not (strokes_alone(scene) and stretches(scene))


def moves(scene: Scene, trajectory: Trajectory) -> bool:
    """Whether a part was carried far and stayed on."""
    return kept(trajectory) and trajectory.distance > FAR * scene.surface.size


def kept(trajectory: Trajectory) -> bool:
    """Whether a part stayed on to the end."""
    return trajectory.outcome in (Outcome.STUCK, Outcome.MOVING)


def strokes_alone(scene: Scene) -> bool:
    """Whether only strokes can be scaled: the plate does not follow its drives at once, or they are measured."""
    return bool(scene.fits) or (isinstance(scene, PlateScene) and scene.has_inertia)


def stretches(scene: Scene) -> bool:
    """Whether the plate stretches, and so is not linear in its strokes."""
    return isinstance(scene, PlateScene) and scene.stretch is not None


def at_rest(case: Case, surface: SurfaceMotion, part: Micropart, friction: Contact) -> PartAtRest:
    """A part that stays at its start, for as long as the drives take to repeat, or some strokes."""
    duration, repeated = case.run.duration, horizon(surface.drives, 0.0)
    shortest = float(surface.stroke_times.min(initial=duration))
    window = min(duration, MAX_STROKES * shortest, math.inf if repeated is None else repeated)
    return part_at_rest(surface, part, friction, window, case.run.gravity)


def driven(scene: Scene, rest: PartAtRest, factor: float, stroke: float = 1.0) -> PartAtRest:
    """A part at rest under drives times a factor: of the frequency, or of the stroke where only that is scaled."""
    return rest.scaled(1.0, factor) if strokes_alone(scene) else rest.scaled(factor, stroke)


def factors_of(scaled: Callable[[float], PartAtRest]) -> Factors:
    """The factors of drives from which a part at rest slips, and comes off."""
    return Factors(_first(lambda x: _excess_pull(scaled(x))), _first(lambda x: _excess_load(scaled(x))))


def _excess_pull(rest: PartAtRest) -> float:
    """The logarithm of the largest pull over what friction holds: the part slips from 0 on."""
    return math.log(min(max(rest.slip().value, 1e-12), 1e12))


def _excess_load(rest: PartAtRest) -> float:
    """By how much the load leaves what contact bears, over the weight or so: the part is lost from 0 on."""
    law, part = rest.part.law, rest.part
    unit = part.mass * abs(part.gravity) + part.squeeze or part.mass
    excess = -math.inf
    if math.isfinite(law.pull_off):
        excess = -(rest.smallest_load().value + law.pull_off) / unit
    if math.isfinite(law.largest_load):
        excess = max(excess, (rest.largest_load().value - law.largest_load) / unit)
    return excess


def _first(excess: Callable[[float], float]) -> float:
    """The factor nearest to 1 from which an excess is positive, seen upwards; inf: none is up to the largest."""
    low = high = 1.0
    if excess(1.0) >= 0:
        while excess(low) >= 0:
            low, high = low / STEP, low
            if low < LEAST:
                return 0.0
    else:
        while excess(high) < 0:
            low, high = high, high * STEP
            if high > RANGE:
                return math.inf
    if math.isinf(excess(low)):
        return high
    return float(brentq(excess, low, high, xtol=EXACT * low, rtol=EXACT))
