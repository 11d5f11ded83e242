"""Nearest points of an ellipse and of straight or parabolic edges, for many points at once.

`particle/surface/rim.py` has the same formulas for one point, compiled: `particle` knows no meshes, and meshes are made
without numba.
"""

from __future__ import annotations

import numpy as np

from meshes.types import FloatArray, IntArray

CHUNK = 200_000  # pairs of point and edge compared at a time: about 50 MB


def nearest_on_ellipse(xy: FloatArray, semi_axes: tuple[float, float]) -> FloatArray:
    """The nearest points of an ellipse around the origin to points (n, 2); of several equally near ones, one.

    The foot of (u, v) is (a^2 u / (s + a^2), b^2 v / (s + b^2)), a >= b, where s > -b^2 is the largest root of
    (a u / (s + a^2))^2 + (b v / (s + b^2))^2 = 1 (D. Eberly, Distance from a point to an ellipse, 2013).
    """
    axes = np.asarray(semi_axes, dtype=float)
    long, short = (0, 1) if axes[0] >= axes[1] else (1, 0)
    ratio = (axes[long] / axes[short]) ** 2
    z0, z1 = np.abs(xy[:, long]) / axes[long], np.abs(xy[:, short]) / axes[short]
    # With t = 1 + s / b^2 the left side falls and is convex, so Newton's steps from a point left of the root never
    # pass it; at either of these two points one of the terms is 1 already.
    t = np.maximum(z1, ratio * z0 - (ratio - 1))
    on_axis = t <= 0  # between the ends of the evolute on the long axis, the centre of a circle among them
    t = np.where(on_axis, 1.0, t)
    for _ in range(200):
        c0, c1 = ratio * z0 / (t + (ratio - 1)), z1 / t
        slope = 2 * (c0**2 / (t + (ratio - 1)) + c1**2 / t)
        step = (c0**2 + c1**2 - 1) / np.where(on_axis, 1.0, slope)
        t = t + np.where(on_axis, 0.0, np.maximum(step, 0.0))
        if not np.any((step > 1e-15 * t) & ~on_axis):
            break
    c0, c1 = ratio * z0 / (t + (ratio - 1)), z1 / t
    if ratio > 1:
        c0 = np.where(on_axis, ratio * z0 / (ratio - 1), c0)
    c1 = np.where(on_axis, np.sqrt(np.clip(1 - c0**2, 0, None)), c1)
    length = np.hypot(c0, c1)
    foot = np.empty_like(xy)
    foot[:, long] = np.copysign(axes[long] * c0 / length, xy[:, long])
    foot[:, short] = np.copysign(axes[short] * c1 / length, xy[:, short])
    return foot


def on_edges(edges: FloatArray, t: FloatArray) -> FloatArray:
    """Points (k, n, 2) of edges (k, 3, 2), given by start, middle and end, at parameters t (k, n)."""
    start, slope, bend = powers(edges)
    return start[:, None] + t[..., None] * (slope[:, None] + t[..., None] * bend[:, None])


