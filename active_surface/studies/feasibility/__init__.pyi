from .area import ACROSS as ACROSS, Feasible as Feasible, find_feasible as find_feasible
from .case import feasibility as feasibility
from .pick import Picked as Picked, pick as pick
from .report import lines as lines, warnings as warnings
from .result import Feasibility as Feasibility
