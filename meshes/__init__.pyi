from .curves import Circle as Circle, Ellipse as Ellipse, Parabolas as Parabolas
from .mesh import Corner as Corner, PlateMesh as PlateMesh
from .outline import Outline as Outline
from .polygons import polygon as polygon, regular_polygon as regular_polygon
from .reader import from_skfem as from_skfem, read as read
from .shapes import annulus as annulus, disc as disc, ellipse as ellipse, rectangle as rectangle

# Not public: for the packages that build on this one.
from .fill import delaunay as delaunay
from .outline import rim_curves as rim_curves
from .mesh import facets_of as facets_of, skfem_mesh as skfem_mesh
from .triangles import areas as areas, cross as cross, edge_numbers as edge_numbers, sides as sides
