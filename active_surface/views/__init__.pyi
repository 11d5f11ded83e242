from .film.animation import Animation as Animation, animate as animate, still as still
from .pages.run_page import write_run_page as write_run_page
from .pages.study_page import write_study_page as write_study_page
from .prints.plots import plot as plot

# Not public: for the packages that build on this one.
from .geometry import thinned as thinned
from .result_file import is_of as is_of, result_of as result_of
from .pages.drift_page import write_drift_page as write_drift_page
from .pages.packed import packed as packed
from .pages.page_file import PARTS as PARTS, part as part
from .pages.run_data import run_data as run_data
