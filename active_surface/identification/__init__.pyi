from .identify import identify as identify
from .result import Estimate as Estimate, Identified as Identified
from .track import Track as Track, read_track as read_track

# Not public: for the packages that build on this one.
from .parameters import free_parameters as free_parameters
from .result import check_free as check_free
