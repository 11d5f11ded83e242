"""Actuators: where each one is and how it is driven, one by one or as a lattice."""

from coupling.case.actuators.drive import ENDLESS, MIN_SPACING, ActuatorCase, DriveCase, SegmentCase
from coupling.case.actuators.heights import amplitude
from coupling.case.actuators.lattice import LatticeCase
from coupling.case.actuators.lattice_places import (
    SAME_PLACE,
    Place,
    Stand,
    gaps,
    half_size,
    must_be_inside,
    outside,
    shared_places,
)
