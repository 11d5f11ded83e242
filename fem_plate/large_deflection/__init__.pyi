from .discrete import DiscretePlate as DiscretePlate, level_of as level_of
from .equilibrium import NotConverged as NotConverged
from .full_solutions import Columns as Columns
from .large_deflection import (
    LargeDeflection as LargeDeflection,
    check_stretches as check_stretches,
    fine_enough as fine_enough,
    movable_by_boundary as movable_by_boundary,
)
from .reduced import Forms as Forms, ReducedPlate as ReducedPlate
from .reduction import Reduction as Reduction, reduce as reduce
from .state import DeflectedPlate as DeflectedPlate
from .with_inertia import mode_columns as mode_columns, with_modes as with_modes
