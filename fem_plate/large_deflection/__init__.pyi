from .cells import level_of as level_of
from .fine_enough import fine_enough as fine_enough
from .equilibrium import NotConverged as NotConverged
from .large_deflection import LargeDeflection as LargeDeflection
from .reduced import Forms as Forms, ReducedPlate as ReducedPlate
from .reduced_solver import (
    ReducedEquilibrium as ReducedEquilibrium,
    energy as energy,
    reduced_equilibrium as reduced_equilibrium,
)
from .reduction import Reduction as Reduction, reduce as reduce
from .shapes import StretchedShapes as StretchedShapes
from .discrete import DiscretePlate as DiscretePlate
from .snapshots import Columns as Columns
from .with_inertia import HeldShapes as HeldShapes, mode_columns as mode_columns, with_modes as with_modes
from .state import DeflectedPlate as DeflectedPlate
from .supports import movable_by_boundary as movable_by_boundary
