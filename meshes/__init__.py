"""Triangle meshes of plate outlines, with named boundaries and their true curves."""

from meshes.curves import Circle
from meshes.mesh import PlateMesh
from meshes.shapes import disc

__all__ = ["Circle", "PlateMesh", "disc"]
