"""What a field of a file may hold: quantities with units, formulas, and columns of numbers in CSV files."""

from coupling.case.values.annotations import adapter, of_kind, parts_of, quantity_of
from coupling.case.values.csv_columns import (
    Columns,
    MeasuredColumns,
    by_line,
    first_of,
    name_and_unit,
    read_columns,
    read_rows,
    unreadable,
)
from coupling.case.values.dimensions import DIMENSIONS, RANGES
from coupling.case.values.expression import LONGEST
from coupling.case.values.formula import Amount, Choice, Condition, Formula, unit_of
from coupling.case.values.quantities import (
    AXES,
    Angle,
    Area,
    Density,
    Directed,
    FileBeside,
    Force,
    Foundation,
    Frequency,
    Gravity,
    Length,
    LoadPressure,
    Mass,
    Point,
    PositiveArea,
    PositiveForce,
    PositiveLength,
    PositivePressure,
    PositiveTime,
    Pressure,
    Stiffness,
    SurfaceEnergy,
    Tension,
    Time,
    Velocity,
)
from coupling.case.values.units import (
    POSITIVE,
    UNITS_REQUIRED,
    WRITTEN,
    Quantity,
    length_text,
    number_and_unit,
    prefixed,
    quoted,
    written_unit,
)
