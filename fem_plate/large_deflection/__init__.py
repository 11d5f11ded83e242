"""Large deflection: von Karman's plate, which stretches as it bends."""

from fem_plate.large_deflection.equilibrium import NotConverged
from fem_plate.large_deflection.large_deflection import LargeDeflection
from fem_plate.large_deflection.state import DeflectedPlate
from fem_plate.large_deflection.supports import movable_by_boundary
