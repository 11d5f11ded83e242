"""Dimensions: what quantities are called, and units as pint knows them, which takes long to load."""

from __future__ import annotations

from contextlib import suppress
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import pint

DIMENSIONS: Final = {
    "m": "a length", "m^2": "an area", "m^3": "a volume", "rad": "an angle",
    "s": "a time", "Hz": "a frequency", "rad/s": "an angular velocity", "m/s": "a velocity", "m/s^2": "an acceleration",
    "kg": "a mass", "kg/m^3": "a density", "N": "a force", "Pa": "a pressure",
    "J": "an energy", "J/m^2": "an energy per area", "N/m": "a stiffness", "N/m^3": "a stiffness per area",
    "W": "a power", "K": "a temperature", "1": "a plain number",
}  # fmt: skip
"""SI units, and what a quantity in each is called in a message."""

RANGES: Final = {
    "m": (1e-15, 1e3), "m^2": (1e-24, 1e6), "rad": (1e-9, 1e6), "s": (1e-12, 1e6), "Hz": (1e-6, 1e12),
    "m/s": (1e-15, 1e6), "m/s^2": (1e-12, 1e9), "kg": (1e-24, 1e3), "kg/m^3": (1e-3, 1e7), "N": (1e-21, 1e6),
    "Pa": (1e-3, 1e15), "J/m^2": (1e-9, 1e3), "N/m": (1e-12, 1e12), "N/m^3": (1e-6, 1e21),
}  # fmt: skip
"""Between which sizes a quantity in an SI unit may be: the smallest of one that must not be 0, and the largest."""


@cache
def registry() -> pint.UnitRegistry[Any]:
    import pint

    # Decimals, so that "100 um" gives the float 1e-4 itself and not a neighbour.
    return pint.UnitRegistry(non_int_type=Decimal)


def is_unit(name: str) -> bool:
    try:
        registry().parse_units(name)
    except Exception:
        return False
    return True


def root_of(unit: str) -> pint.Unit:
    # Dimensions do not tell Hz from rad/s, and pint would turn 60 rpm into 6.28 Hz; root units differ.
    return registry().get_root_units(registry().parse_units(unit))[1]


def si_of(unit: str) -> str:
    """The key of `DIMENSIONS` with the dimension of a unit; "" where there is none, or no such unit."""
    with suppress(Exception):
        root = root_of(unit)
        return next((si for si in DIMENSIONS if root_of(si) == root), "")
    return ""


def dimension_of(unit: str) -> str:
    """Return what a quantity in `unit` is called."""
    si = unit if unit in DIMENSIONS else si_of(unit)  # N/m has the dimension of J/m^2
    return DIMENSIONS[si] if si else f"a quantity in {root_of(unit):~}"
