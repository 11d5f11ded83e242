"""A plate that stretches: its reduced model over time, and the drives of its corrections."""

from coupling.stretch.corrections import Corrections, correction_drives
from coupling.stretch.equilibrium import Equilibrium, energy, equilibrium
from coupling.stretch.reduced import ReducedPlate
