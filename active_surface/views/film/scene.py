"""Scene of a film: the surface of a run, what lies on it, and how both move.

The surface is the sum of a few modes, so whatever lies on it is a mesh with a row of shapes for each of its points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import cycle
from typing import NamedTuple

import numpy as np
import pyvista as pv
from matplotlib.tri import CubicTriInterpolator, Triangulation, UniformTriRefiner

from active_surface.arrays import FloatArray, IntArray
from active_surface.views.geometry import exaggeration, round_above, spots_of
from active_surface.views.modes import modes_of
from coupling import silent
from coupling.case import PlatformCase
from coupling.pictures import PARTS_COLOURS, PITCHES, Scale, is_visible, path_window
from coupling.results import SavedRun, name_of
from coupling.scene import platform_scene
from fem_plate import extent, pitch
from particle import Footprint, State

MAX_TRIANGLES, MAX_HALVINGS = 20_000, 7  # of a mesh that is refined to be drawn, and of its edges
WIDER = 3.0  # times what the part goes up and down is the least width of a window
MAX_WINDOW = 0.6  # of the plate's longer side: a wider window shows all of it
FINE = 1 / 200  # of the longer side: the distance of the trail's points
FLAT, ROUNDING = 1e-11, 1e-5  # m, and of the largest height: a smaller range of heights is none
AROUND = 0.5  # of the longer side: points farther from the frame do not shape what is in it
BATCH = 64  # steps that are read together
CROWDED = 1 / 60  # of the longer side: actuators nearer to each other are not marked
SQUARES = 12  # of the net, about, along the longer side


class Moment(NamedTuple):
    """What there is at one time of a run."""

    time: float  # s
    amplitudes: FloatArray  # (r,) of the modes
    part: FloatArray  # (3,) m
    heading: float  # rad; 0 of a point
    under: float  # m, the surface's height under the part
    state: State
    lost: bool
    shift: FloatArray  # (2,) m, how far a platform has come

    @property
    def flight(self) -> float:
        """How far above the surface the part is [m]."""
        return float(self.part[2]) - self.under if self.state is State.FLIGHT else 0.0


@dataclass(frozen=True, eq=False)
class Scene:
    """What there is to draw.

    Meshes are in the frame's longer sides, from its middle, and have the `shapes` (k, r) [m] of their points.
    """

    run: SavedRun
    amplitudes: FloatArray  # (k, r) of the stored steps
    frame: FloatArray  # (2, 2) m, the part of the plane that is shown
    window: bool  # whether the frame is only a part of the plate
    whole: pv.PolyData  # the surface in the frame and around it
    surface: pv.PolyData  # what is in the frame
    time: FloatArray  # (k,) s, of these steps
    path: FloatArray  # (r, 2) m, all known places of the part
    path_time: FloatArray  # (r,) s
    colour: str | None = None  # of one of many parts; None: by what the part does
    others: tuple[Scene, ...] = ()  # the same with other parts

    @property
    def size(self) -> float:
        """The longer side [m] of the frame."""
        return extent(self.frame)

    @property
    def name(self) -> str:
        """The name of the run, with its part unless all are shown."""
        return name_of(self.run.plate_path) if self.others else self.run.name

    @cached_property
    def face(self) -> Footprint | None:
        """The face of the part; None: it is a point."""
        return self.run.case.part.face

    @property
    def mesh_width(self) -> float:
        """The distance [m] of the net's lines."""
        return round_above(self.size / SQUARES)

    @cached_property
    def slopes(self) -> FloatArray:
        """The slopes (2, p, r) of the surface's shapes, along x and y."""
        slopes = self.surface["gradient"].reshape(self.surface.n_points, -1, 3)[..., :2] / self.size
        return np.moveaxis(slopes, 2, 0).copy()

    @cached_property
    def rim(self) -> pv.PolyData:
        """The plate's rim."""
        slack = 1e-9 * np.array([[-1.0], [1.0]])  # where the frame is the plate's box
        return _within(_edges(self.whole), self.scaled(self.frame) + slack)

    @cached_property
    def cut(self) -> pv.PolyData:
        """The edges of the surface that is shown."""
        return _edges(self.surface)

    @cached_property
    def net(self) -> pv.PolyData:
        """Lines of equal x and of equal y."""
        lines = pv.PolyData()
        for k in (0, 1):
            first, last = self.frame[:, k] / self.mesh_width
            levels = np.arange(math.floor(first) + 1, math.ceil(last))[:, None] * self.mesh_width
            if len(levels):
                lines += self.surface.contour(self.scaled(levels)[:, k], scalars=self.surface.points[:, k])
        return lines

    @cached_property
    def actuators(self) -> FloatArray:
        """The actuators (N', 2) [m] in the frame; none where their marks would merge."""
        places = self.run.actuators
        seen = places[((places >= self.frame[0]) & (places <= self.frame[1])).all(axis=1)]
        return seen[:0] if len(seen) > 1 and pitch(seen) < CROWDED * self.size else seen

    @cached_property
    def trail(self) -> tuple[FloatArray, FloatArray]:
        """Points (q, 2) [m] along the path and when they are passed [s]; none where it is no more than a point."""
        length = np.append(0.0, np.cumsum(np.hypot(*np.diff(self.path, axis=0).T)))
        count = math.ceil(length[-1] / (FINE * self.size)) if is_visible(self.path, self.frame) else -1
        at = np.linspace(0.0, length[-1], count + 1)
        return _interpolated(at, length, self.path), np.interp(at, length, self.path_time)

    @cached_property
    def reach(self) -> tuple[FloatArray, FloatArray]:
        """The lowest and the highest height (p,) [m] of each point of the surface in all steps."""
        shapes, batches = shapes_of(self.surface), np.array_split(self.amplitudes, -(-len(self.amplitudes) // BATCH))
        heights = [shapes @ some.T for some in batches]
        low, high = (np.stack([f(h, axis=1) for h in heights]) for f in (np.min, np.max))
        return low.min(axis=0), high.max(axis=0)

    @property
    def range(self) -> tuple[float, float]:
        """The lowest and the highest height [m]."""
        return float(self.reach[0].min()), float(self.reach[1].max())

    @property
    def scale(self) -> Scale:
        """How heights become colours."""
        return Scale.of(np.array(self.range))

    @property
    def flat(self) -> bool:
        """Whether all heights are the same."""
        low, high = self.range
        return high - low < max(FLAT, ROUNDING * max(abs(high), abs(low)))

    @property
    def exaggeration(self) -> float:
        """By how much heights are drawn larger by default."""
        return 1.0 if self.flat else exaggeration(self.range[1] - self.range[0], self.size)

    def scaled(self, places: FloatArray) -> FloatArray:
        """Places (..., 2) [m] as the meshes have them."""
        return (places - self.frame.mean(axis=0)) / self.size

    def shapes_at(self, places: FloatArray) -> FloatArray:
        """The shapes (k, r) [m] at places (k, 2) [m] of the surface."""
        spots = spots_of(self.whole.points[:, :2], self.whole.regular_faces, self.scaled(places))
        return np.asarray((shapes_of(self.whole)[spots.corners] * spots.weights[..., None]).sum(axis=1))

    def shifts(self, times: FloatArray) -> FloatArray:
        """How far the platform has come (k, 2) [m] at times (k,) [s]; 0: there is a plate, or it turns.

        A turning platform is drawn in its own axes.
        """
        plate = self.run.case.plate
        base = platform_scene(plate, silent).base if isinstance(plate, PlatformCase) else ()
        if len(base) != 2:
            return np.zeros((len(times), 2))
        return np.stack([drive.evaluate(times)[0] for drive in base], axis=1)

    def moments(self, times: FloatArray) -> list[Moment]:
        """What there is at times (F,) [s]; between stored steps heights are linear, the part is where its rows are."""
        run, rows = self.run, self.run.rows
        amplitudes, place = (
            _interpolated(times, *columns) for columns in ((self.time, self.amplitudes), (self.path_time, self.path))
        )
        part = np.column_stack([place, np.interp(times, run.time, run.position[:, 2])])
        under = (self.shapes_at(place) * amplitudes).sum(axis=1)
        states = [State(int(state)) for state in rows.state[np.searchsorted(rows.time, times, side="right") - 1]]
        heading = np.zeros(len(times)) if rows.heading is None else np.interp(times, rows.time, rows.heading)
        lost = times >= (math.inf if run.loss is None else run.loss.time)
        return [
            Moment(*row)
            for row in zip(times, amplitudes, part, heading, under, states, lost, self.shifts(times), strict=True)
        ]


def shapes_of(mesh: pv.PolyData) -> FloatArray:
    """The shapes (k, r) [m] at the points of a mesh of a scene."""
    return np.asarray(mesh["shapes"]).reshape(mesh.n_points, -1)  # VTK knows no columns where there is one


def scene_of(run: SavedRun, others: Sequence[SavedRun] = ()) -> Scene:
    """The scene of a run: all of its surface, or a window around paths that are short beside it.

    others: of further parts over the same surface, which do not last longer.
    """
    runs, paths = (run, *others), [_path(one) for one in (run, *others)]
    shown = [places for one, (path, _) in zip(runs, paths, strict=True) for places in (path, *_ends(one, path))]
    frame, window = _frame(run, np.concatenate(shown))
    low, high = frame + AROUND * extent(frame) * np.array([[-1.0], [1.0]])
    inside = ((run.points >= low) & (run.points <= high)).all(axis=1)
    used, corners = np.unique(run.triangles[inside[run.triangles].any(axis=1)], return_inverse=True)
    shapes, amplitudes = _modes(run, used)
    scaled = (np.stack([*frame, *run.points[used]]) - frame.mean(axis=0)) / extent(frame)
    whole = _refined(Triangulation(*scaled[2:].T, corners.reshape(-1, 3)), shapes)
    surface = _within(whole, scaled[:2]).triangulate() if window else whole.copy()
    ground = (amplitudes, frame, window, whole, surface, run.time)
    colours = cycle(PARTS_COLOURS if others else [None])
    first, *beside = (
        Scene(one, *ground, *path, colour) for one, path, colour in zip(runs, paths, colours, strict=False)
    )
    return replace(first, others=tuple(beside))


def _ends(run: SavedRun, path: FloatArray) -> list[FloatArray]:
    """The first and the last outline (c, 2) [m] of a part with a face."""
    face, heading = run.case.part.face, run.rows.heading
    return [] if face is None or heading is None else [face.outline(path[k], heading[k]) for k in (0, -1)]


def _path(run: SavedRun) -> tuple[FloatArray, FloatArray]:
    """The places (q, 2) [m] of the part and their times (q,): all stored ones, and all rows until the last of these."""
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


def _modes(run: SavedRun, used: IntArray) -> tuple[FloatArray, FloatArray]:
    """The shapes (r, n) [m] of points, and their amplitudes (k, r) at the stored steps."""

    def heights(steps: slice) -> FloatArray:
        return np.asarray(run.plate_field("deflection", steps)[:, used], dtype=np.float64)

    batches, shapes = [slice(k, k + BATCH) for k in range(0, len(run.time), BATCH)], np.empty((0, len(used)))
    for some in batches:
        modes = modes_of(np.concatenate([shapes, heights(some)]))
        shapes = modes.shapes * np.abs(modes.amplitudes).max(axis=0)[:, None]
    inverse = np.linalg.pinv(shapes)
    return shapes, np.concatenate([heights(some) @ inverse for some in batches])


def _refined(mesh: Triangulation, shapes: FloatArray) -> pv.PolyData:
    """The surface with smaller triangles, on which shapes (r, n) are smooth."""
    halvings = min(int(math.log(max(MAX_TRIANGLES / len(mesh.triangles), 1), 4)), MAX_HALVINGS)
    fine, values = mesh, list(shapes)
    if halvings:
        refiner = UniformTriRefiner(mesh)
        fields = [CubicTriInterpolator(mesh, shape, kind="geom") for shape in shapes]
        both = [refiner.refine_field(shape, field, halvings) for shape, field in zip(shapes, fields, strict=True)]
        fine, values = both[0][0], [value for _, value in both]
    surface = pv.PolyData.from_regular_faces(np.column_stack([fine.x, fine.y, 0 * fine.x]), fine.triangles)
    surface["shapes"] = np.stack(values, axis=1)
    return surface.compute_derivative(scalars="shapes")


def _edges(surface: pv.PolyData) -> pv.PolyData:
    return surface.extract_feature_edges(feature_edges=False, non_manifold_edges=False, manifold_edges=False)


def _within(mesh: pv.PolyData, frame: FloatArray) -> pv.PolyData:
    """The part of a mesh that lies in a frame (2, 2)."""
    for axis, low, high in zip("xy", *frame, strict=True):
        for normal, end in ((f"-{axis}", low), (axis, high)):
            mesh = mesh.clip(normal, origin=(end, end, 0.0)) if mesh.n_points else mesh
    return mesh


def _interpolated(at: FloatArray, known: FloatArray, values: FloatArray) -> FloatArray:
    """Columns of values (k, c), known at k numbers, at others (q,)."""
    return np.stack([np.interp(at, known, column) for column in values.T], axis=1)
