"""Feasible: where on a surface slip starts while the part stays attached, and how that changes with frequency.

A part at rest at a place slips there while the pull without friction exceeds what friction holds, and stays attached
while its net load lies between minus pull-off and the end of the friction law (`particle.events.equations` with
v = 0). Two areas follow from that, both over one window of time:

- feasible: places where it slips at that moment, and where it would not have come off at any moment of the window;
- slipping: places where it slips at that moment and is attached then, whatever happens there at other moments.

Drives that run `factor` times as fast leave shapes and slopes as they are and multiply accelerations by its square,
unless the plate has mass (`faster`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from meshes import Outline
from particle import Micropart, SurfaceMotion, part_record
from particle.drives import DriveTable
from particle.events import count_slips, find_lost
from particle.friction import Contact

ACROSS: Final = 120  # places along the longer side of the plate
PER_STROKE: Final = 48  # moments in the shortest stroke
MAX_STROKES: Final = 85  # of the shortest, in a window
MAX_KEPT: Final = 20_000_000  # numbers of the surface that are kept from the search for losses to that for slips


class Curves(NamedTuple):
    """Areas over the factors (F,) that the drives' frequencies are multiplied with."""

    peak: FloatArray  # (F,) m^2, the largest at any moment
    integral: FloatArray  # (F,) m^2 s, over the window


@dataclass(frozen=True, eq=False)
class Own:
    """The same at the drives' own frequency, a factor of 1."""

    peak: float  # m^2, feasible
    integral: float  # m^2 s, feasible
    lost_area: float  # m^2
    shares: FloatArray = field(repr=False)  # (n,) of the window's time in which the part slips attached
    lost: BoolArray = field(repr=False)  # (n,) whether it comes off at some moment
    over_time: FloatArray = field(repr=False)  # (K,) m^2, the feasible area


@dataclass(frozen=True, eq=False)
class Feasible:
    """Where a part slips without coming off, over factors (F,) of frequency, moments (K,) and places (n,)."""

    factors: FloatArray  # (F,)
    window: float  # s, at a factor of 1, as looked at; it is shorter by the factor
    moments: FloatArray = field(repr=False)  # (K,) s, at a factor of 1
    points: FloatArray = field(repr=False)  # (n, 2) m, centres of squares
    spacing: float  # m, the squares' side
    feasible: Curves = field(repr=False)
    slipping: Curves = field(repr=False)
    lost_area: FloatArray = field(repr=False)  # (F,) m^2, where it comes off at some moment
    own: Own


State = tuple[FloatArray, tuple[FloatArray, FloatArray, FloatArray], FloatArray]


def find_feasible(
    surface: SurfaceMotion,
    outline: Outline,
    part: Micropart,
    friction: Contact,
    window: float,
    factors: FloatArray,
    gravity: float | Sequence[float] = 9.80665,
    across: int = ACROSS,
) -> Feasible:
    """The feasible areas of a part at rest on a surface within an outline, over a window [s] from the start.

    factors: (F,) what the drives' frequencies are multiplied with, the base's drives among them. The surface follows
        its drives at once; one with inertia does not.
    window: no more of it is looked at than MAX_STROKES of the shortest strokes of drives that move.
    gravity: as for `particle.simulate`.  across: places along the longer side.
    The part's place and velocity do not matter.
    """
    stroke_time = float(surface.drives.stroke_time[moving(surface.drives)].min(initial=window))
    window = min(window, MAX_STROKES * stroke_time)
    count = max(int(np.ceil(PER_STROKE * window / stroke_time)), PER_STROKE)
    factors = np.sort(np.asarray(factors, dtype=float))
    return examine(surface, outline, part, friction, window, count, factors, gravity, across)


def examine(
    surface: SurfaceMotion,
    outline: Outline,
    part: Micropart,
    friction: Contact,
    window: float,
    count: int,
    factors: FloatArray,
    gravity: float | Sequence[float],
    across: int,
) -> Feasible:
    """The same at so many moments of the whole window [s], for ascending factors."""
    every = np.append(factors, 1.0)
    points, spacing = places(outline, across)
    moments = window * (np.arange(count) + 0.5) / count
    resting = part_record(surface, part, friction, gravity)
    lost = np.zeros((len(every), len(points)), dtype=np.bool_)
    states = _states(surface, points, moments)
    for state in states():
        find_lost(*state, resting, every, lost)
    counts = np.zeros((2, len(every), count))
    slips = np.zeros(len(points))
    for k, state in enumerate(states()):
        count_slips(*state, resting, every, lost, counts[:, :, k], slips)
    areas = counts * spacing**2
    step = window / count
    peaks, integrals = areas.max(axis=2), areas.sum(axis=2) * step / every
    feasible, slipping = (Curves(peaks[k, :-1], integrals[k, :-1]) for k in (0, 1))
    lost_area = lost.sum(axis=1) * spacing**2
    own = Own(float(peaks[0, -1]), float(integrals[0, -1]), float(lost_area[-1]), slips / count, lost[-1], areas[0, -1])
    return Feasible(factors, window, moments, points, spacing, feasible, slipping, lost_area[:-1], own)


def moving(drives: DriveTable) -> BoolArray:
    """Whether each drive (N,) ever changes its height; one without a stroke has a frequency, too."""
    pieces = drives.coefficients[:, 1:]
    return np.array([pieces[first:last].any() for first, last in pairwise(drives.first)], dtype=np.bool_)


def _states(surface: SurfaceMotion, points: FloatArray, moments: FloatArray) -> Callable[[], Iterable[State]]:
    """w_tt (n,), slopes and their two rates (n, 2), and the acceleration in the plane (n, 2), moment by moment.

    On a mid-plane that stretches these are the material's slopes, off by its strain.

    They are kept where they take little memory, else found again.
    """

    def find() -> Iterator[State]:
        for time in moments.tolist():
            state = surface.evaluate(points, time)
            slopes = state.gradient, state.gradient_t, state.gradient_tt
            yield state.w_tt, slopes, state.u_tt + surface.base_acceleration(time)

    if 9 * len(points) * len(moments) > MAX_KEPT:
        return find
    kept = list(find())
    return lambda: kept


def places(outline: Outline, across: int) -> tuple[FloatArray, float]:
    """The centres (n, 2) [m] of squares that cover what the outline encloses, and their side [m]."""
    low, high = outline.box
    spacing = float((high - low).max()) / across
    counts = np.ceil((high - low) / spacing - 1e-9).astype(int)
    sides = [
        middle + spacing * (np.arange(n) - (n - 1) / 2) for middle, n in zip((low + high) / 2, counts, strict=True)
    ]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid[outline.gap(grid) > 0], spacing
