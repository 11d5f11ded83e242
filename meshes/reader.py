"""Meshes from the files of mesh generators: read, check, build."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from meshes.curves import Parabolas
from meshes.files import line_names, load
from meshes.mesh import PlateMesh
from meshes.nearest import on_edges, powers
from meshes.shapes import check_lengths
from meshes.triangles import areas, cross, edge_numbers, sides
from meshes.types import BoolArray, FloatArray, IntArray

if TYPE_CHECKING:
    from skfem import MeshTri1, MeshTri2

PLANE = 1e-9  # of the box: how far points may lie off their plane
FARTHEST, SMALLEST = 1e6, 1e-15  # m, where points are and how far apart, beyond which squares lose their digits
MIN_AREA = 1e-12  # of the box
STRAIGHT = 1e-9  # of the chord: edges whose middle is closer to it are straight
RIM = "rim"  # the boundary of a mesh that names none
WANTED = "a plane mesh of triangles with named boundaries"
GMSH = "give them a Physical Curve name in gmsh"
SURFACE = "give the plate a Physical Surface in gmsh, without which only the named curves are saved"
NUMBERED = "give them lines, with a whole number each in the cell data boundary"
BENT = 1e-6  # of the chord: inner edges must not be bent more


class Found(NamedTuple):
    """What a file or another program's mesh holds."""

    points: FloatArray  # (n, 2 or 3)
    corners: IntArray  # (m, 3) rows of points
    middles: IntArray  # (m, 3) of the edges 01, 12, 20; -1 in cells of first order
    lines: IntArray  # (l, 2) rows of points
    names: list[set[str]]  # of each line
    naming: str  # how boundaries get names there


class RimEdges(NamedTuple):
    """The edges of the rim."""

    edges: IntArray  # (k, 2) rows of points, the plate on their left
    pieces: FloatArray  # (k, 3, 2), start, middle and end
    bent: BoolArray  # (k,)


def read(path: str | Path, unit: float = 1.0) -> PlateMesh:
    """Read a mesh file: .msh of gmsh 2 and 4, .vtu or .xdmf, with triangles of first or second order.

    Second-order .xdmf is not supported. Boundaries are the file's lines, by the names of their physical curves in gmsh,
    or by their number in formats without names. Curved rims of second-order cells are kept. Points that no triangle
    uses are dropped.

    Parameters
    ----------
    path : path-like
        The file.
    unit : float
        Metres per unit of the file's lengths. Places stay where they are in the file.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        The file cannot be read; or names, with counts and the first places in the file's unit, everything in it that is
        not a plane conforming mesh with named boundaries.
    """
    check_lengths("read", unit=unit)
    mesh = load(Path(path))
    mistakes: list[str] = []
    corners, middles = _cells(mesh, mistakes)
    lines = [np.asarray(block.data, dtype=np.int64)[:, :2] for block in mesh.cells if block.type in ("line", "line3")]
    pairs = np.concatenate([*lines, np.empty((0, 2), dtype=np.int64)])
    naming = GMSH if Path(path).suffix.lower() == ".msh" else NUMBERED
    found = Found(np.asarray(mesh.points, dtype=float), corners, middles, pairs, line_names(mesh), naming)
    return _plate_mesh(found, unit, mistakes, f"path of read must be {WANTED}; {path} has")


def from_skfem(mesh: MeshTri1 | MeshTri2, unit: float = 1.0) -> PlateMesh:
    """The plate's mesh of scikit-fem's triangles; curved rims of a `MeshTri2` are kept.

    Parameters
    ----------
    mesh : skfem.MeshTri1 or skfem.MeshTri2
        Its named boundaries cover the rim; without any, all of the rim is "rim".
    unit : float
        Metres per unit of the mesh's lengths.

    Returns
    -------
    PlateMesh

    Raises
    ------
    ValueError
        Names everything that is not a plane conforming mesh of triangles with named boundaries.
    """
    check_lengths("from_skfem", unit=unit)
    wrong = f"mesh of from_skfem must be {WANTED}; it has"
    if type(mesh).__name__ not in ("MeshTri1", "MeshTri2"):
        _refuse([f"the type {type(mesh).__name__}, not MeshTri1 or MeshTri2"], wrong)
    corners, middles = mesh.t.T.astype(np.int64), np.full((mesh.t.shape[1], 3), -1)
    if type(mesh).__name__ == "MeshTri2":
        middles = mesh.dofs.element_dofs[3:].T.astype(np.int64)  # of edges 01, 12 and 02
    boundaries = mesh.boundaries or {RIM: mesh.boundary_facets()}
    pairs = [mesh.facets[:, facets].T.astype(np.int64) for facets in boundaries.values()]
    names = [{name} for name, facets in boundaries.items() for _ in facets]
    found = Found(mesh.doflocs.T, corners, middles, np.concatenate(pairs), names, "name them with `with_boundaries`")
    return _plate_mesh(found, unit, [], wrong)


