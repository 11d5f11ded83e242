"""Chart: where single runs slip a part, lose it or leave it at rest, over the drives' frequency and stroke."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple

from active_surface.studies.feasibility.ground import Ground
from active_surface.studies.feasibility.losses import CLOSE, find_losses, margin_of
from coupling import borders

State = Literal["rest", "moves", "lost", "either"]

EXACT: Final = 1e-4  # of the stroke: where slip begins
STRIDE: Final = 0.4  # between the logarithms of strokes tried in search of it
TOLERANCE: Final = 0.01  # of borders between columns
ALIKE: Final = 2.1, 1.1  # ratios of frequencies, and of losses over slips, of two columns between which others are so
NEAR: Final = 0.99  # of the stroke where losses are expected: from there on they are looked for
BELOW: Final = 0.99  # of the stroke from which the part is lost
# Ratios of the frequencies of neighbours between which there are no more columns, where so many of them are ragged.
RAGGED: Final = (1.015, 1.1, 1.2)


@dataclass(frozen=True)
class Column:
    """The borders at one factor of frequency, as factors of the strokes; inf: not up to the largest looked at."""

    frequency: float
    slips: float  # from which the part leaves rest
    lost: float  # from which some run loses it
    all_lost: float  # from which all do
    runs: dict[float, float] = field(repr=False, compare=False, default_factory=dict)
    """By the factor of strokes: how near a run came to losing the part, from 1 to 0, at which it is lost."""

    @property
    def ragged(self) -> bool:
        """Whether strokes that lose the part and others lie side by side."""
        return self.all_lost > self.lost * CLOSE**2


def find_slip(ground: Ground, frequency: float, strokes: tuple[float, float], guess: float = 1.0) -> float:
    """The factor of strokes from which a part at rest at its start slips, or comes off, at a factor of frequency.

    inf: not up to the largest of `strokes`; their smallest where it slips at that.  guess: where to begin.
    """
    if any(ground.case.part.velocity) or ground.case.part.spin:
        return strokes[0]  # it is on the move from the start
    bottom, top = map(math.log, strokes)
    start = min(max(math.log(guess), bottom), top)

    def excess(x: float) -> float:
        return borders.excess_pull(ground.rest(frequency, math.exp(x)))

    x = borders.begins(excess, start, (bottom, top), STRIDE, EXACT / 2)
    return strokes[0] if x == -math.inf else math.exp(x + EXACT / 2)


def find_column(
    ground: Ground,
    frequency: float,
    strokes: tuple[float, float],
    beside: Sequence[Column] = (),
    threads: int | None = None,
) -> Column:
    """The borders at a factor of frequency, within factors of the strokes.

    beside: known columns. Slip is looked for from theirs. Between two of them with like borders, losses are looked for
        from just below where they are expected, else, or where the part is lost there already, from the first slip.
    """
    slips = find_slip(ground, frequency, strokes, _guess(beside))
    if slips > strokes[1]:
        return Column(frequency, slips, math.inf, math.inf)

    def run(more: Sequence[float]) -> list[float]:
        paths = ground.paths([(frequency, stroke) for stroke in more], threads)
        return [margin_of(path, ground.friction, ground.outline) for path in paths]

    lowest = slips * (1 + 2 * EXACT)
    low = max(NEAR * slips * _expected_loss(frequency, beside), lowest)
    if lowest < low < strokes[1]:
        first, last, runs = find_losses(run, slips, low, strokes[1])
        if first > low:
            return Column(frequency, slips, first, last, runs)
    first, last, runs = find_losses(run, slips, lowest, strokes[1])
    return Column(frequency, slips, max(first, slips), last, runs)


def _expected_loss(frequency: float, beside: Sequence[Column]) -> float:
    """Where losses begin at a factor of frequency, over where slip does, between two columns alike; else 0."""
    if len(beside) != 2 or not beside[0].frequency < frequency < beside[1].frequency:
        return 0.0
    low, high = sorted(one.lost / one.slips for one in beside)
    near = beside[1].frequency < beside[0].frequency * ALIKE[0] and high < min(low * ALIKE[1], math.inf)
    return math.sqrt(low * high) if near and not any(one.ragged for one in beside) else 0.0


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
        for one in (a, b):
            if math.isclose(frequency, one.frequency, rel_tol=1e-9):
                return Limits((one.slips, one.slips), (one.lost, one.all_lost))
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
    find: Callable[[float, Sequence[Column]], Column],
    frequencies: Sequence[float],
    strokes: tuple[float, float],
    most: int,
    tell: Callable[[int, int], object] = lambda done, of: None,
) -> Chart:
    """The chart with columns at these ascending factors, and more of them where borders are not smooth.

    find: a column at a factor of frequency, with known columns beside it: those below it, or one on either side.
    most: columns at most.  tell: takes how many there are, and of how many.
    """
    columns: list[Column] = []
    for frequency in (*frequencies[:-1:2], frequencies[-1]):
        columns.append(find(frequency, tuple(columns)))
        tell(len(columns), most)
    for n in range(1, len(frequencies) - 1, 2):
        columns.insert(n, find(frequencies[n], (columns[n - 1], columns[n])))
        tell(len(columns), most)
    errors = [(math.inf, math.inf)] * (len(columns) - 1)  # of slips and of losses

    def urgency(n: int) -> tuple[bool, bool, float]:
        """Columns make more of borders that are not ragged: these come first."""
        a, b = columns[n], columns[n + 1]
        error = max(
            error if _wide(a, b, losses) else 0.0 for error, losses in zip(errors[n], (False, True), strict=True)
        )
        return error > TOLERANCE, not (a.ragged or b.ragged), error

    while len(columns) < most:
        worst = max(range(len(errors)), key=urgency)
        if not urgency(worst)[0]:
            break
        a, b = columns[worst], columns[worst + 1]
        middle = find(math.sqrt(a.frequency * b.frequency), (a, b))
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


class Nearest(NamedTuple):
    """Where, just below the borders, a part that no point of a chart moves comes nearest to slipping."""

    frequency: float  # factor of the case's
    stroke: float  # likewise
    comes_off: bool  # whether a larger stroke loses the part there
    share: float  # of the pull over the friction limit


def nearest(ground: Ground, chart: Chart) -> Nearest:
    """Where a part at rest comes nearest to slipping, below the strokes that lose it."""
    found = []
    for column in chart.columns:
        comes_off = math.isfinite(column.lost)
        stroke = BELOW * column.lost if comes_off else chart.strokes[1]
        share = ground.rest(column.frequency, stroke).slip().value
        found.append(Nearest(column.frequency, stroke, comes_off, share))
    return max(found, key=lambda one: one.share)
