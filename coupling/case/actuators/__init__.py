"""Actuators: where each one is and how it is driven, one by one or as a lattice."""

from coupling.case.actuators.drive import ENDLESS, MIN_SPACING, ActuatorCase, Angles, DriveCase, SegmentCase, amplitude
from coupling.case.actuators.lattice import (
    SAME_PLACE,
    LatticeCase,
    Place,
    actuators_of,
    gaps,
    half_size,
    must_be_inside,
    outside,
)
