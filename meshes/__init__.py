"""Triangle meshes of plate outlines, with named boundaries and their true curves."""

from meshes.curves import Circle, Ellipse, Parabolas
from meshes.mesh import Corner, PlateMesh
from meshes.outline import Outline
from meshes.polygon import polygon
from meshes.read import read
from meshes.shapes import annulus, disc, ellipse, rectangle

__all__ = [
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
    "read",
    "rectangle",
]
