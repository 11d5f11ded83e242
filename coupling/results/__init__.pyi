from .case_record import CaseRecord as CaseRecord, files_of as files_of, record_of as record_of
from .export import export_run as export_run
from .results import Output as Output, write_results as write_results
from .saved import (
    ENDINGS as ENDINGS,
    SavedRun as SavedRun,
    instead as instead,
    is_run as is_run,
    name_of as name_of,
    read_run as read_run,
    read_runs as read_runs,
)
