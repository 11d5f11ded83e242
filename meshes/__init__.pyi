from .curves import Circle as Circle, Ellipse as Ellipse, Parabolas as Parabolas
from .mesh import Corner as Corner, PlateMesh as PlateMesh
from .outline import Outline as Outline
from .polygons import polygon as polygon
from .reader import read as read
from .shapes import annulus as annulus, disc as disc, ellipse as ellipse, rectangle as rectangle

# Not public: for the packages that build on this one.
from .drawing import (
    Drawing as Drawing,
    SIZE as SIZE,
    html as html,
    in_unit as in_unit,
    plan as plan,
    plotted as plotted,
    put_below as put_below,
)
from .fill import delaunay as delaunay, sides as sides
from .refine import edge_numbers as edge_numbers
from .rim_points import rim_curves as rim_curves
