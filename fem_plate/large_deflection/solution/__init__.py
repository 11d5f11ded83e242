"""Full solutions: the plate on one mesh, and Newton's method for its equilibrium."""

from fem_plate.large_deflection.solution.bordered import BorderedSolver
from fem_plate.large_deflection.solution.cells import level_of
from fem_plate.large_deflection.solution.discrete import DiscretePlate
from fem_plate.large_deflection.solution.equilibrium import Coefficients, Loads, NotConverged, Solution
from fem_plate.large_deflection.solution.trial import Trial
