"""Setting: what a trial run changes, and what it then did."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple


@dataclass(frozen=True)
class Trial:
    """A run with other drives, or from another place, that moved the part and kept it."""

    frequency: float  # over the case's own
    stroke: float
    friction: float  # of what friction holds
    place: tuple[float, float] | None  # m, where it began; None: at the case's start
    distance: float  # m
    duration: float  # s, at most that of the case
    smallest_load: float  # N
    plasticity_index: float | None = None  # of Kogut and Etsion's law; None: the case's own
    ramp: float | None = None  # cycles over which forces grow that begin at once in the case; None: as there


class Setting(NamedTuple):
    """What a trial changes besides what its thresholds are of."""

    stroke: float = 1.0  # over the case's own
    friction: float = 1.0  # of what friction holds
    plasticity: float | None = None  # its index; None: the case's own
    ramp: float | None = None  # cycles, of forces that begin at once; None: the case's own
    pulled: bool = True  # whether the plate may pull at the part where the law bears any load


OWN: Final = Setting()
