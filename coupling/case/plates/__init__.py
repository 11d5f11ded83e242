"""Plates and platforms: shape, material, supports, motion."""

from coupling.case.plates.plate import INERTIA, VON_KARMAN, PlateCase
from coupling.case.plates.platform import RATES, AxisCase, MotionCase, PlatformCase
from coupling.case.plates.shapes import (
    PLATFORM,
    AnnulusCase,
    AnyPlate,
    DiscCase,
    EllipseCase,
    MeshCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
    ShapeCase,
)
