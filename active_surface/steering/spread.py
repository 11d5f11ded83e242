"""Spread: drives that stand for all that a search may try, for which a plate that stretches is solved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.steering.disturbances import deviations, stroke_room
from active_surface.steering.knobs import Knobs
from active_surface.steering.paths import driven
from active_surface.steering.tables import Settings
from coupling import build_drives
from coupling.case import ActuatorCase, Case
from particle import AnyDrive

COUNT: Final = 64  # sets of drives


def spread_drives(case: Case, settings: Settings, able: Sequence[int], together: int) -> list[list[AnyDrive]]:
    """Sets of drives of a case, one an actuator in each.

    In each set some actuators move endlessly with any values of their knobs within the bounds, the others rest. The
    first two sets have all strokes lowest and highest, with room for scatter; the last one has the case's own drives.

    able: numbers of the actuators that can take part.  together: how many do at most.
    """
    generator, sets = np.random.default_rng(settings.seed), []
    ends = Knobs(case, settings, tuple(able))
    low, high = np.array(ends.bounds, dtype=float).reshape(-1, 2).T
    samples = [(ends, low), (ends, high)]
    for _ in range(COUNT):
        chosen = generator.choice(able, min(together, len(able)), replace=False)
        knobs = Knobs(case, settings, tuple(sorted(chosen.tolist())))
        low, high = np.array(knobs.bounds, dtype=float).reshape(-1, 2).T
        samples.append((knobs, low + (high - low) * generator.random(len(low))))
    deviating = deviations(case, settings.disturbances)
    own = [case.actuators] if settings.stroke is None else []  # searched around where they end near the target
    for actuators in (*(knobs.actuators(values) for knobs, values in samples), *own):
        longer = [
            one if one.stroke is None else _endless(one, stroke_room(deviating, k, abs(one.stroke)))
            for k, one in enumerate(actuators)
        ]
        sets.append(build_drives(driven(case, tuple(longer))))
    return sets


def _endless(actuator: ActuatorCase, factor: float) -> ActuatorCase:
    """The same with a longer stroke that goes up and down without end."""
    stroke = (actuator.stroke or 0.0) * factor
    goes_on = {"cycles": None, "delay": 0.0} if stroke and actuator.cycle == "up-down" else {}
    return actuator.model_copy(update={"stroke": stroke} | goes_on)
