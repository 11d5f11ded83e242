"""Plates: what the part moves over, a plate of some shape or a rigid platform."""

from coupling.case.plates.any_plate import PLATES, PLATFORM, AnyPlate, ShapelessCase, kind, outline_of
from coupling.case.plates.plate import INERTIA, VON_KARMAN, PlateCase
from coupling.case.plates.platform import RATES, AxisCase, MotionCase, PlatformCase, platform_of
from coupling.case.plates.shapes import (
    AnnulusCase,
    DiscCase,
    EllipseCase,
    MeshCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
    ShapeCase,
)
