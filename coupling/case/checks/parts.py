"""Parts: the tables of a case that is being checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

MAY_MOVE: Final = "may_move"
"""The key of a context in which supports and actuators may leave a plate free to move as a whole."""


class Parts(NamedTuple):
    """The tables of a case: models where they are valid, else as they are written; and as they are written anyway."""

    tables: Mapping[str, Any]
    written: Mapping[str, Any]
    context: Any  # of their validation

    def items(self, key: str) -> list[tuple[Any, Any]]:
        """The tables in a list, each with what is written; nothing where that is no list."""
        several = [one.get(key) for one in (self.tables, self.written)]
        return list(zip(*several, strict=True)) if all(isinstance(one, (list, tuple)) for one in several) else []
