"""The elastic plate: Kirchhoff-Love finite elements under point actuators, and the theory they are checked against."""

from fem_plate import analytic
from fem_plate.plate import Deflection, InfluenceShapes, Plate
from fem_plate.section import PlateSection

__all__ = ["Deflection", "InfluenceShapes", "Plate", "PlateSection", "analytic"]
