"""Stage: what a film shows, at rest: the surface, lines on it, actuators and trail, and how high they come."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from matplotlib.tri import Triangulation, UniformTriRefiner
from scipy.sparse import csr_matrix

from active_surface.arrays import FloatArray, IntArray
from active_surface.views.lines import Lines, clipped, divided, net, net_width, path_points
from active_surface.views.rounding import exaggeration
from active_surface.views.smooth import Smooth
from active_surface.views.triangles import outer_edges
from coupling import silent
from coupling.case import PlatformCase
from coupling.pictures import PITCHES, Scale, is_visible, path_window
from coupling.results import SavedRun
from coupling.scene import platform_scene
from fem_plate import extent, pitch
from particle import AnyDrive, State

MAX_TRIANGLES = 40_000  # of a mesh that is made finer to be drawn
ACROSS = 120  # cells along a window
WIDER = 3.0  # times what the part goes up and down is the least width of a window
MAX_WINDOW = 0.6  # of the plate's longer side: a wider window shows all of it
FINE = 1 / 200  # of the longer side: the length of a piece of a line
FLAT, ROUNDING = 1e-11, 1e-5  # m, and of the largest height: a smaller range of heights is none
AROUND = 0.5  # of the longer side: points further from the frame do not shape what is in it
BATCH = 16  # steps that are read together
CROWDED = 1 / 60  # of the longer side: actuators nearer to each other are not marked


@dataclass(frozen=True, eq=False)
class Stage:
    """What there is to draw, in m; `frame` (2, 2) is the part of the plane that is shown."""

    run: SavedRun = field(repr=False)
    used: IntArray  # (n',) the points of the run that what is shown depends on
    smooth: Smooth  # heights of these
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

    @cached_property
    def base(self) -> tuple[AnyDrive, ...]:
        """What moves a platform along x and y; none: there is a plate."""
        plate = self.run.case.plate
        return tuple(platform_scene(plate, silent).base) if isinstance(plate, PlatformCase) else ()

    def shifts(self, times: FloatArray) -> FloatArray:
        """How far the platform has come (k, 2) [m] at times (k,) [s]."""
        if not self.base:
            return np.zeros((len(times), 2))
        return np.stack([drive.evaluate(times)[0] for drive in self.base], axis=1)

    @property
    def size(self) -> float:
        """The longer side of the frame."""
        return extent(self.frame)

    @property
    def outer(self) -> FloatArray:
        """The pieces (s, 2, 2) [m] of the plate's whole rim."""
        return self.run.points[outer_edges(self.run.triangles)]

    @cached_property
    def path(self) -> tuple[FloatArray, FloatArray]:
        """All known places (r, 2) [m] of the part, and when it was there (r,) [s]."""
        return path_of(self.run)

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
        none = csr_matrix((0, len(self.used)))
        return {name: self.smooth.at(xy) if len(xy) else none for name, xy in things.items()}

    @cached_property
    def reach(self) -> tuple[FloatArray, FloatArray]:
        """The lowest and the highest height (p,) [m] of each point of the surface in all steps."""
        low = np.full(len(self.surface), np.inf)
        high = -low
        for _, heights in self.stored_heights():
            deflection = self.matrices["surface"] @ heights.T
            low, high = np.minimum(low, deflection.min(axis=1)), np.maximum(high, deflection.max(axis=1))
        return low, high

    def stored_heights(self) -> Iterator[tuple[int, FloatArray]]:
        """The first step of some, and their deflections (k, n') [m] at the used points, until all steps have been."""
        for first in range(0, len(self.run.time), BATCH):
            deflection = self.run.plate_field("deflection", slice(first, first + BATCH))
            yield first, np.asarray(deflection[:, self.used], dtype=np.float64)

    @property
    def scale(self) -> Scale:
        """How heights become colours."""
        low, high = self.reach
        return Scale.of(np.array([low.min(), high.max()]))

    @property
    def flat(self) -> bool:
        """Whether all heights are the same."""
        low, high = self.reach
        largest = max(abs(float(high.max())), abs(float(low.min())))
        return float(high.max() - low.min()) < max(FLAT, ROUNDING * largest)

    @property
    def exaggeration(self) -> float:
        """By how much heights are drawn larger without a wish."""
        low, high = self.reach
        return 1.0 if self.flat else exaggeration(float(high.max() - low.min()), self.size)


