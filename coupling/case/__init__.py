"""The case: what one run simulates, as a TOML file or in Python."""

from coupling.case.actuators import (
    ENDLESS,
    SAME_PLACE,
    ActuatorCase,
    DriveCase,
    LatticeCase,
    SegmentCase,
    amplitude,
    gaps,
    half_size,
    must_be_inside,
)
from coupling.case.case import Case, read_case, read_parts
from coupling.case.checks import MAX_STRETCHING, MAX_VIBRATING, common_period
from coupling.case.fields import Field, Value, find_field, lattice_of, plain_case
from coupling.case.friction import (
    ConstantCase,
    CoulombCase,
    FrictionCase,
    KogutEtsionCase,
    TableCase,
    has_known_law,
)
from coupling.case.groups import endless_case, groups_of, running_case
from coupling.case.part import PART_NAME, PartCase
from coupling.case.plates import (
    INERTIA,
    RATES,
    VON_KARMAN,
    AnnulusCase,
    DiscCase,
    EllipseCase,
    MeshCase,
    MotionCase,
    PlateCase,
    PlatformCase,
    PolygonCase,
    RectangleCase,
    RegularPolygonCase,
    ShapeCase,
)
from coupling.case.scaled import (
    friction_scales,
    largest_stroke,
    more_plastic,
    ramped_case,
    scaled_case,
    scaled_friction,
    with_index,
)
from coupling.case.table import Contradictions, Faults, InputError, Location, Mistake, Table, mistakes_of
from coupling.case.tables import AirCase, CaseTables, RunCase
from coupling.case.toml_file import CaseError, Problem, parse, unfit_name
from coupling.case.values import (
    AXES,
    UNITS_REQUIRED,
    Angle,
    Expected,
    Frequency,
    Length,
    Point,
    Quantity,
    Time,
    length_text,
    quoted,
    read_columns,
    unreadable,
)
from coupling.case.writing import Difference, differences, json_schema, template, write_case, write_edited
