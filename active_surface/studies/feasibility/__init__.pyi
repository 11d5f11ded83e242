from .area import ACROSS as ACROSS, Feasible as Feasible, find_feasible as find_feasible
from .case import feasibility as feasibility
from .pick import Picked as Picked, pick as pick
from .report import lines as lines, warnings as warnings
from .result import Feasibility as Feasibility

# Not public: for the rooms beside.
from .area import moving as moving
from .places import (
    on_plate as on_plate,
    responses_of as responses_of,
    resting_of as resting_of,
    squares_within as squares_within,
)