def _plate_mesh(found: Found, unit: float, mistakes: list[str], wrong: str) -> PlateMesh:
    """The mesh of what was found; raises ValueError with all mistakes."""
    points, corners, middles, pairs, line_sets, naming = found
    if not len(corners):
        mistakes.append("no triangles" + f"; {SURFACE}" * (naming == GMSH))
        _refuse(mistakes, wrong)
    for numbers, what in ((corners, "triangle"), (middles, "curved triangle"), (pairs, "line")):
        lowest = -1 if numbers is middles else 0
        wild = ((numbers < lowest) | (numbers >= len(points))).any(axis=1)
        if wild.any():
            first = f"the first with points {numbers[wild][0].tolist()}, counted from 0"
            mistakes.append(
                f"{_counted(wild.sum(), what)} between points that are not there, of {len(points)}: {first}"
            )
    if mistakes:
        _refuse(mistakes, wrong)
    used = np.unique(np.concatenate([corners.ravel(), middles[middles >= 0]]))
    lost = used[~np.isfinite(points[used]).all(axis=1)]
    if len(lost):
        _note(mistakes, len(lost), "point", "with coordinates that are not finite", points[lost])
        _refuse(mistakes, wrong)
    far = used[(np.abs(points[used]) * unit > FARTHEST).any(axis=1)]
    if len(far):
        _note(mistakes, len(far), "point", f"more than {FARTHEST:g} m from the origin", points[far])
        _refuse(mistakes, wrong)
    box = np.ptp(points[used, :2], axis=0)
    if box.max() * unit < SMALLEST:
        _refuse([f"all its points within {box.max() * unit:g} m"], wrong)
    if points.shape[1] == 3:
        off = used[np.abs(points[used, 2] - np.median(points[used, 2])) > PLANE * box.max()]
        _note(mistakes, len(off), "point", "off the plane of the others", points[off])
    points = points[:, :2]
    corners, middles = _turned_over(points, corners, middles)
    _check_cells(points, corners, box.prod(), mistakes)
    rim = _edges(points, corners, middles, mistakes)
    pieces = _pieces(corners)
    if pieces > 1:
        mistakes.append(f"{pieces} pieces that do not hang together: a plate is one")
    names = np.array(_names(pairs, line_sets, points, rim.edges, naming, mistakes))
    _refuse(mistakes, wrong)
    kept, rows = np.unique(corners, return_inverse=True)
    boundaries, curves = {}, {}
    for name in dict.fromkeys(names.tolist()):
        on_boundary = names == name
        boundaries[name] = np.searchsorted(kept, rim.edges[on_boundary])
        if rim.bent[on_boundary].any():
            curves[name] = Parabolas(unit * rim.pieces[on_boundary])
    return PlateMesh(unit * points[kept], rows.reshape(-1, 3), boundaries, curves)


def _cells(mesh: Any, mistakes: list[str]) -> tuple[IntArray, IntArray]:
    """The triangles' corners (m, 3) and the middles (m, 3) of their edges 01, 12, 20, -1 in first-order ones."""
    corners, middles = [np.empty((0, 3), dtype=np.int64)], [np.empty((0, 3), dtype=np.int64)]
    for block in mesh.cells:
        data = np.asarray(block.data, dtype=np.int64)
        if block.type in ("triangle", "triangle6"):
            corners.append(data[:, :3])
            middles.append(data[:, 3:] if block.type == "triangle6" else np.full((len(data), 3), -1))
        elif block.type not in ("vertex", "line", "line3"):
            mistakes.append(
                f"{_counted(len(data), 'cell')} of kind {block.type}: only triangle and triangle6 can be used"
            )
    return np.concatenate(corners), np.concatenate(middles)


def _turned_over(points: FloatArray, corners: IntArray, middles: IntArray) -> tuple[IntArray, IntArray]:
    """The cells, all counter-clockwise: a file may turn them either way, as surfaces of a CAD model are."""
    clockwise = areas(points, corners)[:, None] < 0
    return np.where(clockwise, corners[:, [0, 2, 1]], corners), np.where(clockwise, middles[:, [2, 1, 0]], middles)


