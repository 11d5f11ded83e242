"""The ends of a range of frequencies that a study looks at: what is wrong with them."""

from __future__ import annotations

import math

from common import quantity_text


def range_fault(
    caller: str, lowest: float | None, highest: float | None, low: float, high: float, defaults: tuple[str, str]
) -> str | None:
    """What is wrong with frequencies from low to high [Hz], in the words of those that were given; None: nothing.

    lowest, highest: as given.  defaults: what low and high are where these are None.
    """
    if 0 < low < high < math.inf:
        return None
    if lowest is None:
        return (
            f"Input highest of {caller} must be above the lowest, by default {defaults[0]}, {_hertz(low)}, and finite; "
            f"got {_hertz(high)}"
        )
    default = f"by default {defaults[1]}, " if highest is None else ""
    return (
        f"Input lowest of {caller} must be positive and below the highest, {default}{_hertz(high)}; got {_hertz(low)}"
    )


def _hertz(frequency: float) -> str:
    return quantity_text(frequency, "Hz", 6)
