"""Assembly of the bending matrix: this project's Argyris element against scikit-fem's own, at equal unknowns.

Both are first shown to give the same matrix (its diagonal, which no choice of edge normals changes), then timed in
turns. Run it with `.venv/bin/python benchmarks/assembly.py`; it prints a table of medians as ratios.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from time import perf_counter

import numpy as np
from scipy.sparse import csr_matrix
from skfem import CellBasis, ElementTriArgyris, MeshTri

from fem_plate import forms
from fem_plate.argyris import ArgyrisBasis, ElementArgyris
from meshes import disc

CELLS_FROM_CENTRE = (4, 8, 12)
REPEATS = 5
POISSON_RATIO = 0.3


def ours(grid: MeshTri) -> csr_matrix:
    """The polygon's bending matrix by the element of `fem_plate`."""
    basis = CellBasis(grid, ElementArgyris(ArgyrisBasis(grid)), intorder=6, disable_doflocs=True)
    return forms.bending(POISSON_RATIO).assemble(basis)


def stock(grid: MeshTri) -> csr_matrix:
    """The same by scikit-fem's element."""
    basis = CellBasis(grid, ElementTriArgyris(), intorder=6, disable_doflocs=True)
    return forms.bending(POISSON_RATIO).assemble(basis)


def seconds(work: Callable[[MeshTri], csr_matrix], grid: MeshTri) -> float:
    begin = perf_counter()
    work(grid)
    return perf_counter() - begin


def main() -> None:
    print("unknowns   stock over ours: median (least - most)   largest difference of the diagonals")
    for cells in CELLS_FROM_CENTRE:
        mesh = disc(1.0, 1.0 / cells)
        grid = MeshTri(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.triangles.T))
        mine, theirs = ours(grid).diagonal(), stock(grid).diagonal()
        difference = float(np.abs(mine / theirs - 1).max())
        assert difference < 1e-6, difference
        ratios = [seconds(stock, grid) / seconds(ours, grid) for _ in range(REPEATS)]
        print(f"{len(mine):>8}   {median(ratios):.0f} ({min(ratios):.0f} - {max(ratios):.0f})   {difference:.1e}")


if __name__ == "__main__":
    main()
