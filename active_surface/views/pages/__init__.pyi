from .drift_page import write_drift_page as write_drift_page
from .run_page import PARTIAL as PARTIAL, write_run_page as write_run_page
from .study_page import write_study_page as write_study_page
