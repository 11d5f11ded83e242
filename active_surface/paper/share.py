"""Share: how many of all starts do something, with the confidence interval of the true share."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt
from typing import Final, NamedTuple

NEARLY_ALL, HARDLY_ANY = 0.9, 0.1  # shares of starts at which a statement is met, or not met
NORMAL: Final = 1.959964  # standard deviations on either side that hold 95 % of a normal distribution


class Share(NamedTuple):
    """`hits` of `of`, with Wilson's interval of 95 %."""

    hits: int
    of: int

    @property
    def value(self) -> float:
        """0 to 1."""
        return self.hits / self.of

    @property
    def interval(self) -> tuple[float, float]:
        """Lower and upper end, 0 to 1."""
        square = NORMAL**2 / self.of
        middle = self.value + square / 2
        half = NORMAL * sqrt(self.value * (1 - self.value) / self.of + square / (4 * self.of))
        return max((middle - half) / (1 + square), 0.0), min((middle + half) / (1 + square), 1.0)

    @property
    def met(self) -> float:
        """1 or 0 where the whole interval lies above or below those shares, else a half."""
        low, high = self.interval
        return 1.0 if low >= NEARLY_ALL else 0.0 if high <= HARDLY_ANY else 0.5

    def __str__(self) -> str:
        low, high = self.interval
        return f"{100 * self.value:.0f} % ({100 * low:.0f}-{100 * high:.0f})"


def share_of(holds: Iterable[bool]) -> Share:
    """The share of those that hold."""
    every = [bool(one) for one in holds]
    return Share(sum(every), len(every))


def percents(shares: Iterable[Share]) -> str:
    """Several shares in short: 100, 87, 0 %."""
    return ", ".join(f"{100 * share.value:.0f}" for share in shares) + " %"
