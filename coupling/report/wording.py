"""How reports write counts, shares and lengths."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from common import quantity_text
from coupling.summary import PlateSummary, Summary

MICRO, MILLI = 1e6, 1e3
MICRO_UNITS: Final = re.compile(r"(?<=[\d)] )u(?=(?:m|N|s|g|Pa|J)\b)|\bu(?=m\b)")
"""The letter u of "2 um", which terminals can print, where it stands for the prefix."""


def unit_of(s: Summary) -> tuple[str, float]:
    """The unit of length in which the path has handy numbers, and how many make a metre."""
    return ("um", MICRO) if s.path_length < 0.01 else ("mm", 1e3) if s.path_length < 1 else ("m", 1.0)


def percent(share: float) -> str:
    return "more than 50 %" if share > 0.5 else f"about {100 * share:.2g} %"


def in_percent(share: float) -> str:
    percent = 100 * share
    return f"{percent:.2g} %" if percent < 99.5 else f"{percent:.0f} %"


def count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def by_theory(s: PlateSummary) -> str:
    return " by linear theory" if s.theory == "linear" else ""


def quantity(value: float, si: str, digits: int = 3) -> str:
    """A value [si] with its unit as in case files, "2.3 um"."""
    return quantity_text(value, si, digits).replace("\N{MICRO SIGN}", "u")


def with_micro_signs(text: str) -> str:
    """A text of the report as pages and pictures have it, "2.3 µm" for "2.3 um"."""
    return MICRO_UNITS.sub("\N{MICRO SIGN}", text)


def joined(words: Sequence[str]) -> str:
    """Words as a list in a sentence: 0, 2 and 3."""
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
