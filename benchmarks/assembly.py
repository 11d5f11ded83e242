"""Assembly of the bending matrix on a polygon: this project against scikit-fem's Argyris element, equal unknowns."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np
from scipy.sparse import csc_matrix
from skfem import Basis, BilinearForm, ElementTriArgyris, MeshTri
from skfem.helpers import dd, ddot, trace

from fem_plate.elements import forms
from fem_plate.elements.argyris import Triangles
from fem_plate.elements.assembly import number_entities, sum_up
from fem_plate.sections import bending_law
from meshes import PlateMesh, disc

CELLS_FROM_CENTRE = (4, 8, 16)
REPEATS = 7
AGREEMENT = 1e-6
POISSON_RATIO = 0.3


@BilinearForm
def bending(u, v, _):  # type: ignore[no-untyped-def]
    hu, hv = dd(u), dd(v)
    return (1 - POISSON_RATIO) * ddot(hu, hv) + POISSON_RATIO * trace(hu) * trace(hv)


def ours(mesh: PlateMesh) -> csc_matrix:
    triangles = Triangles(mesh.points, mesh.triangles)
    entities, first = number_entities(mesh.triangles, mesh.triangles, triangles.functions)
    return sum_up(forms.bending(triangles, bending_law(POISSON_RATIO)), entities, first)


def stock(mesh: PlateMesh) -> csc_matrix:
    """With the least quadrature that is exact, and without a table of dof locations."""
    return bending.assemble(Basis(grid(mesh), ElementTriArgyris(), intorder=6, disable_doflocs=True))


def default(mesh: PlateMesh) -> csc_matrix:
    """As it comes."""
    return bending.assemble(Basis(grid(mesh), ElementTriArgyris()))


def grid(mesh: PlateMesh) -> MeshTri:
    return MeshTri(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.triangles.T))


def seconds(work: Callable[[PlateMesh], csc_matrix], mesh: PlateMesh) -> float:
    begin = perf_counter()
    work(mesh)
    return perf_counter() - begin


def table() -> list[str]:
    """Lines of a table: first the matrices must agree, then they are timed in turns."""
    lines = [
        "| unknowns | scikit-fem, same quadrature | scikit-fem, default | largest difference of the diagonals |",
        "|---:|---:|---:|---:|",
    ]
    for cells in CELLS_FROM_CENTRE:
        mesh = disc(1.0, 1 / cells)
        # No choice of edge normals or order of unknowns changes the sorted diagonal.
        mine, *theirs = (np.sort(work(mesh).diagonal()) for work in (ours, stock, default))
        difference = max(float(np.abs(mine / other - 1).max()) for other in theirs)
        assert difference < AGREEMENT, f"the matrices differ by {difference:.1e}"
        rounds = [[seconds(work, mesh) for work in (ours, stock, default)] for _ in range(REPEATS)]
        ratios = [[times[k] / times[0] for times in rounds] for k in (1, 2)]
        same, plain = (f"{median(r):.0f} ({min(r):.0f} - {max(r):.0f})" for r in ratios)
        lines.append(f"| {len(mine)} | {same} | {plain} | {difference:.0e} |")
    return lines
