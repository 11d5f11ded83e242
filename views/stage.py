"""Stage: what a film shows, at rest: the surface, lines on it, actuators and trail, and how high they come."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from matplotlib.tri import Triangulation, UniformTriRefiner
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from coupling.plate_picture import Scale
from coupling.saved import SavedRun
from coupling.window import extent, is_visible, path_window, pitch
from meshes.refine import edge_numbers
from views.pace import nearest_round
from views.smooth import Smooth

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MOST_TRIANGLES = 40_000  # of a mesh that is made finer to be drawn
ACROSS = 120  # cells along a window
SQUARES = 12  # of the net of lines, about, along the longer side
FINE = 1 / 200  # of the longer side: the length of a piece of a line
RISE = 0.2  # of the longer side: about so high are heights drawn without a wish
ALMOST_TRUE = 2.0  # a smaller exaggeration is none
FLAT = 1e-12  # m: a smaller range of heights is none
AT_ONCE = 16  # steps that are read together
CROWDED = 1 / 60  # of the longer side: actuators nearer to each other are not marked


@dataclass(frozen=True, eq=False)
class Lines:
    """Points (k, 2) [m] and the two of each piece (s, 2) of a line."""

    xy: FloatArray
    pieces: IntArray


@dataclass(frozen=True, eq=False)
class Stage:
    """What there is to draw, in m; `frame` (2, 2) is the part of the plane that is shown."""

    run: SavedRun = field(repr=False)
    smooth: Smooth
    frame: FloatArray
    window: bool  # whether the frame is only a part of the plate
    surface: FloatArray  # (p, 2)
    triangles: IntArray  # (t, 3)
    rim: Lines
    cut: Lines  # where the frame cuts the plate
    net: Lines
    mesh_width: float  # of the net
    actuators: FloatArray  # (N', 2), those that are marked
    trail: FloatArray  # (r, 2)
    trail_time: FloatArray  # (r,) s

    @property
    def size(self) -> float:
        """The longer side of the frame."""
        return extent(self.frame)

    @property
    def outer(self) -> FloatArray:
        """The pieces (s, 2, 2) [m] of the plate's whole rim."""
        return self.run.points[_rim(self.run.points, self.run.triangles)]

    @cached_property
    def matrices(self) -> dict[str, csr_matrix]:
        """From the heights at the run's points to those of each thing that lies on the surface."""
        things = {
            "surface": self.surface,
            "rim": self.rim.xy,
            "cut": self.cut.xy,
            "net": self.net.xy,
            "actuators": self.actuators,
            "trail": self.trail,
        }
        return {name: self.smooth.at(xy) if len(xy) else csr_matrix((0, len(self.run.points))) for name, xy in things.items()}

    @cached_property
    def reach(self) -> tuple[FloatArray, FloatArray]:
        """The lowest and the highest height (p,) [m] of each point of the surface in all steps."""
        low = np.full(len(self.surface), np.inf)
        high = -low
        for first, heights in stored_heights(self.run):
            found = self.matrices["surface"] @ heights.T
            low, high = np.minimum(low, found.min(axis=1)), np.maximum(high, found.max(axis=1))
        return low, high

    @property
    def scale(self) -> Scale:
        """How heights become colours."""
        low, high = self.reach
        return Scale.of(np.array([low.min(), high.max()]))

    @property
    def exaggeration(self) -> float:
        """By how much heights are drawn larger without a wish."""
        low, high = self.reach
        rise = float(high.max() - low.min())
        wanted = RISE * self.size / rise if rise > FLAT else 1.0
        return nearest_round(wanted) if wanted >= ALMOST_TRUE else 1.0


def stored_heights(run: SavedRun) -> Iterator[tuple[int, FloatArray]]:
    """The first step of some, and the deflections (k, n) [m] of these, until all steps have been."""
    for first in range(0, len(run.time), AT_ONCE):
        yield first, np.asarray(run.plate_field("deflection", slice(first, first + AT_ONCE)), dtype=np.float64)


def stage_of(run: SavedRun) -> Stage:
    """The stage of a run: all of its surface, or a window around a path that is short beside it."""
    smooth = Smooth(run.points, run.triangles)
    box = np.stack([run.points.min(axis=0), run.points.max(axis=0)])
    path = run.position[:, :2]
    window = path_window(path, box, run.actuators)
    frame = box if window is None else np.array([np.maximum(window[0], box[0]), np.minimum(window[1], box[1])])
    surface, triangles = _finer(run) if window is None else _grid(smooth, frame)
    size = extent(frame)
    outer = _rim(run.points, run.triangles)
    rim = _clipped(_divided(Lines(run.points, outer), FINE * size), frame)
    cut = Lines(surface, _rim(surface, triangles)) if window is not None else Lines(surface[:0], outer[:0])
    width = _mesh_width(size)
    trail, trail_time = _trail(path, run.time, FINE * size) if is_visible(path, frame) else (path[:0], run.time[:0])
    return Stage(
        run,
        smooth,
        frame,
        window is not None,
        surface,
        triangles,
        rim,
        cut,
        _net(smooth, frame, width),
        width,
        _marked(run.actuators, frame),
        trail,
        trail_time,
    )


