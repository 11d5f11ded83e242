"""Faster: drives that do the same in less time, and the feasible areas of a plate that answers each speed anew.

A plate with mass does not follow its actuators at once: at twice the frequency it moves in another way, not the same
in half the time. So each factor of frequency takes a surface of its own; these share their modes and cells.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.studies.feasibility.area import MAX_STROKES, PER_STROKE, Curves, Errors, Feasible, examine
from meshes import Outline
from particle import AnyDrive, Micropart, SurfaceMotion
from particle.drives import QuinticDrive
from particle.friction import Contact

PER_PERIOD: Final = 16  # moments in a period of the lowest modes
LOWEST: Final = 3  # modes whose ringing is resolved
MAX_FINER: Final = 8  # times as many moments as strokes take
HALVINGS: Final = 1  # of the time between moments


def faster(drives: Sequence[AnyDrive], factor: float) -> list[AnyDrive]:
    """Drives that do the same in 1/factor of the time, delays included; equal drives stay one object."""
    distinct = {drive: _faster(drive, factor) for drive in dict.fromkeys(drives)}
    return [distinct[drive] for drive in drives]


def _faster(drive: AnyDrive, factor: float) -> AnyDrive:
    if factor == 1:
        return drive
    pieces = drive.segments()
    shortened = pieces._replace(start=pieces.start / factor, scale=pieces.scale / factor)
    return QuinticDrive(
        shortened, drive.stroke_time / factor, drive.frequency * factor, drive.error, drive.delay / factor
    )


def find_feasible_anew(
    driven: Callable[[float], SurfaceMotion],
    modes: FloatArray,
    stroke_time: float,
    outline: Outline,
    part: Micropart,
    friction: Contact,
    window: float,
    factors: FloatArray,
    gravity: float | Sequence[float],
    across: int,
) -> Feasible:
    """The feasible areas of a plate with mass, which is driven anew at each factor.

    driven: gives the surface under drives that run `factor` times as fast, good up to window / factor.
    modes: Hz, natural frequencies, ascending.  stroke_time: s, the shortest at a factor of 1.
    The rest is as for `find_feasible`.
    """
    factors = np.sort(np.asarray(factors, dtype=float))
    window = min(window, MAX_STROKES * stroke_time)
    least = max(int(np.ceil(PER_STROKE * window / stroke_time)), PER_STROKE)
    ringing = window * PER_PERIOD * float(modes[:LOWEST].max(initial=0.0))

    def at(factor: float) -> Feasible:
        count = int(np.clip(np.ceil(ringing / factor), least, MAX_FINER * least))
        end = window / factor
        return examine(driven(factor), outline, part, friction, end, count, np.ones(1), gravity, across, HALVINGS)

    own, found = at(1.0), [at(factor) for factor in factors.tolist()]
    feasible, slipping = (
        Curves(*(np.array([getattr(getattr(one, name), part)[0] for one in found]) for part in Curves._fields))
        for name in ("feasible", "slipping")
    )
    lost_area = np.array([one.lost_area[0] for one in found])
    errors = Errors(*(max(getattr(one.errors, name) for one in [own, *found]) for name in Errors._fields))
    count = max(one.count for one in [own, *found])
    return replace(
        own, factors=factors, window=window, feasible=feasible, slipping=slipping, lost_area=lost_area, errors=errors,
        count=count,
    )  # fmt: skip
