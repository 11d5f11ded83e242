"""DriftMap: where a part goes in a period of the drives, from everywhere on the plate, and how well runs agree."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.studies.drifts.basins import Basin, Basins, Fate, Field, basins_of
from common import count, percent, quantity
from meshes import Outline

NAMED: Final = 3  # ends, in words
FINE: Final = 0.01  # of the spacing: the digits of places in words
FAR: Final = 0.5  # of the way of runs, or of their number
DEEP: Final = 30.0  # times the smallest speed whose arrow is longer than the shortest
LENGTHS: Final = 0.35, 0.95  # of the spacing: those of the shortest and longest arrows
NONE: Final = math.nan
SLIDING: Final = 0.05  # share of the starts: of more that still move when the first period ends it is said


class Check(NamedTuple):
    """Runs from places in between, without a stop, against what a map says of them."""

    runs: int = 0
    periods: int = 0  # of each
    way: float = NONE  # m, the median from start to end, of those that both keep; nan: there are none
    gap: float = NONE  # m, the median between the ends of runs and those by the map
    otherwise: int = 0  # how many are lost where the map keeps them, or kept where it loses them

    @property
    def is_far(self) -> bool:
        """Whether the map says little of where runs end."""
        return self.gap > FAR * self.way or self.otherwise > FAR * self.runs

    @property
    def text(self) -> str:
        """What it says, in words."""
        found = []
        if not math.isnan(self.gap):
            way, gap = quantity(self.way, "m", 2), quantity(self.gap, "m", 2)
            found.append(f"they go {way} and end {gap} from where the map says, medians")
        if self.otherwise:
            found.append(f"{self.otherwise} lost where it keeps them, or kept where it loses them")
        what = "; ".join(found) or "they are lost, as the map says"
        return f"{count(self.runs, 'run')} of {count(self.periods, 'period')} from places in between: {what}"


@dataclass(frozen=True, eq=False)
class DriftMap:
    """Where a part goes in a period of some actuators, which have always been running, from rest at n places."""

    name: str  # of the group of actuators
    actuators: tuple[int, ...]  # of these that move; all others hold the plate where it is
    period: float  # s
    after: int  # periods from rest before that of the map
    field: Field
    starts: FloatArray  # (n, 2) m
    turned: FloatArray  # (n,) rad, in a period; 0 of a point
    sliding: float  # share of the parts that are still on the move when the first period ends
    check: Check
    outline: Outline
    places: FloatArray  # (N, 2) m, of all actuators

    @property
    def moved(self) -> FloatArray:
        """The displacements (n, 2) [m] in a period; 0 where a part stays or is lost."""
        return self.field.moved

    @property
    def fates(self) -> IntArray:
        """What becomes of the parts (n,) within a period: 0 they stay, 1 move, 2 come off, 3 leave the plate."""
        return self.field.fates

    @cached_property
    def basins(self) -> Basins:
        """Where parts end in the long run."""
        return basins_of(self.field, self.starts)

    @property
    def speed(self) -> float:
        """The largest mean speed [m/s] of a part that is kept."""
        return float(np.hypot(*self.moved.T).max(initial=0.0)) / self.period

    def arrows(self, fastest: float) -> FloatArray:
        """Arrows (k, 2) [m] for the parts that move, longer for speeds over a DEEP-th of the fastest [m/s]."""
        moved = self.moved[self.fates == Fate.MOVES]
        length = np.hypot(*moved.T)
        share = np.clip(1 + np.log(length / (self.period * fastest)) / math.log(DEEP), 0.0, 1.0)
        return moved * (self.field.spacing * (LENGTHS[0] + (LENGTHS[1] - LENGTHS[0]) * share) / length)[:, None]

    def figures(self) -> dict[str, Any]:
        """The figures by name, in SI units."""
        basins, check = self.basins, self.check._asdict()
        return {
            "group": self.name,
            "actuators": list(self.actuators),
            "period": self.period,
            "after": self.after,
            "fastest": self.speed,
            "stay": basins.stay,
            "come_off": basins.come_off,
            "leave": basins.leave,
            "ends": [one._asdict() for one in basins.ends],
            "still_sliding": self.sliding,
            "check": {name: None if math.isnan(value) else value for name, value in check.items()},
        }

    @property
    def later(self) -> str:
        """Which period it is, in words, where many parts still move when the first ends."""
        still = f"{percent(self.sliding)} still move when the first ends; this is no. {self.after + 1}"
        return f" ({still})" if self.sliding > SLIDING else ""

    @property
    def text(self) -> str:
        """What becomes of the parts, in words."""
        basins = self.basins
        if basins.stay == 1.0:
            return "no part moves"
        ends = [f"{percent(one.share)} end {self._where(one)}" for one in basins.ends[:NAMED]]
        others = sum(one.share for one in basins.ends[NAMED:])
        shares = ((others, "elsewhere"), (basins.stay, "stay"), (basins.come_off, "come off"), (basins.leave, "leave"))
        found = [*ends, *(f"{percent(share)} {what}" for share, what in shares if share)]
        return f"up to {quantity(self.speed, 'm/s')}; of all starts {', '.join(found)}"

    def is_point(self, end: Basin) -> bool:
        """Whether parts end at one place, as far as the places tell."""
        return end.extent <= 2 * self.field.spacing

    def _where(self, end: Basin) -> str:
        place = place_text(end.place, self.field.spacing)
        return f"at {place}" if self.is_point(end) else f"over {quantity(end.extent, 'm', 2)} around {place}"


def place_text(place: Sequence[float], spacing: float) -> str:
    """A place [m] with as many digits as places so far apart [m] are worth, such as "(-131.7, 0.0) um"."""
    digits = max(0, math.ceil(-math.log10(1e6 * FINE * spacing)))
    return "({:.{d}f}, {:.{d}f}) um".format(*(round(1e6 * c, digits) + 0.0 for c in place), d=digits)
