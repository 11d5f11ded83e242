"""The discrete plate: the Argyris element, its matrices up to the true rim, corners, and known answers to loads."""

from fem_plate.elements.field import Estimated, Field, Fields
from fem_plate.elements.grading import Fineness, Singular, corner_rows, graded, singular_corners
from fem_plate.elements.model import PlateModel
from fem_plate.elements.singular import UNIT_STRENGTH, point_load, point_value
from fem_plate.elements.supports import CLAMPED, by_boundary
