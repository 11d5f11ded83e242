"""How many times heights are drawn larger than lengths along the plate."""

from __future__ import annotations

import math

ENOUGH, WANTED = 0.1, 0.2  # of the plate's longer side: heights of as much are drawn as they are, others as large


def exaggeration(height: float, length: float) -> float:
    """A round factor for heights [m] over a plate of some length [m]: 1, 2, 5, 10 and so on."""
    if height <= 0 or height >= ENOUGH * length:
        return 1.0
    factor = WANTED * length / height
    power = 10.0 ** math.floor(math.log10(factor))
    return max(max(step for step in (1, 2, 5) if step * power <= factor * (1 + 1e-9)) * power, 1.0)
