"""Feasible: where on a surface slip starts while the part stays attached, and how that changes with frequency.

A part at rest at a place slips there while the pull without friction exceeds what friction holds, and stays attached
while its net load lies between minus pull-off and the end of the friction law (`particle.events.mechanics` with
v = 0). Two areas follow from that, both over one window of time:

- feasible: places where it slips at that moment, and where it would not have come off at any moment of the window;
- slipping: places where it slips at that moment and is attached then, whatever happens there at other moments.

A part with a face slips beyond its limit surface and is lost where an edge lifts, too (`particle.body.rest`).

Drives that run `factor` times as fast leave shapes and slopes as they are and multiply accelerations by its square,
unless the plate has mass: then it moves in another way at each factor, and is driven anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from active_surface.arrays import BoolArray, FloatArray
from active_surface.studies.feasibility.counting import SHARES, SIDE, count_slips, find_held, find_states
from active_surface.studies.feasibility.places import Place, Squares, responses_of, resting_of, squares_within
from meshes import Outline
from particle import Body, Micropart, PartAtRest, SurfaceMotion, part_at_rest
from particle.drives import DriveTable
from particle.friction import LOCAL, Contact

ACROSS: Final = 100  # places along the longer side of the plate
PER_STROKE: Final = 24  # moments in the shortest stroke, at first
MAX_HALVINGS: Final = 3  # of the time between moments, where all factors share them
PER_PERIOD: Final = 16  # moments in a period of the lowest modes
LOWEST: Final = 3  # modes whose ringing is resolved
MAX_FINER: Final = 8  # times as many moments as strokes take
TOLERANCE: Final = 0.01  # of the areas: what half of that time may change
FEW: Final = 24  # places along the longer side that tell how many moments are enough
MAX_STROKES: Final = 85  # of the shortest, in a window


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


class Errors(NamedTuple):
    """Of the areas at any factor, over their value there, or a twentieth of the curve's largest if that is more."""

    moments: float  # what half of the time between moments changes, with fewer squares
    squares: float  # half of the largest difference between the areas by two halves of the points in the squares


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
    errors: Errors
    count: int  # moments looked at in the window, between which the surface is taken as linear


def find_feasible(
    surface: SurfaceMotion,
    outline: Outline,
    part: Micropart | Body,
    friction: Contact,
    window: float,
    factors: FloatArray,
    gravity: float | Sequence[float] = 9.80665,
    across: int = ACROSS,
    tips: bool = True,
) -> Feasible:
    """The feasible areas of a part at rest on a surface within an outline, over a window [s] from the start.

    factors: (F,) what the drives' frequencies are multiplied with, the base's drives among them. The surface follows
        its drives at once; one with inertia does not.
    window: no more of it is looked at than MAX_STROKES of the shortest strokes of drives that move.
    gravity: as for `particle.simulate`.  across: places along the longer side.
    tips: whether a part with a face is lost where an edge lifts.
    The part's place and velocity do not matter; a face keeps its heading. The time between moments is halved until the
    areas hold to TOLERANCE, at most MAX_HALVINGS times.
    """
    stroke_time = float(surface.drives.stroke_time[moving(surface.drives)].min(initial=window))
    window, count = min(window, MAX_STROKES * stroke_time), moments_in(window, stroke_time)
    place = Place(outline, part, friction, gravity, across, tips)
    return _examine(surface, place, window, count, np.sort(np.asarray(factors, dtype=float)), MAX_HALVINGS)


def find_feasible_anew(
    driven: Callable[[float, float], SurfaceMotion],
    modes: FloatArray,
    stroke_time: float,
    place: Place,
    window: float,
    factors: FloatArray,
) -> Feasible:
    """The feasible areas of a plate with mass, which is driven anew at each of ascending factors (F,).

    driven: gives the surface under drives that run `factor` times as fast, good up to a time [s].
    modes: Hz, natural frequencies, ascending.  stroke_time: s, the shortest at a factor of 1.
    """
    window, least = min(window, MAX_STROKES * stroke_time), moments_in(window, stroke_time)
    ringing = window * PER_PERIOD * float(modes[:LOWEST].max(initial=0.0))

    def at(factor: float) -> Feasible:
        count = int(np.clip(np.ceil(ringing / factor), least, MAX_FINER * least))
        return _examine(driven(factor, window / factor), place, window / factor, count, np.ones(1), 1)

    own, every = at(1.0), [at(factor) for factor in factors.tolist()]
    feasible, slipping = (
        Curves(*(np.array([getattr(getattr(one, name), curve)[0] for one in every]) for curve in Curves._fields))
        for name in ("feasible", "slipping")
    )
    return replace(
        own, factors=factors, window=window, feasible=feasible, slipping=slipping,
        lost_area=np.array([one.lost_area[0] for one in every]),
        errors=Errors(*np.max([one.errors for one in [own, *every]], axis=0).tolist()),
        count=max(one.count for one in [own, *every]),
    )  # fmt: skip


