"""Round numbers, for lengths, factors and grids."""

from __future__ import annotations

import math

DIGITS = (1, 2, 5)
DRAWN_HEIGHT = 0.2  # of a length: heights are drawn about so large
MIN_EXAGGERATION = 1.5  # a smaller one counts as 1
SLACK = 1e-9  # relative: a number that is round but for rounding errors is round


def round_below(value: float) -> float:
    """The largest 1, 2 or 5 with a power of ten that is not above a positive number."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(digit * power for digit in DIGITS if digit * power <= value * (1 + SLACK))


def round_above(value: float) -> float:
    """The smallest one that is not below it."""
    power = 10.0 ** math.floor(math.log10(value))
    return min(digit * power for digit in (*DIGITS, 10) if digit * power >= value * (1 - SLACK))


def exaggeration(height: float, length: float) -> float:
    """The factor by which heights [m] of something so long [m] are drawn larger: a round number, or 1."""
    exact = DRAWN_HEIGHT * length / height if height > 0 else 1.0
    if exact < MIN_EXAGGERATION:
        return 1.0
    return min(round_below(exact), round_above(exact), key=lambda factor: abs(math.log(factor / exact)))
