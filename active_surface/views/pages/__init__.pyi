from .run_page import PARTIAL as PARTIAL, write_run_page as write_run_page
from .study_page import write_study_page as write_study_page
