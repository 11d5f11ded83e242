from .equilibrium import NotConverged as NotConverged
from .large_deflection import LargeDeflection as LargeDeflection
from .reduced import ReducedPlate as ReducedPlate
from .reduced_equilibrium import energy as energy, equilibrium as equilibrium
from .reduction import Reduction as Reduction, reduce as reduce
from .state import DeflectedPlate as DeflectedPlate
from .supports import movable_by_boundary as movable_by_boundary
