"""The elastic plate: Kirchhoff-Love finite elements under point actuators, and the theory they are checked against."""

from fem_plate import analytic
from fem_plate.deflection import Deflection
from fem_plate.export import neighbour_coupling, save_influence
from fem_plate.influence import InfluenceShapes, Shapes
from fem_plate.patched import PatchedShapes, PlateShapes
from fem_plate.plate import Plate
from fem_plate.section import PlateSection
from fem_plate.vibration import Modes

__all__ = [
    "Deflection",
    "InfluenceShapes",
    "Modes",
    "PatchedShapes",
    "Plate",
    "PlateSection",
    "PlateShapes",
    "Shapes",
    "analytic",
    "neighbour_coupling",
    "save_influence",
]
