"""Display surface: a scene's surface on a triangle mesh, for result files and pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from coupling.display.mesh import display_mesh
from coupling.display.stretching import Stretching
from coupling.drives import stroke_heights
from coupling.scene import PlateScene, PlatformScene, Scene
from coupling.surface import FLOOR
from fem_plate import InfluenceShapes, MovingShapes, PatchedShapes, Shapes
from meshes import Outline
from particle import AnyDrive, Trajectory

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

MARGIN = 0.2  # of the path's extent: how far the square of a platform reaches beyond the path
AS_MUCH = 0.999  # of the largest deflection: the first step with this much counts as the most deflected
DISTINCT = 100  # actuators to each different drive, at least: with fewer, sums take more memory than shapes
TRUNCATED_HEIGHT = 1e-7  # of a stroke: smaller entries of patched shapes are left out of deflections
TRUNCATED_CURVATURE = 1e-5  # of the curvature at an actuator: likewise of curvatures


class DisplaySurface(NamedTuple):
    """A surface on a triangle mesh."""

    points: FloatArray  # (n, 2) m
    triangles: NDArray[np.int64]  # (m, 3)
    deflection: Callable[[FloatArray], FloatArray]  # from heights (k, K) [m] of the moving drives to w (k, n) [m]
    curvature: Callable[[FloatArray], FloatArray] | None = None  # likewise to Laplacians [1/m]; None: always flat
    stretching: Stretching | None = None  # None: linear theory, or a platform


def display_surface(scene: Scene, *trajectories: Trajectory) -> DisplaySurface:
    """The whole plate, or the square of a platform around the paths."""
    if isinstance(scene, PlatformScene):
        return _square(scene, np.concatenate([one.position for one in trajectories]))
    points, triangles = display_mesh(scene.plate.mesh, scene.shapes.points)
    shapes = scene.moving_shapes
    stretching = None if scene.stretch is None else Stretching(scene, scene.stretch, points)
    kinds = _kinds(scene.moving_drives) if isinstance(shapes, PatchedShapes) else None
    surfaces = deflections(shapes, points, kinds), _curvatures(shapes, points, kinds)
    return DisplaySurface(points, triangles, *surfaces, stretching)


def moving_heights(scene: Scene, times: FloatArray, derivative: int = 0) -> FloatArray:
    """The heights (k, K) [m] of the surface's drives at times (k,) [s], the actuators' first, or a derivative."""
    drives = scene.moving_drives if isinstance(scene, PlateScene) else scene.lifts
    return stroke_heights(drives, times, derivative)


def onto_surface(scene: Scene, xy: FloatArray) -> FloatArray:
    """Points (n, 2) [m], those just past the rim of a plate moved onto it."""
    return onto_plate(scene.shapes.outline, xy) if isinstance(scene, PlateScene) else xy


def onto_plate(outline: Outline, xy: FloatArray) -> FloatArray:
    """Points (n, 2) [m], those outside an outline moved to the nearest place on its rim."""
    outside = outline.gap(xy) < 0
    xy = xy.copy()
    if outside.any():
        xy[outside] = outline.project(xy[outside])
    return xy


def most_deflected(mean_squares: FloatArray) -> int:
    """The first of k steps at which the surface is deflected most, from the mean square deflections (k,) [m^2]."""
    return int(np.argmax(mean_squares >= AS_MUCH**2 * mean_squares.max()))


def deflections(
    shapes: Shapes, points: FloatArray, kinds: IntArray | None = None
) -> Callable[[FloatArray], FloatArray]:
    """The deflections (k, n) [m] at points (n, 2) [m] as a function of the shapes' heights (k, K) [m].

    kinds: (K,), of patched shapes, the first of all that have the same heights; they are summed once and for all.
    """
    if isinstance(shapes, PatchedShapes):
        return _summed(partial(shapes.matrix, points, TRUNCATED_HEIGHT), kinds)
    values = shapes.values(points)
    return lambda heights: np.asarray((values @ heights.T).T)


def _curvatures(shapes: Shapes, points: FloatArray, kinds: IntArray | None) -> Callable[[FloatArray], FloatArray]:
    """Likewise the Laplacians (k, n) [1/m], bounded at actuators as the part's surface is; built at the first call."""

    @cache
    def laplacians() -> Callable[[FloatArray], FloatArray]:
        floor = FLOOR * shapes.size
        if isinstance(shapes, PatchedShapes):
            return _summed(partial(shapes.laplacians, points, floor, TRUNCATED_CURVATURE), kinds)
        assert isinstance(shapes, InfluenceShapes | MovingShapes)
        values = shapes.laplacians(points, floor)
        return lambda heights: np.asarray((values @ heights.T).T)

    return lambda heights: laplacians()(heights)


def _kinds(drives: Sequence[AnyDrive]) -> IntArray:
    """The row (K,) of the first drive equal to each."""
    first: dict[AnyDrive, int] = {}
    return np.array([first.setdefault(drive, row) for row, drive in enumerate(drives)])


def _summed(
    shapes: Callable[..., csr_matrix | FloatArray], kinds: IntArray | None
) -> Callable[[FloatArray], FloatArray]:
    """Functions at points as a function of heights (k, K); shapes: makes the matrix (n, K), or (n, l) with weights."""
    few, kind = np.unique([] if kinds is None else kinds, return_inverse=True)
    if kinds is None or len(few) > len(kind) // DISTINCT:
        whole = shapes(weights=None)
        return lambda heights: np.asarray((whole @ heights.T).T)
    sums = shapes(weights=(kind[:, None] == np.arange(len(few))).astype(float))
    return lambda heights: np.asarray(heights[:, few] @ sums.T)


def _square(scene: PlatformScene, places: FloatArray) -> DisplaySurface:
    low, high = places.min(axis=0), places.max(axis=0)
    half = (0.5 + MARGIN) * float((high - low).max()) or scene.surface.size / 2
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    return DisplaySurface((low + high) / 2 + half * corners, triangles, lambda heights: heights @ np.ones((1, 4)))
