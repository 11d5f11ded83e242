"""Cases: by which readings each statement of the paper holds, in each model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple, Protocol

from active_surface.paper.models import CLOSED, PAPER, PLATE
from active_surface.paper.readings.reading import Reading
from active_surface.paper.readings.single import Shares
from active_surface.paper.readings.sweep import Row, Sweep
from active_surface.paper.share import NEARLY_ALL

STATEMENTS: Final = {
    "5": "three strokes begin to move parts at about 200 Hz; the area grows, peaks and falls",
    "6": "the integral is largest at 300 to 400 Hz for three strokes",
    "5, 6 (range)": "300 to 1000 Hz are feasible, almost whatever the stroke",
    "11": "velocities along x and y are constant multiples",
    "12": "the path from (170.08, 170.08) um is straight",
    "13, 14": "straight decline by 20.9 m/s^2",
    "15": "from a lowest frequency, held by friction, to a highest, where it comes off",
    "VI-B": "150 um are 33 % of the wavelength",
    "16": "at 250 Hz it returns to the first actuator, at 350 to 650 Hz it goes to the neighbour",
    "17a": "at 300 Hz it converges",
    "17b": "at 600 Hz it leaves in two strokes",
    "18": "the threshold is 320 Hz, below it parts converge",
    "18 (above)": "above the threshold parts leave",
    "18 (curve)": "the threshold is a quadratic function of the stroke",
    "19": "at 250 Hz all states converge",
    "20": "it leaves the 450 Hz actuator and converges to the 300 Hz one",
    "20 (five cycles)": "that takes five oscillations",
    "21": "it leaves the 400 Hz actuator and converges to the 300 Hz one",
    "VI-C (anywhere)": "from anywhere parts converge to the low frequency",
    "22": "parts lie within 5 um",
    "22 (1 um)": "some lie within 1 um",
    "22 (two cases)": "the two stated ones lie within 1 um",
}


class Shared(Protocol):
    """A row of any sweep."""

    @property
    def reading(self) -> Reading: ...
    @property
    def shares(self) -> dict[str, Shares]: ...


class Case(NamedTuple):
    """One reading with one choice of what a statement leaves open besides."""

    reading: Reading
    choice: str
    share: float

    @property
    def holds(self) -> bool:
        """Whether nearly all starts do what the paper says."""
        return self.share >= NEARLY_ALL


def cases_of(rows: Iterable[Shared], model: str, statement: str) -> list[Case]:
    """All cases of a statement in a model."""
    return [
        Case(row.reading, choice, share)
        for row in rows
        for choice, share in row.shares.get(model, {}).get(statement, {}).items()
    ]


def where(holding: Sequence[Case], every: Sequence[Case]) -> str:
    """For which values of what is open some cases hold; what holds for all values is not named."""
    parts = []
    radii = sorted({case.reading.radius for case in holding})
    if len(radii) < len({case.reading.radius for case in every}):
        parts.append("a = " + ", ".join(f"{1e6 * radius:g}" for radius in radii))
    gravities = {case.reading.gravity for case in holding}
    if len(gravities) < len({case.reading.gravity for case in every}):
        parts.append("gravity" if holding[0].reading.gravity else "no gravity")
    laws = {case.reading.law for case in holding}
    if len(laws) < len({case.reading.law for case in every}):
        parts.append(", ".join(laws))
    choices = list(dict.fromkeys(case.choice for case in holding))
    if len(choices) < len({case.choice for case in every}):
        others = f" or {len(choices) - 1} other{'s' * (len(choices) > 2)}" if len(choices) > 1 else ""
        parts.append(choices[0] + others)
    return "; ".join(parts) or "all"


def cell(cases: Sequence[Case]) -> str:
    """How often a statement holds, in a cell."""
    if not cases:
        return "-"
    holding = [case for case in cases if case.holds]
    if len(holding) == len(cases):
        return f"**everywhere** ({len(cases)})"
    if not holding:
        return f"**nowhere**, at most {100 * max(case.share for case in cases):.0f} %"
    return f"{len(holding)} of {len(cases)}"


def best_shares(row: Shared, model: str) -> dict[str, float]:
    """By statement the best share over what it leaves open besides the reading."""
    return {name: max(shares.values()) for name, shares in row.shares.get(model, {}).items()}


def met(row: Row, model: str) -> list[str]:
    """The statements that hold by one reading."""
    return [name for name, share in best_shares(row, model).items() if share >= NEARLY_ALL]


def best_row(sweep: Sweep) -> Row:
    """The reading by which most statements hold in the paper's scheme, and among these in our equations."""
    return max(sweep.rows, key=lambda row: (len(met(row, PAPER)), len(met(row, CLOSED)), len(met(row, PLATE))))
