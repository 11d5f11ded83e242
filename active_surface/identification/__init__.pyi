from .estimate import Estimate as Estimate, TrackFit as TrackFit
from .identify import identify as identify
from .result import Identified as Identified
from .track import Track as Track, read_track as read_track

# Not public: for the packages that build on this one.
from .parameters import parameters_of as parameters_of
from .result import case_names as case_names, free_files as free_files
