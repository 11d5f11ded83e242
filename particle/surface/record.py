"""A moving surface as kernels read it."""

from __future__ import annotations

from typing import NamedTuple

from particle.drives import DriveTable
from particle.group import grouped
from particle.surface.cells import Cells
from particle.types import FloatArray

BASE = 3  # drives that a base has at most: along x, along y, and its turn about the origin


@grouped
class Surface(NamedTuple):
    """A moving surface as kernels read it: arrays and numbers only."""

    drives: DriveTable  # `shape_count` drives, `in_plane_count` ones, then the base's x and y where it moves
    cells: Cells
    shape_count: int
    in_plane_count: int  # shapes of the mid-plane's motion in its plane
    sources: FloatArray  # (J, 2) m, the centres of the logarithms
    size: float  # m, the length in the logarithms and that tolerances refer to
    floor: float  # m, radius below which the Hessian of a logarithm grows no more
    overhang: float  # a cell's polynomials hold out to this many half widths
    conics: FloatArray  # (k, 4) m, the rim's whole ellipses: centre x, y and semi-axes
    edges: FloatArray  # (m, 3, 2) m, its other edges: start, middle and end of parabolas; no rim where both are empty
    base_drives: int  # 0, or the two or three more drives of a base that moves in its plane
    unit: float  # s, of time in the polynomials that are made of cells and drives
