from .case import (
    Case as Case,
    CaseError as CaseError,
    InputError as InputError,
    read_case as read_case,
    read_parts as read_parts,
)
from .results.csv_file import write_csv as write_csv
from .results.saved import SavedRun as SavedRun, read_run as read_run
from .comparison import Comparison as Comparison, compare as compare
from .batch import run_cases as run_cases, run_parts as run_parts
from .parts import PartsResult as PartsResult
from .result import Result as Result
from .run import build_surface as build_surface, run_case as run_case
from .surface.file import read_surface as read_surface, write_surface as write_surface
from .surface.motion import surface_motion as surface_motion

# Not public: for the packages that build on this one.
from .batch import FAILURES as FAILURES, PathTask as PathTask, follow as follow, follow_each as follow_each
from .air import AirFigures as AirFigures, air_figures as air_figures
from .drives import build_drive as build_drive, build_drives as build_drives
from .environment import PACKAGES as PACKAGES, versions as versions
from .files import (
    check_folder as check_folder,
    check_free as check_free,
    check_room as check_room,
    printable as printable,
    remove_partial_files as remove_partial_files,
    whole_file as whole_file,
    why as why,
)
from .progress import (
    Bar as Bar,
    Progress as Progress,
    ProgressCallback as ProgressCallback,
    silent as silent,
    doing as doing,
    no_progress as no_progress,
)
from .outlook import (
    case_warnings as case_warnings,
    frequency_warnings as frequency_warnings,
    limit_warnings as limit_warnings,
)
from . import advice as advice, borders as borders, report as report
from .report import warnings as warnings
from .part import build_friction as build_friction, build_part as build_part, build_point as build_point
from .results import Output as Output
from .run import (
    Rerun as Rerun,
    build_scene as build_scene,
    check_case as check_case,
    follow_part as follow_part,
    one_blas_thread as one_blas_thread,
    quick_summary as quick_summary,
    rerun as rerun,
    run_over as run_over,
    stage_count as stage_count,
)
from .shared import (
    AnsweringSurface as AnsweringSurface,
    answers_drives as answers_drives,
    shared_surface as shared_surface,
)
from .plate_figures import plate_figures as plate_figures
from .solved_plates import SolvedPlates as SolvedPlates, ground_key as ground_key
from .suggestion import near as near
from .margins import Margin as Margin
from .summary import PlateSummary as PlateSummary, Summary as Summary, summary_of as summary_of
from .summary import least_pressure as least_pressure
