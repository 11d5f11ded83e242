from .read import read_study as read_study
from .run import Sweep as Sweep, run_study as run_study
from .study import Study as Study

# Not public: for the packages that build on this one.
from .sweep_file import key_of as key_of, read_sweep as read_sweep
from .engine import AT_ONCE as AT_ONCE, Engine as Engine
from .record import OUTCOMES as OUTCOMES, REFUSED as REFUSED, SENTENCES as SENTENCES
from .refusal import contact_of as contact_of, start_faults as start_faults
from .report import figures as figures, lines as lines
from .run import ENDING as ENDING
from .tables import StudyTables as StudyTables
