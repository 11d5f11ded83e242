"""Options that several commands have, the quantities that options give, and bars."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from active_surface.cli.command import option
from active_surface.cli.refusal import refusing

if TYPE_CHECKING:
    from coupling import Progress, ProgressCallback

RESULTS = Path("results")
POSITIVE = click.IntRange(min=1)
NOT_NEGATIVE = click.IntRange(min=0)


class Folder(click.Path):
    """A folder that is there, or that can be made: better to know before the work than after it."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Path:
        from coupling import check_folder

        with refusing():
            check_folder(Path(value))
        return Path(value)


EXAMPLES = {"Hz": "300 Hz", "m": "12 um", "N": "1 mN"}  # of quantities, by their units
FILE = click.Path(path_type=Path, dir_okay=False)
FOLDER = Folder(file_okay=False)
Output = Annotated[Path, option("Folder for the results [results].", "-o", type=FOLDER)]
Overwrite = Annotated[bool, option("Replace an earlier result.")]
Threads = Annotated[int | None, option("Paths found at a time [one a processor].", "-t", type=POSITIVE)]


def stages(count: int | None) -> AbstractContextManager[Progress]:
    """A bar over so many stages, or over the pieces of one, unless the command is quiet."""
    from coupling import Bar, silent

    return nullcontext(silent) if click.get_current_context().params["quiet"] else Bar(count)


@contextmanager
def counted(pieces: str) -> Iterator[ProgressCallback]:
    """A bar over pieces of a kind, unless the command is quiet."""
    with stages(None) as bar, bar(pieces) as tell:
        yield tell


def amount_of(text: str | None, unit: str, name: str, example: str = "") -> float | None:
    """The quantity [unit] that an option gives; None: it is not given."""
    from coupling.case import Quantity

    if text is None:
        return None
    try:
        return Quantity(unit, example or EXAMPLES[unit]).parse(text.strip())
    except ValueError as error:
        raise ValueError(f"{name} {error}") from None


def point_of(text: str, unit: str, name: str) -> tuple[float, float] | tuple[()]:
    """The frequency [Hz] and the stroke [m or N] that an option gives, with a comma between; (): the best point."""
    if text.strip().lower() == "best":
        return ()
    frequency, comma, stroke = text.partition(",")
    if not comma:
        raise ValueError(f'{name} must be "best", or a frequency and a stroke such as "2.4 kHz, 12 um"; got "{text}"')
    point = amount_of(frequency, "Hz", name) or 0.0, amount_of(stroke, unit, name) or 0.0
    if not min(point) > 0:
        raise ValueError(f'{name} must be a positive frequency and a positive stroke; got "{text}"')
    return point


def place_of(text: str, name: str) -> tuple[float, float]:
    """The point [m] that an option gives, as two lengths with a comma between."""
    parts = text.split(",")
    if len(parts) != 2:
        raise ValueError(f'{name} must be two lengths, x and y, such as "100 um, 50 um"; got "{text}"')
    x, y = (amount_of(part, "m", name, "100 um") or 0.0 for part in parts)
    return x, y


def numbers_of(text: str | None, name: str) -> list[int]:
    """The numbers of actuators that an option gives, with commas between; none: it is not given."""
    parts = [] if text is None else [part.strip() for part in text.split(",")]
    if not all(part.isdecimal() for part in parts):
        raise ValueError(f'{name} must be numbers of actuators, such as "3,7"; got "{text}"')
    return sorted({int(part) for part in parts})