def powers(edges: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The coefficients of 1, t and t^2 of edges (..., 3, 2): three (..., 2)."""
    start, middle, end = np.moveaxis(edges, -2, 0)
    return start, 4 * (middle - start) - (end - start), 2 * ((start - middle) + (end - middle))


def nearest_on_edges(xy: FloatArray, edges: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
    """The nearest points (n, 2) of edges (k, 3, 2) to points (n, 2), with the edges (n,) and parameters (n,) there."""
    step = max(1, CHUNK // len(edges))
    parts = [_nearest_on_edges(xy[i : i + step], edges) for i in range(0, max(1, len(xy)), step)]
    foot, edge, t = (np.concatenate(part) for part in zip(*parts, strict=True))
    return foot, edge, t


def _nearest_on_edges(xy: FloatArray, edges: FloatArray) -> tuple[FloatArray, IntArray, FloatArray]:
    # An edge stays within `reach` of its middle: (1-t)|1-2t| + t|1-2t| <= 1.
    reach = np.linalg.norm(edges - edges[:, 1:2], axis=-1).max(axis=1)
    distance = np.linalg.norm(xy[:, None] - edges[:, 1], axis=-1)
    # "not >" rather than "<=", so that a NaN point keeps its edges.
    row, edge = np.nonzero(~(distance - reach > distance.min(axis=1, keepdims=True)))
    t = nearest_parameter(xy[row], edges[edge])
    foot = on_edges(edges[edge], t[:, None])[:, 0]
    order = np.lexsort((np.linalg.norm(foot - xy[row], axis=1), row))
    best = order[np.searchsorted(row[order], np.arange(len(xy)))]
    return foot[best], edge[best], t[best]


def nearest_parameter(xy: FloatArray, edges: FloatArray) -> FloatArray:
    """The parameters (n,) in [0, 1] at which edges (n, 3, 2) are nearest to points (n, 2), each to its own.

    Around its vertex a parabola is V + T u + C u^2 with T normal to C, and |V + T u + C u^2 - x|^2 is stationary where
    u^3 + p u + q = 0, p = (T.T - 2 C.(x - V)) / 2 C.C, q = -T.(x - V) / 2 C.C.
    """
    _, slope, bend = powers(edges)
    chord = edges[:, 2] - edges[:, 0]
    t = _dot(xy - edges[:, 0], chord) / np.maximum(_dot(chord, chord), np.finfo(float).tiny)
    t = np.clip(t, 0.0, 1.0)
    bent = np.flatnonzero(_dot(bend, bend) > 1e-24 * _dot(slope, slope))
    t[bent] = _parabola_parameter(xy[bent], edges[bent])
    return t


def _parabola_parameter(xy: FloatArray, edges: FloatArray) -> FloatArray:
    start, slope, bend = powers(edges)
    square = _dot(bend, bend)
    vertex = -_dot(slope, bend) / (2 * square)
    tangent = slope + 2 * vertex[:, None] * bend
    offset = xy - start - vertex[:, None] * (slope + vertex[:, None] * bend)
    t = vertex + _outer_roots(
        (_dot(tangent, tangent) - 2 * _dot(bend, offset)) / (2 * square), -_dot(tangent, offset) / (2 * square)
    )
    # Polish by Newton's method: the vertex of a nearly straight edge is far away, and its root inexact.
    for _ in range(3):
        from_x = start - xy + t[..., None] * (slope + t[..., None] * bend)
        along = slope + 2 * t[..., None] * bend
        growth = _dot(along, along) + 2 * _dot(from_x, bend)
        t = t - np.where(growth > 0, _dot(from_x, along) / np.where(growth > 0, growth, 1.0), 0.0)
    t = np.concatenate([np.clip(t, 0.0, 1.0), np.zeros((1, len(xy))), np.ones((1, len(xy)))])
    distance = np.linalg.norm(start - xy + t[..., None] * (slope + t[..., None] * bend), axis=-1)
    return np.take_along_axis(t, np.argmin(distance, axis=0)[None], axis=0)[0]


def _outer_roots(p: FloatArray, q: FloatArray) -> FloatArray:
    """The largest and the smallest real root (2, n) of u^3 + p u + q = 0."""
    discriminant = (q / 2) ** 2 + (p / 3) ** 3
    big = -np.copysign(np.cbrt(np.abs(q) / 2 + np.sqrt(np.maximum(discriminant, 0.0))), q)
    single = big - p / (3 * np.where(big == 0, 1.0, big))
    radius = np.sqrt(np.maximum(-p, 0.0) / 3)
    cosine = np.clip(-q / (2 * np.where(radius > 0, radius, 1.0) ** 3), -1.0, 1.0)
    angle = np.arccos(cosine) / 3
    three = 2 * radius * np.stack([np.cos(angle), np.cos(angle + 2 * np.pi / 3)])
    return np.where(discriminant > 0, single, three)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
