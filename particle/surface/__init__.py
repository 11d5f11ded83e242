"""The moving surface: its cells, and the polynomial that a part sees of it."""

from particle.surface.at_point import (
    SurfacePoint,
    height_here,
    motion_at,
    plane_jet,
    point_of,
    set_time,
    surface_at,
    surface_here,
)
from particle.surface.bridge import allow_bridges
from particle.surface.cells import (
    NO_PLANE,
    NOWHERE,
    UNBUILT,
    WHOLE,
    BuiltCells,
    CellFit,
    CellPool,
    Cells,
    cells_of,
    columns_of,
)
from particle.surface.jet import Jet, jet
from particle.surface.local import (
    Frame,
    LocalSurface,
    cell_at,
    gap_at,
    missing_place,
    new_local,
    prepare,
    within_cell,
    within_frame,
)
from particle.surface.moving_surface import SurfaceMotion
from particle.surface.record import BASE, Surface
from particle.surface.rim import ROUNDING, first_beyond, has_rim, rim_gap
from particle.surface.span import enter
