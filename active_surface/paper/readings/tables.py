"""Tables: rows of cells in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """The table, with a line's end."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in lines) + "\n"


def percent(share: float) -> str:
    """A share, in whole percents."""
    return f"{100 * share:.0f}"


def spread(low: float, high: float, form: str = ".3g") -> str:
    """Two ends, or the one where both read alike."""
    one, other = format(low, form), format(high, form)
    return one if one == other else f"{one} to {other}"
