"""Chart: where single runs slip a part, lose it or leave it at rest, over the drives' frequency and stroke."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple

from active_surface.studies.feasibility.borders import Column

State = Literal["rest", "moves", "lost", "either"]

TOLERANCE: Final = 0.01  # of borders between columns
# Ratios of the frequencies of neighbours between which there are no more columns, where so many of them are ragged.
RAGGED: Final = (1.015, 1.1, 1.2)


class Limits(NamedTuple):
    """The borders at one factor of frequency, as factors of the strokes; each lies from its first to its second."""

    slips: tuple[float, float]
    lost: tuple[float, float]


class Smooth(NamedTuple):
    """Whether borders are smooth from one column to the next."""

    slips: bool
    losses: bool


@dataclass(frozen=True, eq=False)
class Chart:
    """Columns of borders, ascending in frequency, and how they join.

    smooth: for each two neighbours, which borders are interpolated between them, to TOLERANCE; where they are not, all
        that lies between the lowest and the highest of theirs may go either way.
    """

    columns: tuple[Column, ...]
    strokes: tuple[float, float]  # least and largest factor
    smooth: tuple[Smooth, ...] = field(repr=False)

    def limits(self, frequency: float) -> Limits:
        """The borders at a factor of frequency within the columns."""
        columns = self.columns
        if not columns[0].frequency * (1 - 1e-9) <= frequency <= columns[-1].frequency * (1 + 1e-9):
            raise ValueError(
                f"Input frequency of the chart must be from {columns[0].frequency:g} to {columns[-1].frequency:g} "
                f"times the case's; got {frequency:g}"
            )
        right = min(max(bisect_right([one.frequency for one in columns], frequency), 1), len(columns) - 1)
        a, b = columns[right - 1], columns[right]
        if math.isclose(frequency, a.frequency, rel_tol=1e-9):
            return Limits((a.slips, a.slips), (a.lost, a.all_lost))
        if math.isclose(frequency, b.frequency, rel_tol=1e-9):
            return Limits((b.slips, b.slips), (b.lost, b.all_lost))
        share = math.log(frequency / a.frequency) / math.log(b.frequency / a.frequency)
        slips, lost, all_lost = (
            _between(getattr(a, name), getattr(b, name), share) for name in ("slips", "lost", "all_lost")
        )
        smooth = self.smooth[right - 1]
        return Limits(
            (slips, slips) if smooth.slips else (min(a.slips, b.slips), max(a.slips, b.slips)),
            (lost, all_lost) if smooth.losses else (min(a.lost, b.lost), max(a.all_lost, b.all_lost)),
        )

    def state(self, frequency: float, stroke: float) -> State:
        """What a run does at factors of frequency and stroke."""
        limits = self.limits(frequency)
        if stroke < limits.slips[0]:
            return "rest"
        if stroke >= max(limits.lost[1], limits.slips[1]):
            return "lost"
        return "moves" if limits.slips[1] <= stroke < limits.lost[0] else "either"


def make_chart(
    find: Callable[[float, float], Column],
    frequencies: Sequence[float],
    strokes: tuple[float, float],
    most: int,
    tell: Callable[[int, int], object] = lambda done, of: None,
) -> Chart:
    """The chart with columns at these ascending factors, and more of them where borders are not smooth.

    find: a column at a factor of frequency, near a guess of where slip begins.
    most: columns at most.  tell: takes how many there are, and of how many.
    """
    columns: list[Column] = []
    for frequency in frequencies:
        columns.append(find(frequency, _guess(columns)))
        tell(len(columns), most)
    errors = [(math.inf, math.inf)] * (len(columns) - 1)  # of slips and of losses
    while len(columns) < most:
        wide = [
            max(error[0] if _wide(a, b, False) else 0.0, error[1] if _wide(a, b, True) else 0.0)
            for error, a, b in zip(errors, columns[:-1], columns[1:], strict=True)
        ]
        # Columns make more of borders that are not ragged: these come first.
        urgent = [
            (error > TOLERANCE, not (a.ragged or b.ragged), error)
            for error, a, b in zip(wide, columns[:-1], columns[1:], strict=True)
        ]
        worst = max(range(len(urgent)), key=urgent.__getitem__, default=0)
        if not urgent or not urgent[worst][0]:
            break
        a, b = columns[worst], columns[worst + 1]
        middle = find(math.sqrt(a.frequency * b.frequency), _guess([a, b]))
        # An interpolation is off by a quarter as much over half of the distance.
        apart = _apart(middle, a, b, ("slips",)), _apart(middle, a, b, ("lost", "all_lost"))
        slips, losses = (error / 4 if error < 4 * TOLERANCE else error for error in apart)
        columns.insert(worst + 1, middle)
        errors[worst : worst + 1] = [(slips, losses)] * 2
        tell(len(columns), most)
    smooth = tuple(Smooth(slips <= TOLERANCE, losses <= TOLERANCE) for slips, losses in errors)
    return Chart(tuple(columns), strokes, smooth)


def _wide(a: Column, b: Column, losses: bool) -> bool:
    """Whether there may be a column between two; more of them make nothing of ragged borders."""
    ratio = RAGGED[a.ragged + b.ragged] if losses else RAGGED[0]
    return b.frequency > a.frequency * ratio


def _guess(columns: Sequence[Column]) -> float:
    """Where slip begins beside known columns."""
    return next((one.slips for one in reversed(columns) if math.isfinite(one.slips)), 1.0)


def _apart(middle: Column, a: Column, b: Column, names: Sequence[str]) -> float:
    """How far borders of a column halfway are from those interpolated between two others, in the logarithm."""
    return max(_difference(getattr(middle, name), _between(getattr(a, name), getattr(b, name), 0.5)) for name in names)


def _difference(one: float, other: float) -> float:
    if math.isinf(one) or math.isinf(other):
        return 0.0 if one == other else math.inf
    return abs(math.log(one / other))


def _between(a: float, b: float, share: float) -> float:
    """A border between two columns; one that is beyond the largest stroke in either is so between them."""
    return math.inf if math.isinf(a) or math.isinf(b) else a ** (1 - share) * b**share
