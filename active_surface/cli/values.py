"""Quantities given as options: frequencies and points."""

from __future__ import annotations


def frequency_of(text: str | None, option: str) -> float | None:
    """The frequency [Hz] that an option gives; None: it is not given."""
    from coupling.case import Quantity

    if text is None:
        return None
    try:
        return Quantity("Hz", "300 Hz").parse(text)
    except ValueError as error:
        raise ValueError(f"{option} {error}") from None


def place_of(text: str, option: str) -> tuple[float, float]:
    """The point [m] that an option gives, as two lengths with a comma between."""
    from coupling.case import Quantity

    parts = text.split(",")
    try:
        if len(parts) != 2:
            raise ValueError(f'must be two lengths, x and y, such as "100 um, 50 um"; got "{text}"')
        x, y = (Quantity("m", "100 um").parse(part.strip()) for part in parts)
    except ValueError as error:
        raise ValueError(f"{option} {error}") from None
    return x, y
