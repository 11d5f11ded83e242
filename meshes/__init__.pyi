from .curves import Circle as Circle, Ellipse as Ellipse, Parabolas as Parabolas
from .mesh import Corner as Corner, PlateMesh as PlateMesh
from .outline import Outline as Outline
from .polygons import polygon as polygon, regular_polygon as regular_polygon
from .reader import from_skfem as from_skfem, read as read
from .shapes import annulus as annulus, disc as disc, ellipse as ellipse, rectangle as rectangle

# Not public: for the packages that build on this one.
from .drawing import (
    Drawing as Drawing,
    SIZE as SIZE,
    STEPS as STEPS,
    draw_rim as draw_rim,
    label_axis as label_axis,
    label_places as label_places,
    legend_below as legend_below,
    notebook_html as notebook_html,
    plotted as plotted,
)
from .fill import delaunay as delaunay
from .hdf5 import DEADLY as DEADLY, UNREADABLE as UNREADABLE, check_hdf5 as check_hdf5, survives as survives
from .outline import rim_curves as rim_curves
from .prefixes import (
    NOTHING as NOTHING,
    Unit as Unit,
    quantity_text as quantity_text,
    range_text as range_text,
    unit_for as unit_for,
)
from .scikit_fem import facets_of as facets_of, skfem_mesh as skfem_mesh
from .triangles import areas as areas, cross as cross, edge_numbers as edge_numbers, sides as sides
