"""Quantities given as options: frequencies, strokes, points and numbers of actuators."""

from __future__ import annotations


def frequency_of(text: str | None, option: str) -> float | None:
    """The frequency [Hz] that an option gives; None: it is not given."""
    return amount_of(text, "Hz", "300 Hz", option)


def stroke_of(text: str | None, unit: str, option: str) -> float | None:
    """The stroke [m], or force [N] where that is the unit, that an option gives; None: it is not given."""
    return amount_of(text, unit, "12 um" if unit == "m" else "1 mN", option)


def point_of(text: str, unit: str, option: str) -> tuple[float, float] | tuple[()]:
    """The frequency [Hz] and the stroke [m or N] that an option gives, with a comma between; (): the best point."""
    if text.strip().lower() == "best":
        return ()
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2:
        raise ValueError(f'{option} must be "best", or a frequency and a stroke such as "2.4 kHz, 12 um"; got "{text}"')
    frequency, stroke = frequency_of(parts[0], option), stroke_of(parts[1], unit, option)
    assert frequency is not None and stroke is not None
    if not (frequency > 0 and stroke > 0):
        raise ValueError(f'{option} must be a positive frequency and a positive stroke; got "{text}"')
    return frequency, stroke


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


def amount_of(text: str | None, unit: str, example: str, option: str) -> float | None:
    """The quantity [unit] that an option gives; None: it is not given."""
    from coupling.case import Quantity

    if text is None:
        return None
    try:
        return Quantity(unit, example).parse(text)
    except ValueError as error:
        raise ValueError(f"{option} {error}") from None


def numbers_of(text: str | None, option: str) -> list[int]:
    """The numbers of actuators that an option gives, with commas between; none: it is not given."""
    parts = [] if text is None else [part.strip() for part in text.split(",")]
    if not all(part.isdecimal() for part in parts):
        raise ValueError(f'{option} must be numbers of actuators, such as "3,7"; got "{text}"')
    return sorted({int(part) for part in parts})
