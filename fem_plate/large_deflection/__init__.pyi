from .fine_enough import fine_enough as fine_enough
from .large_deflection import LargeDeflection as LargeDeflection
from .reduction import (
    Columns as Columns,
    Forms as Forms,
    HeldShapes as HeldShapes,
    ReducedEquilibrium as ReducedEquilibrium,
    ReducedPlate as ReducedPlate,
    Reduction as Reduction,
    StretchedShapes as StretchedShapes,
    energy as energy,
    mode_columns as mode_columns,
    reduce as reduce,
    reduced_equilibrium as reduced_equilibrium,
    with_modes as with_modes,
)
from .solution import DiscretePlate as DiscretePlate, NotConverged as NotConverged, level_of as level_of
from .state import DeflectedPlate as DeflectedPlate
from .supports import check_stretches as check_stretches, movable_by_boundary as movable_by_boundary
