"""Meshes from the files of mesh generators."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from meshes.curves import Parabolas
from meshes.files import line_names, load
from meshes.mesh import PlateMesh
from meshes.nearest import FloatArray, IntArray, on_edges, powers
from meshes.refine import edge_numbers
from meshes.shapes import check_lengths, refuse

PLANE = 1e-9  # of the box: points may lie so far off their plane
LEAST_AREA = 1e-12  # of the box
STRAIGHT = 1e-9  # of the chord: edges whose middle is nearer to it are straight
BENT = 1e-6  # of the chord: inner edges must not be bent more


def read(path: str | Path, unit: float = 1.0) -> PlateMesh:
    """Read a mesh file: .msh of gmsh 2 and 4, .vtu or .xdmf, with triangles of first or (except .xdmf) second order.

    Boundaries are the file's lines, by the names of their physical curves in gmsh, or by their number where the
    format has no names. Curved rims of second-order cells stay curved. Points that no triangle uses are dropped.

    Parameters
    ----------
    path : path
        The file.
    unit : float
        Metres in one unit of the file's lengths. Places stay where they are in the file.

    Returns
    -------
    mesh : PlateMesh
        The mesh.

    Raises
    ------
    ValueError
        The file cannot be read, or is not a plane conforming mesh with named boundaries; gives counts and the first
        places at fault, in the file's unit.
    """
    refuse(check_lengths("read", unit=unit))
    mesh = load(Path(path))
    wrong: list[str] = []
    corners, middles = _cells(mesh, wrong)
    if not len(corners):
        wrong.append("no triangles")
        _refuse(path, wrong)
    points = np.asarray(mesh.points, dtype=float)
    used = np.unique(np.concatenate([corners.ravel(), middles[middles >= 0]]))
    lost = used[~np.isfinite(points[used]).all(axis=1)]
    if len(lost):
        _note(wrong, len(lost), "points that are not finite", points[lost])
        _refuse(path, wrong)
    box = np.ptp(points[used, :2], axis=0)
    if points.shape[1] == 3:
        off = used[np.abs(points[used, 2] - np.median(points[used, 2])) > PLANE * box.max()]
        _note(wrong, len(off), "points off the plane of the others", points[off])
    points = points[:, :2]
    corners, middles = _turned_over(points, corners, middles)
    _check_cells(points, corners, box.prod(), wrong)
    rim = _edges(points, corners, middles, wrong)
    names = _names(mesh, points, rim.edges, wrong)
    _refuse(path, wrong)
    kept, rows = np.unique(corners, return_inverse=True)
    boundaries, curves = {}, {}
    for name in dict.fromkeys(names):
        there = np.array([other == name for other in names])
        boundaries[name] = np.searchsorted(kept, rim.edges[there])
        if rim.bent[there].any():
            curves[name] = Parabolas(unit * rim.pieces[there])
    return PlateMesh(unit * points[kept], rows.reshape(-1, 3), boundaries, curves)


def _cells(mesh: Any, wrong: list[str]) -> tuple[IntArray, IntArray]:
    """The triangles' corners (m, 3) and the middles (m, 3) of their edges 01, 12, 20, -1 in first-order ones."""
    corners, middles = [np.empty((0, 3), dtype=np.int64)], [np.empty((0, 3), dtype=np.int64)]
    for block in mesh.cells:
        data = np.asarray(block.data, dtype=np.int64)
        if block.type in ("triangle", "triangle6"):
            corners.append(data[:, :3])
            middles.append(data[:, 3:] if block.type == "triangle6" else np.full((len(data), 3), -1))
        elif block.type not in ("vertex", "line", "line3"):
            wrong.append(f"{len(data)} cells of kind {block.type}: only triangle and triangle6 can be used")
    return np.concatenate(corners), np.concatenate(middles)


def _turned_over(points: FloatArray, corners: IntArray, middles: IntArray) -> tuple[IntArray, IntArray]:
    """The cells, each the other way round if all run clockwise."""
    return (corners[:, [0, 2, 1]], middles[:, [2, 1, 0]]) if (_areas(points, corners) < 0).all() else (corners, middles)


def _check_cells(points: FloatArray, corners: IntArray, box: float, wrong: list[str]) -> None:
    area, centre = _areas(points, corners), points[corners].mean(axis=1)
    flat = np.abs(area) <= LEAST_AREA * box
    _note(wrong, flat.sum(), "cells without an area", centre[flat])
    turned = (area < 0) if 2 * (area < 0).sum() <= len(area) else (area > 0)
    turned &= ~flat
    _note(wrong, turned.sum(), "cells that run the other way round than the rest", centre[turned])


