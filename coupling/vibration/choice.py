"""How many modes a plate needs for the acceleration of its surface, and which of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coupling.drives import stroke_heights
from coupling.vibration.motion import ModalMotion, modal_motion
from coupling.vibration.oscillators import Oscillators
from fem_plate import MAX_MODES, Excitation, ExcitedModes, HeldShapes, InfluenceShapes
from particle import AnyDrive

FloatArray = NDArray[np.float64]
Damping = Callable[[FloatArray], FloatArray]
"""The damping ratios (n,) of modes with natural frequencies (n,) [Hz]."""

TOLERANCE = 5e-4  # of the largest acceleration: what half as many responses more may change
# Times that: what is still missing, where the error falls as one over the number of responses or faster.
REMAINING = 2.0
DROPPED = 3e-4  # of it: what the modes that are left out may add together
SAMPLES, MAX_POINTS = 400, 400
GOLDEN = (5**0.5 - 1) / 2


@dataclass(frozen=True, eq=False)
class ChosenModes:
    """The modes that are kept, and how good the surface's acceleration is with them."""

    modes: ExcitedModes
    error: float  # of the largest acceleration: what the last modes change, and what is left out


def choose_modes(
    shapes: InfluenceShapes | HeldShapes,
    excitation: Excitation,
    damping: Damping,
    sets: Sequence[Sequence[AnyDrive]],
    end: float,
    steady: bool,
    tell: Callable[[int, int], None] = lambda done, of: None,
) -> ChosenModes:
    """The modes that the plate needs under several sets of drives, up to an end [s].

    Responses are added, half as many as there are at a time, until they change the acceleration by less than 5e-4 of
    its largest: a single one may change nothing before others do. Then modes that hardly move are left out.
    tell: takes how much is done, and of how much.
    Raises ValueError when a mode without damping resonates.
    """
    xy = shapes.functions.space.samples * shapes.size
    xy = xy[:: max(len(xy) // MAX_POINTS, 1)]
    times = np.asarray(end * (np.arange(1, SAMPLES + 1) * GOLDEN % 1.0))
    static = shapes.values(xy)
    carried = [stroke_heights(drives, times, 2) @ static.T for drives in sets]  # (k, points) of each set
    before: list[FloatArray] | None = None
    error = np.inf
    while True:
        modes = excitation.modes()
        rung = [motion_of(modes, damping, drives, end, steady).evaluate(times)[2] for drives in sets]  # (k, n) of each
        values = modes.functions.values(xy / shapes.size)
        after = [fixed + own @ values.T for fixed, own in zip(carried, rung, strict=True)]
        largest = max(float(np.abs(w_tt).max()) for w_tt in after)
        if before is not None and largest > 0:
            change = max(float(np.abs(one - other).max()) for one, other in zip(after, before, strict=True)) / largest
            error = REMAINING * change
        if largest == 0 or error < REMAINING * TOLERANCE or excitation.exhausted:
            break
        before = after
        for _ in range(max(len(excitation.blocks) // 2, 1)):
            if not excitation.exhausted:
                excitation.grow()
        tell(min(len(modes.omega), MAX_MODES - 1), MAX_MODES)
    kept, dropped = _few(rung, values, DROPPED * largest)
    return ChosenModes(modes.chosen(kept), (error if np.isfinite(error) else 0.0) + dropped / (largest or 1.0))


def _few(rung: Sequence[FloatArray], values: FloatArray, allowed: float) -> tuple[NDArray[np.bool_], float]:
    """The modes (n,) to keep, so that what the others add to the acceleration is at most allowed; and what that is.

    rung: accelerations (k, n) of the modes under each set of drives.  values: (points, n), of the modes.
    """
    most = np.max([np.abs(own).max(axis=0) for own in rung], axis=0)
    order = np.argsort(most)

    def added(count: int) -> float:
        """By the `count` modes that move least."""
        weak = order[:count]
        return max(float(np.abs(own[:, weak] @ values[:, weak].T).max(initial=0.0)) for own in rung)

    low, high = 0, len(order)  # added(low) is allowed; as many as `high` are too many
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if added(middle) <= allowed else (low, middle)
    kept = np.ones(len(most), dtype=bool)
    kept[order[:low]] = False
    return kept, added(low)


def motion_of(
    modes: ExcitedModes, damping: Damping, drives: Sequence[AnyDrive], end: float, steady: bool
) -> ModalMotion:
    """How modes move under the drives of the actuators; equal drives count once."""
    distinct = list(dict.fromkeys(drives))
    numbers = {drive: k for k, drive in enumerate(distinct)}
    together = np.zeros((len(drives), len(distinct)))
    together[np.arange(len(drives)), [numbers[drive] for drive in drives]] = 1.0
    oscillators = Oscillators(
        np.ascontiguousarray(modes.omega),
        damping(modes.frequencies),
        np.ascontiguousarray(modes.participation @ together),
    )
    return modal_motion(oscillators, distinct, end, steady)
