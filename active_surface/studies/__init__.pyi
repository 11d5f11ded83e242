from .drifts import Basin as Basin, Basins as Basins, Drift as Drift, DriftMap as DriftMap, drift as drift
from .read import read_study as read_study
from .run import Sweep as Sweep, run_study as run_study
from .study import Study as Study

# Not public: for the packages that build on this one.
from .columns import OUTCOMES as OUTCOMES, REFUSED as REFUSED, SENTENCES as SENTENCES
from .engine import AT_ONCE as AT_ONCE, Engine as Engine
from .read import StudyTables as StudyTables, read_sweep as read_sweep
from .run import ENDING as ENDING, figures as figures, lines as lines
from .study import contact_of as contact_of, start_faults as start_faults
from .sweep_file import key_of as key_of
