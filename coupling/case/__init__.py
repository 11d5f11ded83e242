"""The case: what one run simulates, as a TOML file or in Python."""

from coupling.case.case import Case, read_case
from coupling.case.drive import ENDLESS, ActuatorCase, DriveCase, SegmentCase, amplitude
from coupling.case.friction import (
    AnyFriction,
    ConstantCase,
    CoulombCase,
    FrictionCase,
    KogutEtsionCase,
    TableCase,
    has_known_law,
)
from coupling.case.lattice import LatticeCase
from coupling.case.lattice_places import SAME_PLACE, beyond, gaps, half_size
from coupling.case.messages import InputError, Location, Mistake, in_file, location_text, message_of, mistakes_in
from coupling.case.plate import INERTIA, VON_KARMAN, PlateCase
from coupling.case.platform import MotionCase, PlatformCase
from coupling.case.schema import json_schema
from coupling.case.shapes import (
    AnnulusCase,
    DiscCase,
    EllipseCase,
    MeshCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
)
from coupling.case.table import WRONG, Contradictions, KeyedTable, Table, adapter, errors_of, right_value, validate
from coupling.case.tables import CaseTables, PartCase, RunCase
from coupling.case.templates import template
from coupling.case.text import write_case
from coupling.case.theories import MAX_STRETCHING, MAX_VIBRATING
from coupling.case.toml_file import CaseError, Problem, parse
from coupling.case.values import (
    AXES,
    UNITS_REQUIRED,
    Directed,
    Frequency,
    Length,
    Point,
    Quantity,
    Time,
    length_text,
    of_kind,
    parts_of,
    quantity_of,
    quoted,
)
