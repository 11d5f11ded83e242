"""A place as a command has it: two lengths, in micrometres or with their units."""

from __future__ import annotations

from coupling.case import Quantity, quoted

LENGTH = Quantity("m", "150 um")


def read_place(text: str, option: str) -> tuple[float, float]:
    """The place [m] in a text such as 100,-50; ValueError, naming the option, where that is none."""
    wanted = f'{option} must be two lengths, x and y, such as 100,-50 (um) or "0.1 mm,-50 um"; got {quoted(text)}'
    parts = text.split(",")
    if len(parts) != 2:
        raise ValueError(wanted)
    found = []
    for part in parts:
        try:
            found.append(LENGTH.convert(part, part.strip(), "um") if _is_number(part) else LENGTH.parse(part))
        except ValueError as error:
            raise ValueError(f"{wanted}, whose {part.strip() or 'empty part'} {error}") from None
    return found[0], found[1]


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
