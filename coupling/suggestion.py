"""What somebody may have meant by a word that is not known."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def near(word: str, known: Iterable[str]) -> str | None:
    """The known word that is most like another, or the only one that begins with it; None: nothing is like it."""
    choices, given = list(known), word.strip().lower()
    begun = [choice for choice in choices if len(given) > 2 and choice.lower().startswith(given)]
    return next(iter(difflib.get_close_matches(given, choices, 1)), begun[0] if len(begun) == 1 else None)
