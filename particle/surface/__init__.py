"""The moving surface: its cells, and the polynomial that a part sees of it."""

from particle.surface.at_point import Fields, fields, standing
from particle.surface.bridge import allow
from particle.surface.cells import NOWHERE, UNBUILT, WHOLE, BuiltCells, CellFit, CellPool, Cells
from particle.surface.local import (
    BASE,
    CELL,
    END,
    LANDED,
    NEAR,
    SIZE,
    TIME,
    UNIT,
    Local,
    gap_at,
    missing_place,
    new_local,
    prepare,
    within_cell,
)
from particle.surface.moving_surface import Surface, SurfaceMotion
from particle.surface.rim import ROUNDING, first_beyond, rim_gap
from particle.surface.span import enter, go_on
