"""The elastic plate: Kirchhoff-Love finite elements under point actuators, and the theory they are checked against."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "AnisotropicSection",
    "DeflectedPlate",
    "Deflection",
    "InfluenceFit",
    "InfluenceShapes",
    "LargeDeflection",
    "MeasuredInfluence",
    "Modes",
    "PatchedShapes",
    "Plate",
    "PlateSection",
    "PlateShapes",
    "Shapes",
    "VaryingSection",
    "analytic",
    "backbone",
    "fit_influence",
    "neighbour_coupling",
    "read_influence",
    "save_influence",
]
