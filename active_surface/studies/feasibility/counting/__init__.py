"""Counting: kernels that look at many places at once; an edit elsewhere does not compile them anew."""

from active_surface.studies.feasibility.counting.slips import (
    SHARES,
    SIDE,
    Fields,
    count_lost,
    count_slips,
    find_held,
    find_responses,
    find_states,
)

__all__ = ["SHARES", "SIDE", "Fields", "count_lost", "count_slips", "find_held", "find_responses", "find_states"]
