from .basins import Basin as Basin, Basins as Basins, Fate as Fate
from .drift import ACROSS as ACROSS, Drift as Drift, DriftMap as DriftMap, drift as drift
