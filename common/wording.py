"""Wording: how texts and pictures write quantities with SI prefixes, shares, counts and lists."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"))
NOTHING = 1e-12  # SI units: smaller numbers are rounding errors
ROUNDING = 1e-9  # relative
OF_ZEROS = {"m": ("µm", 1e6)}
"""The units that zeros take, where it is not the SI unit: parts and plates are that large."""


class Unit(NamedTuple):
    """A unit of the same dimension as an SI unit."""

    name: str
    per_si: float  # how many of it make up the SI unit


def unit_for(values: ArrayLike, si: str) -> Unit:
    """The largest unit of which the largest of some values [si] is at least one.

    Where all are 0, or one is not finite, it is the SI unit, but the micrometre of lengths.
    """
    extent = float(np.abs(values).max())
    if extent < NOTHING or not np.isfinite(extent):
        return Unit(*OF_ZEROS.get(si, (si, 1.0)))
    size, prefix = next((pair for pair in PREFIXES if extent >= pair[0] * (1 - ROUNDING)), PREFIXES[-1])
    return Unit(prefix + si, 1 / size)


def quantity_text(value: float, si: str, digits: int = 3) -> str:
    """A value [si] with so many digits and its unit, such as "12.3 µm"."""
    unit = unit_for(value, si)
    number = float(f"{value * unit.per_si:.{digits}g}")
    return f"{number:.{max(digits, 6)}g} {unit.name}"  # two digits alone turn 250 into 2.5e+02


def quantity(value: float, si: str, digits: int = 3) -> str:
    """A value [si] as `quantity_text` writes it, but in letters of ASCII, as in case files: "12.3 um"."""
    return quantity_text(value, si, digits).replace("\N{MICRO SIGN}", "u")


def range_text(low: float, high: float, si: str, digits: int = 3, word: str = "to") -> str:
    """Two values [si] and a word between them, such as "12.3 to 250 µm" or "900 Hz to 1.2 kHz"."""
    texts = [quantity_text(value, si, digits) for value in (low, high)]
    (number, its_unit), unit = texts[0].split(" "), texts[1].split(" ")[1]
    return f"{number if its_unit == unit else texts[0]} {word} {texts[1]}"


def percent(share: float) -> str:
    """A share with two digits, such as "0.51 %"."""
    value = 100 * share
    return f"{value:.2g} %" if value < 99.5 else f"{value:.0f} %"


def count(number: int, noun: str) -> str:
    """A number of things, such as "1 slip" or "3 slips"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def joined(words: Sequence[str]) -> str:
    """Words as a list in a sentence: 0, 2 and 3."""
    return " and ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
