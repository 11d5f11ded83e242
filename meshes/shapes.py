"""Meshes of the standard outlines."""

from __future__ import annotations

import math

import numpy as np

from meshes.curves import Circle, Ellipse
from meshes.fill import RimEdges, check_count, fill
from meshes.mesh import PlateMesh
from meshes.nearest import nearest_on_ellipse
from meshes.outline import Outline, straight
from meshes.types import FloatArray

LONGEST_ARC = 2 / 3  # rim edges of an ellipse are at most this long in radii of curvature


def check_lengths(caller: str, *mistakes: str, **lengths: float) -> None:
    """Raise ValueError, naming every length that is not positive and finite, and other mistakes if there are any."""
    wrong = [
        f"Input {name} of {caller} must be a positive length in m; got {value!r}"
        for name, value in lengths.items()
        if not (math.isfinite(value) and value > 0)
    ]
    if wrong or mistakes:
        raise ValueError("\n".join([*wrong, *mistakes]))


def disc(radius: float, cell_size: float) -> PlateMesh:
    """A disc around the origin, in rings of nearly equilateral triangles: ring k has 6 k points.

    Its boundary is "rim".

    Parameters
    ----------
    radius : float
        [m].
    cell_size : float
        The largest width of a ring [m]; a cell's longest edge is at most 1.45 times that. There are at least two rings.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        A length is not positive and finite; or there are more than a million cells.
    """
    check_lengths("disc", radius=radius, cell_size=cell_size)
    check_count("disc", 6 * (radius / cell_size) ** 2, cell_size)
    rings = max(2, math.ceil(radius / cell_size * (1 - 1e-12)))
    points = np.concatenate([np.zeros((1, 2)), *(_ring(k, radius * k / rings) for k in range(1, rings + 1))])
    triangles = []
    for k in range(rings):
        for sector in range(6):
            for step in range(k + 1):
                inner, outer = sector * k + step, sector * (k + 1) + step
                triangles.append((_row(k, inner), _row(k + 1, outer), _row(k + 1, outer + 1)))
                if step < k:
                    triangles.append((_row(k, inner), _row(k + 1, outer + 1), _row(k, inner + 1)))
    rim = np.array([(_row(rings, i), _row(rings, i + 1)) for i in range(6 * rings)])
    return PlateMesh(points, np.array(triangles), {"rim": rim}, {"rim": Circle(radius)})


def rectangle(width: float, height: float, cell_size: float) -> PlateMesh:
    """A rectangle around the origin, in an even number of nearly square boxes either way, each cut along a diagonal.

    The diagonals alternate, so that the mesh has the rectangle's symmetries. Its boundaries are "left", "right",
    "bottom" and "top".

    Parameters
    ----------
    width, height : float
        Along x and y [m].
    cell_size : float
        The largest width and height of a box [m]. There are at least two by two.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names every length that is not positive and finite; or there are more than a million cells.
    """
    check_lengths("rectangle", width=width, height=height, cell_size=cell_size)
    lengths = np.array([width, height])
    count = 2 * np.ceil(lengths / (2 * cell_size) * (1 - 1e-12))
    count = np.maximum(count, 2 * np.round(lengths / (2 * (lengths / count).min())))
    check_count("rectangle", 2 * float(count.prod()), cell_size)
    nx, ny = count.astype(int).tolist()
    i, j = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij")
    points = np.stack([(2 * i - nx) / (2 * nx) * width, (2 * j - ny) / (2 * ny) * height], axis=-1).reshape(-1, 2)
    row = i * (ny + 1) + j
    a, b, c, d = (x.ravel() for x in (row[:-1, :-1], row[1:, :-1], row[1:, 1:], row[:-1, 1:]))
    rising = ((i + j) % 2 == 0)[:-1, :-1].ravel()[:, None]
    first = np.where(rising, np.stack([a, b, c], axis=1), np.stack([a, b, d], axis=1))
    second = np.where(rising, np.stack([a, c, d], axis=1), np.stack([b, c, d], axis=1))
    walks = {"left": row[0, ::-1], "right": row[-1], "bottom": row[:, 0], "top": row[::-1, -1]}
    boundaries = {name: np.stack([walk[:-1], walk[1:]], axis=1) for name, walk in walks.items()}
    corners = points[[row[0, 0], row[-1, 0], row[-1, -1], row[0, -1]]]
    outline = Outline(edges=straight(corners, np.roll(corners, -1, axis=0)))
    return PlateMesh(points, np.concatenate([first, second]), boundaries, {}, outline)


