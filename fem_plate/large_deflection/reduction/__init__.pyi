from .reduced import Forms as Forms, ReducedPlate as ReducedPlate
from .reduced_solver import (
    ReducedEquilibrium as ReducedEquilibrium,
    energy as energy,
    reduced_equilibrium as reduced_equilibrium,
)
from .reduction import Reduction as Reduction, reduce as reduce
from .shapes import StretchedShapes as StretchedShapes
from .snapshots import Columns as Columns
from .with_inertia import HeldShapes as HeldShapes, mode_columns as mode_columns, with_modes as with_modes
