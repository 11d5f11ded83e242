"""Kept: what is done of a sweep, line by line in a file, so that one that was stopped goes on where it was."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple


def keep(path: Path | None, size: NamedTuple, row: NamedTuple) -> None:
    """Add a row of a sweep of a size, whose first field is all that it sweeps over; None: nowhere."""
    if path is None:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        file.write(json.dumps({"size": list(size[1:])} | row._asdict()) + "\n")


def kept_rows(path: Path | None, size: NamedTuple) -> list[dict[str, Any]]:
    """What is kept of the same sweep; a last line that was cut off is passed over."""
    if path is None or not path.exists():
        return []
    rows = [one for line in path.read_text().splitlines() if (one := _parsed(line)) is not None]
    return [one for one in rows if one.pop("size") == list(size[1:])]


def _parsed(line: str) -> dict[str, Any] | None:
    try:
        return json.loads(line)  # type: ignore[no-any-return]
    except json.JSONDecodeError:
        return None
