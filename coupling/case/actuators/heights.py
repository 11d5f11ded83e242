"""The heights that drives go to, and whether actuators can."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import accumulate
from typing import Any

from coupling.case.table import WRONG
from coupling.case.values import length_text

SLACK = 1 + 1e-9  # for limits that are met exactly


def heights_of(motion: Any) -> list[float]:
    """The heights [m] at the points of a table or after the segments of a schedule; none where it is not valid."""
    if not isinstance(motion, tuple) or not motion:
        return []
    if isinstance(motion[0], tuple):
        return [height for _, height in motion]
    rises = (s.cycles * (s.stroke or 0.0) if s.cycle == "up" else 0.0 for s in motion)
    return list(accumulate(rises, initial=0.0))


def _farthest(table: Any, segments: Any, stroke: float | None) -> float:
    """The height [m] furthest from 0 of a table, a schedule or a stroke."""
    if table:
        return max(heights_of(table), key=abs)
    if segments:
        before = heights_of(segments)
        tops = [height + (s.stroke or 0.0) for height, s in zip(before, segments, strict=False)]
        return max(before + tops, key=abs)
    return stroke or 0.0


def amplitude(drive: Any) -> float:
    """The stroke [m] of a drive, its force [N], or the height [m] furthest from 0 that it goes to."""
    return _farthest(drive.table, drive.segments, drive.stroke) or getattr(drive, "force", None) or 0.0


def limit_faults(given: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield each key of an actuator's drive that asks for more than max_stroke or max_force, and why.

    given: valid values by their keys; WRONG for others, None for what is not given.
    """
    motions = {key: given.get(key) for key in ("table", "segments", "stroke")}
    limit, force, largest = given.get("max_stroke"), given.get("force"), given.get("max_force")
    key = next((key for key, motion in motions.items() if motion is not None), "")
    if isinstance(limit, float) and key and motions[key] is not WRONG:
        farthest = _farthest(*motions.values())
        if abs(farthest) > SLACK * limit:
            must = "must be" if key == "stroke" else "must have heights of"
            got = length_text(farthest)
            yield key, f"{must} at most max_stroke, {length_text(limit)}, up or down; got {got}"
    if isinstance(largest, float) and isinstance(force, float) and abs(force) > SLACK * largest:
        yield "force", f"must be at most max_force, {largest:g} N, up or down; got {force:g} N"
