from .accuracy import BAND as BAND, distances as distances, within as within
from .coming_off import paragraph as paragraph
from .convergence import (
    ANY as ANY,
    HIGH as HIGH,
    LOW as LOW,
    converge as converge,
    from_start as from_start,
    from_states as from_states,
    leave as leave,
)
from .deceleration import slowing as slowing, slowing_paths as slowing_paths
from .feasible_area import onset as onset
from .handover import HANDOVERS as HANDOVERS, Handover as Handover, arrives as arrives
from .neighbours import CYCLES as CYCLES, Trend as Trend, trend_of as trend_of
from .pairs import SURFACES as SURFACES, paths_of as paths_of
from .radial import one_cycle as one_cycle
from .threshold import (
    HIGHEST as HIGHEST,
    LOWEST as LOWEST,
    STATED_STROKE as STATED_STROKE,
    ends_of as ends_of,
    thresholds as thresholds,
)