def _finer(run: SavedRun) -> tuple[FloatArray, IntArray]:
    """The points and triangles of the run, divided while there are few."""
    halvings = int(math.log(max(MOST_TRIANGLES / len(run.triangles), 1), 4))
    if not halvings:
        return run.points, run.triangles
    plain = Triangulation(*run.points.T, run.triangles)
    fine = UniformTriRefiner(plain).refine_triangulation(subdiv=halvings)
    return np.stack([fine.x, fine.y], axis=1), fine.triangles.astype(np.int64)


def _grid(smooth: Smooth, frame: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points of a grid in a frame (2, 2) [m], and the triangles that lie on the plate."""
    counts = np.maximum(np.ceil(ACROSS * np.ptp(frame, axis=0) / extent(frame)), 1).astype(int)
    x, y = (np.linspace(*frame[:, k], counts[k] + 1) for k in (0, 1))
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = smooth.locate(points)[2]
    number = np.arange(len(points)).reshape(len(x), len(y))
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    kept = triangles[inside[triangles].all(axis=1)]
    used, rows = np.unique(kept, return_inverse=True)
    return points[used], rows.reshape(-1, 3)


def _rim(points: FloatArray, triangles: IntArray) -> IntArray:
    """The edges (s, 2) that only one triangle has."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, counts = np.unique(edge_numbers(edges, len(points)), return_index=True, return_counts=True)
    return edges[first[counts == 1]]


def _divided(lines: Lines, longest: float) -> Lines:
    """The same lines in pieces that are no longer than so [m]."""
    ends = lines.xy[lines.pieces]
    parts = max(1, math.ceil(float(np.hypot(*(ends[:, 1] - ends[:, 0]).T).max()) / longest))
    share = np.linspace(0, 1, parts + 1)[:, None]
    xy = (1 - share) * ends[:, None, 0] + share * ends[:, None, 1]
    first = (np.arange(len(ends))[:, None] * (parts + 1) + np.arange(parts)).ravel()
    return Lines(xy.reshape(-1, 2), np.stack([first, first + 1], axis=1))


def _clipped(lines: Lines, frame: FloatArray) -> Lines:
    """The pieces of lines that lie in a frame (2, 2) [m]."""
    slack = 1e-9 * extent(frame)
    seen = ((lines.xy >= frame[0] - slack) & (lines.xy <= frame[1] + slack)).all(axis=1)
    return Lines(lines.xy, lines.pieces[seen[lines.pieces].all(axis=1)])


def _mesh_width(size: float) -> float:
    """The distance of the net's lines: 1, 2 or 5 with a power of ten."""
    wanted = size / SQUARES
    power = 10.0 ** math.floor(math.log10(wanted))
    return next(digits * power for digits in (1, 2, 5, 10) if digits * power >= wanted * (1 - 1e-9))


def _net(smooth: Smooth, frame: FloatArray, width: float) -> Lines:
    """Lines of equal x and of equal y, `width` [m] apart, as far as they are on the plate."""
    parts = math.ceil(extent(frame) / (FINE * extent(frame)))
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


def _trail(path: FloatArray, time: FloatArray, longest: float) -> tuple[FloatArray, FloatArray]:
    """Points (r, 2) along a path (k, 2) [m] that are so near to each other [m], and when the part was there."""
    length = np.hypot(*np.diff(path, axis=0).T)
    parts = np.ceil(length / longest).astype(int)
    moved = np.repeat(np.arange(len(length)), parts)
    share = (np.arange(len(moved)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[moved]
    xy = path[moved] + share[:, None] * (path[moved + 1] - path[moved])
    return np.concatenate([xy, path[-1:]]), np.concatenate([time[moved] + share * (time[moved + 1] - time[moved]), time[-1:]])


def _marked(actuators: FloatArray, frame: FloatArray) -> FloatArray:
    """The actuators (N', 2) [m] in a frame (2, 2) [m], none where their marks would merge."""
    seen = actuators[((actuators >= frame[0]) & (actuators <= frame[1])).all(axis=1)]
    return seen[:0] if len(seen) > 1 and pitch(seen) < CROWDED * extent(frame) else seen