def _edges(points: FloatArray, corners: IntArray, middles: IntArray, wrong: list[str]) -> SimpleNamespace:
    """The rim: edges (k, 2) with the plate on their left, pieces (k, 3, 2) and which of them are bent (k,)."""
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    apex, middle = points[np.roll(corners, -2, axis=1).ravel()], middles.ravel()
    _, edge, count = np.unique(edge_numbers(sides, len(points)), return_inverse=True, return_counts=True)
    shared = points[sides].mean(axis=1)
    many = np.unique(edge[count[edge] > 2], return_index=True)[1]
    _note(wrong, len(many), "edges shared by more than two cells", shared[np.flatnonzero(count[edge] > 2)[many]])
    start, end = np.moveaxis(points[sides], 1, 0)
    pieces = np.stack([start, np.where(middle[:, None] < 0, shared, points[middle]), end], axis=1)
    chord, rise = end - start, pieces[:, 1] - start
    sag = np.abs(chord[:, 0] * rise[:, 1] - chord[:, 1] * rise[:, 0])
    square = np.maximum((chord**2).sum(axis=1), np.finfo(float).tiny)
    on_rim = count[edge] == 1
    curved = (sag > BENT * square) & ~on_rim
    _note(wrong, len(np.unique(edge[curved])), "curved edges inside the plate: only the rim may be", shared[curved])
    bent = sag > STRAIGHT * square
    pieces[~bent, 1] = shared[~bent]
    suspects = np.flatnonzero(bent & on_rim)
    along, out = _walk(pieces[suspects], np.linspace(0, 1, 5))
    out = out - apex[suspects, None]
    folded = suspects[(out[..., 0] * along[..., 1] - out[..., 1] * along[..., 0]).min(axis=1) <= 0]
    _note(wrong, len(folded), "cells that their curved edge folds", shared[folded])
    return SimpleNamespace(edges=sides[on_rim], pieces=pieces[on_rim], bent=bent[on_rim])


def _walk(pieces: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Derivatives and points (k, n, 2) of pieces (k, 3, 2) at parameters s (n,)."""
    _, slope, bend = powers(pieces)
    return slope[:, None] + 2 * s[:, None] * bend[:, None], on_edges(pieces, np.tile(s, (len(pieces), 1)))


def _names(mesh: Any, points: FloatArray, edges: IntArray, wrong: list[str]) -> list[str]:
    """The name of each rim edge (k, 2)."""
    lines = [np.asarray(block.data, dtype=np.int64)[:, :2] for block in mesh.cells if block.type in ("line", "line3")]
    numbers = edge_numbers(np.concatenate([*lines, np.empty((0, 2), dtype=np.int64)]), len(points)).tolist()
    found: dict[int, set[str]] = {}
    for number, given_names in zip(numbers, line_names(mesh), strict=True):
        found.setdefault(number, set()).update(given_names)
    given = [found.get(number, set()) for number in edge_numbers(edges, len(points)).tolist()]
    without = np.array([not names for names in given])
    if without.any():
        count, first = int(without.sum()), points[edges[without][0]]
        ends = " and ".join(_place(end) for end in first)
        between = f"the first between {ends}" if count > 1 else f"between {ends}"
        wrong.append(
            f"an unnamed boundary: {count} edge{'s'[: count > 1]}, {between}; give them a Physical Curve name in gmsh"
        )
    double = np.array([len(names) > 1 for names in given])
    _note(wrong, double.sum(), "boundary edges with more than one name", points[edges[double]].mean(axis=1))
    return [min(names, default="") for names in given]


def _areas(points: FloatArray, corners: IntArray) -> FloatArray:
    a, b, c = np.moveaxis(points[corners], 1, 0)
    return np.asarray((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2


def _note(wrong: list[str], count: int, what: str, places: FloatArray) -> None:
    """Adds a mistake with its count and the first of its places (n, 2 or 3), if there is any."""
    if count:
        more = ", ..." if count > 3 else ""
        wrong.append(f"{count} {what}, at {', '.join(map(_place, places[: min(3, int(count))]))}{more}")


def _place(xy: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.6g}' for x in xy)})"


def _refuse(path: str | Path, wrong: list[str]) -> None:
    if wrong:
        lines = "".join(f"\n  {line}" for line in wrong)
        raise ValueError(
            f"Input path of read must be a plane mesh of triangles with named boundaries; {path} has{lines}"
        )
