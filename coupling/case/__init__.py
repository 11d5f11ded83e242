"""The case: what one run simulates, as a TOML file or in Python."""

from coupling.case import schema
from coupling.case.annotations import of_kind, parts_of, quantity_of
from coupling.case.case import (
    TABLES,
    AnyFriction,
    Case,
    CaseError,
    CaseTables,
    ConstantCase,
    CoulombCase,
    FrictionCase,
    KogutEtsionCase,
    PartCase,
    RunCase,
    TableCase,
    read_case,
)
from coupling.case.drive import ENDLESS, ActuatorCase, DriveCase, SegmentCase, amplitude
from coupling.case.keyed_table import WRONG, Contradictions, KeyedTable, adapter
from coupling.case.lattice import LatticeCase
from coupling.case.lattice_places import SAME_PLACE, beyond, gaps, half_size
from coupling.case.lines import LACKS_DEFAULT, Location, find_problems, in_file, load, message_of, shown_location
from coupling.case.plate import AnnulusCase, DiscCase, EllipseCase, MeshCase, PlateCase, RectangleCase
from coupling.case.platform import AXES, MotionCase, PlatformCase
from coupling.case.table import Table
from coupling.case.templates import template
from coupling.case.text import write_case
from coupling.case.units import UNITS_REQUIRED, Directed, Frequency, Length, Point, Quantity, Time, shown, shown_length