def moments_in(window: float, stroke_time: float) -> int:
    """How many moments of a window [s] are looked at at first, where the shortest stroke takes so long [s]."""
    return max(math.ceil(PER_STROKE * min(window, MAX_STROKES * stroke_time) / stroke_time), PER_STROKE)


def _examine(
    surface: SurfaceMotion, place: Place, window: float, count: int, factors: FloatArray, most: int
) -> Feasible:
    """The areas at so many moments of the whole window [s] or, up to `most` times, twice as many; ascending factors."""
    every = np.append(factors, 1.0)
    rest = part_at_rest(surface, place.part, place.friction, window, place.gravity, place.tips)
    if rest.part.law.kind == LOCAL:
        raise ValueError("Input friction of find_feasible must not be a LocalContact")

    def look(squares: Squares, moments: int) -> _Counts:
        return _count(rest, squares, np.linspace(0.0, window, moments + 1), every**2)

    # Few squares tell how many moments are enough, if a face has room in them.
    few = squares = squares_within(place.outline, place.across, rest)
    with suppress(ValueError):
        few = squares_within(place.outline, min(place.across, FEW), rest)
    coarse, error = look(few, count), np.inf
    for _ in range(most):
        fine = look(few, 2 * count)
        error = _change(coarse.curves(), fine.curves(), 1.0)
        if error <= TOLERANCE:
            break
        coarse, count = fine, 2 * count
    found = look(squares, count)
    areas = found.slips.mean(axis=0) * squares.side**2
    moments = window * (np.arange(areas.shape[2]) + 0.5) / areas.shape[2]
    peaks, integrals = areas.max(axis=2), areas.mean(axis=2) * window / every
    feasible, slipping = (Curves(peaks[k, :-1], integrals[k, :-1]) for k in (0, 1))
    lost_area = found.lost.sum(axis=0) * squares.side**2
    lost = found.lost[:, -1] >= 0.5
    own = Own(float(peaks[0, -1]), float(integrals[0, -1]), float(lost_area[-1]), found.shares, lost, areas[0, -1])
    halves = [found.curves(found.slips[half]) for half in (0, 1)]
    errors = Errors(float(error), _change(halves[0], halves[1], 0.0) / 2)
    return Feasible(
        factors, window, moments, squares.centres, squares.side, feasible, slipping, lost_area[:-1], own, errors, count
    )


class _Counts(NamedTuple):
    """How many of n squares slip at shares of the time between moments, what is lost left out and all."""

    slips: FloatArray  # (2, 2, F, k), by halves of the points in the squares, each for itself
    lost: FloatArray  # (n, F) shares of the squares
    shares: FloatArray  # (n,) of the window and the square in which the part slips at the last factor

    def curves(self, slips: FloatArray | None = None) -> FloatArray:
        """Largest and mean numbers of squares that slip (4, F), at all points or of one half of them (2, F, k)."""
        counts = self.slips.mean(axis=0) if slips is None else slips
        return np.concatenate([counts.max(axis=2), counts.mean(axis=2)])


def _count(rest: PartAtRest, squares: Squares, moments: FloatArray, scales: FloatArray) -> _Counts:
    size, neighbours = (len(squares.centres), len(scales)), squares.neighbours
    part, resting, responses = rest.part, resting_of(rest), responses_of(rest, squares.centres, moments)
    held = np.empty((size[0], SIDE, SIDE, 2))
    held[:] = 0.0, np.inf
    for one in responses():
        find_held(one, neighbours, part, resting, held)
    low, high = held[..., :1], held[..., 1:]
    lost = (~((low <= scales) & (scales <= high))).sum(axis=(1, 2), dtype=np.int8)
    first, second = np.zeros(size, dtype=np.int8), np.zeros(size, dtype=np.int8)
    slips, counts = np.zeros(size[0]), np.zeros((len(moments) - 1, 2, 2, size[1], SHARES))
    before: FloatArray | None = None
    for k, after in enumerate(responses()):
        find_states(after, scales, part, resting, second)
        if before is not None:
            state = held, lost, first, second
            count_slips(before, after, neighbours, scales, part, resting, *state, counts[k - 1], slips)
        before, first, second = after, second, first
    ordered = np.moveaxis(counts, 0, 3).reshape(2, 2, size[1], -1)
    return _Counts(ordered, lost / SIDE**2, slips / (len(moments) - 1))


def _change(a: FloatArray, b: FloatArray, slack: float) -> float:
    """The largest difference of curves (4, F) at any factor, as `Errors`; so many squares more in a peak are none."""
    change = np.abs(a - b)
    peaks = change[: len(a) // 2]
    peaks[:] = np.maximum(peaks - slack, 0.0)
    scale = np.maximum(np.maximum(a, b), 0.05 * np.maximum(a, b).max(axis=1, keepdims=True))
    return float(np.divide(change, scale, out=np.zeros_like(a), where=scale > 0).max())


def moving(drives: DriveTable) -> BoolArray:
    """Whether each drive (N,) ever changes its height; one without a stroke has a frequency, too."""
    pieces = drives.coefficients[:, 1:]
    return np.array([pieces[first:last].any() for first, last in pairwise(drives.first)], dtype=np.bool_)
