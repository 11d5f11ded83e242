"""Spread: drives that stand for all that a search may try, for which a plate that stretches is solved."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from active_surface.steering.knobs import Knobs
from active_surface.steering.paths import driven
from active_surface.steering.scatter import STROKES
from active_surface.steering.tables import Settings
from coupling import build_drives
from coupling.case import Case
from particle import AnyDrive

COUNT: Final = 64  # sets of drives


def spread_drives(case: Case, settings: Settings, able: Sequence[int], together: int) -> list[list[AnyDrive]]:
    """Sets of drives of a case, one an actuator in each.

    In each set some actuators move endlessly with any values of their knobs within the bounds, the others rest. The
    first two sets have all strokes lowest and highest, with room for scatter.

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
    room = [1 + STROKES] * len(case.actuators)
    for knobs, values in samples:
        actuators = tuple(
            one.model_copy(update={"cycles": None, "delay": 0.0}) if one.stroke and one.cycle == "up-down" else one
            for one in knobs.actuators(values)
        )
        sets.append(build_drives(driven(case, actuators, room)))
    return sets
