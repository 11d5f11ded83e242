"""Where a plate is steepest, highest and bent most; one with many actuators is not looked at everywhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, cKDTree

from coupling.case import SAME_PLACE
from coupling.drives import moments, stroke_heights
from fem_plate import InfluenceShapes, MovingShapes, PatchedShapes, Shapes
from fem_plate.elements import SingularCorner
from particle import AnyDrive

FloatArray = NDArray[np.float64]

MOMENTS, ACTUATORS = 16, 16  # that are looked at closely: so many of each
TOGETHER = 32  # moments whose slopes are summed up at a time, to bound memory
ALIKE = 1e-9  # of the largest height: drives this close stand alike
AROUND = 8  # points on each circle around one
RADII = 0.1, 0.3, 0.5  # of circles, in distances to the nearest other actuator


def extremes(
    shapes: Shapes, drives: Sequence[AnyDrive], end: float, sharp: FloatArray, off: float
) -> tuple[float, float, float | None]:
    """The largest slope, deflection [m] and curvature [1/m] over the time asked for, wherever the run ended.

    They are those at the elements' samples and on circles around the actuators, where the slope is largest. Curvatures
    are principal ones, `off` [m] or farther from the sharp points (k, 2) [m], where they are infinite; None where no
    point is as far. Of very many actuators, slope and deflection over the neighbourhood of those where they must be.
    """
    heights = stroke_heights(drives, moments(drives, end))
    if isinstance(shapes, PatchedShapes):
        return *steepest(shapes, heights), None
    assert isinstance(shapes, InfluenceShapes | MovingShapes)
    heights = heights[_unlike(heights * shapes.own_heights())]
    steep = np.concatenate([shapes.functions.space.samples * shapes.size, _around(shapes)])
    points = np.concatenate([steep, _rings(shapes, sharp, off)])
    value, gradient, hessian = shapes.evaluate(points)
    value, gradient = value[: len(steep)], gradient[: len(steep)]
    slopes = np.ascontiguousarray(np.moveaxis(gradient, 2, 0))  # (2, n, N)
    together = [heights[k : k + TOGETHER].T for k in range(0, len(heights), TOGETHER)]
    slope = max(float(np.hypot(*(slopes @ h)).max()) for h in together)
    far = cKDTree(sharp).query(points)[0] >= off * (1 - SAME_PLACE)
    rows = np.stack([hessian[far, :, 0, 0], hessian[far, :, 0, 1], hessian[far, :, 1, 1]])
    curvature = max(float(_principal(*(rows @ h)).max()) for h in together) if far.any() else None
    return slope, float(np.abs(heights @ value.T).max()), curvature


def _principal(xx: FloatArray, xy: FloatArray, yy: FloatArray) -> FloatArray:
    """The larger one of a symmetric tensor's two principal values, without its sign."""
    return np.asarray(np.abs(xx + yy) / 2 + np.hypot((xx - yy) / 2, xy))


def steepest(shapes: Shapes, heights: FloatArray) -> tuple[float, float]:
    """The largest slope and deflection [m] at moments with heights (k, N) [m] of the drives.

    Between neighbours, or an actuator and the rim, the mean slope follows from their heights. Where it is largest, in
    time and place, and where the plate is highest, circles around the actuators are looked at.
    """
    lifted = heights * shapes.own_heights()
    pairs = _neighbours(shapes.points)
    distance = np.hypot(*(shapes.points[pairs[:, 0]] - shapes.points[pairs[:, 1]]).T)
    nearest = np.minimum(np.full(len(shapes.points), np.inf), shapes.outline.gap(shapes.points))
    rim = nearest.copy()
    for side in (0, 1):
        np.minimum.at(nearest, pairs[:, side], distance)
    slope = np.empty_like(lifted)
    for row, height in zip(slope, lifted, strict=True):
        row[:] = np.abs(height) / rim
        mean = np.abs(height[pairs[:, 0]] - height[pairs[:, 1]]) / distance
        for side in (0, 1):
            np.maximum.at(row, pairs[:, side], mean)
    largest, highest = 0.0, float(np.abs(lifted).max())
    for measure in (slope, np.abs(lifted)):
        most = np.argsort(-measure.max(axis=1), kind="stable")[:MOMENTS]
        for moment in most[_unlike(lifted[most])]:
            centres = np.argsort(-measure[moment], kind="stable")[:ACTUATORS]
            xy = _circles(shapes, centres, nearest[centres])
            value, gradient, _ = shapes.evaluate(xy, heights[moment])
            largest = max(largest, float(np.hypot(*gradient.T).max(initial=0.0)))
            highest = max(highest, float(np.abs(value).max(initial=0.0)))
    return largest, highest


def _unlike(heights: FloatArray) -> NDArray[np.int64]:
    """Which rows of heights (k, N) [m] no earlier row equals up to rounding: cycles repeat themselves."""
    unit = ALIKE * np.abs(heights).max()
    return np.sort(np.unique(np.round(heights / (unit or 1.0)), axis=0, return_index=True)[1])


def _around(shapes: Shapes) -> FloatArray:
    """Points (n, 2) [m] on circles around all actuators, as small as the next actuator or the rim is near."""
    others = cKDTree(shapes.points).query(shapes.points, k=[2])[0][:, 0]  # inf where there is none
    return _circles(shapes, np.arange(len(shapes.points)), np.minimum(others, shapes.outline.gap(shapes.points)))


def _rings(shapes: Shapes, centres: FloatArray, radius: float) -> FloatArray:
    """Points (n, 2) [m] of the plate on circles of a radius [m] around centres (k, 2) [m]."""
    return _stars(shapes, centres, np.full(len(centres), radius), (1.0,))


def sharp_points(singular: Sequence[SingularCorner], points: FloatArray) -> FloatArray:
    """Where the bending moment is infinite: actuators' points (N, 2) [m] and, below these, corners of the plate."""
    return np.concatenate([points, *(corner.point[None] for corner in singular if corner.exponent < 1)])


def _circles(shapes: Shapes, centres: NDArray[np.int64], nearest: FloatArray) -> FloatArray:
    """Points (n, 2) [m] of the plate around actuators in these rows, whose nearest neighbours are so far [m]."""
    return _stars(shapes, shapes.points[centres], nearest, RADII)


def _stars(shapes: Shapes, centres: FloatArray, lengths: FloatArray, radii: Sequence[float]) -> FloatArray:
    """Points (n, 2) [m] of the plate on circles around centres (k, 2), with radii in lengths (k,) [m] of each."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    star = np.multiply.outer(radii, np.stack([np.cos(angle), np.sin(angle)], axis=1)).reshape(-1, 2)
    xy = (centres[:, None] + lengths[:, None, None] * star).reshape(-1, 2)
    return np.asarray(xy[shapes.outline.gap(xy) >= 0])


def _neighbours(points: FloatArray) -> NDArray[np.int64]:
    """Pairs (k, 2) of rows of points (N, 2) that are neighbours; of points on one line, those next to each other."""
    spread = points - points.mean(axis=0)
    across = np.linalg.svd(spread, full_matrices=False)
    if across[1][-1] < 1e-9 * across[1][0]:
        order = np.argsort(spread @ across[2][0])
        return np.stack([order[:-1], order[1:]], axis=1)
    triangles = Delaunay(points).simplices
    return np.unique(
        np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])), axis=0
    )
