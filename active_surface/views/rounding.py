"""Round numbers, for lengths, factors and grids that are told in words."""

from __future__ import annotations

import math

DIGITS = (1, 2, 5)
WANTED = 0.2  # of a length: about so large are heights drawn
ALMOST_SEEN = 1.5  # a smaller exaggeration is none
SLACK = 1e-9  # relative: a number that is round but for rounding is


def round_below(value: float) -> float:
    """The largest 1, 2 or 5 with a power of ten that is not above a positive number."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(digit * power for digit in DIGITS if digit * power <= value * (1 + SLACK))


def round_above(value: float) -> float:
    """The smallest one that is not below it."""
    power = 10.0 ** math.floor(math.log10(value))
    return min(digit * power for digit in (*DIGITS, 10) if digit * power >= value * (1 - SLACK))


def exaggeration(height: float, length: float) -> float:
    """How many times heights [m] of something so long [m] are drawn larger: a round number, 1 where they are seen."""
    wanted = WANTED * length / height if height > 0 else 1.0
    if wanted < ALMOST_SEEN:
        return 1.0
    return min(round_below(wanted), round_above(wanted), key=lambda factor: abs(math.log(factor / wanted)))
