from .area import Feasible as Feasible, find_feasible as find_feasible
from .case import feasibility as feasibility
from .report import lines as lines, warnings as warnings
