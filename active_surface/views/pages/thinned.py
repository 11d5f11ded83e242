"""A line with fewer points, which looks the same."""

from __future__ import annotations

import numpy as np

from active_surface.arrays import FloatArray


def thinned(line: FloatArray, apart: float) -> FloatArray:
    """Those points of a line (n, 2) that a line through them needs to pass all others within `apart`.

    By Ramer, Douglas and Peucker: the farthest point stays while it is too far away.
    """
    kept = np.zeros(len(line), dtype=bool)
    kept[[0, -1]] = True
    pieces = [(0, len(line) - 1)]
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        away = _distances(line[first + 1 : last], line[first], line[last])
        farthest = int(np.argmax(away))
        if away[farthest] > apart:
            middle = first + 1 + farthest
            kept[middle] = True
            pieces += [(first, middle), (middle, last)]
    return line[kept]


def _distances(points: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    """How far points (n, 2) are from a straight piece."""
    along = end - begin
    length = float(along @ along)
    share = np.clip((points - begin) @ along / length, 0, 1) if length > 0 else np.zeros(len(points))
    return np.asarray(np.hypot(*(points - begin - share[:, None] * along).T))