def _pieces(corners: IntArray) -> int:
    """How many pieces cells (m, 3) make that have no point in common."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    used, rows = np.unique(corners, return_inverse=True)
    start, end = sides(rows.reshape(-1, 3)).T
    links = coo_array((np.ones(len(start)), (start, end)), shape=(len(used), len(used)))
    return int(connected_components(links, directed=False)[0])


def _check_cells(points: FloatArray, corners: IntArray, box: float, mistakes: list[str]) -> None:
    flat = areas(points, corners) <= MIN_AREA * box
    _note(mistakes, flat.sum(), "cell", "without an area", points[corners].mean(axis=1)[flat])


def _edges(points: FloatArray, corners: IntArray, middles: IntArray, mistakes: list[str]) -> RimEdges:
    """The edges of the rim; notes what is wrong with any edge."""
    pairs = sides(corners)
    apex, middle = points[np.roll(corners, -2, axis=1).ravel()], middles.ravel()
    _, edge, count = np.unique(edge_numbers(pairs, len(points)), return_inverse=True, return_counts=True)
    halfway = points[pairs].mean(axis=1)
    many = np.unique(edge[count[edge] > 2], return_index=True)[1]
    _note(mistakes, len(many), "edge", "shared by more than two cells", halfway[np.flatnonzero(count[edge] > 2)[many]])
    ascending = np.bincount(edge, pairs[:, 0] < pairs[:, 1])
    over = (count[edge] == 2) & (ascending[edge] != 1)
    folds = np.flatnonzero(over)[np.unique(edge[over], return_index=True)[1]]
    _note(mistakes, len(folds), "edge", "at which the plate folds back over itself", halfway[folds])
    start, end = np.moveaxis(points[pairs], 1, 0)
    pieces = np.stack([start, np.where(middle[:, None] < 0, halfway, points[middle]), end], axis=1)
    chord, rise = end - start, pieces[:, 1] - start
    sag = np.abs(cross(chord, rise))
    square = np.maximum((chord**2).sum(axis=1), np.finfo(float).tiny)
    on_rim = count[edge] == 1
    curved = (sag > BENT * square) & ~on_rim
    _note(
        mistakes, len(np.unique(edge[curved])), "curved edge", "inside the plate: only the rim may be", halfway[curved]
    )
    bent = sag > STRAIGHT * square
    pieces[~bent, 1] = halfway[~bent]
    suspects = np.flatnonzero(bent & on_rim)
    along, out = _walk(pieces[suspects], np.linspace(0, 1, 5))
    out = out - apex[suspects, None]
    folded = suspects[cross(out, along).min(axis=1) <= 0]
    _note(mistakes, len(folded), "cell", "folded by a curved edge", halfway[folded])
    return RimEdges(pairs[on_rim], pieces[on_rim], bent[on_rim])


def _walk(pieces: FloatArray, s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Derivatives and points (k, n, 2) of pieces (k, 3, 2) at parameters s (n,)."""
    _, slope, bend = powers(pieces)
    return slope[:, None] + 2 * s[:, None] * bend[:, None], on_edges(pieces, np.tile(s, (len(pieces), 1)))


def _names(
    lines: IntArray,
    line_sets: Sequence[set[str]],
    points: FloatArray,
    edges: IntArray,
    naming: str,
    mistakes: list[str],
) -> list[str]:
    """The name of each rim edge (k, 2), from lines (l, 2) and the names of each."""
    by_number: dict[int, set[str]] = {}
    for number, of_line in zip(edge_numbers(lines, len(points)).tolist(), line_sets, strict=True):
        by_number.setdefault(number, set()).update(of_line)
    of_edges = [by_number.get(number, set()) for number in edge_numbers(edges, len(points)).tolist()]
    unnamed = np.array([not names for names in of_edges])
    if unnamed.any():
        count, first = int(unnamed.sum()), points[edges[unnamed][0]]
        ends = " and ".join(_place(end) for end in first)
        between = f"the first between {ends}" if count > 1 else f"between {ends}"
        mistakes.append(f"an unnamed boundary: {_counted(count, 'edge')}, {between}; {naming}")
    double = np.array([len(names) > 1 for names in of_edges])
    _note(mistakes, double.sum(), "boundary edge", "with more than one name", points[edges[double]].mean(axis=1))
    return [min(names, default="") for names in of_edges]


def _note(mistakes: list[str], count: int, noun: str, what: str, places: FloatArray) -> None:
    """Add a mistake with its count and its first places (n, 2 or 3), if there are any."""
    if count:
        more = ", ..." if count > 3 else ""
        mistakes.append(
            f"{_counted(count, noun)} {what}, at {', '.join(map(_place, places[: min(3, int(count))]))}{more}"
        )


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' * bool(count != 1)}"


def _place(xy: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.6g}' for x in xy)})"


def _refuse(mistakes: list[str], wrong: str) -> None:
    if mistakes:
        raise ValueError(f"Input {wrong}" + "".join(f"\n  {line}" for line in mistakes))
