"""The rim: how it is supported, and quadrature along the true curve and in the slivers between it and the chords."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from fem_plate.types import FloatArray, IntArray
from meshes import PlateMesh, areas, cross, edge_numbers, sides

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"
KINDS = (CLAMPED, SIMPLY_SUPPORTED, FREE)


def by_boundary(supports: str | Mapping[str, str], boundaries: Mapping[str, object]) -> dict[str, str]:
    """The support of every boundary; those that a mapping leaves out are free.

    Raises ValueError, naming every unknown support and boundary.
    """
    if isinstance(supports, str):
        supports = dict.fromkeys(boundaries, supports)
    if not isinstance(supports, Mapping):
        raise ValueError(f"Input supports of Plate must be one name or a mapping from boundaries; got {supports!r}")
    names, kinds = ", ".join(map(repr, boundaries)), ", ".join(map(repr, KINDS))
    mistakes = [f"boundary {name!r} is not one of the mesh's, {names}" for name in supports if name not in boundaries]
    mistakes += [
        f"the support of {name!r} must be one of {kinds}; got {kind!r}"
        for name, kind in supports.items()
        if kind not in KINDS
    ]
    if mistakes:
        raise ValueError("Input supports of Plate: " + "; ".join(dict.fromkeys(mistakes)))
    return {name: supports.get(name, FREE) for name in boundaries}


def prescribed(support: str, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a support prescribes at rim points with normals (..., 2): T (..., 2, 2) of the gradient, c (...) of w."""
    if support == FREE:
        return np.zeros((*normal.shape, 2)), np.zeros(normal.shape[:-1])
    if support == CLAMPED:
        return np.broadcast_to(np.eye(2), (*normal.shape, 2)), np.ones(normal.shape[:-1])
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    return tangent[..., :, None] * tangent[..., None, :], np.ones(normal.shape[:-1])


# A rim triangle's integrands are polynomials along a curve: this many points a side leave rounding errors only, and
# penalties this share of the rim's cells, at the lowest degree. Traces grow with the square of the degree.
RIM_POINTS, DEGREE = 8, 5
BULGE = 1e-14  # of the plate's size: less between chord and rim is rounding


class RimQuadrature(NamedTuple):
    """Quadrature on the rim, n points on each of k edges; dimensionless."""

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2), on the true curve
    weights: FloatArray  # (k, n), arc length included
    normal: FloatArray  # (k, n, 2), outward
    T: FloatArray  # (k, n, 2, 2), what the support prescribes of the gradient
    c: FloatArray  # (k, n), and of the value
    h: FloatArray  # (k,), the length of the edge, or less where its cell is flat or its degree above five
    twist: FloatArray  # (k, n, 2), t at the end of a free edge at a held one, -t at its start, 0 elsewhere


class Slivers(NamedTuple):
    """Quadrature between chords and the true rim, of negative weight where the rim lies inside its chord."""

    triangle: IntArray  # (k,)
    points: FloatArray  # (k, n, 2)
    weights: FloatArray  # (k, n)


def rim_quadrature(mesh: PlateMesh, supports: Mapping[str, str], degree: int = DEGREE) -> tuple[RimQuadrature, Slivers]:
    """Quadrature on the rim of a mesh and on what its triangles miss of the plate, both dimensionless."""
    gauss, weights = unit_gauss(RIM_POINTS + degree - DEGREE)
    s = np.concatenate([[0.0], gauss, [1.0]])  # the ends have no weight, but carry `twist`
    edges = np.concatenate(list(mesh.boundaries.values()))
    triangle = _owners(mesh, edges)
    chords = mesh.points[edges] / mesh.size  # (k, 2, 2)
    arcs = [mesh.arcs(name, s) for name in mesh.boundaries]
    points = np.concatenate([points for points, _ in arcs]) / mesh.size
    tangents = np.concatenate([tangents for _, tangents in arcs]) / mesh.size
    speed = np.linalg.norm(tangents, axis=-1)
    normal = np.stack([tangents[..., 1], -tangents[..., 0]], axis=-1) / speed[..., None]
    length = np.pad(weights, 1) * speed
    kinds = np.repeat([supports[name] for name in mesh.boundaries], [len(e) for e in mesh.boundaries.values()])
    T, c = np.empty((*points.shape, 2)), np.empty(length.shape)
    for kind in set(kinds.tolist()):
        T[kinds == kind], c[kinds == kind] = prescribed(kind, normal[kinds == kind])
    held, twist = c[:, 0] > 0, np.zeros(points.shape)
    for end, at, sign in ((0, 0, -1.0), (1, -1, 1.0)):
        at_held = ~held & np.isin(edges[:, end], edges[held])
        twist[at_held, at] = sign * tangents[at_held, at] / speed[at_held, at, None]
    # A trace is bounded by the energy over the cell's height. An equilateral cell has 0.87 of its edge.
    height = (
        2
        * np.abs(areas(mesh.points / mesh.size, mesh.triangles[triangle]))
        / np.linalg.norm(chords[:, 1] - chords[:, 0], axis=1)
    )
    h = np.minimum(length.sum(axis=1), 2 / np.sqrt(3) * height) * (DEGREE / degree) ** 2
    rim = RimQuadrature(triangle, points, length, normal, T, c, h, twist)
    return rim, _slivers(triangle, chords, points[:, 1:-1], tangents[:, 1:-1])


def _slivers(triangle: IntArray, chords: FloatArray, points: FloatArray, tangents: FloatArray) -> Slivers:
    """Quadrature between chords (k, 2, 2) and the rim's Gauss points (k, n, 2) with tangents (k, n, 2)."""
    gauss, weights = unit_gauss(points.shape[1])
    start, along = chords[:, 0, None], (chords[:, 1] - chords[:, 0])[:, None]
    chord = start + gauss[:, None] * along
    bulge, growth = points - chord, tangents - along
    curved = np.abs(bulge).max(axis=(1, 2)) > BULGE
    chord, bulge, growth = chord[curved, None], bulge[curved, None], growth[curved, None]  # (k, 1, along, 2)
    across = gauss[:, None, None]
    area = cross(bulge, along[curved, None] + across * growth)
    inside = (chord + across * bulge).reshape(len(bulge), len(gauss) ** 2, 2)
    return Slivers(triangle[curved], inside, (np.outer(weights, weights) * area).reshape(inside.shape[:2]))


def rigid_motions(rim: RimQuadrature) -> FloatArray:
    """The rigid motions that the supports allow, as columns of coefficients of (1, x, y): (3, r)."""
    x, y = rim.points.reshape(-1, 2).T
    values = rim.c.reshape(-1)[:, None] * np.stack([np.ones_like(x), x, y], axis=1)
    gradients = rim.T.reshape(-1, 2)
    rows = np.concatenate([values, np.concatenate([np.zeros((len(gradients), 1)), gradients], axis=1)])
    _, scale, directions = np.linalg.svd(rows.T @ rows)
    return np.asarray(directions[scale <= 1e-10 * len(rows)].T)


def unit_gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre points and weights on [0, 1]."""
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


def _owners(mesh: PlateMesh, edges: IntArray) -> IntArray:
    """The triangle that each boundary edge (k, 2) belongs to."""
    count = len(mesh.points)
    numbers = edge_numbers(sides(mesh.triangles), count)
    order = np.argsort(numbers)
    return np.asarray(order[np.searchsorted(numbers, edge_numbers(edges, count), sorter=order)] // 3)
