"""The elastic plate: Kirchhoff-Love finite elements under point actuators, and the theory they are checked against."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "DeflectedPlate",
    "Deflection",
    "InfluenceShapes",
    "LargeDeflection",
    "Modes",
    "PatchedShapes",
    "Plate",
    "PlateSection",
    "PlateShapes",
    "Shapes",
    "analytic",
    "backbone",
    "neighbour_coupling",
    "save_influence",
]
