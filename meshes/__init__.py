"""Triangle meshes of plate outlines, with named boundaries and their true curves."""

import lazy_loader

__getattr__, __dir__, _ = lazy_loader.attach_stub(__name__, __file__)

__all__ = [  # public; the stub beside has also what other packages of the program use
    "Circle",
    "Corner",
    "Ellipse",
    "Outline",
    "Parabolas",
    "PlateMesh",
    "annulus",
    "disc",
    "ellipse",
    "polygon",
    "from_skfem",
    "read",
    "rectangle",
    "regular_polygon",
]
