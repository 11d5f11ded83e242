"""Objective: how far from the target each of many settings of the knobs brings the part, and the surface for all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.steering.knobs import Knobs
from active_surface.steering.paths import Paths, cost, driven
from active_surface.steering.robustness import (
    SEARCHED,
    Disturbance,
    conditional_value_at_risk,
    deviations,
    draws,
    stroke_room,
)
from active_surface.steering.settings import Settings
from active_surface.steering.task import TOGETHER, Task, able, offset_of
from coupling import answers_drives, build_drives, build_friction, follow_part, shared_surface
from coupling.case import ActuatorCase, Case
from particle import AnyDrive, SurfaceMotion, interruptible

SAMPLES: Final = 16  # disturbed runs of each trial, if a quantile or CVaR is minimised
SETS: Final = 64  # of drives, for which a plate that stretches is solved


def objective(task: Task, threads: int | None = None) -> Objective:
    """The distance from a task's target as a function of its knobs, for optimisers of other libraries.

    The plate is solved once, here; each call follows one path for each setting of the knobs, or 16 disturbed ones where
    the settings have a quantile or CVaR.

    Parameters
    ----------
    task : Task
        The case, its target and what may be varied.
    threads : int, optional
        Number of paths at a time, by default one on each processor; the values are the same for any.

    Returns
    -------
    objective : Objective
        Callable with an array (n, knobs); returns the distances (n,), m.

    Raises
    ------
    ValueError
        The case cannot be run.
    """
    knobs = Knobs(task.case, task.settings, task.movers, wide=True)
    paths = Paths(task.case, prepared(task.case, task.settings), threads)
    return Objective(task, knobs, paths, task.settings.is_robust)


def prepared(case: Case, settings: Settings) -> SurfaceMotion:
    """The moving surface for a search; compiles all that paths need, so that Ctrl-C works from then on."""
    sets: list[list[AnyDrive]] = []
    if answers_drives(case):
        chosen = able(case, settings)
        sets = spread_drives(
            case, settings, chosen, len(chosen) if settings.actuators else settings.nearest or TOGETHER
        )
    surface = interruptible(shared_surface, case, sets, case.run.duration)
    interruptible(follow_part, case, surface, build_friction(case))
    return surface


def spread_drives(case: Case, settings: Settings, fit: Sequence[int], together: int) -> list[list[AnyDrive]]:
    """Sets of drives that stand for all that a search may try, one an actuator in each.

    In each set some actuators move endlessly with any values of their knobs within the bounds, the others rest. The
    first two sets have all strokes lowest and highest, with room for scatter; the last one has the case's own drives.

    fit: numbers of the actuators that can take part.  together: how many do at most.
    """
    generator, ends = np.random.default_rng(settings.seed), Knobs(case, settings, tuple(fit))
    settings_of = [ends.actuators(end) for end in np.array(ends.bounds, dtype=float).reshape(-1, 2).T]
    for _ in range(SETS):
        chosen = generator.choice(fit, min(together, len(fit)), replace=False)
        knobs = Knobs(case, settings, tuple(sorted(chosen.tolist())))
        low, high = np.array(knobs.bounds, dtype=float).reshape(-1, 2).T
        settings_of.append(knobs.actuators(low + (high - low) * generator.random(len(low))))
    if settings.stroke is None:  # the own drives are searched around where they end near the target
        settings_of.append(case.actuators)
    deviating = deviations(case, settings.disturbances)
    longer = (
        tuple(
            one if one.stroke is None else _endless(one, stroke_room(deviating, k, abs(one.stroke)))
            for k, one in enumerate(actuators)
        )
        for actuators in settings_of
    )
    return [build_drives(driven(case, actuators)) for actuators in longer]


def _endless(actuator: ActuatorCase, factor: float) -> ActuatorCase:
    """The same with a longer stroke that goes up and down without end."""
    stroke = (actuator.stroke or 0.0) * factor
    goes_on = {"cycles": None, "delay": 0.0} if stroke and actuator.cycle == "up-down" else {}
    return actuator.model_copy(update={"stroke": stroke} | goes_on)


class Objective:
    """The distance from a task's target as a function of its knobs: what `aim` minimises.

    Call it with settings (n, knobs) for distances (n,) in m. A part that has not come to a final rest counts as
    farther off than it is, and one that is lost as farther than any other. Equal settings give equal distances.
    """

    def __init__(self, task: Task, knobs: Knobs, paths: Paths, is_robust: bool = False) -> None:
        self._task, self._knobs, self._paths = task, knobs, paths
        # The same for every trial, so that trials differ in nothing but their drives.
        deviating = deviations(task.case, task.settings.disturbances) if is_robust else ()
        self._ways = draws(SAMPLES, deviating, task.settings.seed, SEARCHED) if is_robust else [Disturbance()]
        self._is_robust = is_robust

    def __call__(self, values: FloatArray) -> FloatArray:
        """The distances (n,) [m] for settings (n, knobs), or one for a single setting (knobs,)."""
        low, high = self.bounds.T
        trials = np.atleast_2d(np.asarray(values, dtype=float))
        if trials.shape[1:] != low.shape or not np.isfinite(trials).all():
            raise ValueError(
                f"values must be finite, one for each of the {len(low)} knobs; got an array {trials.shape}"
            )
        distances = self.evaluate(np.clip(trials, low, high))[1]
        return distances if np.ndim(values) > 1 else distances[0]

    @property
    def names(self) -> tuple[str, ...]:
        """The knobs as paths of fields, such as actuators.0.stroke."""
        return tuple(knob.field.path for knob in self._knobs.knobs)

    @property
    def bounds(self) -> FloatArray:
        """The smallest and largest values (knobs, 2) in SI units; cycles are rounded down, so theirs end 1 above."""
        return np.array(self._knobs.bounds, dtype=float).reshape(-1, 2)

    @property
    def paths(self) -> int:
        """How many have been followed."""
        return self._paths.count

    @property
    def tolerance(self) -> float:
        """The distance [m] at which a search may end."""
        return self._task.settings.tolerance

    @property
    def runs(self) -> int:
        """How many paths one setting takes."""
        return len(self._ways)

    def case(self, values: FloatArray) -> Case:
        """The case with a setting (knobs,), as `run_case` and `write_case` take it."""
        low, high = self.bounds.T
        return driven(self._task.case, self._knobs.actuators(np.clip(np.asarray(values, dtype=float), low, high)))

    def evaluate(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How far off the ends are (n, 2) [m], and the distances (n,) [m]; of disturbed runs the ends' mean counts.

        With a heading to reach there is a third column, how far that is off as a length.
        """
        case, target, settings, turn = self._task.case, self._task.target, self._task.settings, self._task.turn
        trials = [self._knobs.actuators(row) for row in values]
        trajectories = self._paths.of([(actuators, way) for actuators in trials for way in self._ways])
        size = self._paths.surface.size
        off = np.array([offset_of(path, target, turn) for path in trajectories])
        costs = [cost(path, target, case.run.duration, size, settings.tolerance, turn) for path in trajectories]
        each = len(trials), len(self._ways)
        return off.reshape(*each, -1).mean(axis=1), self._measure(np.array(costs).reshape(each))

    def _measure(self, costs: FloatArray) -> FloatArray:
        """What counts of the costs (n, runs) [m] of disturbed runs."""
        settings = self._task.settings
        if not self._is_robust:
            return costs[:, 0]
        if settings.cvar is not None:
            return conditional_value_at_risk(costs, settings.cvar)
        return np.asarray(np.quantile(costs, settings.quantile or 0.0, axis=1))
