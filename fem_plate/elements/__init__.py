"""The discrete plate: the Argyris element, its matrices up to the true rim, corners, and responses in closed form."""

from fem_plate.elements import forms
from fem_plate.elements.anisotropic import AnisotropicPlate
from fem_plate.elements.argyris import DEGREE
from fem_plate.elements.corners import MAX_EXPONENT
from fem_plate.elements.dipoles import SourceBasis, source_basis
from fem_plate.elements.energy import PlateEnergy, plate_energy
from fem_plate.elements.factor import factorised
from fem_plate.elements.functions import Derivatives, PlateFunctions
from fem_plate.elements.grading import (
    COARSE_GAIN,
    GAIN,
    MeshGrading,
    SingularCorner,
    corner_rows,
    grade_mesh,
    singular_corners,
)
from fem_plate.elements.infinite import UNIT_STRENGTH, point_load, point_value
from fem_plate.elements.model import PlateModel
from fem_plate.elements.rim import CLAMPED, FREE, SIMPLY_SUPPORTED, by_boundary, rigid_motions, rim_quadrature
from fem_plate.elements.space import QUADRATURE, PlateSpace
from fem_plate.elements.wedges import rounded_corners, wedges