def stage_of(run: SavedRun) -> Stage:
    """The stage of a run: all of its surface, or a window around a path that is short beside it."""
    path, then = path_of(run)
    frame, window = _frame(run, path)
    used, kept = _near(run, frame)
    smooth = Smooth(run.points[used], kept)
    surface, triangles = _grid(smooth, frame) if window else _finer(run)
    size = extent(frame)
    outer = outer_edges(run.triangles)
    rim = clipped(divided(clipped(Lines(run.points, outer), frame), FINE * size), frame)
    cut = Lines(surface, outer_edges(triangles)) if window else Lines(surface[:0], outer[:0])
    width = net_width(size)
    trail, trail_time = path_points(path, then, FINE * size) if is_visible(path, frame) else (path[:0], then[:0])
    return Stage(
        run,
        used,
        smooth,
        frame,
        window,
        surface,
        triangles,
        rim,
        cut,
        net(smooth, frame, width, FINE * size),
        width,
        _marked(run.actuators, frame),
        trail,
        trail_time,
    )


def path_of(run: SavedRun) -> tuple[FloatArray, FloatArray]:
    """The places (r, 2) [m] of the part and their times (r,): all stored ones, and all rows until the last of these."""
    known = run.rows.time <= run.time[-1]
    then, first = np.unique(np.concatenate([run.time, run.rows.time[known]]), return_index=True)
    return np.concatenate([run.position[:, :2], run.rows.position[known]])[first], then


def _frame(run: SavedRun, path: FloatArray) -> tuple[FloatArray, bool]:
    """The frame (2, 2) [m], and whether it is a window around a path that is short beside the plate.

    Its sides are a few lengths of the path, two pitches, and some times what the part goes up and down with the plate,
    whichever is most.
    """
    box = np.stack([run.points.min(axis=0), run.points.max(axis=0)])
    window = path_window(path, box, run.actuators)
    if window is None:
        return box, False
    heights = run.position[run.state != State.FLIGHT, 2]
    rise = float(np.ptp(heights)) if len(heights) else 0.0
    side = max(extent(window), PITCHES * pitch(run.actuators), WIDER * rise)
    if side > MAX_WINDOW * extent(box):
        return box, False
    sides = np.minimum(side, np.ptp(box, axis=0))
    low = np.clip(window.mean(axis=0) - sides / 2, box[0], box[1] - sides)
    return np.stack([low, low + sides]), True


def _near(run: SavedRun, frame: FloatArray) -> tuple[IntArray, IntArray]:
    """The points of a run that are in a frame (2, 2) [m] or near it, and the triangles between them."""
    low, high = frame + AROUND * extent(frame) * np.array([[-1.0], [1.0]])
    inside = ((run.points >= low) & (run.points <= high)).all(axis=1)
    touching = run.triangles[inside[run.triangles].any(axis=1)]
    used, rows = np.unique(touching, return_inverse=True)
    return used, rows.reshape(-1, 3)


def _finer(run: SavedRun) -> tuple[FloatArray, IntArray]:
    """The points and triangles of the run, divided while there are few."""
    halvings = int(math.log(max(MAX_TRIANGLES / len(run.triangles), 1), 4))
    if not halvings:
        return run.points, run.triangles
    plain = Triangulation(*run.points.T, run.triangles)
    fine = UniformTriRefiner(plain).refine_triangulation(subdiv=halvings)
    return np.stack([fine.x, fine.y], axis=1), fine.triangles.astype(np.int64)


def _grid(smooth: Smooth, frame: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points of a grid in a frame (2, 2) [m], those beyond the plate drawn to its rim, and the triangles on it."""
    counts = np.maximum(np.ceil(ACROSS * np.ptp(frame, axis=0) / extent(frame)), 1)
    x, y = (np.linspace(frame[0, k], frame[1, k], int(counts[k]) + 1) for k in (0, 1))
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    triangle, shares, inside = smooth.locate(points)
    nearest = (smooth.points[smooth.triangles[triangle]] * shares[..., None]).sum(axis=1)
    points[~inside] = nearest[~inside]
    number = np.arange(len(points)).reshape(len(x), len(y))
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    used, rows = np.unique(triangles[inside[triangles].any(axis=1)], return_inverse=True)
    return points[used], rows.reshape(-1, 3)


def _marked(actuators: FloatArray, frame: FloatArray) -> FloatArray:
    """The actuators (N', 2) [m] in a frame (2, 2) [m], none where their marks would merge."""
    seen = actuators[((actuators >= frame[0]) & (actuators <= frame[1])).all(axis=1)]
    return seen[:0] if len(seen) > 1 and pitch(seen) < CROWDED * extent(frame) else seen
