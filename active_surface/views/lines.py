"""Lines on the surface: its rim, a net of squares and the trail of the part, as points and short pieces."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from active_surface.arrays import FloatArray, IntArray
from active_surface.views.rounding import round_above
from active_surface.views.smooth import Smooth
from fem_plate import extent

SQUARES = 12  # of the net, about, along the longer side


@dataclass(frozen=True, eq=False)
class Lines:
    """Points (k, 2) [m] and the two of each piece (s, 2) of a line."""

    xy: FloatArray
    pieces: IntArray


def divided(lines: Lines, longest: float) -> Lines:
    """The same lines in pieces that are no longer than so [m]."""
    if not len(lines.pieces):
        return lines
    ends = lines.xy[lines.pieces]
    parts = max(1, math.ceil(float(np.hypot(*(ends[:, 1] - ends[:, 0]).T).max()) / longest))
    share = np.linspace(0, 1, parts + 1)[:, None]
    xy = (1 - share) * ends[:, None, 0] + share * ends[:, None, 1]
    first = (np.arange(len(ends))[:, None] * (parts + 1) + np.arange(parts)).ravel()
    return Lines(xy.reshape(-1, 2), np.stack([first, first + 1], axis=1))


def clipped(lines: Lines, frame: FloatArray) -> Lines:
    """The pieces of lines whose boxes touch a frame (2, 2) [m]."""
    ends, slack = lines.xy[lines.pieces], 1e-9 * extent(frame)
    touching = ((ends.max(axis=1) >= frame[0] - slack) & (ends.min(axis=1) <= frame[1] + slack)).all(axis=1)
    used, rows = np.unique(lines.pieces[touching], return_inverse=True)
    return Lines(lines.xy[used], rows.reshape(-1, 2))


def net_width(size: float) -> float:
    """The distance of the net's lines on a surface of a size [m]."""
    return round_above(size / SQUARES)


def net(smooth: Smooth, frame: FloatArray, width: float, longest: float) -> Lines:
    """Lines of equal x and of equal y, `width` [m] apart, as far as they are on the plate.

    longest: of their pieces [m].
    """
    parts = math.ceil(extent(frame) / longest)
    lines = []
    for k in (0, 1):
        across = np.arange(math.ceil(frame[0, k] / width), math.floor(frame[1, k] / width) + 1) * width
        along = np.linspace(frame[0, 1 - k], frame[1, 1 - k], parts + 1)
        pair = np.meshgrid(across, along, indexing="ij")
        lines.append(np.stack(pair if k == 0 else pair[::-1], axis=-1).reshape(-1, 2))
    xy = np.concatenate(lines)
    rows = np.arange(len(xy)).reshape(-1, parts + 1)
    pieces = np.stack([rows[:, :-1].ravel(), rows[:, 1:].ravel()], axis=1)
    inside = smooth.locate(xy)[2] if len(xy) else np.empty(0, dtype=bool)
    return Lines(xy, pieces[inside[pieces].all(axis=1)])


def cut_in(parts: IntArray) -> tuple[IntArray, FloatArray]:
    """Pieces of a line that are cut in so many parts each: of every part's beginning its piece, and how far along."""
    piece = np.repeat(np.arange(len(parts)), parts)
    return piece, (np.arange(len(piece)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[piece]


def path_points(path: FloatArray, time: FloatArray, longest: float) -> tuple[FloatArray, FloatArray]:
    """Points (r, 2) along a path (k, 2) [m], about so near to each other [m], and when the part was there.

    None is nearer than half of that to the one before: of shorter pieces OpenGL draws hardly anything.
    """
    length = np.hypot(*np.diff(path, axis=0).T)
    parts = np.ceil(length / longest).astype(int)
    moved, share = cut_in(parts)
    xy = np.concatenate([path[moved] + share[:, None] * (path[moved + 1] - path[moved]), path[-1:]])
    then = np.concatenate([time[moved] + share * (time[moved + 1] - time[moved]), time[-1:]])
    kept = [0]
    for k in range(1, len(xy)):
        if np.hypot(*(xy[k] - xy[kept[-1]])) >= longest / 2:
            kept.append(k)
    return xy[kept], then[kept]
