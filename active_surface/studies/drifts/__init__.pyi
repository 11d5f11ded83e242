from .basins import Basin as Basin, Basins as Basins, Fate as Fate, Field as Field, basins_of as basins_of
from .maps import Check as Check, DriftMap as DriftMap
from .pictures import LOST as LOST, shades as shades
from .result import Drift as Drift
from .runs import ACROSS as ACROSS, STAGES as STAGES, drift as drift, running_groups as running_groups