def annulus(inner_radius: float, outer_radius: float, cell_size: float) -> PlateMesh:
    """A ring around the origin, of nearly equilateral cells that grow outwards with the radius.

    It is the image of a hexagonal lattice under the exponential function, which keeps angles. Its boundaries are
    "inner" and "outer".

    Parameters
    ----------
    inner_radius, outer_radius : float
        [m].
    cell_size : float
        The largest height of a cell [m]; its sides are 1.15 times that. There are at least two rings of twelve cells.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names every length that is not positive and finite; or the inner radius is not smaller than the outer one; or
        there are more than a million cells.
    """
    check_lengths("annulus", inner_radius=inner_radius, outer_radius=outer_radius, cell_size=cell_size)
    if inner_radius >= outer_radius:
        raise ValueError(
            f"Input inner_radius of annulus must be less than its outer_radius, {outer_radius!r}; got {inner_radius!r}"
        )
    growth = math.log1p((outer_radius - inner_radius) / inner_radius)
    around = max(12.0, math.sqrt(3) * math.pi * outer_radius / cell_size * (1 - 1e-12))
    per_ring = math.sqrt(3) * math.pi  # log of a ring's radii times the cells around, for equilateral cells
    check_count("annulus", 2 * growth * around**2 / per_ring, cell_size)
    rings = max(2, round(growth * around / per_ring))
    # A multiple of four, so that the mesh mirrors in both axes.
    check_count("annulus", 2 * rings * max(around, rings * per_ring / growth), cell_size)
    around = 4 * math.ceil(max(around, rings * per_ring / growth) / 4 * (1 - 1e-12))
    k, i = np.meshgrid(np.arange(rings + 1), np.arange(around), indexing="ij")
    radius = inner_radius * (outer_radius / inner_radius) ** (np.arange(rings + 1) / rings)
    radius[[0, -1]] = inner_radius, outer_radius
    angle = 2 * np.pi * ((i + k / 2) % around) / around
    points = (radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)).reshape(-1, 2)
    row = k * around + i
    after = np.roll(row, -1, axis=1)
    a, b, c, d = (x.ravel() for x in (row[:-1], after[:-1], row[1:], after[1:]))
    triangles = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    inner, outer = np.stack([after[0], row[0]], axis=1), np.stack([row[-1], after[-1]], axis=1)
    curves = {"inner": Circle(inner_radius), "outer": Circle(outer_radius)}
    return PlateMesh(points, triangles, {"inner": inner, "outer": outer}, curves)


def ellipse(semi_axis_x: float, semi_axis_y: float, cell_size: float) -> PlateMesh:
    """An ellipse around the origin, with smaller cells towards its sharper ends.

    Its boundary is "rim".

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        [m].
    cell_size : float
        About the longest edge of a cell [m]; cells are at most half of the shorter semi-axis.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names every length that is not positive and finite; or there are more than a million cells.
    """
    check_lengths("ellipse", semi_axis_x=semi_axis_x, semi_axis_y=semi_axis_y, cell_size=cell_size)
    axes = np.array([semi_axis_x, semi_axis_y])
    size = min(cell_size, axes.min() / 2)
    # Divide a quarter into edges of the length due at each place, and mirror it.
    angle = np.linspace(0, np.pi / 2, 4001)
    middle = (angle[1:] + angle[:-1]) / 2
    speed = np.hypot(axes[0] * np.sin(middle), axes[1] * np.cos(middle))
    length = np.minimum(size, LONGEST_ARC * speed**3 / axes.prod())
    number = np.concatenate([[0], np.cumsum(speed * np.diff(angle) / length)])
    count = math.ceil(number[-1])
    check_count("ellipse", max(4.0 * count, 2 * math.pi * axes.prod() / size**2), cell_size)
    quarter = np.interp(np.arange(count) * number[-1] / count, number, angle)
    angle = np.concatenate([quarter, np.pi - np.append(quarter[1:], np.pi / 2)[::-1]])
    angle = np.concatenate([angle, angle + np.pi])
    rim_points = axes * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    row = np.arange(len(angle))

    rim = RimEdges(
        np.stack([row, np.roll(row, -1)], axis=1),
        np.zeros(len(row), dtype=np.int64),
        lambda middle, _: nearest_on_ellipse(middle, (semi_axis_x, semi_axis_y)),
        lambda start, end, _: np.zeros(len(start)),
    )
    outline = Outline(conics=np.array([[0.0, 0.0, semi_axis_x, semi_axis_y]]))
    points, triangles = fill(rim_points, rim, outline, size)
    return PlateMesh(points, triangles, {"rim": rim.edges}, {"rim": Ellipse(semi_axis_x, semi_axis_y)})


def _ring(k: int, radius: float) -> FloatArray:
    angle = 2 * np.pi * np.arange(6 * k) / (6 * k)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _row(ring: int, place: int) -> int:
    """Row of a point in `points` from its ring and its place there, counted round and round."""
    return 0 if ring == 0 else 1 + 3 * ring * (ring - 1) + place % (6 * ring)
